"""The driver's motion through its angles at the targets: in order up to rounding, no further."""

import numpy as np
import pytest

from grashof.analysis.judge.task_motion import task_motion
from grashof.problems import FourBar

ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=2, r4=2.5)
CRANK = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)


@pytest.mark.parametrize("linkage", [ROCKER, CRANK])
@pytest.mark.parametrize(("back", "in_order"), [(1e-12, True), (1e-6, False), (0.01, False)])
def test_a_step_back_is_out_of_order_unless_it_is_rounding(
    linkage: FourBar, back: float, in_order: bool
) -> None:
    steps = np.array([0.2, 0.4, 0.4 - back, 0.6])
    for theta2 in (steps, -steps):
        found = task_motion(linkage, theta2, True)
        assert found.in_order is in_order
        if in_order:
            assert found.direction == np.sign(theta2[0])
            assert (found.start, found.end) == pytest.approx((theta2[0], theta2[-1]))


def test_without_order_it_is_the_shortest_way_through_all() -> None:
    found = task_motion(CRANK, np.radians([350.0, 20.0, 5.0]), False)
    assert np.degrees([found.start, found.end]) == pytest.approx([350, 380])
    assert np.degrees(found.theta2) == pytest.approx([350, 380, 365])


def test_a_driver_in_one_range_has_no_way_around() -> None:
    there = task_motion(ROCKER, np.array([-0.3, 0.1, 0.5]), True)
    assert (there.start, there.end, there.direction) == pytest.approx((-0.3, 0.5, 1))
    assert there.closed().end == pytest.approx(-0.3 + 2 * np.pi)
