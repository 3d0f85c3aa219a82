"""The files of `grashof solve`: lists, the record; other files are left alone."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from command_runs import Grashof, assert_one_line, failing

from grashof.analysis import verify
from grashof.output.run_files import write_csv, write_rows, write_run
from grashof.problems import FourBar, Requirements, load, problem_text
from grashof.synth import Result
from grashof.synth.designs.table import rows_of

QUICK = ("--top", "6", "--starts", "16", "--drawings", "2")


def test_lists_are_written_as_pandas_writes_them(few: Result, alike: Result, tmp_path: Path) -> None:
    here, there = tmp_path / "here.csv", tmp_path / "there.csv"
    for result in (few, alike):
        write_rows(here, rows_of(result.problem, result.candidates))
        write_csv(there, result.to_frame())
        assert here.read_bytes() == there.read_bytes()
    texts = ["=1+1", 'a "b", c', "two\nlines", "-x", "ü", "", "plain"]
    numbers = [1.0, 0.1 + 0.2, 1e-300, -1e22, np.inf, np.nan, np.float64(2.5)]
    rows = [
        {"text": text, "@key": number, "known": number > 1, "none": None, "count": number and 3}
        for text, number in zip(texts, numbers, strict=True)
    ]
    write_rows(here, rows)
    write_csv(there, pd.DataFrame(rows))
    assert here.read_bytes() == there.read_bytes()


@pytest.mark.slow
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
    run = record["run"]
    assert (run["ending"], run["resumed"], run["drawings_left_out"]) == ("complete", 0, 0)
    begun, ended = (datetime.fromisoformat(run[name]) for name in ("begun", "ended"))
    assert timedelta(0) <= ended - begun < timedelta(minutes=5)  # whole seconds
    assert ended.utcoffset() == timedelta(0)
    assert record["counts"]["verified and distinct"] >= len(table)
    assert "distinct" in done.stdout
    assert done.output.splitlines()[-1] == "Open luggage-designs/report.html in a browser to look at it."
    for design, row in zip(designs, table.itertuples(), strict=True):
        for key in ("circuit_ok", "branch_ok", "order_ok", "full_rotation", "pareto"):
            assert design[key] is bool(getattr(row, key))
        assert design["assembly"] == [row.assembly] * 4
    # Without a terminal, progress is plain lines.
    assert "\x1b" not in done.output
    assert "of 16 starts solved" in done.stderr


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.usefixtures("small_search")
def test_an_impossible_problem_names_the_obstacle(grashof: Grashof, tmp_path: Path, impossible: Path) -> None:
    done = grashof("solve", impossible, "--starts", "16")
    assert done.exit_code == 1
    assert "transmission_min_deg 13.4 instead of 60" in done.stderr
    nearest = pd.read_csv(tmp_path / "impossible-designs" / "nearest.csv")
    of_angle = nearest[nearest["misses"].str.startswith("transmission_min_deg")]
    assert of_angle["transmission_min_cycle_deg"].to_numpy() == pytest.approx([13.44], abs=0.01)
    assert not (tmp_path / "impossible-designs" / "candidates.csv").exists()


def test_output_folder_that_cannot_be_written(grashof: Grashof, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    for out in (tmp_path / "taken", tmp_path / "taken" / "below"):
        assert_one_line(grashof("solve", "luggage", "--out", out), 2, str(out))
    assert (tmp_path / "taken").read_text() == "a file"


@pytest.mark.slow
def test_a_tilde_is_a_name(
    grashof: Grashof,
    tmp_path: Path,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    home = tmp_path_factory.mktemp("home")  # others, as Matplotlib, may keep files there
    monkeypatch.setenv("HOME", str(home))
    assert grashof("solve", "luggage", "--out", "~", "--starts", "2", "--drawings", "1").exit_code == 0
    names = {"candidates.csv", "candidates.json", "report.html", "run.json", "design-01.png", "design-01.svg"}
    assert {path.name for path in (tmp_path / "~").iterdir()} == names
    assert [path.name for path in tmp_path.iterdir()] == ["~"]
    assert not {path.name for path in home.rglob("*")} & names


def test_foreign_files_are_refused_before_solving(grashof: Grashof, tmp_path: Path) -> None:
    (tmp_path / "run.json").write_text('{"files": ["thesis.txt"]}')
    assert_one_line(grashof("solve", "luggage", "--out", "."), 2, "run.json")
    assert [path.name for path in tmp_path.iterdir()] == ["run.json"]


@pytest.mark.slow
def test_the_list_has_the_number_of_designs_that_the_file_requires(grashof: Grashof, tmp_path: Path) -> None:
    text = problem_text("luggage") + "\n[search]\nenough = 30\n"
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    assert grashof("solve", "mine.toml", "--drawings", "0").exit_code == 0
    assert len(pd.read_csv(tmp_path / "mine-designs" / "candidates.csv")) >= 30


@pytest.mark.slow
def test_a_full_disk_is_reported_and_keeps_the_old_run(
    grashof: Grashof, few: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_run(tmp_path / "luggage-designs", few, {}, 1)
    before = {path: path.read_bytes() for path in (tmp_path / "luggage-designs").iterdir()}

    full = failing(OSError(28, "No space left on device"))
    monkeypatch.setattr("grashof.output.run_files.write_json", full)
    done = grashof("solve", "luggage", *QUICK, "--starts", "2")
    assert done.exit_code == 3
    assert "No space left" in done.stderr
    assert {path: path.read_bytes() for path in (tmp_path / "luggage-designs").iterdir()} == before


def test_a_short_list_states_the_reason(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("solve", "luggage", "--starts", "3", "--drawings", "0")
    said = "the search ended after 3 of 3 solves: starts = 3 allows no more"
    assert done.stderr.splitlines().count(said) == 1
    assert json.loads((tmp_path / "luggage-designs/run.json").read_text())["ended"] == said


POSES = [[0, 0, 0], [30, 10, 10], [60, 15, 25], [90, 10, 40], [120, -5, 60], [130, -30, 80]]
MOTION = f'kind = "motion"\nlength_unit = "mm"\n[motion]\nposes = {POSES}\n'


@pytest.mark.slow
def test_the_record_has_the_least_error_and_the_bound(grashof: Grashof, tmp_path: Path) -> None:
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


@pytest.mark.study
def test_zones_that_are_too_small_say_how_large_would_do(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("grashof.synth.results.relaxations.limiting", lambda *_: [])  # the zones alone
    (tmp_path / "mine.toml").write_text(MOTION + "within = 0.001\n[search]\neffort = 0.2\n")
    done = grashof("solve", "mine.toml")
    assert done.exit_code == 1
    said = re.search(r"this alone would do: within (\S+) instead of 0\.001$", done.stderr, re.MULTILINE)
    assert said is not None
    folder = tmp_path / "mine-designs"
    assert {path.name for path in folder.iterdir()} == {"nearest.csv", "report.html", "run.json"}
    misses = pd.read_csv(folder / "nearest.csv")["misses"][0]
    assert re.match(r"within: the position error at target \d is \S+, allowed: up to 0\.001; ", misses)
    assert "; angle_within_deg: the angle error in deg at target " in misses
    page = (folder / "report.html").read_text()
    assert f"within {said[1]} instead of 0.001" in page
    assert "each target is missed by at most 0.001 mm and" in page
    (tmp_path / "mine.toml").write_text(MOTION + f"within = {said[1]}\n[search]\neffort = 0.2\n")
    assert grashof("solve", "mine.toml", "--drawings", "0").exit_code == 0
