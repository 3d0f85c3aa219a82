"""Best line and circle: exact ones recovered, optimality by perturbation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis import solve_position
from grashof.analysis.curves.line_and_circle import along_path, best_circle, best_line, circularity
from grashof.problems import FourBar, ProblemError

ANGLES = st.floats(-np.pi, np.pi)


def direction(angle: float) -> np.ndarray:
    return np.array([np.cos(angle), np.sin(angle)])


@given(angle=ANGLES, length=st.floats(0.1, 10), count=st.integers(2, 30))
def test_a_line_is_recovered(angle: float, length: float, count: int) -> None:
    along = np.linspace(-0.3, 0.7, count) * length
    line = best_line([3, -5] + along[:, None] * direction(angle))
    np.testing.assert_allclose(direction(line.angle), direction(angle), atol=1e-12)
    assert line.length == pytest.approx(length)
    assert max(line.deviation_max, line.deviation_rms, line.width) < 1e-13


def test_no_other_line_is_nearer() -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(30, 2)) * [3, 0.5] @ np.array([[0.8, 0.6], [-0.6, 0.8]])
    line = best_line(points)

    def rms(turn: float, shift: float) -> float:
        normal = direction(line.angle + turn + np.pi / 2)
        return float(np.sqrt((((points - line.point) @ normal - shift) ** 2).mean()))

    assert rms(0, 0) == pytest.approx(line.deviation_rms)
    for turn, shift in ((1e-4, 0), (-1e-4, 0), (0, 1e-4), (0, -1e-4), (1, 0), (0.5, 0.5)):
        assert rms(turn, shift) > line.deviation_rms
    off = (points - line.point) @ direction(line.angle + np.pi / 2)
    assert (line.deviation_max, line.width) == (pytest.approx(abs(off).max()), pytest.approx(np.ptp(off)))
    assert line.error_share == pytest.approx(abs(off).max() / line.length)


@given(start=ANGLES, arc=st.floats(0.02, 6), radius=st.floats(0.01, 100), sense=st.sampled_from([-1, 1]))
def test_a_circle_is_recovered_from_any_arc(start: float, arc: float, radius: float, sense: int) -> None:
    angle = start + sense * np.linspace(0, arc, 25)
    points = np.array([2.0, -1]) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    circle = best_circle(points)
    # The height of the arc is about radius arc^2 / 8: rounding of the points counts by that much more.
    within = 1e-13 * (1 + 3 / radius) * (1 + 100 / arc**2)
    assert circle.radius == pytest.approx(radius, rel=within)
    np.testing.assert_allclose(circle.centre, [2, -1], atol=radius * within)
    assert circle.deviation_max < 1e-14 * (3 + radius) * 10


@pytest.mark.parametrize("seed", range(2))
def test_no_other_circle_is_nearer(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, rng.uniform(0.5, 6), 40)
    points = 3 * np.stack([np.cos(angle), np.sin(angle)], axis=-1) + rng.normal(0, 0.05, (40, 2))
    circle = best_circle(points)

    def rms(dx: float, dy: float, dr: float) -> float:
        distance = np.hypot(*(points - circle.centre - [dx, dy]).T)
        return float(np.sqrt(((distance - circle.radius - dr) ** 2).mean()))

    assert rms(0, 0, 0) == pytest.approx(circle.deviation_rms)
    assert circle.error_share == pytest.approx(circle.deviation_max / circle.radius)
    h = 1e-4
    slope = [(rms(*(h * axis)) - rms(*(-h * axis))) / (2 * h) for axis in np.eye(3)]
    np.testing.assert_allclose(slope, 0, atol=1e-6)
    for axis in np.eye(3):
        assert min(rms(*(0.1 * axis)), rms(*(-0.1 * axis))) > circle.deviation_rms


def test_the_arcs_of_the_pivots() -> None:
    at_b = FourBar((1, 1), (5, 1), 1, 4, 3, coupler_point=(4, 0))
    circle = circularity(at_b, 0.5, 2.5)
    np.testing.assert_allclose([*circle.centre, circle.radius], [5, 1, 3], atol=1e-11)
    at_a = circularity(FourBar((1, 1), (5, 1), 1, 4, 3), 0.5, -2.5)
    np.testing.assert_allclose([*at_a.centre, at_a.radius], [1, 1, 1], atol=1e-12)


def test_points_along_a_path_are_equally_far_apart() -> None:
    linkage = FourBar((0, 0), (4, 0), 1, 4, 3, coupler_point=(2, 3))
    points = along_path(linkage, 0.2, 5.0, 200)
    step = np.hypot(*np.diff(points, axis=0).T)
    assert step.max() / step.min() < 1.02
    np.testing.assert_allclose(points[[0, -1]], solve_position(linkage, [0.2, 5.0]).p, atol=1e-14)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ProblemError, match="all one"):
        best_line([[1, 1], [1, 1]])
    for points in ([[0, 0], [1, 1]], [[0, 0], [1, 1], [2, 2]], [[0.1, 0.3], [1.1, 0.6], [2.1, 0.9]]):
        with pytest.raises(ProblemError, match="one line"):
            best_circle(points)
    with pytest.raises(ProblemError, match="cannot be assembled"):
        circularity(FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1)), 0, np.pi)
