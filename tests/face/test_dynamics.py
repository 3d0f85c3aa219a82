"""Problems with [dynamics] and [manufacturing]: `grashof check`, and the columns of a run."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from command_runs import Grashof, assert_one_line

from grashof.analysis.judge.measures import MEASURES
from grashof.output.run_files import write_run
from grashof.problems import Manufacturing, problem_text
from grashof.synth import Result

MOTION = ("omega4_max", "point_speed_max", "point_acceleration_max", "coupler_fit_r2")
MANUFACTURING = (
    *("move_r1", "move_r2", "move_r3", "move_r4", "move_u", "move_v"),
    *("worst_move", "share_within_linear", "share_within_made"),
)
DYNAMICS = ("torque_peak", "torque_rms", "joint_force_peak")


def test_check_states_the_tables(grashof: Grashof, tmp_path: Path) -> None:
    mine = tmp_path / "mine.toml"
    made = "\n[manufacturing]\nlength_tolerance = 0.02\nband = 0.03\n"
    mine.write_text(problem_text("luggage") + made, encoding="utf-8")
    assert "made to within 0.02 m, band 0.03 m" in grashof("check", mine).stdout
    text = grashof("check", "luggage").stdout
    assert "dynamics: links of 0.3764, 0.4762, 0.4308 kg; driver at 9.5493 rpm; gravity 0, -9.81 m/s2" in text
    table = "[dynamics]\nmass_per_length = 2\npayload = 5\nspeed_rpm = 10\n"
    mine.write_text(problem_text("luggage").split("[dynamics]")[0] + table, encoding="utf-8")
    text = grashof("check", mine).stdout
    assert "uniform links of 2 kg a length unit, payload 5 kg; driver at 10 rpm; gravity 0, 0 m/s2" in text
    assert "dynamics" not in grashof("check", "dwell").stdout


def test_csv_and_json_hold_the_same_figures(few: Result, tmp_path: Path) -> None:
    write_run(tmp_path / "out", few, {}, 0)
    text = (tmp_path / "out" / "candidates.csv").read_text(encoding="utf-8")
    designs = json.loads((tmp_path / "out" / "candidates.json").read_text())["designs"]
    for design, row in zip(designs, csv.DictReader(text.splitlines()), strict=True):
        for name in (*MOTION, *DYNAMICS):
            assert design[name] == float(row[name]) > 0
        assert str(design["pareto"]) == row["pareto"]


def test_without_the_tables_there_are_no_columns(few: Result, tmp_path: Path) -> None:
    bare = replace(few, problem=replace(few.problem, dynamics=None))
    write_run(tmp_path / "out", bare, {}, 0)
    designs = json.loads((tmp_path / "out" / "candidates.json").read_text())["designs"]
    assert all(design[name] > 0 for design in designs for name in MOTION)
    assert not any(name in design for design in designs for name in (*DYNAMICS, *MANUFACTURING))


def test_infinity_is_null_in_json(few: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As at a dead position: JSON has no infinity."""
    for name in ("torque_peak", "move_r2"):
        monkeypatch.setitem(MEASURES, name, lambda values: math.inf)
    few = replace(
        few,
        problem=replace(few.problem, manufacturing=Manufacturing(0.02)),
        candidates=tuple(replace(each, values=None) for each in few.candidates),
    )
    write_run(tmp_path / "out", few, {}, 0)
    designs = json.loads((tmp_path / "out" / "candidates.json").read_text())["designs"]
    assert {(design["torque_peak"], design["move_r2"]) for design in designs} == {(None, None)}
    assert all(design["move_r1"] > 0 for design in designs)


def test_an_unknown_length_unit_is_one_line(grashof: Grashof, tmp_path: Path) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text(problem_text("luggage").replace('length_unit = "m"', 'length_unit = "ell"'))
    said = "length_unit is 'ell'; it must be one of mm, cm, m, in, ft with dynamics"
    assert_one_line(grashof("solve", mine), 2, said)


@pytest.mark.slow
def test_the_table_names_the_torque_among_the_goals(grashof: Grashof, tmp_path: Path) -> None:
    out = str(tmp_path / "out")
    done = grashof("solve", "luggage", "--starts", "8", "--drawings", "0", "--out", out)
    assert done.exit_code == 0, done.output
    assert "*: Pareto-optimal in mu, size and torque." in done.output
