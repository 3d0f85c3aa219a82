"""A problem with [manufacturing] from the command line."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from grashof.analysis.judge.measures import MEASURES
from grashof.output.run_files import write_run
from grashof.problems import Manufacturing, problem_text
from grashof.synth import Result

MANUFACTURING = (
    *("move_r1", "move_r2", "move_r3", "move_r4", "move_u", "move_v"),
    *("worst_move", "share_within_linear", "share_within_made"),
)

Grashof = Callable[..., Any]


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    table = "\n[manufacturing]\nlength_tolerance = 0.02\nband = 0.03\n"
    path.write_text(problem_text("luggage") + table, encoding="utf-8")
    return path


def test_check_says_it(grashof: Grashof, mine: Path) -> None:
    assert "made to within 0.02 m, band 0.03 m" in grashof("check", mine).stdout


@pytest.mark.slow
def test_solve_writes_it(grashof: Grashof, mine: Path, tmp_path: Path) -> None:
    done = grashof("solve", mine, "--starts", "16", "--drawings", "0")
    assert done.exit_code == 0, done.output
    text = (tmp_path / "mine-designs" / "candidates.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(text.splitlines()))
    designs = json.loads((tmp_path / "mine-designs" / "candidates.json").read_text())["designs"]
    for design, row in zip(designs, rows, strict=True):
        assert [design[name] for name in MANUFACTURING] == [float(row[name]) for name in MANUFACTURING]


def test_bad_input_is_one_line(grashof: Grashof, mine: Path) -> None:
    mine.write_text(mine.read_text().replace("band = 0.03", "band = -1"))
    done = grashof("solve", mine)
    assert done.exit_code == 2
    assert done.stderr.strip().endswith("manufacturing.band is -1; it must be a number greater than zero")
    assert done.stderr.count("\n") == 1


def test_json_knows_no_infinity(few: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As at a dead position: null, not the Infinity that no reader of JSON takes."""
    monkeypatch.setitem(MEASURES, "move_r2", lambda values: math.inf)
    result = replace(few, problem=replace(few.problem, manufacturing=Manufacturing(0.02)))
    write_run(tmp_path / "out", result, {}, 0)
    designs = json.loads((tmp_path / "out" / "candidates.json").read_text())["designs"]
    assert {design["move_r2"] for design in designs} == {None}
    assert all(design["move_r1"] > 0 for design in designs)


def test_without_the_table_nothing_is_written(few: Result, tmp_path: Path) -> None:
    write_run(tmp_path / "out", few, {}, 0)
    designs = json.loads((tmp_path / "out" / "candidates.json").read_text())["designs"]
    assert len(designs) == len(few)
    assert not any(name in design for design in designs for name in MANUFACTURING)
