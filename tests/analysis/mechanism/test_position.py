"""Positions: against published figures, by closing the loop, and against another way to find them."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, driver_ranges, solve_position
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar

CHECKED = settings(max_examples=25)
TURN = np.pi * 2
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]


def all_states(golden: dict[str, Any]) -> list[tuple[str, int, dict[str, Any]]]:
    pumpjack, bag = golden["pumpjack_report_geometry"]["states"], golden["bag_mechanism_exact"]
    lufkin = golden["pumpjack_lufkin_C912D_427_144"]["states(omega2=1 rad/s, inches)"]
    return [
        *(("pumpjack", 1, state) for state in pumpjack["sigma=+1"]),
        *(("pumpjack", -1, state) for state in pumpjack["sigma=-1"]),
        *(("lufkin", 1, state) for state in lufkin),
        *(("bag", 1, state) for state in [*bag["states_at_poses"], *bag["states"]]),
        *(("table7", 1, state) for state in golden["table7_lengths_theta1_0"]["states"]),
    ]


def test_every_state_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    states = all_states(golden)
    assert len(states) == 10 + 2 + 8 + 9
    for name, assembly, expected in states:
        found = solve_position(golden_linkages[name], np.radians(float(expected["theta2_deg"])), assembly)
        for key, value in (("A", found.a), ("B", found.b), ("P", found.p)):
            if key in expected:
                point = np.array(expected[key], dtype=np.float64)
                np.testing.assert_allclose(value, point, rtol=0, atol=1e-12 * np.abs(point).max())
        angles = [float(found.theta3), float(found.theta4)]
        expected_angles = np.array([expected["theta3"], expected["theta4"]], dtype=np.float64)
        atol = 1e-12 * np.abs(expected_angles).max()
        np.testing.assert_allclose(angles, expected_angles, rtol=0, atol=atol)


@pytest.mark.parametrize(
    ("assembly", "theta3", "theta4"),
    [(1, 20.297882788196475, 57.324880070360784), (-1, -60.97796679586442, -98.00496407802873)],
)
def test_example_4_1_of_norton(assembly: int, theta3: float, theta4: float) -> None:
    # Norton, Design of Machinery, example 4-1: the open circuit, then the crossed one.
    linkage = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80, assembly=assembly)
    state = solve_position(linkage, np.radians(40))
    assert np.degrees(state.theta3) == pytest.approx(theta3, rel=1e-12)
    assert np.degrees(state.theta4) == pytest.approx(theta4, rel=1e-12)


@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@CHECKED
def test_positions_close_the_loop_on_the_declared_assembly(
    four_bars: Drawer, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    theta2 = data.draw(st.floats(-2 * TURN, 2 * TURN)) + np.linspace(0, TURN, 97)
    for sign in (1, -1):
        state = solve_position(linkage, theta2, sign)
        closed = np.isfinite(state.b[:, 0])
        assert closed.any()
        a, b, p = (point[closed] @ np.array([1, 1j]) for point in (state.a, state.b, state.p))
        o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
        limit = 1e-12 * (linkage.lengths.max() + max(abs(o2), abs(o4)))
        coupler = np.exp(1j * state.theta3[closed])
        for gap in (
            a - o2 - linkage.r2 * np.exp(1j * theta2[closed]),
            b - a - linkage.r3 * coupler,
            b - o4 - linkage.r4 * np.exp(1j * state.theta4[closed]),
            p - a - complex(*linkage.coupler_point) * coupler,
        ):
            assert np.abs(gap).max() <= limit
        side = ((o4 - a).conj() * (b - a)).imag
        turned = np.sin(state.theta4[closed] - state.theta3[closed])
        clear = np.abs(turned) > 1e-6
        assert (np.sign(side[clear]) == sign).all()
        assert (np.sign(turned[clear]) == sign).all()
        assert np.abs([state.theta3[closed], state.theta4[closed]]).max() <= np.pi


@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@CHECKED
def test_positions_agree_with_the_law_of_cosines(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    theta2 = np.linspace(-np.pi, np.pi, 181) + data.draw(st.floats(0, 0.03))
    for sign in (1, -1):
        _, b, p = close_loop(linkage, theta2, sign)
        state = solve_position(linkage, theta2, sign)
        found_b, found_p = (point @ np.array([1, 1j]) for point in (state.b, state.p))
        # The arc cosine has half its digits at a dead position, and there alone the two may disagree.
        length = np.abs(complex(*linkage.o4) - state.a @ np.array([1, 1j]))
        room = np.minimum(linkage.r3 + linkage.r4 - length, length - np.abs(linkage.r3 - linkage.r4))
        clear = np.abs(room) > 1e-4 * linkage.r3
        np.testing.assert_array_equal(np.isnan(found_b[clear]), np.isnan(b[clear]))
        np.testing.assert_array_equal(np.isnan(found_b[clear]), room[clear] < 0)
        for found, expected in ((found_b, b), (found_p, p)):
            np.testing.assert_allclose(found[clear], expected[clear], atol=1e-9 * linkage.lengths.max())


@pytest.mark.parametrize(
    "kind", [GrashofClass.DOUBLE_ROCKER, GrashofClass.ROCKER_CRANK, GrashofClass.NON_GRASHOF]
)
@given(data=st.data())
@CHECKED
def test_dead_positions_close_in_spite_of_rounding(
    four_bars: Drawer, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    ends = driver_ranges(linkage)
    ends = ends[np.isfinite(ends)]
    state = solve_position(linkage, ends)
    assert np.isfinite(state.b).all()
    assert np.abs(np.sin(state.theta4 - state.theta3)).max() < 1e-6
    outside = solve_position(linkage, ends + np.resize([-1e-6, 1e-6], len(ends)))
    assert np.isnan(outside.b).all()
    assert np.isfinite(outside.a).all()


def test_own_assembly_is_the_default() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, assembly=-1)
    np.testing.assert_array_equal(solve_position(linkage, 0.7).b, solve_position(linkage, 0.7, -1).b)
    assert solve_position(linkage, 0.7).b[1] < 0


def test_batches_give_what_single_linkages_give() -> None:
    rng = np.random.default_rng(4)
    batch = FourBar(
        o2=rng.normal(size=(5, 2)),
        o4=4 + rng.normal(size=(5, 2)),
        r2=rng.uniform(1, 2, 5),
        r3=rng.uniform(3, 5, 5),
        r4=rng.uniform(3, 5, 5),
        coupler_point=rng.normal(size=(5, 2)),
        assembly=[1, -1, 1, 1, -1],
    )
    theta2 = np.linspace(0, 6, 7)
    together = solve_position(batch[:, None], theta2)
    assert together.b.shape == (5, 7, 2)
    assert together.theta2.shape == together.theta3.shape == (5, 7)
    for index in range(5):
        alone = solve_position(batch[index], theta2)
        for name in ("theta2", "theta3", "theta4", "a", "b", "p"):
            np.testing.assert_array_equal(getattr(together, name)[index], getattr(alone, name))


@pytest.mark.parametrize("away", [0.0, 1e-310, 1e-200, 1e-17])
def test_driver_pivot_on_the_output_pivot_is_open_without_a_warning(away: float) -> None:
    linkage = FourBar(o2=(0, 0), o4=(2, away), r2=2, r3=1, r4=1.5)
    assert np.isnan(solve_position(linkage, 0.0).b).all()
