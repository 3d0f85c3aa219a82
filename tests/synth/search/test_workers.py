"""Work in other processes, and on a Dask cluster that loses one: the same lists."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from functools import partial
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

from grashof import load, synthesize
from grashof.problems import MotionTask, Problem, Requirements
from grashof.synth import Result
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search import workers
from grashof.synth.search.plain import plain
from grashof.synth.search.workers import CrashError, OnExecutor, Processes, Work, screen

CONVEYOR = MotionTask.from_degrees([[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70], [360, 0, 90]])
SEARCHES = {
    "poses met": (load("luggage"), {"starts": 40, "enough": 30, "seed": 5}),
    "poses fitted": (Problem(task=CONVEYOR, requirements=Requirements(exact=False)), {"effort": 0.35}),
    "pairs fitted": (load("function-dosing-slide"), {}),
    "limit positions": (load("quick-return"), {}),
    "none": (
        Problem(task=CONVEYOR, requirements=Requirements(link_length=(1.0, 60.0), exact=False)),
        {"effort": 0.2},
    ),
}


def table(result: Result) -> str:
    return result.to_frame().to_csv() + result.note + result.ended


@pytest.mark.slow
@pytest.mark.quick("poses fitted", "pairs fitted", "limit positions")
@pytest.mark.parametrize("kind", SEARCHES)
def test_workers_change_no_byte(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "LONG", 0.0)
    problem, options = SEARCHES[kind]
    alone = table(synthesize(problem, **options))
    assert table(synthesize(problem, **options, workers=2)) == alone


@pytest.fixture
def processes(monkeypatch: pytest.MonkeyPatch) -> Iterator[Processes]:
    """Two of them, which know the functions of this module."""
    monkeypatch.syspath_prepend(Path(__file__).parents[3])
    monkeypatch.setattr(workers, "LONG", 0.0)
    made = Processes(2)
    made._timer.join()
    yield made
    made.end()


def crash(_scaled: ScaledProblem, code: int) -> None:
    os._exit(code)


def nap(_scaled: ScaledProblem, seconds: float) -> float:
    time.sleep(seconds)
    return seconds


@pytest.mark.study
def test_a_start_that_ends_its_process_is_skipped_and_the_next_is_not(processes: Processes) -> None:
    scaled = ScaledProblem.of(load("luggage"))
    assert processes.begin(crash, scaled, 7)  # else it is done here as long as they begin
    with pytest.raises(CrashError, match="a worker process was lost twice"):
        processes.made(crash, scaled, 7)
    assert processes.begin(nap, scaled, 0.1)
    assert processes.made(nap, scaled, 0.1) == 0.1
    assert processes.lost == 2


@pytest.mark.study
def test_the_work_of_a_lost_process_is_repeated(processes: Processes) -> None:
    scaled = ScaledProblem.of(load("luggage"))
    naps = (0.5, 2.5, 0.1)
    assert [processes.begin(nap, scaled, seconds) for seconds in (*naps, 0.5)] == [True, True, True, False]
    before = multiprocessing.active_children()

    def kill() -> None:
        time.sleep(1.5)
        for child in before:
            child.kill()

    Thread(target=kill).start()
    assert [processes.made(nap, scaled, seconds) for seconds in naps] == list(naps)


def test_a_short_search_begins_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "LONG", 1e6)
    before, seen = multiprocessing.active_children(), list[Any]()
    search = partial(synthesize, load("luggage"), starts=40)
    found = search(workers=2, progress=lambda _: seen.append(multiprocessing.active_children()))
    assert seen == [before] * len(seen)
    assert table(found) == table(search())


def test_a_search_goes_on_where_no_process_can_be_begun(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def none(*_: object) -> None:
        raise OSError("no more processes")

    monkeypatch.setattr(workers, "LONG", 0.0)
    monkeypatch.setattr(workers, "begun", none)
    search = partial(synthesize, load("luggage"), starts=40)
    assert table(search(workers=2)) == table(search())
    assert "no more processes" in caplog.text


def test_a_problem_is_the_same_in_bytes_whatever_was_cached() -> None:
    scaled = ScaledProblem.of(load("luggage"))
    before = pickle.dumps(scaled)
    assert scaled.loading is not None
    assert scaled.at_targets == ()
    assert pickle.dumps(scaled) == before


class Killing(Executor):
    """An executor whose process ends with certain starts."""

    def __init__(self, fatal: list[Start]) -> None:
        self.fatal = fatal

    def submit(self, function: Any, /, *given: Any, **named: Any) -> Future[Any]:
        future = Future[Any]()
        if any(start is fatal for fatal in self.fatal for start in given):
            future.set_exception(BrokenExecutor("lost"))
        else:
            future.set_result(function(*given, **named))
        return future


class Replaced(OnExecutor):
    """Work whose lost processes are replaced at once."""

    def _lost(self, _error: BrokenExecutor) -> None:
        self.drop()


@pytest.mark.slow
def test_only_the_faulty_start_of_a_bundle_is_skipped() -> None:
    scaled = ScaledProblem.of(load("luggage"))
    found = screen(scaled, 0, 0, 50, 0)
    assert found is not None
    starts = found.starts[:10]
    alone = Work().attempts(scaled, starts, 5)
    work = Replaced(Killing([starts[2], starts[9]]), 2)
    work.begin_attempts(scaled, starts)
    made = work.attempts(scaled, starts, 5)
    assert [one.status for one in made] == [
        "Crashed" if k in (2, 9) else one.status for k, one in enumerate(alone)
    ]
    for k, (one, other) in enumerate(zip(made, alone, strict=True)):
        if k not in (2, 9):
            assert repr(plain(one)) == repr(plain(other))


PARENT = """
import multiprocessing
from grashof import load, synthesize
from dataclasses import replace

def report(_):
    print(*(child.pid for child in multiprocessing.active_children()), flush=True)

if __name__ == "__main__":
    synthesize(load("path-ellipse"), effort=20, workers=2, progress=report)
"""


@pytest.mark.quick("9")
@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_workers_end_with_their_parent(tmp_path: Path, number: int) -> None:
    (tmp_path / "parent.py").write_text(PARENT, encoding="utf-8")
    parent = subprocess.Popen([sys.executable, "parent.py"], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    children = []
    while len(children) < 2:
        children = [int(word) for word in parent.stdout.readline().split()]
    time.sleep(2.0)
    parent.send_signal(number)
    parent.wait(timeout=10)
    parent.stdout.close()
    end = time.monotonic() + 10
    while any(Path(f"/proc/{child}/status").exists() for child in children) and time.monotonic() < end:
        time.sleep(0.1)
    assert not any(Path(f"/proc/{child}/status").exists() for child in children)


SCRIPT = """
import os
import signal
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Timer
from time import sleep

from distributed import Client, LocalCluster

from grashof import load, synthesize
from grashof.synth.merging import merge_shards
from grashof.synth.shards import Shard, solve_shard

MORE = {"effort": 4}
SEARCHES = {"luggage": {"starts": 400, "enough": 200}, "path-ellipse": {"effort": 0.6}, "dwell": MORE}


def kill_a_worker(cluster):
    # while a lost process is being started again, the other one is there, or in a moment this one
    while not (pids := [worker.pid for worker in list(cluster.workers.values()) if worker.pid]):
        sleep(0.05)
    os.kill(pids[0], signal.SIGKILL)


def in_one_shard(name, executor=None):
    with TemporaryDirectory() as folder:
        solve_shard(load(name), Shard(1, 1), Path(folder), effort=2, executor=executor, workers=2)
        return merge_shards(Path(folder))


if __name__ == "__main__":
    started = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with started as cluster, Client(cluster) as client:
        ways = [lambda executor=None, given=given: synthesize(load(given[0]), **given[1], executor=executor,
                workers=2) for given in SEARCHES.items()]
        for way in (*ways, partial(in_one_shard, "luggage")):
            alone = way()
            lost = Timer(1.0, kill_a_worker, (cluster,))
            lost.start()
            shared = way(executor=client.get_executor())
            lost.join()
            same = shared.to_frame().to_csv() == alone.to_frame().to_csv() and shared.ended == alone.ended
            print(len(alone), "the same list" if same else "another list", flush=True)
"""


@pytest.mark.study
def test_a_cluster_that_loses_a_worker_gives_the_same_list(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "cluster.py").write_text(SCRIPT, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "cluster.py"], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("the same list") == 4, done.stdout
