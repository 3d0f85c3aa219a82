"""Stroke tasks: their properties, and impossible ones, which are refused in a line."""

import tomllib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from refusals import refusal, rows

from grashof.problems import (
    Box,
    DwellTask,
    LinkSwing,
    Problem,
    Requirements,
    StrokeTask,
    TandemTask,
    TargetLimits,
    Task,
)


def test_two_limit_positions_without_a_place() -> None:
    task = StrokeTask.from_degrees(swing_deg=80, time_ratio=1.25)
    assert len(task) == 2
    assert np.isnan(task.positions).all()
    assert not task.has_angle.any()
    assert task.swing == np.radians(80)
    assert (task.closed, task.returns, task.exact_by_default, task.scale_free) == (True, False, True, True)
    assert task.middle.tolist() == [0, 0]


def test_a_stroke_is_the_size() -> None:
    task = StrokeTask(stroke=100, time_ratio=1.2)
    assert (task.size, task.scale_free, task.swing) == (100.0, False, None)
    assert Requirements().resolved(1.0, scale_free=True).link_length is None


@pytest.mark.parametrize(
    ("wanted", "size"),
    [
        ({}, 1.0),
        ({"r1": (120, 120)}, 120.0),
        ({"link_length": (10, 200)}, 200.0),
        ({"o2": Box((0, 0), (0, 0)), "o4": Box((3, 3), (4, 4))}, 5.0),
        ({"o2": Box((0, 0), (0, 0)), "o4": Box((3, 3))}, 3.0),
        ({"distances": {"a-o4": (2, 4)}}, 4.0),
        ({"at": (TargetLimits(targets=[2], distances={"a-o4": (2, 1e6)}),)}, 20.0),
        ({"o2": Box((0, 0), (0, 0)), "at": (TargetLimits(targets=[1], a=Box((2, 3), (3, 4))),)}, 5.0),
    ],
)
def test_a_free_scale_is_taken_from_limits(wanted: dict[str, Any], size: float) -> None:
    task = StrokeTask.from_degrees(swing_deg=80, time_ratio=1.1)
    assert Problem(task=task, requirements=Requirements(**wanted)).task.size == size
    assert task.size == 1.0


def test_replaced_strokes_keep_the_rest() -> None:
    task = StrokeTask(swing=1.0, time_ratio=1.5).sized(7.0)
    assert replace(task).swing == 1.0
    assert task.without_zones().time_ratio == 1.5


BAD = r"""
# | stroke has neither swing_deg nor stroke; <EITHER>
swing_deg = 80\nstroke = 1 | stroke has both swing_deg and stroke; <EITHER>
swing_deg = 200 | stroke.swing_deg is 200; it must be from 0.0573 to less than 180, as a rocker swings
swing_deg = 180 | stroke.swing_deg is 180; it must be from 0.0573 to less than 180, as a rocker swings
stroke = -1 | stroke.stroke is -1; it must be a number greater than zero
swing_deg = 80\ntime_ratio = 0.9 |
    stroke.time_ratio is 0.9; it must be at least 1, the slow stroke over the quick one
"""
EITHER = "it must be one of the two: swing_deg for a rocker, stroke for a slide"


@pytest.mark.parametrize(("stated", "said"), rows(BAD, EITHER=EITHER))
def test_impossible_strokes_are_refused_in_a_line(stated: str, said: str) -> None:
    assert refusal(StrokeTask.from_degrees, **tomllib.loads(stated)) == said


OF_A_KIND = r"""
swing_deg = 80\ntime_ratio = 6.2 | four-bar |
    stroke.time_ratio is 6.2; it must be less than 6.2 for a crank-rocker that swings by 80 deg
swing_deg = 80\ntime_ratio = 6.19 | four-bar | #
stroke = 1\ntime_ratio = 3.0 | slider-crank |
    stroke.time_ratio is 3; it must be less than 2.999 for a slider-crank, whose crank would not turn fully
stroke = 1\ntime_ratio = 2.99 | slider-crank | #
stroke = 1 | four-bar | stroke.stroke is of a slide; a four-bar has a swing, stroke.swing_deg
swing_deg = 80 | slider-crank | stroke.swing_deg is of a rocker; a slider-crank has a slide, stroke.stroke
"""


@pytest.mark.parametrize(("stated", "mechanism", "said"), rows(OF_A_KIND))
def test_impossible_strokes_of_a_kind_of_linkage(stated: str, mechanism: str, said: str) -> None:
    assert StrokeTask.from_degrees(**tomllib.loads(stated)).impossible(mechanism) == said


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ({"exact": False}, "requirements.exact is false; "),
        ({"rotatability": "double-crank"}, 'requirements.rotatability is "double-crank", '),
        ({"error_factor": 1.2}, "requirements.error_factor needs least squares"),
        ({"a_on_body": Box((0, 1))}, "stroke has no angles; requirements.a_on_body needs it"),
    ],
)
def test_requirements_that_do_not_apply(wanted: dict[str, Any], said: str) -> None:
    task = StrokeTask.from_degrees(swing_deg=80, time_ratio=1.1)
    line = refusal(Problem, task=task, requirements=Requirements(**wanted))
    assert line.startswith(said)
    assert "\n" not in line


AT = r"""
targets = [3]\ntransmission_min_deg = 30 | requirements.at[0].targets has 3; the last target is 2
targets = [1]\npast_deg = [2, 5] | <NOT>past_deg<WITH> driver and coupler are in line
targets = [1]\ncoupler_rate = [0, 1] | <NOT>coupler_rate<WITH>
    it follows from lengths, r2/r3; limit link_ratios
targets = [2]\nmechanical_advantage_min = 2 | <NOT>mechanical_advantage_min<WITH> the advantage is infinite
"""
WITH = " does not go with a stroke; in a limit position"


@pytest.mark.parametrize(("stated", "said"), rows(AT, NOT="requirements.at[0].", WITH=WITH))
def test_limits_that_say_nothing_in_limit_positions_are_refused_in_a_line(stated: str, said: str) -> None:
    task = StrokeTask.from_degrees(swing_deg=80, time_ratio=1.1)
    wanted = Requirements(at=(TargetLimits(**tomllib.loads(stated)),))
    assert refusal(Problem, task=task, requirements=wanted) == said


def test_a_target_may_be_named_twice_and_its_place_limits_something() -> None:
    assert TargetLimits(targets=[2, 1, 2], transmission_min_deg=30).targets == (2, 1)
    line = refusal(TargetLimits, targets=[1], a=Box())
    assert line == "a limits neither x nor y; give one of them a finite side"


def test_a_centre_in_a_limit_position_is_a_place_of_b() -> None:
    task, single = StrokeTask(swing=1.0), TargetLimits(targets=[1], instant_centre=Box(x=(0, 1)))
    line = refusal(Problem, task=task, requirements=Requirements(at=(single,)))
    assert line.endswith("instant_centre does not go with a stroke; in a limit position that is B; limit b")


@pytest.mark.parametrize(
    ("task", "word"),
    [
        (DwellTask.from_degrees(dwell_deg=60, swing_deg=30), 'kind = "dwell"'),
        (TandemTask([LinkSwing(4, 1.0), LinkSwing(6, 1.0)]), 'kind = "stroke" with two outputs'),
    ],
)
def test_single_targets_of_dwells_and_of_two_outputs_have_no_limits(task: Task, word: str) -> None:
    wanted = Requirements(at=(TargetLimits(targets=[1], transmission_min_deg=30),))
    line = refusal(Problem, task=task, requirements=wanted)
    assert line == (
        f"requirements.at[0] does not go with {word}; "
        "it needs poses, points, pairs of a function or the limit positions of one stroke"
    )


def test_a_large_tolerance_is_not_a_zone() -> None:
    task = StrokeTask.from_degrees(swing_deg=80, time_ratio=1.1)
    problem = Problem(task=task, requirements=Requirements(tolerance=0.01))
    assert problem.zones is None
    assert problem.by_objective


@pytest.mark.parametrize("ratio", [1.0, 1.3, 1e6])
def test_the_slow_stroke_takes_the_ratio_of_the_quick_one(ratio: float) -> None:
    slow = StrokeTask(swing=1.0, time_ratio=ratio).driver_rotation
    assert slow >= np.pi - 1e-12
    assert slow / (2 * np.pi - slow) == pytest.approx(ratio, rel=1e-8)
