"""Instant centres against what they are for: velocities."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, driver_ranges, instant_centres, solve_kinematics
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar

CHECKED = settings(max_examples=25)
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]


@pytest.mark.parametrize("kind", [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT])
@given(data=st.data())
@CHECKED
def test_velocities_follow_from_the_centres(
    four_bars: Drawer, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    low, high = driver_ranges(linkage)[0]
    theta2 = np.linspace(low, high, 31)[2:-2]
    centres, state = instant_centres(linkage, theta2), solve_kinematics(linkage, theta2)
    # The coupler turns about I13: v_P is at right angles to I13-P and omega3 times as long.
    arm = state.p.position - centres.i13
    near = np.abs(arm).max(axis=-1) < 1e4 * linkage.r1
    turned = state.omega3[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
    velocity = state.p.velocity[near]
    np.testing.assert_allclose(turned[near], velocity, atol=1e-8 * np.abs(velocity).max(initial=1))
    # Driver and output have the same velocity at I24.
    from_o2, from_o4 = centres.i24 - centres.i12, centres.i24 - centres.i14
    near = np.abs(from_o2).max(axis=-1) < 1e4 * linkage.r1
    np.testing.assert_allclose(
        (state.omega4[:, None] * from_o4)[near], from_o2[near], rtol=1e-7, atol=1e-8 * linkage.r1
    )


def test_parallel_lines_meet_nowhere() -> None:
    parallelogram = FourBar(o2=(0, 0), o4=(3, 0), r2=1, r3=3, r4=1, assembly=1)
    centres = instant_centres(parallelogram, np.pi / 2)
    np.testing.assert_allclose(centres.i34, [3, 1], atol=1e-12)
    assert not np.isfinite(centres.i13).all() or np.abs(centres.i13).max() > 1e12
    assert instant_centres(parallelogram, np.zeros((4, 1))).i24.shape == (4, 1, 2)
