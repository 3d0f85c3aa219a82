"""Newton-Raphson and the closed form agree on every kind of linkage."""

import numpy as np
from drawn_linkages import FOUR_BAR_CLASSES, of_each_class

from grashof.analysis import driver_ranges, newton_position, solve_position
from grashof.problems import FourBar
from grashof.problems.values.arrays import turned_from


@of_each_class(*FOUR_BAR_CLASSES)
def test_newton_raphson_agrees_with_the_closed_form(linkage: FourBar) -> None:
    low, high = driver_ranges(linkage)[0]
    theta2 = np.linspace(low, high, 41)[1:-1]
    exact = solve_position(linkage, theta2)
    sine = np.sin(exact.theta4 - exact.theta3)
    clear = np.abs(sine) > 1e-3
    found = newton_position(linkage, theta2)
    assert found.converged[clear].all()
    same = clear & (np.sign(np.sin(found.theta4 - found.theta3)) == np.sign(sine))
    assert same.sum() >= 0.9 * clear.sum()
    for angle, expected in ((found.theta3, exact.theta3), (found.theta4, exact.theta4)):
        assert np.abs(turned_from(angle, expected))[same].max() < 1e-9
    # From a guess nearby it always ends on the same assembly, in fewer steps.
    near = newton_position(linkage, theta2, (exact.theta3 + 1e-4, exact.theta4 - 1e-4))
    for angle, expected in ((near.theta3, exact.theta3), (near.theta4, exact.theta4)):
        assert np.abs(turned_from(angle, expected))[np.abs(sine) > 0.01].max(initial=0) < 1e-9
    assert near.steps[np.abs(sine) > 0.1].max(initial=0) <= 4


def test_open_positions_do_not_converge() -> None:
    triple_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    found = newton_position(triple_rocker, np.radians([0, 170]))
    np.testing.assert_array_equal(found.converged, [True, False])
    assert np.isnan([found.theta3[1], found.theta4[1]]).all()
    assert found.gap[1] > 0.1


def test_batches_and_assemblies() -> None:
    batch = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=[[120], [110]], r4=80, assembly=[[1], [-1]])
    theta2 = np.radians([30, 40, 50])
    found, exact = newton_position(batch, theta2), solve_position(batch, theta2)
    assert found.theta3.shape == (2, 3)
    np.testing.assert_allclose(found.theta3, exact.theta3, atol=1e-12)
    np.testing.assert_allclose(found.theta4, exact.theta4, atol=1e-12)
