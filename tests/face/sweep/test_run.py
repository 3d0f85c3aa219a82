"""Sweeps from a study to a table: interrupted, resumed, on an executor; files kept and refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from grashof import synthesize
from grashof.problems import ProblemError, SolverError
from grashof.problems.files.on_disk import versions
from grashof.problems.files.problem_file import problem_of
from grashof.sweep import Step, load_study, sweep
from grashof.sweep.combinations import combinations
from grashof.synth.designs.table import COLUMNS

Write = Callable[..., Path]


class Stop:
    """Stops after a number of steps."""

    def __init__(self, after: int) -> None:
        self.left = after

    def progress(self, _step: Step) -> None:
        self.left -= 1

    def __call__(self) -> bool:
        return self.left <= 0


def interrupted(study: Path, out: Path, after: int, *, resume: bool) -> int:
    """How many combinations are finished after some steps more."""
    stop = Stop(after)
    done = sweep(study, out=out, resume=resume, progress=stop.progress, stop=stop)
    assert not done.complete
    return len(done.results)


@pytest.mark.slow
@pytest.mark.usefixtures("texts")
def test_an_interrupted_sweep_gives_the_same_table(write: Write, tmp_path: Path, texts: list[str]) -> None:
    study, out = write(), tmp_path / "out"
    assert interrupted(study, out, 5, resume=False) == 5
    assert len(pd.read_csv(out / "sweep.csv")) == 5
    assert json.loads((out / "sweep.json").read_text())["complete"] is False
    assert interrupted(study, out, 3, resume=True) == 8
    assert sweep(study, out=out, resume=True).complete
    assert len(texts) == 12
    assert len(set(texts)) == 12
    sweep(study, out=tmp_path / "once")
    for name in ("sweep.csv", "sweep.png", "sweep.html"):
        assert (out / name).read_bytes() == (tmp_path / "once" / name).read_bytes()
    assert len(list((out / "tasks").iterdir())) == 12
    assert sweep(study, out=out, resume=True).complete  # nothing is left to do
    assert len(texts) == 24


@pytest.mark.slow
def test_the_row_of_a_combination_is_its_best_design(write: Write) -> None:
    study = write(
        'problem = "base.toml"\ndesigns = 2\n[vary]\n"path.points[1].y" = [1.0, 1.2]\n[search]\nenough = 4'
    )
    done = sweep(study)
    table = pd.read_csv(StringIO(done.to_frame().to_csv(index=False)))
    assert list(table) == ["combination", "path.points[1].y", "status", "designs", *COLUMNS, "note"]
    for number, one in enumerate(combinations(load_study(study)), start=1):
        result = synthesize(problem_of(one.text, "", "base"))
        rows = table[table["combination"] == number]
        assert (rows["designs"] == len(result)).all()
        frame = result.to_frame().iloc[:2]
        assert rows["id"].tolist() == frame["id"].tolist()
        numbers = [name for name in frame.select_dtypes("number") if name in rows]
        np.testing.assert_array_equal(rows[numbers].to_numpy(float), frame[numbers].to_numpy(float))


@pytest.mark.usefixtures("texts")
def test_anybody_s_executor(write: Write) -> None:
    with ThreadPoolExecutor(3) as executor:
        there = sweep(write(), executor=executor)
    assert there.to_frame().to_csv() == sweep(write()).to_frame().to_csv()


@pytest.mark.study
def test_processes_find_the_same(write: Write) -> None:
    here, there = sweep(write()), sweep(write(), workers=2)
    assert here.to_frame().to_csv() == there.to_frame().to_csv()


@pytest.mark.study
def test_a_combination_without_designs_states_the_reason(write: Write) -> None:
    limits = '[vary]\n"requirements.transmission_min_deg" = [95, 15, 80]\n'
    done = sweep(write(f'problem = "luggage"\n{limits}[search]\nstarts = 2\n'))
    frame = done.to_frame()
    assert frame["status"].tolist() == ["invalid", "ok", "no design"]
    assert frame["note"][0] == "requirements.transmission_min_deg is 95; it must be from 0 to 90"
    assert "transmission_min_deg" in frame["note"][2]
    assert "instead of 80" in frame["note"][2]
    assert done.headline == "3 combinations, 1 with designs, 1 invalid"


@pytest.mark.usefixtures("texts")
def test_other_studies_versions_and_spoilt_tasks_are_not_resumed(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, out = write(), tmp_path / "out"
    interrupted(study, out, 2, resume=False)
    kept = sorted((out / "tasks").iterdir())

    def refused(path: Path, words: str, **options: Any) -> None:
        with pytest.raises(ProblemError, match=words) as error:
            sweep(path, out=out, **options)
        assert "\n" not in str(error.value)

    other = write('problem = "base.toml"\n[vary]\nsearch.seed = [1]\n', "other.toml")
    refused(study, "holds an unfinished sweep, 2 of 12 tasks done; --resume continues it")
    refused(study, "holds a sweep of another study or of other options", resume=True, designs=2)
    refused(other, "holds a sweep of another study", resume=True)
    with monkeypatch.context() as patched:
        others = {**versions(), "casadi": "9.9"}
        patched.setattr("grashof.sweep.checkpoints.versions", lambda: others)
        refused(study, r"holds a sweep made with casadi [\d.]+ \(now 9.9\)", resume=True)
    assert sorted((out / "tasks").iterdir()) == kept
    for text in ("{", '{"task": "other", "result": {}}', "[]"):
        kept[0].write_text(text)
        refused(study, "is not a finished task of this sweep", resume=True)
    kept[0].rename(kept[0].with_name(f"{32 * 'a'}.json"))
    refused(study, "is of another study or version", resume=True)


@pytest.mark.slow
@pytest.mark.usefixtures("texts")
def test_a_finished_sweep_is_done_again_and_other_files_stay(
    write: Write, tmp_path: Path, texts: list[str]
) -> None:
    study, out = write(), tmp_path / "out"
    sweep(study, out=out)
    (out / "notes.txt").write_text("mine")
    (out / "tasks" / ".writing-abc").write_text("half")
    (out / "tasks" / "mine.txt").write_text("mine")
    sweep(study, out=out)
    assert len(texts) == 24
    assert sorted(path.name for path in out.iterdir()) == [
        "notes.txt", "sweep.csv", "sweep.html", "sweep.json", "sweep.png", "tasks",
    ]  # fmt: skip
    names = {path.name for path in (out / "tasks").iterdir()}
    assert "mine.txt" in names
    assert len(names) == 13
    (out / "sweep.json").write_text("{}")
    with pytest.raises(ProblemError, match="name a folder without it"):
        sweep(study, out=out)


@pytest.mark.usefixtures("texts")
def test_a_lost_process_keeps_the_finished_tasks(write: Write, tmp_path: Path) -> None:
    class Losing(ThreadPoolExecutor):
        left = 3

        def submit(self, *arguments: Any, **named: Any) -> Any:
            self.left -= 1
            if self.left < 0:
                raise BrokenProcessPool("gone")
            return super().submit(*arguments, **named)

    with Losing(1) as executor, pytest.raises(SolverError, match="a worker process was lost: gone; --resume"):
        sweep(write(), out=tmp_path / "out", executor=executor)
    assert json.loads((tmp_path / "out" / "sweep.json").read_text())["complete"] is False
    assert sweep(write(), out=tmp_path / "out", resume=True).complete


@pytest.mark.usefixtures("texts")
def test_equal_combinations_are_solved_once(write: Write, texts: list[str]) -> None:
    done = sweep(write('problem = "base.toml"\n[vary]\n"path.points[1].y" = [1, 1.0, 2]\n'))
    assert len(texts) == 2
    assert done.to_frame()["combination"].tolist() == [1, 2, 3]


@pytest.mark.extra
def test_parquet_is_the_same_table(write: Write, tmp_path: Path, texts: list[str]) -> None:
    pytest.importorskip("pyarrow")
    sweep(write(f"parquet = true\n{write().read_text()}"), out=tmp_path / "out")
    table = pd.read_parquet(tmp_path / "out" / "sweep.parquet")
    assert table.to_csv(index=False) == (tmp_path / "out" / "sweep.csv").read_text(encoding="utf-8")


def test_parquet_without_its_package(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grashof.sweep.files.find_spec", lambda _: None)
    with pytest.raises(ProblemError, match=r"parquet needs pyarrow: pip install 'grashof\[parquet\]'"):
        sweep(write(f"parquet = true\n{write().read_text()}"))


def test_a_value_without_limit_goes_through_checkpoints(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, solved: dict[str, Any]
) -> None:
    design = {**solved["designs"][0], "torque_peak": "inf", "r1": 0.1 + 0.2}
    monkeypatch.setattr("grashof.sweep.solving.solve_task", lambda *_: {**solved, "designs": [design]})
    sweep(write('problem = "base.toml"\n[vary]\nsearch.seed = [1]\n'), out=tmp_path / "out")
    table = pd.read_csv(tmp_path / "out" / "sweep.csv")
    assert np.isinf(table["torque_peak"][0])
    assert table["r1"][0] == 0.1 + 0.2
