"""Burmester dyads: every one that is found carries its point on a circle, and none is missed."""

from typing import Any

import numpy as np
import pytest
from circles import pivots_of
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis.judge.planted import planted_motion
from grashof.problems import MotionTask, Problem
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import (
    Displacements,
    Dyads,
    centre_points,
    circle_points_on_lines,
    polish,
    radius_error,
    trace_four_pose_curves,
)

coordinate = st.floats(-5, 5)
angle = st.floats(-np.pi, np.pi)
exact_poses = st.lists(st.tuples(coordinate, coordinate, angle), min_size=4, max_size=4).filter(
    lambda poses: all(
        np.hypot(p[0] - q[0], p[1] - q[1]) > 0.1 and abs(np.angle(np.exp(1j * (p[2] - q[2])))) > 0.05
        for i, p in enumerate(poses)
        for q in poses[:i]
    )
)
bounded = settings(max_examples=12)


def displacements(poses: list[tuple[float, float, float]]) -> Displacements:
    rows = np.array(poses)
    return Displacements.from_poses(rows[:, 0] + 1j * rows[:, 1], rows[:, 2])


def carried(poses: list[tuple[float, float, float]], point: complex) -> ComplexArray:
    """Places of a body point, given at the first pose: by the body's own frame, not by displacements."""
    x, y, turn = poses[0]
    own = (point - complex(x, y)) * np.exp(-1j * turn)
    return np.array([complex(x, y) + own * np.exp(1j * turn) for x, y, turn in poses])


def circumcentre(a: complex, b: complex, c: complex) -> complex:
    """Centre of the circle through three points, by the determinant formula."""
    b, c = b - a, c - a
    double = 2 * (b.real * c.imag - b.imag * c.real)
    x = (c.imag * abs(b) ** 2 - b.imag * abs(c) ** 2) / double
    y = (b.real * abs(c) ** 2 - c.real * abs(b) ** 2) / double
    return a + complex(x, y)


def off_circle(places: ComplexArray) -> float:
    """How far the fourth place is off the circle through the first three, as a share of the radius."""
    centre = circumcentre(*(complex(place) for place in places[:3]))
    radius = abs(places[0] - centre)
    return abs(abs(places[3] - centre) - radius) / radius


def determinant(poses: list[tuple[float, float, float]], point: complex) -> float:
    """Of the four places (x, y, x^2 + y^2, 1): zero, and changing sign, where they lie on a circle."""
    places = carried(poses, point) - complex(*poses[0][:2])
    rows = np.stack([places.real, places.imag, np.abs(places) ** 2, np.ones(4)], axis=1)
    return float(np.linalg.det(rows))


@bounded
@given(exact_poses, coordinate, angle)
def test_points_found_on_a_line_lie_on_it_and_on_circles(
    poses: list[tuple[float, float, float]], offset: float, direction: float
) -> None:
    along, origin = complex(np.exp(1j * direction)), complex(offset, -offset / 2)
    found = circle_points_on_lines(displacements(poses), np.array([origin]), along)
    for point in found[np.abs(found) < 1e3]:
        assert abs(((point - origin) * np.conj(along)).imag) < 1e-9 * (1 + abs(point))
        places = carried(poses, complex(point))
        if abs(circumcentre(*places[:3])) < 1e4 and np.abs(np.diff(places)).min() > 1e-3:
            assert off_circle(places) < 1e-7


@bounded
@given(exact_poses, coordinate)
def test_no_point_of_a_line_is_missed(poses: list[tuple[float, float, float]], offset: float) -> None:
    """Between sign changes of an independent determinant lies an odd number of the points found."""
    found = circle_points_on_lines(displacements(poses), np.array([complex(offset)]), 1j).imag
    assert len(found) in (1, 2, 3)
    height = 50 * np.sinh(np.linspace(-6, 6, 401)) / np.sinh(6)
    values = np.array([determinant(poses, complex(offset, y)) for y in height])
    for low, high, before, after in zip(height, height[1:], values, values[1:], strict=False):
        if min(abs(before), abs(after)) > 1e-9:
            inside = (found > low) & (found < high)
            assert inside.sum() % 2 == (before * after < 0)


def luggage_motion() -> Displacements:
    poses = np.array([[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]])
    return Displacements.from_poses(poses[:, 0] + 1j * poses[:, 1], np.radians(poses[:, 2]))


@pytest.mark.parametrize("number", range(8))
@pytest.mark.parametrize("along", [complex(np.exp(0.7j))])
def test_published_luggage_dyads_are_found(golden: dict[str, Any], number: int, along: complex) -> None:
    sample = golden["motion4pose"]["family_samples"][number]
    moving, ground = (complex(*map(float, sample[name])) for name in ("A1", "O2"))
    motion = luggage_motion()
    found = circle_points_on_lines(motion, np.array([moving - 0.9 * along]), along)
    nearest = found[np.argmin(np.abs(found - moving))]
    assert abs(nearest - moving) < 1e-9 * abs(moving)
    assert abs(centre_points(motion, np.array([nearest]))[0] - ground) < 1e-8 * abs(ground)
    assert radius_error(motion, Dyads(np.array([moving]), np.array([ground])))[0] < 1e-10


@bounded
@given(exact_poses)
def test_seen_from_the_body_circle_and_centre_points_change_places(
    poses: list[tuple[float, float, float]],
) -> None:
    motion = displacements(poses)
    moving = circle_points_on_lines(motion, np.array([-1.0, 0.4, 2.0], dtype=np.complex128), 1j)
    ground = centre_points(motion, moving)
    usual = (np.abs(moving) < 30) & (np.abs(ground) < 30) & (np.abs(moving - ground) > 0.01)
    moving, ground = moving[usual], ground[usual]
    back = motion.inverse()
    np.testing.assert_allclose(back.apply(motion.apply(moving)[:, 2])[:, 2], moving, atol=1e-12)
    distance = np.abs(back.apply(ground) - moving[:, None])
    np.testing.assert_allclose(distance, np.abs(ground - moving)[:, None] * np.ones(4), rtol=1e-6)
    for point in ground:
        again = circle_points_on_lines(back, np.array([point.real + 0j]), 1j)
        assert np.abs(again - point).min() < 1e-5 * (1 + abs(point))


@settings(max_examples=8)
@given(st.integers(0, 10_000))
def test_polish_makes_dyads_exact_with_a_small_step(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scaled, exact = planted(seed)
    shift = 1e-4 * (rng.normal(size=(2, 2)) + 1j * rng.normal(size=(2, 2)))
    off = Dyads(exact.moving + shift[0], exact.ground + shift[1])
    polished = polish(scaled.motion, off)
    assert radius_error(scaled.motion, polished).max() < 1e-12 * (1 + np.abs(exact.ground).max())
    moved = np.hypot(np.abs(polished.moving - off.moving), np.abs(polished.ground - off.ground))
    back = np.hypot(np.abs(shift[0]), np.abs(shift[1]))
    assert (moved <= 1.01 * back).all()  # no farther than the exact dyad that it came from


def planted(seed: int) -> tuple[ScaledProblem, Dyads]:
    """A planted task, and both dyads of its linkage in the frame of the search."""
    task, linkage = planted_motion(np.random.default_rng(seed), poses=4)
    scaled = ScaledProblem.of(Problem(task=task))
    pivots = pivots_of(scaled, linkage)
    return scaled, Dyads(pivots[2:4], pivots[:2])


@pytest.mark.parametrize("seed", range(4))
def test_every_planted_dyad_has_traced_neighbours(seed: int) -> None:
    scaled, exact = planted(seed)
    cell = 0.02
    traced = trace_four_pose_curves(scaled.motion, reach=60.0, lines=800, cell=cell)
    for one in range(2):
        moving, ground = exact.moving[one], exact.ground[one]
        gap = np.hypot(np.abs(traced.moving - moving), np.abs(traced.ground - ground))
        # Cells grow with the distance from the origin beyond half a size.
        room = np.hypot(1 + 2 * abs(moving), 1 + 2 * abs(ground))
        assert gap.min() < 4 * cell * room


def test_traced_dyads_are_exact_and_within_reach() -> None:
    scaled, _ = planted(1)
    traced = trace_four_pose_curves(scaled.motion, reach=8.0, lines=300, cell=0.02)
    assert len(traced) > 300
    far = np.maximum(np.abs(traced.moving), np.abs(traced.ground))
    assert (np.minimum(np.abs(traced.moving), np.abs(traced.ground)) <= 8.0).all()
    usual = traced[far < 20]
    assert (radius_error(scaled.motion, usual) < 1e-8).all()


def test_finer_cells_and_another_phase_trace_the_same_curve() -> None:
    scaled, _ = planted(2)
    coarse = trace_four_pose_curves(scaled.motion, reach=4.0, lines=200, cell=0.08)
    fine = trace_four_pose_curves(scaled.motion, reach=4.2, lines=1500, cell=0.01, phase=0.23)
    assert len(fine) > 3 * len(coarse)
    both = coarse[(np.abs(coarse.moving) < 4) & (np.abs(coarse.ground) < 4)]
    assert len(both) > 20
    gap = np.abs(fine.moving - both.moving[:, None]) + np.abs(fine.ground - both.ground[:, None])
    assert gap.min(axis=1).max() < 0.2


def near_degenerate() -> dict[str, FloatArray]:
    return {
        "hardly turned": np.array([[5, 4, 0], [3.5, 4, -0.05], [2, 3, 0.08], [1, 0, 0.02]]),
        "pairs of translations": np.array([[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]),
        "three alike": np.array([[0, 0, 0], [1, 0.5, 0], [2, 0.2, 0], [3, 1, 40]]),
        "a half turn": np.array([[0, 0, 0], [1, 0.5, 180], [2, 0.2, 30], [3, 1, 210]]),
        "nearly one pole": np.array([[1, 0, 0], [0, 1, 90], [-1, 1e-3, 180], [0, -1, 270]]),
        "close together": np.array([[0, 0, 0], [1e-3, 0, 0.5], [1, 0.2, 30], [1.001, 0.2, 30.2]]),
    }


@pytest.mark.parametrize("kind", near_degenerate())
def test_near_degenerate_poses_have_true_dyads(kind: str) -> None:
    task = MotionTask.from_degrees(near_degenerate()[kind])
    motion = ScaledProblem.of(Problem(task=task)).motion
    traced = trace_four_pose_curves(motion, reach=20.0, lines=200, cell=0.03)
    usual = traced[(np.abs(traced.moving) < 15) & (np.abs(traced.ground) < 15)]
    usual = usual[np.abs(usual.moving - usual.ground) > 1e-3]
    assert len(usual) > 50
    polished = polish(motion, usual)
    assert radius_error(motion, polished).max() < 1e-10
    moved = np.hypot(np.abs(polished.moving - usual.moving), np.abs(polished.ground - usual.ground))
    assert np.median(moved) < 1e-8


@pytest.mark.parametrize("about", [0j, 3 - 2j])
def test_pole_of_a_rotation(about: complex) -> None:
    turn = np.array([0.2, 0.5, 1.7])
    motion = Displacements.from_poses(about + 2 * np.exp(1j * (turn + 1)), turn)
    assert motion.pole(1e-9) == pytest.approx(about, abs=1e-12)
    assert not motion.translates


def test_no_pole_of_translations_and_other_motions() -> None:
    places = np.array([0, 1, 2 + 1j])
    translated = Displacements.from_poses(places, np.full(3, 0.4))
    assert translated.translates
    assert translated.pole(1e-9) is None
    assert Displacements.from_poses(places, np.array([0.0, 0.3, 0.9])).pole(1e-9) is None
