"""Zones that are too small: what the note says would do does."""

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import verify
from grashof.problems import MotionTask, Objective, Problem, Requirements
from grashof.synth import Result
from grashof.synth.results.larger_zones import up

pytestmark = pytest.mark.usefixtures("small_search")

POSES = [[0, 0, 0], [30, 10, 10], [60, 15, 25], [90, 10, 40], [120, -5, 60], [130, -30, 80]]

LOOSE = Requirements(rotatability="any", order=False, same_branch=False)  # nothing else to be named


def task(**zones: Any) -> MotionTask:
    return MotionTask.from_degrees(POSES, **zones)


@pytest.mark.study
def test_larger_zones_that_are_named_would_do(least_error: Callable[..., Result]) -> None:
    """Down to the least zone, the named sizes depend on the poses alone."""
    named = []
    for zone in (0.01, 1e-9):
        result = synthesize(Problem(task=task(within=zone)), effort=0.2)
        said = re.fullmatch(
            rf"no design meets all requirements; this alone would do: within (\S+) instead of {zone:g}",
            result.note,
        )
        assert said is not None
        assert len(result) == 0
        larger = task(within=float(said[1]))
        assert verify(result.nearest[0].linkage, larger, Requirements()).ok
        smaller = task(within=float(said[1]) * 0.98)
        assert not verify(result.nearest[0].linkage, smaller, Requirements()).ok
        named.append(float(said[1]))
    assert named[0] == pytest.approx(named[1], rel=0.02)
    squares = least_error(Problem(task=task()), effort=0.2).best.verdict
    length = task().angle_length
    assert named[0] <= max(squares.error_max, length * squares.angle_error.max())


@pytest.mark.study
def test_zones_that_are_named_are_little_larger_than_need_be() -> None:
    """With 6.9 mm designs are found by four times the effort, with 6.5 mm none."""
    poses = [[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70], [360, 0, 90]]
    limits = Requirements(link_length=(30, 400), transmission_min_deg=35)
    gripper = MotionTask.from_degrees(poses, within=0.5, angle_within_deg=3)
    result = synthesize(Problem(task=gripper, requirements=limits))
    said = re.search(r"would do: within (\S+) instead of 0\.5;", result.note)
    assert said is not None
    assert 6.5 < float(said[1]) < 7.2
    larger = MotionTask.from_degrees(poses, within=float(said[1]), angle_within_deg=3)
    assert any(verify(one.linkage, larger, limits).ok for one in result.nearest)


@pytest.mark.study
def test_each_zone_is_named_with_its_own_figure() -> None:
    each = task(within=1e-3, angle_within_deg=[1, 1, 1, 1, 1, 2])
    result = synthesize(Problem(task=each, requirements=LOOSE), effort=0.2)
    said = re.search(r"would do: within (\S+) instead of 0\.001$", result.note)
    assert said is not None
    larger = task(within=float(said[1]), angle_within_deg=[1, 1, 1, 1, 1, 2])
    assert verify(result.nearest[0].linkage, larger, LOOSE).ok
    each = task(within=[1e-3] * 5 + [0.01])
    result = synthesize(Problem(task=each, requirements=LOOSE), effort=0.2)
    said = re.search(r"would do: within (\S+) times as large$", result.note)
    assert said is not None
    larger = task(within=np.array([1e-3] * 5 + [0.01]) * float(said[1]))
    assert verify(result.nearest[0].linkage, larger, LOOSE).ok
    result = synthesize(Problem(task=task(angle_within_deg=0.001), requirements=LOOSE), effort=0.2)
    said = re.search(r"would do: angle_within_deg (\S+) instead of 0\.001$", result.note)
    assert said is not None
    larger = task(angle_within_deg=float(said[1]))
    assert verify(result.nearest[0].linkage, larger, LOOSE).ok


@pytest.mark.slow
def test_a_larger_tolerance_is_named(relaxing_only: Callable[..., None]) -> None:
    relaxing_only()
    wanted = Requirements(exact=True, tolerance=1e-4)
    result = synthesize(Problem(task=task(), requirements=wanted), effort=0.2)
    said = re.search(r"would do: tolerance (\S+) instead of 0\.0001$", result.note)
    assert said is not None
    loose = replace(wanted, tolerance=1.02 * float(said[1]))  # room for another local optimum
    assert verify(result.nearest[0].linkage, task(), loose).ok
    assert len(synthesize(Problem(task=task(), requirements=loose), effort=0.2)) > 0


@pytest.mark.slow
def test_two_poses_may_be_missed_too(relaxing_only: Callable[..., None]) -> None:
    relaxing_only("link_length")
    poses = [[0, 0, 0], [30, 10, 40]]
    problem = Problem(task=MotionTask.from_degrees(poses, within=2), objective=Objective(0, 1))
    result = synthesize(problem, enough=4, effort=0.2)
    exact = synthesize(replace(problem, task=problem.task.without_zones()), enough=4)
    assert all(verify(one.linkage, problem.task, problem.requirements).ok for one in result.candidates)
    assert result.best.verdict.size < exact.best.verdict.size
    far = Requirements(link_length=(1, 2), coupler_arms=(0, 1))
    result = synthesize(replace(problem, requirements=far), effort=0.2)
    assert len(result) == 0
    assert result.note.startswith("no design")


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.4706, "0.471"), (0.47, "0.47"), (1234.5, "1240"), (0.0, "0"), (9.999, "10"), (1e-9, "1e-09")],
)
def test_figures_are_rounded_up(value: float, said: str) -> None:
    assert f"{up(value):g}" == said
    assert float(said) >= value
