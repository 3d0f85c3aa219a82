"""The command: its output, its exit codes, and the files that signals leave behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from command_runs import COMMAND, assert_one_line
from typer.testing import CliRunner

from grashof.cli import app

Write = Callable[..., Path]
posix = pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
MANY = """\
problem = "base.toml"
[vary]
"path.points[1].y" = { from = 0.5, to = 2.4, steps = 20 }
"path.points[1].x" = { from = 0.55, to = 1.45, steps = 10 }
"""


def grashof(*arguments: object) -> Any:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.mark.usefixtures("texts")
def test_the_output_of_a_sweep(write: Write, tmp_path: Path) -> None:
    done = grashof("sweep", write(), "--out", tmp_path / "out", "--top", 1)
    assert done.exit_code == 0
    headline, best = done.stdout.splitlines()
    assert headline == "12 combinations, 12 with designs"
    assert best.startswith("best: path.points[1].y = 0.5: worst transmission angle over the task (deg) ")
    assert "\n2 of 12: path.points[1].y = 0.6: " in done.stderr
    assert f"Open {tmp_path / 'out' / 'sweep.html'} in a browser" in done.stderr


def test_bad_input_ends_it_with_a_line_for_each_error(write: Write, tmp_path: Path) -> None:
    done = grashof("sweep", write('problem = "luggage"\ndesigns = 0\n[vary]\na = 1\n'))
    assert done.exit_code == 2
    assert [line.partition(";")[0] for line in done.stderr.splitlines()] == [
        f"grashof: {tmp_path / 'study.toml'}: designs is 0",
        f"grashof: {tmp_path / 'study.toml'}: vary.a is 1",
    ]


def test_nothing_but_invalid_combinations_is_no_design(write: Write, tmp_path: Path) -> None:
    study = write('problem = "base.toml"\n[vary]\nrequirements.transmission_min_deg = [95, 96]\n')
    done = grashof("sweep", study, "--out", tmp_path / "out")
    assert done.exit_code == 1
    assert done.stdout == "2 combinations, 0 with designs, 2 invalid\n"
    assert pd.read_csv(tmp_path / "out" / "sweep.csv")["status"].tolist() == ["invalid", "invalid"]


@pytest.mark.quick("2")
@posix
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_leaves_the_finished_tasks(
    write: Write,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    solved: dict[str, Any],
    number: signal.Signals,
) -> None:
    done: list[str] = []

    def solve(name: str, text: str, options: Any, stop: Callable[[], bool]) -> dict[str, Any] | None:
        done.append(text)
        if len(done) == 4:
            signal.raise_signal(number)
        return None if stop() else solved

    before = signal.getsignal(number)
    monkeypatch.setattr("grashof.sweep.solving.solve_task", solve)
    ended = grashof("sweep", write(), "--out", tmp_path / "out")
    assert ended.exit_code == 128 + number
    assert "3 of 12 combinations done" in ended.stdout
    assert "--resume continues it" in ended.stderr
    assert signal.getsignal(number) is before
    assert len(pd.read_csv(tmp_path / "out" / "sweep.csv")) == 3
    refused = grashof("sweep", write(), "--out", tmp_path / "out")
    assert_one_line(refused, 2, "3 of 12 tasks done; --resume continues it")
    assert grashof("sweep", write(), "--out", tmp_path / "out", "--resume").exit_code == 0
    assert len(done) == 4 + 9


def started(study: Path, out: Path, *options: str) -> subprocess.Popen[str]:
    command = [*COMMAND, "sweep", str(study), "--out", str(out), *options]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)


def ended_after(running: subprocess.Popen[str], steps: int, number: signal.Signals, *, group: bool) -> int:
    """Send a signal after some combinations more; the exit code."""
    assert running.stderr is not None
    seen = 0
    for line in running.stderr:
        seen += " of 200: " in line
        if seen == steps:
            break
    (os.killpg if group else os.kill)(running.pid, number)
    running.communicate(timeout=60)
    return running.returncode


@pytest.mark.study
@posix
def test_two_hundred_tasks_interrupted_in_every_way(write: Write, tmp_path: Path) -> None:
    study, out = write(MANY), tmp_path / "out"
    ways: list[tuple[signal.Signals, bool, int]] = [
        (signal.SIGINT, True, 130),
        (signal.SIGTERM, False, 143),
        (signal.SIGTERM, True, 143),
        (signal.SIGKILL, False, -signal.SIGKILL),
    ]
    for number, (way, group, code) in enumerate(ways):
        options = ("--workers", "2", *(("--resume",) if number else ()))
        assert ended_after(started(study, out, *options), 20, way, group=group) == code
        assert len(list((out / "tasks").glob("*.json"))) >= 20 * (number + 1)
    time.sleep(1.0)  # nothing continues without the parent
    count = len(list((out / "tasks").iterdir()))
    time.sleep(1.0)
    assert len(list((out / "tasks").iterdir())) == count
    running = started(study, out, "--workers", "2", "--resume")
    said = running.communicate(timeout=600)[1]
    assert running.returncode == 0
    assert said.count(" of 200: ") <= 200 - 80
    once = started(study, tmp_path / "once")
    once.communicate(timeout=600)
    assert once.returncode == 0
    for name in ("sweep.csv", "sweep.png", "sweep.html"):
        assert (out / name).read_bytes() == (tmp_path / "once" / name).read_bytes()
