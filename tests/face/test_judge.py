"""`grashof judge`: the verdict on a linkage that no search has found."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_runs import Grashof, assert_one_line

from grashof import load
from grashof.analysis.judge import verify
from grashof.problems import FourBar

POSES = """
kind = "motion"
length_unit = "mm"
[motion]
poses = [[0, 0, 0], [-20, 60, 20], [-60, 130, 55]]
[requirements]
rotatability = "any"
transmission_min_deg = 25
"""
HINGE = """
length_unit = "mm"
o2 = [-3.397, -122.927]
o4 = [-150.0, -200.0]
r2 = 129.922
r3 = 63.675
r4 = 158.719
coupler_point = [-78.579, -119.079]
assembly = -1
body_angle_deg = -153.84
"""


@pytest.fixture
def hood(tmp_path: Path) -> Path:
    (tmp_path / "hood.toml").write_text(POSES.replace("[requirements]", "[requirements]\ntolerance = 1e-4"))
    (tmp_path / "exact.toml").write_text(POSES)
    (tmp_path / "hinge.toml").write_text(HINGE)
    return tmp_path


def test_a_linkage_that_does_it(grashof: Grashof, hood: Path) -> None:
    done = grashof("judge", "hinge.toml", "hood.toml")
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0] == "hinge meets the requirements of hood"
    assert "  double-rocker; driver swings" in lines
    assert "  worst transmission angle over the task: 52.8808 deg" in lines
    assert "  driver rotation: 35.4848 deg" in lines
    assert not any("turn" in line for line in lines)  # it does not turn fully


def test_its_defects_are_those_of_the_judge(grashof: Grashof, hood: Path) -> None:
    done = grashof("judge", "hinge.toml", "exact.toml")
    assert done.exit_code == 1
    missed = [line.removeprefix("  missed: ") for line in done.stdout.splitlines() if "missed" in line]
    problem = load(hood / "exact.toml")
    linkage = FourBar(
        (-3.397, -122.927), (-150, -200), 129.922, 63.675, 158.719, (-78.579, -119.079), assembly=-1,
        body_angle=-2.6850145,
    )  # fmt: skip
    defects = verify(linkage, problem.task, problem.requirements, problem=problem).defects
    assert [each.requirement for each in defects] == ["exact", "exact"]
    assert [line.split(",")[0][:40] for line in missed] == [str(each).split(",")[0][:40] for each in defects]


def test_other_kinds_of_linkage_and_of_tasks_are_judged(grashof: Grashof, hood: Path) -> None:
    assert grashof("judge", "engine", "hood.toml").exit_code in (1, 2)
    done = grashof("judge", "pumpjack", "function-log10")
    assert done.exit_code == 0
    assert "  greatest structural error: 33.0415 deg" in done.stdout.splitlines()


def test_units_must_agree(grashof: Grashof, hood: Path) -> None:
    (hood / "inches.toml").write_text(HINGE.replace('"mm"', '"in"'))
    said = "lengths are in in, those of hood in mm; they must be in the same unit"
    assert_one_line(grashof("judge", "inches.toml", "hood.toml"), 2, said)
