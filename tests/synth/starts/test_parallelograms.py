"""Parallelogram linkages for pure translations: against the circle that P has to move on."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import GrashofClass, solve_position
from grashof.problems import Box, FourBar, MotionTask, Problem, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth import Candidate, Result
from grashof.synth.starts.parallelograms import circle_through

pytestmark = pytest.mark.usefixtures("small_search")

ANY: dict[str, Any] = {"rotatability": "any"}
CENTRE, RADIUS = 1 + 2j, 3.0
BOXES = {"o2": Box((-3, -2), (0, 1)), "o4": Box((-1, 0), (0, 1))}


def on_circle(degrees: list[float], angle: float = 20.0) -> MotionTask:
    """Poses on the circle about CENTRE, all at one angle."""
    at = CENTRE + RADIUS * np.exp(1j * np.radians(degrees))
    return MotionTask(np.stack([at.real, at.imag], axis=1), np.full(len(at), np.radians(angle)))


def problem(task: MotionTask, **wanted: Any) -> Problem:
    return Problem(task=task, requirements=Requirements(**{**ANY, **wanted}))


def complex_of(point: FloatArray) -> complex:
    return complex(float(point[0]), float(point[1]))


def body_of(linkage: FourBar, theta2: FloatArray) -> ComplexArray:
    """Where a parallelogram carries P, by its own formula: O2 + r2 exp(i theta2) + const."""
    along = (complex_of(linkage.o4) - complex_of(linkage.o2)) / float(linkage.r1)
    arm = complex_of(linkage.coupler_point) * along
    return np.asarray(complex_of(linkage.o2) + float(linkage.r2) * np.exp(1j * theta2) + arm)


def check(result: Result, least_deg: float = 0.0) -> None:
    """Each is a parallelogram at every pose, with no change point on the way, and turns nothing."""
    task = result.problem.task
    assert isinstance(task, MotionTask)
    targets = task.positions @ np.array([1, 1j])
    assert len(result) > 0
    for candidate in result.candidates:
        linkage, verdict = candidate.linkage, candidate.verdict
        assert verdict.ok
        assert verdict.grashof_class is GrashofClass.CHANGE_POINT
        assert not verdict.full_rotation
        assert float(linkage.r1) == pytest.approx(float(linkage.r3), rel=1e-9)
        assert float(linkage.r2) == pytest.approx(float(linkage.r4), rel=1e-9)
        assert np.abs(body_of(linkage, verdict.theta2) - targets).max() < 1e-9 * task.size
        way = np.linspace(verdict.theta2.min(), verdict.theta2.max(), 400)
        off = (way - float(linkage.theta1)) / np.pi
        assert np.floor(off).min() == np.floor(off).max()  # no change point on the way
        mu = np.abs((off - np.floor(off)) * 180)
        worst = np.minimum(mu, 180 - mu).min()
        assert np.degrees(verdict.transmission_min_task) == pytest.approx(worst, abs=1e-6)
        assert worst >= least_deg - 1e-6
        state = solve_position(linkage, way)
        assert np.abs(state.p @ np.array([1, 1j]) - body_of(linkage, way)).max() < 1e-6 * task.size


ARCS: dict[str, tuple[list[float], float]] = {
    "three": ([10, 40, 100], 45),
    "three clockwise": ([100, 40, 10], 45),
    "four": ([10, 40, 60, 80], 55),
    "six": ([10, 40, 60, 80, 100, 130], 30),
    "nearly half a turn": ([0, 60, 120, 170], 5),
}


@pytest.mark.quick("three clockwise")
@pytest.mark.parametrize("kind", ARCS)
def test_poses_on_a_circle_get_the_best_transmission_that_there_is(kind: str) -> None:
    """With the ground line across the middle of the way: 90 deg less half the arc."""
    degrees, best = ARCS[kind]
    result = synthesize(problem(on_circle(degrees), exact=True))
    check(result)
    assert np.degrees(result.best.verdict.transmission_min_task) == pytest.approx(best, abs=1e-3)
    assert all(float(one.linkage.r2) == pytest.approx(RADIUS, rel=1e-9) for one in result.candidates)
    sense = 1 if degrees[-1] > degrees[0] else -1
    assert {one.verdict.direction for one in result.candidates} == {sense}


def spread(candidates: tuple[Candidate, ...], name: str) -> float:
    points = np.array([getattr(one.linkage, name) for one in candidates])
    return float(np.hypot(*np.ptp(points, axis=0)))


def test_the_list_offers_many_places_on_both_sides() -> None:
    result = synthesize(problem(on_circle([10, 40, 100])))
    assert len(result) >= 50
    size = result.problem.task.size
    assert spread(result.candidates, "o2") > size
    assert spread(result.candidates, "o4") > size
    lengths = np.array([float(one.linkage.r1) for one in result.candidates])
    assert lengths.max() > 5 * lengths.min()
    assert {int(one.linkage.assembly) for one in result.candidates} == {1, -1}


@pytest.mark.slow
def test_two_poses_get_parallelograms_of_either_sense_among_others() -> None:
    result = synthesize(problem(MotionTask.from_degrees([[0, 0, 10], [2, 1, 10]]), link_length=(0.5, 6)))
    kinds = [one.verdict.grashof_class is GrashofClass.CHANGE_POINT for one in result.candidates]
    assert any(kinds)
    assert not all(kinds)
    chosen = [one for one, kind in zip(result.candidates, kinds, strict=True) if kind]
    assert {one.verdict.direction for one in chosen} == {1, -1}
    for one in chosen:
        at = body_of(one.linkage, one.verdict.theta2)
        assert np.abs(at - [0, 2 + 1j]).max() < 1e-9
        assert 0.5 <= float(one.linkage.r2) <= 6


@pytest.mark.slow
def test_all_requirements_hold() -> None:
    wanted = {**BOXES, "transmission_min_deg": 30, "link_length": (0.5, 5), "coupler_arms": (2, 12)}
    result = synthesize(problem(on_circle([10, 40, 100]), **wanted))
    check(result, 30)
    for one in result.candidates:
        for name, box in BOXES.items():
            x, y = getattr(one.linkage, name)
            assert box.x[0] - 1e-8 <= x <= box.x[1] + 1e-8
            assert box.y[0] - 1e-8 <= y <= box.y[1] + 1e-8


@pytest.mark.slow
def test_fixed_pivots_and_a_fixed_ground_line_are_kept() -> None:
    fixed = Box((0, 0), (0, 0))
    three = synthesize(problem(on_circle([10, 40, 100]), ground_angle_deg=0, o2=fixed))
    check(three)
    assert np.abs([c.linkage.o2 for c in three.candidates]).max() < 1e-9
    assert {round(float(np.degrees(c.verdict.transmission_min_task)), 6) for c in three.candidates} == {10}
    both = synthesize(problem(on_circle([100, 120, 140]), o2=fixed, o4=Box((4, 4), (-1, -1))))
    check(both)
    assert all(float(c.linkage.r1) == pytest.approx(np.sqrt(17)) for c in both.candidates)


@pytest.mark.slow
def test_the_start_angle_chooses_the_circle_of_two_poses() -> None:
    result = synthesize(problem(on_circle([30, 90]), theta2_start_deg=30), enough=30)
    chosen = [c for c in result.candidates if c.verdict.grashof_class is GrashofClass.CHANGE_POINT]
    assert chosen
    assert all(float(c.linkage.r2) == pytest.approx(RADIUS, rel=1e-9) for c in chosen)


IN_ORDER = on_circle([10, 40, 100])
REASONS: dict[str, tuple[Problem, tuple[str, ...], tuple[str, ...]]] = {
    # B lies from P as O4 from the centre: at least 2.83 away from it here, and 3 is required.
    "arms": (
        problem(IN_ORDER, **BOXES, coupler_arms=(3, 12)),
        ("coupler_arms",),
        ("coupler_arms from 2.828 instead of 3",),
    ),
    "full crank": (
        Problem(task=on_circle([10, 40, 60, 80])),
        ("rotatability",),
        ("only parallelogram linkages", 'rotatability "any" instead of "full-crank"'),
    ),
    "straight line": (
        problem(MotionTask.from_degrees([[0, 0, 5], [1, 1, 5], [3, 3, 5]])), (), ("along a straight line",)
    ),
    "change point": (
        problem(on_circle([10, 100, 200, 260])), (), ("spread over 250 deg of a circle",)
    ),
    "order": (problem(on_circle([10, 60, 40, 80])), ("order",), ("order = false",)),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("kind", REASONS)
def test_an_empty_list_says_why(kind: str, relaxing_only: Callable[..., None]) -> None:
    problem, relaxed, words = REASONS[kind]
    relaxing_only(*relaxed)
    result = synthesize(problem)
    assert len(result) == 0
    assert all(said in result.note for said in words)


@pytest.mark.slow
def test_pivots_that_belong_in_one_small_box_do_not_meet_in_its_corner(
    relaxing_only: Callable[..., None],
) -> None:
    relaxing_only("rotatability", "o2")
    box = Box((0.5, 1.5), (1.5, 2.0))  # the centre lies in it, and no pivot a coupler away
    task = on_circle([20, 60, 90])
    stated = {"o2": box, "o4": box, "transmission_min_deg": 20.0}
    result = synthesize(problem(task, **stated, rotatability="full-crank"))
    assert not len(result)
    assert 'rotatability "any" instead of "full-crank"' in result.note
    check(synthesize(problem(task, **stated)), 20.0)


@pytest.mark.study
def test_off_the_circle_it_is_said_how_far_and_least_squares_comes_near(
    relaxing_only: Callable[..., None],
) -> None:
    relaxing_only()
    task = on_circle([10, 40, 70, 100])
    places = task.positions.copy()
    places[1] += 0.05 * (places[1] - [CENTRE.real, CENTRE.imag]) / RADIUS
    result = synthesize(problem(MotionTask(places, task.angles)))
    off = circle_through(places @ np.array([1, 1j])).off
    assert f"up to {off:.3g} off any one circle" in result.note
    assert "exact = false" in result.note
    assert result.nearest[0].verdict.error_max < 0.05


def test_the_circle_of_points_is_found() -> None:
    angles = np.array([0.1, 0.4, 1.3, 2.2])
    circle = circle_through(CENTRE + RADIUS * np.exp(1j * angles))
    assert circle.centre == pytest.approx(CENTRE)
    assert circle.radius == pytest.approx(RADIUS)
    assert circle.off < 1e-12
    assert circle_through(np.array([0, 1 + 1j, 3 + 3j])).radius == np.inf


@pytest.mark.slow
def test_least_squares_of_translations_comes_as_near_as_the_best_circle(
    least_error: Callable[..., Result],
) -> None:
    """A parallelogram on it turns nothing; other linkages may come nearer still."""
    x = np.arange(6.0)
    y = 0.02 * x**2 + 0.005 * (-1) ** x
    task = MotionTask(np.stack([x, y], axis=1), np.zeros(6))
    result = least_error(problem(task, exact=False), effort=0.2)
    at = x + 1j * y
    circle = circle_through(at)
    rms = np.sqrt(np.mean((np.abs(at - circle.centre) - circle.radius) ** 2))
    assert len(result) > 0
    assert result.best.verdict.error_rms <= rms * 1.01
    assert np.degrees(result.best.verdict.angle_error).max() < 0.5
