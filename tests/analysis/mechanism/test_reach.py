"""The box that a motion needs, against a dense sweep."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, driver_ranges, reach_box, solve_position
from grashof.analysis.mechanism.extremes import diagonal
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar

CHECKED = settings(max_examples=20)
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]


def swept_box(close_loop: Brute, linkage: FourBar, start: float, end: float) -> npt.NDArray[np.float64]:
    # Dense towards the ends, where a linkage runs away from its driver near a dead position.
    share = (1 - np.cos(np.linspace(0, np.pi, 20001))) / 2
    points = np.concatenate(
        [
            *close_loop(linkage, start + (end - start) * share, float(linkage.assembly)),
            [complex(*linkage.o2), complex(*linkage.o4)],
        ]
    )
    points = points[np.isfinite(points)]
    corners = np.stack([points.real, points.imag], axis=1)
    return np.array([corners.min(axis=0), corners.max(axis=0)])


@pytest.mark.quick("double-crank", "double-rocker", "non-Grashof")
@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@CHECKED
def test_box_agrees_with_a_dense_sweep(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    low, high = driver_ranges(linkage)[0]
    first, second = (data.draw(st.floats(0, 1)) for _ in range(2))
    start, end = low + (high - low) * np.array([first, second])
    expected = swept_box(close_loop, linkage, start, end)
    # At a change point the curves have a corner, which no parabola fits.
    atol = (1e-3 if kind is GrashofClass.CHANGE_POINT else 2e-5) * diagonal(expected)
    np.testing.assert_allclose(reach_box(linkage, start, end), expected, rtol=0, atol=atol)
    np.testing.assert_allclose(reach_box(linkage, end, start), expected, rtol=0, atol=atol)


@pytest.mark.quick("double-crank", "double-rocker", "non-Grashof")
@pytest.mark.parametrize("kind", [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT])
@given(data=st.data())
@CHECKED
def test_box_of_the_whole_motion_of_the_driver(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    low, high = driver_ranges(linkage)[0]
    expected = swept_box(close_loop, linkage, low, high)
    np.testing.assert_allclose(
        reach_box(linkage, low, high), expected, rtol=0, atol=2e-5 * diagonal(expected)
    )


def test_box_of_a_single_position_holds_every_point_of_the_linkage() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(0, 5))
    # A at (1, 0), B where the circles of 4 about A and 3 about O4 meet: (11, sqrt(80)) / 3.
    box = reach_box(linkage, 0.0, 0.0)
    coupler = np.array([8, np.sqrt(80)]) / 12
    p = np.array([1, 0]) + 5 * np.array([-coupler[1], coupler[0]])
    np.testing.assert_allclose(box, [[p[0], 0], [4, p[1]]], atol=1e-12)
    assert diagonal(box) == pytest.approx(np.hypot(4 - p[0], p[1]), rel=1e-12)


def test_box_of_a_linkage_that_cannot_close_is_that_of_its_pivots() -> None:
    apart = FourBar(o2=(1, 2), o4=(10, -1), r2=1, r3=2, r4=2)
    assert reach_box(apart, 0.0, 1.0).tolist() == [[1.0, -1.0], [10.0, 2.0]]


@pytest.mark.parametrize("kite", [(30.0, 30.0, 30.0), (30.0, 35.0, 35.0)])
def test_box_of_a_kite_reaches_to_where_its_links_are_free(kite: tuple[float, float, float]) -> None:
    """A meets O4 in the middle of the motion, where B is anywhere: on the way there it was in front of O4."""
    linkage = FourBar(o2=(0, 0), o4=(30, 0), r2=kite[0], r3=kite[1], r4=kite[2], assembly=-1)
    box = reach_box(linkage, -3.0, 3.0)
    angles = np.concatenate([-np.geomspace(3.0, 1e-6, 4001), np.geomspace(1e-6, 3.0, 4001)])
    state = solve_position(linkage, angles)
    b = np.concatenate([state.a, state.b, state.p, [[0, 0], [30, 0]]])
    np.testing.assert_allclose(box, [b.min(axis=0), b.max(axis=0)], atol=2e-3)
    assert box[1, 0] == pytest.approx(30 + kite[2], abs=1e-3)
