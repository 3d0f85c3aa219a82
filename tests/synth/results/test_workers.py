"""Work in other processes: the same lists, whatever happens to them."""

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from threading import Thread

import pytest

from grashof import load, synthesize
from grashof.problems import MotionTask, Problem, Requirements
from grashof.synth import Result
from grashof.synth.results.workers import CrashError, Processes

CONVEYOR = MotionTask.from_degrees([[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70], [360, 0, 90]])
SEARCHES = {
    "poses met": (load("luggage"), {"starts": 40, "enough": 30, "seed": 5}),
    "poses fitted": (Problem(task=CONVEYOR, requirements=Requirements(exact=False)), {"effort": 0.35}),
    "none": (
        Problem(task=CONVEYOR, requirements=Requirements(link_length=(1.0, 60.0), exact=False)),
        {"effort": 0.2},
    ),
}


def table(result: Result) -> str:
    return result.to_frame().to_csv() + result.note + result.ended


@pytest.mark.quick("poses fitted")
@pytest.mark.parametrize("kind", SEARCHES)
def test_workers_change_no_byte(kind: str) -> None:
    problem, options = SEARCHES[kind]
    alone = table(synthesize(problem, **options))
    assert table(synthesize(problem, **options, workers=2)) == alone


@pytest.fixture
def processes() -> Processes:
    made = Processes(1)
    yield made
    made.end()


def test_a_start_that_ends_its_process_is_given_up_and_the_next_is_not(processes: Processes) -> None:
    with pytest.raises(CrashError, match="a worker process was lost twice"):
        processes._result(("crash",), os._exit, 7)
    assert processes._result(("sound",), abs, -3) == 3
    assert processes.lost == 2


def test_what_a_lost_process_did_is_done_again(processes: Processes) -> None:
    processes._submit(("slow",), time.sleep, 0.5)
    processes._submit(("next",), abs, -5)
    before = multiprocessing.active_children()

    def kill() -> None:
        time.sleep(1.5)
        for child in before:
            child.kill()

    Thread(target=kill).start()
    processes._submit(("long",), time.sleep, 2.5)
    assert processes._result(("slow",), time.sleep, 0.5) is None
    assert processes._result(("long",), time.sleep, 2.5) is None
    assert processes._result(("next",), abs, -5) == 5


PARENT = """
import multiprocessing
from grashof import load, synthesize
from dataclasses import replace

def tell(_):
    print(*(child.pid for child in multiprocessing.active_children()), flush=True)

if __name__ == "__main__":
    synthesize(load("path-ellipse"), effort=20, workers=2, progress=tell)
"""


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
