"""A run that is interrupted, loses its reader or cannot draw: what it leaves behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from command_runs import COMMAND, Grashof, failing
from matplotlib.figure import Figure

import grashof.figures.files as grashof_draw
from grashof.output.process import ExitCode, interruptible
from grashof.problems import Problem
from grashof.synth import Candidate


@pytest.mark.study
@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
def test_interrupt_while_drawing_leaves_drawings_out(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw = grashof_draw.draw_design

    def interrupted(problem: Problem, candidate: Candidate, rank: int) -> Figure:
        if rank == 2:
            signal.raise_signal(signal.SIGINT)
        return draw(problem, candidate, rank)

    monkeypatch.setattr(grashof_draw, "draw_design", interrupted)
    done = grashof("solve", "luggage", "--starts", "16")
    assert done.exit_code == 130
    names = {"candidates.csv", "candidates.json", "report.html", "run.json"}
    names |= {f"design-0{rank}.{kind}" for rank in (1, 2) for kind in ("png", "svg")}
    folder = tmp_path / "luggage-designs"
    assert {path.name for path in folder.iterdir()} == names
    record = json.loads((folder / "run.json").read_text())
    assert set(record["files"]) == names
    assert (record["complete"], record["run"]["ending"]) == (True, "interrupted")
    assert (record["run"]["drawings_left_out"], record["run"]["why_left_out"]) == (1, "interrupted")
    assert "drawings are left out: Ctrl-C came before 1 of them were made" in done.stderr.splitlines()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks for its processes in /proc")
@pytest.mark.parametrize("later", [0.05, 0.2])
def test_ctrl_c_while_processes_begin_leaves_no_traceback(tmp_path: Path, later: float) -> None:
    given = ["solve", "path-ellipse", "--effort", "20", "--workers", "2", "--drawings", "0"]
    process = subprocess.Popen(
        [*COMMAND, *given],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    while process.poll() is None and len(children.read_text().split()) < 3:  # one of them counts resources
        time.sleep(0.01)
    time.sleep(later)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "KeyboardInterrupt" not in said


def test_a_drawing_that_fails_costs_neither_lists_nor_tidiness(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(grashof_draw, "drawn", failing(KeyboardInterrupt()))
    monkeypatch.setattr("grashof.synth.search.journal.EVERY", 0.0)  # as if the search took long
    assert grashof("solve", "luggage", "--starts", "4").exit_code == 130
    folder = tmp_path / "luggage-designs"
    names = {"candidates.csv", "candidates.json", "report.html", "run.json"}
    assert {path.name for path in folder.iterdir()} == names
    record = json.loads((folder / "run.json").read_text())
    assert set(record["files"]) == names
    assert record["run"]["drawings_left_out"] == min(3, record["designs"]) > 0
    assert record["run"]["why_left_out"] == "the run ended before they were drawn"


@pytest.mark.study
@pytest.mark.quick("True")
@pytest.mark.skipif(sys.platform == "win32", reason="pipes of another kind")
@pytest.mark.parametrize("merged", [True, False])
def test_a_reader_that_leaves_ends_nothing(tmp_path: Path, merged: bool) -> None:
    # FORCE_COLOR makes rich take a pipe for a terminal.
    running = subprocess.Popen(
        [*COMMAND, "solve", "luggage", "--starts", "8", "--drawings", "0"],
        cwd=tmp_path,
        env={**os.environ, "FORCE_COLOR": "1"} if merged else None,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT if merged else subprocess.PIPE,
        text=True,
    )
    assert running.stdout is not None
    if merged:
        running.stdout.readline()
    running.stdout.close()
    said = "" if merged else running.communicate(timeout=60)[1]
    assert running.wait(timeout=60) == 0
    assert "Error" not in said
    assert "Exception" not in said
    assert len(pd.read_csv(tmp_path / "luggage-designs" / "candidates.csv")) > 0


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no terminals that hang up")
def test_a_terminal_that_hangs_up_asks_for_the_end_unless_that_is_ignored() -> None:
    with interruptible() as request:
        os.kill(os.getpid(), signal.SIGHUP)
        assert (request(), request.code, request.by) == (True, ExitCode.TERMINATED, "SIGHUP")
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    try:
        with interruptible() as request:
            os.kill(os.getpid(), signal.SIGHUP)
            assert not request()
    finally:
        signal.signal(signal.SIGHUP, before)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
def test_ctrl_c_while_the_program_is_loaded_is_one_line() -> None:
    # The import of the command line represents any moment of loading: it sends the signal itself.
    program = (
        "import os, signal, sys\n"
        "class Loading:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'numpy': os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Loading())\n"
        "sys.argv = ['grashof', 'check', 'luggage']\n"
        "from grashof.__main__ import main; main()"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "grashof: interrupted\n")
