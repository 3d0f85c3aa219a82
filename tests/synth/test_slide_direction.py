"""Slider-cranks through poses with a prescribed direction of the slide."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, FunctionTask, MotionTask, PathTask, Problem, Requirements, SliderCrank
from grashof.problems.values.arrays import turned_from
from grashof.synth import Candidate

DOOR = MotionTask.from_degrees([[0, 1.05, 90], [-0.2, 1.75, 125], [-0.95, 2.12, 180]])
FREE = MotionTask(DOOR.positions, [np.pi / 2, np.nan, np.pi])

pytestmark = pytest.mark.usefixtures("small_search")


def slides_along(found: list[Candidate], angle_deg: float) -> bool:
    """Whether B of every design moves on a line of that direction, from where it is at the poses alone."""
    for each in found:
        b = solve_position(each.linkage, each.verdict.theta2, each.verdict.assembly).b
        along = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
        way = b - b[0]
        if np.abs(way[:, 0] * along[1] - way[:, 1] * along[0]).max() > 1e-8:
            return False
    return True


@pytest.mark.quick("whole-180", "one angle free-0")
@pytest.mark.parametrize("angle_deg", [180, 0])
@pytest.mark.parametrize("task", [DOOR, FREE], ids=["whole", "one angle free"])
def test_a_door_on_a_level_track(task: MotionTask, angle_deg: float) -> None:
    wanted = Requirements(rotatability="any", slide_angle_deg=angle_deg)
    found = synthesize(Problem(task=task, mechanism="slider-crank", requirements=wanted), enough=5)
    assert len(found) >= 5
    assert slides_along(found.candidates, angle_deg)


@pytest.mark.slow
def test_a_door_on_a_level_track_with_its_pivots_in_zones() -> None:
    on_door = Box((-1.1, 1.1), (-0.2, 0.2))
    wanted = Requirements(
        rotatability="any",
        slide_angle_deg=180,
        o2=Box((-0.3, 0.3), (0.5, 2.2)),
        a_on_body=on_door,
        b_on_body=on_door,
    )
    found = synthesize(Problem(task=FREE, mechanism="slider-crank", requirements=wanted), enough=3)
    assert len(found) >= 3
    assert slides_along(found.candidates, 180)
    for each in found.candidates:
        assert -0.3 - 1e-9 <= each.linkage.o2[0] <= 0.3 + 1e-9  # type: ignore[attr-defined]


@pytest.mark.quick("4", "5")
@pytest.mark.parametrize("poses", [3, 4, 5])
def test_planted_directions_are_met(poses: int) -> None:
    task, linkage = planted_motion(np.random.default_rng([2, poses]), poses, mechanism="slider-crank")
    angle_deg = float(np.degrees(linkage.slide_angle)) + 180
    wanted = Requirements(slide_angle_deg=angle_deg, transmission_min_deg=0)
    found = synthesize(Problem(task=task, mechanism="slider-crank", requirements=wanted), enough=1)
    assert len(found) == 1
    assert slides_along(found.candidates, angle_deg)


def test_with_a_limit_of_its_offset_a_slide_has_a_sense() -> None:
    """The offset counts to the left of the direction that is stated."""
    wanted = Requirements(rotatability="any", slide_angle_deg=180, offset=(0, 5))
    found = synthesize(Problem(task=DOOR, mechanism="slider-crank", requirements=wanted), enough=3)
    for each in found.candidates:
        assert isinstance(each.linkage, SliderCrank)
        assert abs(turned_from(float(each.linkage.slide_angle), np.pi)) < 1e-9
        assert float(each.linkage.offset) >= -1e-9
    assert len(found) >= 3


def test_a_function_gives_a_slide_its_sense() -> None:
    wanted = Requirements(slide_angle_deg=30)
    guided = Problem(task=DOOR, mechanism="slider-crank", requirements=wanted)
    moved = replace(guided, task=FunctionTask([0.0, 1.0, 2.0], [0.0, 1.0, 1.5], travels=True))
    assert (guided.period("slide_angle"), moved.period("slide_angle")) == (np.pi, 2 * np.pi)
    assert guided.period("ground_angle") == 2 * np.pi


def test_a_range_of_directions_is_kept_and_used() -> None:
    wanted = Requirements(rotatability="any", slide_angle_deg=(170.0, 190.0))
    found = synthesize(Problem(task=DOOR, mechanism="slider-crank", requirements=wanted), enough=20)
    slides = np.array([float(each.linkage.slide_angle) for each in found.candidates])  # type: ignore[attr-defined]
    apart = np.degrees(turned_from(slides, np.pi, np.pi))
    assert len(apart) >= 20
    assert np.abs(apart).max() <= 10 + 1e-6
    assert np.ptp(apart) > 5


def test_ranges_of_the_ground_angle_are_equal_modulo_a_turn() -> None:
    task = PathTask([[0, 0], [30, 20], [60, 28], [90, 25], [110, 12]])
    found = [
        synthesize(
            Problem(task=task, requirements=Requirements(rotatability="any", ground_angle_deg=allowed)),
            starts=16,
            enough=3,
        )
        for allowed in ((-10.0, 20.0), (350.0, 380.0))
    ]
    here, there = ([each.linkage for each in one.candidates] for one in found)
    assert len(here) >= 3
    theta1 = np.degrees([float(linkage.theta1) for linkage in here])
    assert theta1.min() >= -10 - 1e-6
    assert theta1.max() <= 20 + 1e-6
    np.testing.assert_allclose([each.r2 for each in there], [each.r2 for each in here], rtol=1e-6)


@pytest.mark.slow
def test_a_range_that_no_linkage_keeps_is_widened_at_its_nearer_end(
    relaxing_only: Callable[..., None],
) -> None:
    relaxing_only("slide_angle_deg")
    task, linkage = planted_motion(np.random.default_rng([2, 5]), 5, mechanism="slider-crank")
    angle = float(np.degrees(linkage.slide_angle))  # the only one
    allowed = (angle + 1.0, angle + 3.0)
    wanted = Requirements(exact=True, slide_angle_deg=allowed, transmission_min_deg=0)
    result = synthesize(Problem(task=task, mechanism="slider-crank", requirements=wanted), starts=2)
    assert not result.candidates
    reached = float(result.note.split("slide_angle_deg from ")[1].split()[0])
    assert reached == pytest.approx(angle, abs=0.01)
    assert reached <= angle
