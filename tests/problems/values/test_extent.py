"""The span of many points: the greatest distance of all pairs, without the pairs."""

import numpy as np
import pytest

from grashof.problems import MotionTask
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.extent import FEW, convex_corners, span

MANY = 5 * FEW
ANGLE = np.linspace(0, 2 * np.pi, MANY, endpoint=False)
LINE = np.linspace(-1, 2, MANY)


def of_all_pairs(points: FloatArray) -> float:
    separation = points[:, None] - points
    return float(np.hypot(separation[..., 0], separation[..., 1]).max())


def drawn(seed: int, count: int = MANY) -> FloatArray:
    return np.random.default_rng(seed).normal(size=(count, 2))


@pytest.mark.parametrize(
    "points",
    [
        np.column_stack([np.cos(ANGLE), np.sin(ANGLE)]),
        np.column_stack([np.cos(ANGLE[1:]), 1e-7 * np.sin(ANGLE[1:])]),
        np.column_stack([np.cos(ANGLE), np.sin(ANGLE)]) * (1 + 0.1 * np.cos(3 * ANGLE))[:, None],
        np.column_stack([LINE, LINE / 3]),
        np.column_stack([np.zeros(MANY), LINE]),
        np.ones((MANY, 2)),
        np.repeat(drawn(0, 3), FEW, axis=0),
        1e-160 * drawn(1),
        1e20 * drawn(2),
        1e12 + drawn(3),
        np.round(drawn(4)),
    ],
)
def test_span_is_the_greatest_distance_of_all_pairs(points: FloatArray) -> None:
    assert span(points) == pytest.approx(of_all_pairs(points), rel=2e-15, abs=0)


@pytest.mark.parametrize("flat", [1.0, 1e-3, 1e-9, 0.0])
def test_span_of_points_drawn_on_and_about_ovals(flat: float) -> None:
    rng = np.random.default_rng(8)
    angle, radius = rng.uniform(0, 7, MANY), rng.choice([1.0, rng.uniform()], MANY)
    points = radius[:, None] * np.column_stack([np.cos(angle), flat * np.sin(angle)])
    turn = rng.uniform(0, 7)
    points = points @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    assert span(points) == pytest.approx(of_all_pairs(points), rel=2e-15)


def test_corners_are_a_convex_polygon_that_holds_all_points() -> None:
    points = drawn(5)
    corners = convex_corners(points)
    edges = np.roll(corners, -1, axis=0) - corners
    offset = points[:, None] - corners
    assert (edges[:, 0] * offset[..., 1] - edges[:, 1] * offset[..., 0] > -1e-12).all()


@pytest.mark.slow
def test_span_of_very_many_points() -> None:
    points = np.random.default_rng(0).uniform(-0.7, 0.7, (200_000, 2))
    points[[77, 777]] = [[-3, -4], [3, 4]]
    assert span(points) == 10


def test_poses_without_positions_count_for_nothing() -> None:
    positions = drawn(6)
    positions[::2] = np.nan
    task = MotionTask(positions, np.linspace(0, 1, MANY))
    assert task.size == pytest.approx(of_all_pairs(positions[1::2]), rel=1e-15)
