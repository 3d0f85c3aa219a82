"""Exact poses of any number: the dyads that starts are made of, and what theory says without them."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from circles import pivots_of, radii

from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, FourBar, MotionTask, Problem, Requirements
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import finder_for
from grashof.synth.starts.exact_poses import DyadPairs
from grashof.synth.theory.burmester import Dyads

Judge = Callable[[FourBar, MotionTask], Any]


def planted(seed: int, poses: int, **wanted: Any) -> tuple[ScaledProblem, MotionTask, FourBar]:
    task, linkage = planted_motion(np.random.default_rng([41, seed]), poses)
    requirements = Requirements(exact=True, **wanted)
    return ScaledProblem.of(Problem(task=task, requirements=requirements)), task, linkage


def posed(rows: list[list[float]], **wanted: Any) -> ScaledProblem:
    return ScaledProblem.of(Problem(task=MotionTask.from_degrees(rows), requirements=Requirements(**wanted)))


def said(task: MotionTask) -> str:
    """Why there may be no design, as the finder says."""
    scaled = ScaledProblem.of(Problem(task=task, requirements=Requirements(exact=True)))
    return finder_for(scaled).obstacle(rng(), {})


def rng() -> np.random.Generator:
    return np.random.default_rng(0)


def spread_of_radii(scaled: ScaledProblem, dyads: Dyads) -> npt.NDArray[np.float64]:
    """By how much the distance of the moving pivot from the ground pivot varies, from the poses."""
    task = scaled.problem.task
    assert isinstance(task, MotionTask)
    radius = radii(scaled.frame.inward(task.positions), task.angles, dyads)
    far = 1 + np.abs(dyads.moving) + np.abs(dyads.ground)
    spread: npt.NDArray[np.float64] = np.ptp(radius, axis=1) / far**2
    return spread


BOXES: dict[str, dict[str, Any]] = {
    "anywhere": {},
    "in a box": {"o2": Box((-1, 2), (0, 1)), "o4": Box((3, 4), (-5, 5))},
    "on a line": {"o2": Box(y=(0.5, 0.5))},
    "fixed": {"o2": Box((1, 1), (-2, -2)), "o4": Box((3, 3), (0, 0))},
}


def dyads_of(scaled: ScaledProblem) -> Dyads:
    finder = finder_for(scaled)
    assert isinstance(finder, DyadPairs)
    return finder.dyads(rng())


@pytest.mark.parametrize("poses", [2, 3])
@pytest.mark.parametrize("kind", BOXES)
def test_sampled_dyads_are_exact_and_half_have_their_pivot_in_its_box(poses: int, kind: str) -> None:
    for seed in range(3):
        scaled, _, _ = planted(seed, poses, **BOXES[kind])
        dyads = dyads_of(scaled)
        assert len(dyads) > 4000
        assert spread_of_radii(scaled, dyads).max() < 1e-9
        for box in (scaled.wanted.o2 or Box(), scaled.wanted.o4 or Box()):
            inside = (dyads.ground.real >= box.x[0]) & (dyads.ground.real <= box.x[1])
            inside &= (dyads.ground.imag >= box.y[0]) & (dyads.ground.imag <= box.y[1])
            assert inside.sum() >= 150


@pytest.mark.quick("anywhere-2", "in a box-2", "on a line-3", "fixed-3")
@pytest.mark.parametrize("poses", [2, 3])
@pytest.mark.parametrize("kind", BOXES)
def test_starts_of_two_and_three_poses_meet_them_with_their_pivots_in_place(
    poses: int, kind: str, independent_judge: Judge
) -> None:
    rows = [[0.0, 0, 0], [2, 1, 20], [3, 3, 50]][:poses]
    scaled = posed(rows, link_length=(0.1, 20), **BOXES[kind])
    queue = finder_for(scaled).round(0, 10, rng(), 1)
    assert len(queue.starts) >= 5
    for start in queue.starts:
        pair = Dyads(np.array([start.a, start.b]), np.array([start.o2, start.o4]))
        assert spread_of_radii(scaled, pair).max() < 1e-9
    for start in queue.starts[: min(5, queue.counts["feasible finds"])]:
        found = independent_judge(
            scaled.linkages(start.points, np.array(start.assembly)), scaled.problem.task
        )
        assert found.position_error < 1e-9
        assert found.angle_error < 1e-9
        assert found.in_order
        assert found.on_one_branch
        assert found.turns


@pytest.mark.quick("5", "12")
@pytest.mark.parametrize("poses", [5, 6, 8, 12])
def test_the_planted_dyads_are_among_those_of_five_poses_and_more(poses: int) -> None:
    for seed in range(25):
        scaled, _, linkage = planted(seed, poses)
        dyads, pivots = dyads_of(scaled), pivots_of(scaled, linkage)
        assert 2 <= len(dyads) <= 4
        assert spread_of_radii(scaled, dyads).max() < 1e-9
        for moving, ground in zip(pivots[2:4], pivots[:2], strict=True):
            gap = np.maximum(np.abs(dyads.moving - moving), np.abs(dyads.ground - ground))
            assert gap.min() < 1e-5 * (1 + abs(moving) + abs(ground)), seed


@pytest.mark.parametrize("poses", [5, 9])
def test_starts_of_five_poses_and_more_are_settled_pairs_of_dyads(
    poses: int, independent_judge: Judge
) -> None:
    usable = 0
    for seed in range(10):
        scaled, task, _ = planted(seed, poses)
        queue = finder_for(scaled).round(0, 50, rng(), 1)
        dyads = dyads_of(scaled)
        assert queue.counts["exact dyads"] == len(dyads)
        assert queue.counts["feasible finds"] == len(queue.starts) <= len(dyads) * (len(dyads) - 1)
        for start in queue.starts:
            assert start.terms.settled
            for pair in ((start.a, start.o2), (start.b, start.o4)):
                gap = np.abs(dyads.moving - pair[0]) + np.abs(dyads.ground - pair[1])
                assert gap.min() < 1e-12
            found = independent_judge(scaled.linkages(start.points, np.array(start.assembly)), task)
            assert found.in_order
            assert found.on_one_branch
            usable += 1
    assert usable >= 10


def sampled_centre_points(scaled: ScaledProblem, count: int = 400_000) -> ComplexArray:
    """Centre points of four poses: ground pivots c whose positions seen from the body lie on a circle.

    Found where the determinant of four concyclic points changes sign along lines of a grid.
    """
    task = scaled.problem.task
    assert isinstance(task, MotionTask)
    places, turned = scaled.frame.inward(task.positions), np.exp(1j * task.angles)

    def off_circle(c: ComplexArray) -> npt.NDArray[np.float64]:
        seen = (c[..., None] - places) * turned.conj()
        rows = np.stack([np.abs(seen) ** 2, seen.real, seen.imag, np.ones(seen.shape)], axis=-1)
        value: npt.NDArray[np.float64] = np.linalg.det(rows)
        return value

    side = int(np.sqrt(count))
    x = np.linspace(-4, 4, side)
    found = []
    for along in (1.0, 1j):
        start = along * x[:-1, None] + along * 1j * x
        value = off_circle(along * x[:, None] + along * 1j * x)
        crossed = value[:-1] * value[1:] < 0
        share = (value[:-1] / (value[:-1] - value[1:]))[crossed]
        found.append(start[crossed] + along * share * (x[1] - x[0]))
    points: ComplexArray = np.concatenate(found)
    return points


def test_how_far_a_fixed_pivot_is_off_the_curve_of_four_poses() -> None:
    rows = [[0.0, 0, 0], [2, 1, 20], [3, 3, 50], [1, 4, 100]]
    free = posed(rows)
    traced = sampled_centre_points(free)
    assert len(traced) > 100
    at = traced[len(traced) // 3] + 0.2 - 0.1j  # in sizes
    x, y = free.frame.outward(np.array(at))
    scaled = posed(rows, o4=Box((float(x), float(x)), (float(y), float(y))))
    expected = float(np.abs(traced - at).min()) * free.frame.scale
    found = finder_for(scaled).obstacle(rng(), {})
    assert found.startswith(f"O4 is fixed at ({x:.6g}, {y:.6g}), ")
    assert "nearest centre point that four poses have" in found
    assert float(found.split("), ")[1].split()[0]) == pytest.approx(expected, abs=0.03 * free.frame.scale)
    assert finder_for(free).obstacle(rng(), {}) == ""


def five_without_dyads() -> ScaledProblem:
    """Five poses at random that have no real dyad."""
    for seed in range(200):
        draw = np.random.default_rng([43, seed])
        task = MotionTask(draw.normal(size=(5, 2)), draw.uniform(-np.pi, np.pi, 5))
        scaled = ScaledProblem.of(Problem(task=task))
        if not len(dyads_of(scaled)):
            return scaled
    raise AssertionError("every set has dyads")


def test_five_poses_without_dyads_say_so() -> None:
    scaled = five_without_dyads()
    assert finder_for(scaled).obstacle(rng(), {}) == "the 5 poses have no real dyad, and a linkage needs two"
    queue = finder_for(scaled).round(0, 50, rng(), 1)
    assert queue.starts == []
    assert finder_for(scaled).relaxed(rng()) == []


def test_five_poses_of_a_slider_crank_say_so() -> None:
    crank = np.exp(1j * np.array([0, 1.1, 2.0, 3.5, 5.0]))
    angles = -np.arcsin(crank.imag / 3)
    body = crank + (1 + 0.7j) * np.exp(1j * angles)
    task = MotionTask(np.stack([body.real, body.imag], axis=1), angles)
    assert said(task).startswith("the 5 poses have ")
    assert said(task).endswith("; 1 dyad would have to be a slider")


def test_two_real_dyads_that_make_no_usable_linkage_are_counted() -> None:
    scaled, _, _ = planted(0, 5, link_length=(1e3, 1e4))
    count = len(dyads_of(scaled))
    assert count >= 2
    few = ", so one linkage at most, or its two drivers" if count == 2 else ""
    assert finder_for(scaled).obstacle(rng(), {}) == f"the 5 poses have {count} real dyads only{few}"


def test_six_poses_at_random_have_no_dyads() -> None:
    draw = np.random.default_rng(44)
    task = MotionTask(draw.normal(size=(6, 2)), draw.uniform(-np.pi, np.pi, 6))
    assert said(task) == "the 6 poses have no real dyad, and a linkage needs two"


def test_one_dyad_of_six_poses_is_not_enough() -> None:
    """Five poses of a linkage, and a sixth that keeps A on its circle and takes B off its own."""
    _, task, linkage = planted(3, 5)
    arm = complex(*linkage.coupler_point)
    theta3, theta2 = float(task.angles[4] - linkage.body_angle) + 0.4, 2.0
    p = complex(*linkage.o2) + float(linkage.r2) * np.exp(1j * theta2) + arm * np.exp(1j * theta3)
    six = MotionTask(
        np.concatenate([task.positions, [[p.real, p.imag]]]),
        np.append(task.angles, theta3 + float(linkage.body_angle)),
    )
    assert said(six) == "the 6 poses have a single real dyad, and a linkage needs two"


@pytest.mark.parametrize("poses", [3, 5, 7])
def test_translations_and_rotations_of_any_number_are_reported(poses: int) -> None:
    draw = np.random.default_rng(poses)
    places = draw.normal(size=(poses, 2))
    still = MotionTask(places, np.full(poses, 0.3))
    assert "pure translations" in said(still)
    assert ("off any one circle" in said(still)) == (poses > 3)
    turns = draw.uniform(-np.pi, np.pi, poses)
    arm = 2 * np.exp(1j * turns)
    about = MotionTask(np.stack([3 + arm.real, arm.imag - 1], axis=1), turns)
    scaled = ScaledProblem.of(Problem(task=about, requirements=Requirements(exact=True)))
    assert "pure rotation about (3, -1)" in finder_for(scaled).degenerate()
    usual = ScaledProblem.of(Problem(task=MotionTask(places, turns), requirements=Requirements(exact=True)))
    assert finder_for(usual).degenerate() == ""


@pytest.mark.parametrize("turn", [0.0, 40.0])
def test_two_poses_are_never_degenerate(turn: float) -> None:
    """A translation or a rotation is what two poses always are; four-bars do it."""
    scaled = posed([[0, 0, 0], [2, 1, turn]], link_length=(0.2, 20))
    assert finder_for(scaled).degenerate() == ""
    queue = finder_for(scaled).round(0, 5, rng(), 1)
    assert len(queue.starts) >= 5


def test_all_is_in_the_unit_of_the_task() -> None:
    """A thousand times the size: the same dyads in sizes."""
    scaled, task, _ = planted(5, 5)
    large = replace(scaled.problem, task=MotionTask(1000 * task.positions, task.angles))
    here, there = (np.sort_complex(dyads_of(each).ground) for each in (scaled, scaled.of_problem(large)))
    np.testing.assert_allclose(here, there, atol=1e-9 * np.abs(here).max())
