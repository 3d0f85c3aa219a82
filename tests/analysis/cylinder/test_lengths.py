"""Lengths, rates and levers against the triangle, differences, and dense samples."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis import driver_ranges, full_rotation, solve_position
from grashof.analysis.cylinder.lengths import cylinder_figures, cylinder_state
from grashof.analysis.cylinder.travel import Travel, travel
from grashof.problems import Cylinder, FourBar

LINKAGE = FourBar(o2=(0.3, -0.2), o4=(4, 0.5), r2=2, r3=2.5, r4=3, coupler_point=(1, 1))
LINKS = ("driver", "coupler", "output")


def test_on_link_2_it_is_a_triangle_with_a_variable_side() -> None:
    theta2 = np.linspace(0.3, 1.4, 23)
    jack = Cylinder("driver", base=(-1.2, -1.5), point=(1.1, 0.4))
    found = cylinder_state(jack, LINKAGE, solve_position(LINKAGE, theta2))
    arm, far = np.hypot(1.1, 0.4), np.hypot(1.5, 1.3)
    at_o2 = theta2 + np.arctan2(0.4, 1.1) - np.arctan2(-1.3, -1.5)
    np.testing.assert_allclose(found.length**2, arm**2 + far**2 - 2 * arm * far * np.cos(at_o2), rtol=1e-13)
    sine = far * np.abs(np.sin(at_o2)) / found.length  # of the angle at Q
    np.testing.assert_allclose(np.sin(found.angle), sine, rtol=1e-12)
    np.testing.assert_allclose(np.abs(found.rate), arm * sine, rtol=1e-12)


@st.composite
def travels(draw: st.DrawFn) -> Travel:
    numbers = st.floats(0.4, 3.0)
    r1, r2, r3, r4 = (draw(numbers) for _ in range(4))
    linkage = FourBar((0, 0), (r1, 0), r2, r3, r4, (0.5, 0.4), draw(st.sampled_from([1, -1])))
    low, high = driver_ranges(linkage)[0]
    if np.isnan(low):
        linkage = FourBar((0, 0), (1, 0), 2, 2, 2)
        low, high = driver_ranges(linkage)[0]
    start, end = sorted(low + (high - low) * draw(st.floats(0.05, 0.95)) for _ in range(2))
    theta2 = np.array([start, end + 1e-3])[:: draw(st.sampled_from([1, -1]))]
    found = travel(linkage, theta2, np.array([int(linkage.assembly)] * 2))
    assert found is not None
    return found


places = st.tuples(st.floats(-3, 3), st.floats(-3, 3))


@given(travels(), st.sampled_from(LINKS), places, places)
def test_extremes_are_those_of_dense_samples(
    moved: Travel, on: str, base: tuple[float, float], point: tuple[float, float]
) -> None:
    jack = Cylinder(on, base, point)
    found = cylinder_figures(jack, moved)
    dense = cylinder_state(jack, moved.linkage, moved.at(np.linspace(moved.start, moved.end, 4001)))
    assert found.closed <= dense.length.min() + 1e-9
    assert found.open >= dense.length.max() - 1e-9
    assert found.closed >= dense.length.min() - 1e-2
    one_way = bool((dense.lever > 0).all() or (dense.lever < 0).all())
    if found.monotone:
        assert one_way
        assert found.angle_min <= dense.angle.min() + 1e-9
        ends = dense.length[[0, -1]]
        assert (found.closed, found.open) == pytest.approx((ends.min(), ends.max()), rel=1e-9)
    else:
        assert found.angle_min == 0


def test_a_cylinder_that_reverses_does_not_drive() -> None:
    assert full_rotation(FourBar((0, 0), (4, 0), 1, 4, 3))
    crank = FourBar((0, 0), (4, 0), 1, 4, 3)
    moved = travel(crank, np.array([-0.6, 0.9]), np.array([1, 1]))
    assert moved is not None
    found = cylinder_figures(Cylinder("driver", (3, 0), (1, 0)), moved)  # in line with its arm at 0
    assert (found.monotone, found.angle_min) == (False, 0.0)
    assert found.closed == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("on", ["coupler", "output"])
def test_a_dead_position_of_link_2_is_none_for_a_cylinder_on_links_3_and_4(on: str) -> None:
    high = float(driver_ranges(LINKAGE)[0, 1])
    moved = travel(LINKAGE, np.array([high - 0.2, high - 0.2]), np.array([1, -1]))
    assert moved is not None
    assert len(moved.dead) == 1
    found = cylinder_figures(Cylinder(on, (7, -4), (1.5, 0.2)), moved)
    assert found.monotone
    assert found.angle_min > 0.1
    on_link_2 = cylinder_figures(Cylinder("driver", (7, -4), (1.5, 0.2)), moved)
    assert not on_link_2.monotone  # link 2 turns back there, and its cylinder with it


def test_a_pivot_that_stands_is_not_driven() -> None:
    moved = travel(LINKAGE, np.array([0.4, 1.0]), np.array([1, 1]))
    assert moved is not None
    assert not cylinder_figures(Cylinder("driver", (3, 1), (0, 0)), moved).monotone
