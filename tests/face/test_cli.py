"""The command line: files, exit codes, messages."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from matplotlib.figure import Figure

import grashof.figures.files as grashof_draw
from grashof.analysis import verify
from grashof.output.run_files import write_run
from grashof.problems import (
    FourBar,
    Problem,
    Requirements,
    linkage_catalogue,
    linkage_text,
    load,
    problem_text,
)
from grashof.synth import Candidate, Result

Grashof = Callable[..., Any]
QUICK = ("--top", "6", "--starts", "16", "--drawings", "2")


def test_solve_writes_a_verified_list(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("solve", "luggage", *QUICK)
    assert done.exit_code == 0, done.output
    folder = tmp_path / "luggage-designs"
    drawings = {f"design-0{rank}.{kind}" for rank in (1, 2) for kind in ("png", "svg")}
    expected = {"candidates.csv", "candidates.json", "report.html", "run.json"} | drawings
    assert {path.name for path in folder.iterdir()} == expected
    table = pd.read_csv(folder / "candidates.csv")
    designs = json.loads((folder / "candidates.json").read_text())["designs"]
    assert 1 <= table["family"].nunique() <= 6
    assert table["family"].tolist() == [design["family"] for design in designs]
    assert {design["mechanism"] for design in designs} == {"four-bar"}
    assert table["rank"].tolist() == list(range(1, len(table) + 1))
    assert [design["id"] for design in designs] == table["id"].tolist()
    problem = load("luggage")
    for design in designs:
        verdict = verify(FourBar(**design["linkage"]), problem.task, problem.requirements)
        assert verdict.ok
        assert verdict.theta2.tolist() == design["theta2"]
    record = json.loads((folder / "run.json").read_text())
    assert set(record["files"]) == expected
    assert record["designs"] == len(table)
    assert record["settings"]["seed"] == 0
    assert record["counts"]["verified and distinct"] >= len(table)
    assert "distinct" in done.stdout
    assert done.output.splitlines()[-1] == "Open luggage-designs/report.html in a browser to look at it."
    for design, row in zip(designs, table.itertuples(), strict=True):
        for key in ("circuit_ok", "branch_ok", "order_ok", "full_rotation", "pareto"):
            assert design[key] is bool(getattr(row, key))
        assert design["assembly"] == [row.assembly] * 4
    # Where it is no terminal, progress is plain lines.
    assert "\x1b" not in done.output
    assert "of 16 starts solved" in done.stderr


def test_second_run_replaces_only_its_own_files(
    grashof: Grashof, tmp_path: Path, impossible: Path, relaxing_only: Callable[..., None]
) -> None:
    relaxing_only("transmission_min_deg")
    out = tmp_path / "out"
    assert grashof("solve", "luggage", "--out", out, *QUICK).exit_code == 0
    (out / "notes.txt").write_text("mine")
    (out / "design-99.png").write_text("mine too")
    assert (
        grashof("solve", "luggage", "--out", out, "--top", "3", "--starts", "8", "--drawings", "1").exit_code
        == 0
    )
    names = {path.name for path in out.iterdir()}
    assert {"notes.txt", "design-99.png", "design-01.png"} <= names
    assert "design-02.png" not in names
    assert grashof("solve", impossible, "--out", out, "--starts", "4").exit_code == 1
    names = {"notes.txt", "design-99.png", "nearest.csv", "report.html", "run.json"}
    assert {path.name for path in out.iterdir()} == names


@pytest.mark.usefixtures("small_search")
def test_impossible_problem_names_what_stands_in_the_way(
    grashof: Grashof, tmp_path: Path, impossible: Path
) -> None:
    done = grashof("solve", impossible, "--starts", "16")
    assert done.exit_code == 1
    assert "transmission_min_deg 13.4 instead of 60" in done.stderr
    nearest = pd.read_csv(tmp_path / "impossible-designs" / "nearest.csv")
    of_angle = nearest[nearest["misses"].str.startswith("transmission_min_deg")]
    assert of_angle["transmission_min_cycle_deg"].to_numpy() == pytest.approx([13.44], abs=0.01)
    assert not (tmp_path / "impossible-designs" / "candidates.csv").exists()


BAD = {
    "one pose": (
        "poses = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]",
        "poses = [[5, 4, 0]]",
        "two or more",
    ),
    "not a number": ("[3.5, 4, -5]", "[nan, 4, -5]", "finite"),
    "infinite": ("[3.5, 4, -5]", "[inf, 4, -5]", "finite"),
    "two numbers": ("[3.5, 4, -5]", "[3.5, 4]", "motion.poses[1]"),
    "equal poses": ("[3.5, 4, -5]", "[5, 4, 360]", "equal"),
    "lo above hi": ("link_length = [0.3, 8]", "link_length = [8, 0.3]", "link_length"),
    "misspelt": ("coupler_arms", "coupler_arm", "did you mean coupler_arms?"),
    "no such objective": (
        "[requirements]",
        "[objective]\nmaximise = 'power'\n[requirements]",
        "allowed is transmission, compactness, torque, another quantity",
    ),
    "area that crosses itself": (
        "[requirements]",
        "[requirements]\nkeep_out = [[[0, 0], [2, 2], [2, 0], [0, 2]]]",
        "requirements.keep_out[0] crosses or touches itself at (1, 1)",
    ),
    "not TOML": ("[motion]", "[motion", "TOML"),
    "half a position": ("[1, 0, 0]]", "[1, 0, 0], { x = 2 }]", "has one of x and y"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_line_and_writes_nothing(grashof: Grashof, tmp_path: Path, case: str) -> None:
    old, new, said = BAD[case]
    text = problem_text("luggage")
    assert old in text
    (tmp_path / "mine.toml").write_text(text.replace(old, new), encoding="utf-8")
    done = grashof("solve", "mine.toml")
    assert done.exit_code == 2
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]


def test_missing_file_and_misspelt_name(grashof: Grashof) -> None:
    for name in ("nowhere.toml", "lugage"):
        done = grashof("solve", name)
        assert done.exit_code == 2
        assert name in done.stderr
    assert "did you mean luggage?" in grashof("solve", "lugage").stderr


def test_output_folder_that_cannot_be_written(grashof: Grashof, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    for out in (tmp_path / "taken", tmp_path / "taken" / "below"):
        done = grashof("solve", "luggage", "--out", out)
        assert done.exit_code == 2
        assert str(out) in done.stderr
        assert done.stderr.count("\n") == 1
    assert (tmp_path / "taken").read_text() == "a file"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("solve luggage --starts 0", "--starts"),
        ("solve luggage --workers none", "--workers"),
        ("solve luggage --time-limit -1", "time_limit is -1.0"),
        ("solve luggage --time-limit inf", "time_limit is inf"),
        ("solve luggage --time-limit nan", "time_limit is nan"),
        ("solve luggage --sed 1", "--seed"),
        ("solve luggage --effort 0.1", "--effort"),
        ("solve luggage --effort 101", "--effort"),
        ("solve luggage --effort much", "--effort"),
        ("solve luggage --effort nan", "--effort"),
        ("solve", "PROBLEM"),
        ("solv luggage", "solve"),
        ("solve luggage --resume", "--resume is not in this version"),
        ("solve luggage --scheduler=here", "--scheduler is not in this version"),
        (f"solve luggage --out {'x' * 300}", "File name too long"),
    ],
)
def test_bad_usage_is_one_line(grashof: Grashof, tmp_path: Path, arguments: str, said: str) -> None:
    done = grashof(*arguments.split())
    assert done.exit_code == 2
    assert said in done.stderr
    assert done.stderr.startswith("grashof: ")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_help_is_no_error(grashof: Grashof) -> None:
    assert grashof("--help").exit_code == 0
    assert "--time-limit" in grashof("solve", "--help").stdout
    assert "Usage" in grashof().output


def test_a_tilde_is_a_name(grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert grashof("solve", "luggage", "--out", "~", "--starts", "2", "--drawings", "1").exit_code == 0
    names = {"candidates.csv", "candidates.json", "report.html", "run.json", "design-01.png", "design-01.svg"}
    assert {path.name for path in (tmp_path / "~").iterdir()} == names
    assert [path.name for path in tmp_path.iterdir()] == ["~"]


def test_foreign_files_are_refused_before_solving(grashof: Grashof, tmp_path: Path) -> None:
    (tmp_path / "run.json").write_text('{"files": ["thesis.txt"]}')
    done = grashof("solve", "luggage", "--out", ".")
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert "run.json" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["run.json"]


def test_the_list_holds_what_the_file_wants(grashof: Grashof, tmp_path: Path) -> None:
    text = problem_text("luggage") + "\n[search]\nenough = 30\n"
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    assert grashof("solve", "mine.toml", "--drawings", "0").exit_code == 0
    assert len(pd.read_csv(tmp_path / "mine-designs" / "candidates.csv")) >= 30


def test_full_disk_is_told_and_keeps_the_old_run(
    grashof: Grashof, few: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_run(tmp_path / "luggage-designs", few, {}, 1)
    before = {path: path.read_bytes() for path in (tmp_path / "luggage-designs").iterdir()}

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("grashof.output.run_files.write_json", full)
    done = grashof("solve", "luggage", *QUICK, "--starts", "2")
    assert done.exit_code == 3
    assert "No space left" in done.stderr
    assert {path: path.read_bytes() for path in (tmp_path / "luggage-designs").iterdir()} == before


def test_check_and_problems(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("check", "luggage")
    assert done.exit_code == 0
    for said in (
        "4 poses",
        "5.65685 m",
        "angle over the task: from 15 deg",
        "link length: 0.3 to 8 m",
        "full-crank",
    ):
        assert said in done.stdout
    assert "luggage" in grashof("problems").stdout
    text = grashof("problems", "luggage").stdout
    (tmp_path / "copy.toml").write_text(text, encoding="utf-8")
    assert grashof("check", "copy.toml").exit_code == 0
    assert grashof("problems", "nothing").exit_code == 2


def test_linkages_of_the_catalogue(grashof: Grashof) -> None:
    listed = grashof("linkages").stdout.splitlines()
    assert tuple(line.split()[0] for line in listed) == linkage_catalogue()
    assert grashof("linkages", "pumpjack").stdout == linkage_text("pumpjack")
    assert "did you mean pumpjack?" in grashof("linkages", "pumpjak").stderr
    assert grashof("check", "nothing").exit_code == 2


@pytest.mark.parametrize("case", ["half a position", "equal poses"])
def test_check_refuses_what_solve_refuses(grashof: Grashof, tmp_path: Path, case: str) -> None:
    old, new, said = BAD[case]
    (tmp_path / "mine.toml").write_text(problem_text("luggage").replace(old, new), encoding="utf-8")
    done = grashof("check", "mine.toml")
    assert done.exit_code == 2
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_check_refuses_repeated_poses(grashof: Grashof, tmp_path: Path) -> None:
    text = problem_text("luggage").replace("[1, 0, 0]]", "[5, 4, 0]]")
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    done = grashof("check", "mine.toml")
    assert done.exit_code == 2
    assert done.stderr == grashof("solve", "mine.toml").stderr


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
    done = grashof("solve", "luggage", "--starts", "8")
    assert done.exit_code == 130
    names = {"candidates.csv", "candidates.json", "report.html", "run.json"}
    names |= {f"design-0{rank}.{kind}" for rank in (1, 2) for kind in ("png", "svg")}
    folder = tmp_path / "luggage-designs"
    assert {path.name for path in folder.iterdir()} == names
    assert set(json.loads((folder / "run.json").read_text())["files"]) == names


@pytest.mark.parametrize(("error", "code"), [(OSError(28, "disk full"), 3), (KeyboardInterrupt(), 130)])
def test_a_drawing_that_fails_does_not_cost_the_lists(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(grashof_draw, "save", fail)
    assert grashof("solve", "luggage", "--starts", "4").exit_code == code
    folder = tmp_path / "luggage-designs"
    names = {"candidates.csv", "candidates.json", "report.html", "run.json"}
    assert {path.name for path in folder.iterdir()} == names
    assert set(json.loads((folder / "run.json").read_text())["files"]) == names


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of another kind")
@pytest.mark.parametrize("merged", [True, False])
def test_a_reader_that_leaves_ends_nothing(tmp_path: Path, merged: bool) -> None:
    # FORCE_COLOR makes rich take a pipe for a terminal.
    program = "from grashof.cli import main; main()"
    command = [sys.executable, "-c", program, "solve", "luggage", "--starts", "8", "--drawings", "0"]
    running = subprocess.Popen(
        command,
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


@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
def test_interrupt_writes_what_was_verified(tmp_path: Path) -> None:
    text = problem_text("luggage") + "\n[search]\nstarts = 5000\nenough = 300\n"
    (tmp_path / "long.toml").write_text(text, encoding="utf-8")
    command = [
        sys.executable,
        "-c",
        "from grashof.cli import main; main()",
        "solve",
        "long.toml",
        "--drawings",
        "0",
    ]
    running = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    assert running.stderr is not None
    seen = ""
    while "starts solved" not in seen:
        seen = running.stderr.readline()
    time.sleep(0.2)
    running.send_signal(signal.SIGINT)
    running.communicate(timeout=60)
    assert running.returncode == 130
    table = pd.read_csv(tmp_path / "long-designs" / "candidates.csv")
    assert len(table) > 0
    assert json.loads((tmp_path / "long-designs" / "run.json").read_text())["complete"] is False


def test_a_short_list_says_why_it_is_short(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("solve", "luggage", "--starts", "3", "--drawings", "0")
    said = "the search ended after 3 of 3 solves: starts = 3 allows no more"
    assert done.stderr.splitlines().count(said) == 1
    assert json.loads((tmp_path / "luggage-designs/run.json").read_text())["ended"] == said


POSES = [[0, 0, 0], [30, 10, 10], [60, 15, 25], [90, 10, 40], [120, -5, 60], [130, -30, 80]]
MOTION = f'kind = "motion"\nlength_unit = "mm"\n[motion]\nposes = {POSES}\n'


def test_the_record_tells_the_least_error_and_the_bound(grashof: Grashof, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(MOTION + "[requirements]\nerror_factor = 1.5\n")
    done = grashof("solve", "mine.toml", "--effort", "0.2", "--drawings", "0")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "mine-designs"
    record = json.loads((folder / "run.json").read_text())
    assert record["settings"]["effort"] == 0.2
    assert record["most_error"] == 1.5 * record["least_error"]
    assert "the best came up in 1 of 1 round" in record["ended"]
    assert record["ended"] in done.stderr.splitlines()
    assert "wanted" not in done.stderr
    problem, wanted = load(str(tmp_path / "mine.toml")), Requirements(exact=False)
    designs = json.loads((folder / "candidates.json").read_text())["designs"]
    for design in designs:
        square = verify(FourBar(**design["linkage"]), problem.task, wanted).square
        assert (square / 6) ** 0.5 <= record["most_error"] * (1 + 1e-6)
    assert grashof("solve", "luggage", "--starts", "2", "--drawings", "0").exit_code == 0
    exact = json.loads((tmp_path / "luggage-designs/run.json").read_text())
    assert (exact["least_error"], exact["most_error"], exact["settings"]["effort"]) == (None, None, 1.0)


def test_zones_that_are_too_small_say_how_large_would_do(
    grashof: Grashof, tmp_path: Path, relaxing_only: Callable[..., None]
) -> None:
    relaxing_only()
    (tmp_path / "mine.toml").write_text(MOTION + "within = 0.001\n[search]\neffort = 0.2\n")
    done = grashof("solve", "mine.toml")
    assert done.exit_code == 1
    said = re.search(r"this alone would do: within (\S+) instead of 0\.001$", done.stderr, re.MULTILINE)
    assert said is not None
    folder = tmp_path / "mine-designs"
    assert {path.name for path in folder.iterdir()} == {"nearest.csv", "report.html", "run.json"}
    misses = pd.read_csv(folder / "nearest.csv")["misses"][0]
    assert re.match(r"within: the position error at target \d is \S+, allowed is up to 0\.001; ", misses)
    assert "; angle_within_deg: the angle error in deg at target " in misses
    page = (folder / "report.html").read_text()
    assert f"within {said[1]} instead of 0.001" in page
    assert "each target is missed by at most 0.001 mm and" in page
    (tmp_path / "mine.toml").write_text(MOTION + f"within = {said[1]}\n[search]\neffort = 0.2\n")
    assert grashof("solve", "mine.toml", "--drawings", "0").exit_code == 0


def test_the_version(grashof: Grashof) -> None:
    done = grashof("--version")
    assert (done.exit_code, done.stdout) == (0, f"grashof {version('grashof')}\n")


def test_control_characters_of_names_do_not_reach_the_terminal(grashof: Grashof, tmp_path: Path) -> None:
    path = tmp_path / "red\x1b[31m.toml"
    done = grashof("check", path)
    assert done.exit_code == 2
    assert "red?[31m.toml: there is no such file" in done.stderr
    path.write_text(problem_text("luggage"), encoding="utf-8")
    assert grashof("check", path).stdout.startswith("red?[31m: Luggage")


def test_what_nobody_expected_ends_with_one_line(grashof: Grashof, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_problem: Problem) -> list[str]:
        raise ZeroDivisionError("division\nby zero")

    monkeypatch.setattr("grashof.wording.problem.summary", broken)
    monkeypatch.delenv("GRASHOF_TRACEBACK", raising=False)
    done = grashof("check", "luggage")
    assert done.exit_code == 3
    line = done.stderr.removesuffix("\n")
    assert line.startswith("grashof: unexpected error: ZeroDivisionError: division by zero;")
    assert "\n" not in line
    monkeypatch.setenv("GRASHOF_TRACEBACK", "1")
    told = grashof("check", "luggage")
    assert told.exit_code == 3
    assert "Traceback (most recent call last)" in told.stderr
    assert told.stderr.splitlines()[-1] == line


def test_no_backend_of_matplotlib_stands_in_the_way(tmp_path: Path) -> None:
    environment = {**os.environ, "MPLBACKEND": "nonsense"}
    code = "import sys; from grashof.cli import main; sys.argv[0] = 'grashof'; main()"
    done = subprocess.run(
        [sys.executable, "-c", code, "animate", "pumpjack", "--seconds", "0.2", "--fps", "10"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "pumpjack.gif\n")


def test_every_error_of_a_file_has_its_line(grashof: Grashof, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text('kind = "motion"\n[motion]\nposes = [[1, 2], [3, 4, 5], 6]\n[search]\nseed = -1\n')
    done = grashof("check", path)
    assert done.exit_code == 2
    assert done.stderr.splitlines() == [
        f"grashof: {path}: motion.poses[0] is [1, 2], 2 numbers; allowed is a pose [x, y, angle in degrees]",
        f"grashof: {path}: motion.poses[2] is 6; allowed is a pose [x, y, angle in degrees]",
        f"grashof: {path}: search.seed is -1; allowed is a whole number from 0",
    ]
