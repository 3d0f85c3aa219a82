"""Positions and their rates: published figures, the law of cosines, open and dead positions."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from drawn_linkages import FOUR_BAR_CLASSES, SWINGING, close_loop, of_each_class
from hypothesis import strategies as st

from grashof.analysis import driver_ranges, solve_kinematics, solve_position
from grashof.problems import AssemblyError, DeadPositionWarning, FourBar, ProblemError


def assert_near(found: npt.ArrayLike, expected: npt.ArrayLike, share: float = 1e-12) -> None:
    """Within a share of the largest component of the vector."""
    expected = np.asarray(expected, dtype=np.float64)
    np.testing.assert_allclose(found, expected, rtol=0, atol=share * np.abs(expected).max())


def test_every_state_of_the_reference_figures(
    golden_states: list[Any], golden_linkages: dict[str, FourBar]
) -> None:
    for name, assembly, speed, expected in golden_states:
        linkage = golden_linkages[name]
        found = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])), speed, assembly=assembly)
        place = solve_position(linkage, np.radians(float(expected["theta2_deg"])), assembly)
        assert_near([place.theta3, place.theta4], [expected["theta3"], expected["theta4"]])
        for key, value in (("A", place.a), ("B", place.b), ("P", place.p)):
            if key in expected:
                assert_near(value, expected[key])
        for rate in ("theta", "omega", "alpha"):
            pair = [getattr(found, f"{rate}{link}") for link in (3, 4)]
            assert_near(pair, [expected[f"{rate}3"], expected[f"{rate}4"]])
        points = {"A": found.a, "B": found.b, "P": found.p} | {
            f"G{link}": found.point(link, (float(getattr(linkage, f"r{link}")) / 2, 0)) for link in (2, 3, 4)
        }
        for point, motion in points.items():
            kinds = {"": motion.position, "v": motion.velocity, "a": motion.acceleration}
            for prefix, value in kinds.items():
                if prefix + point in expected:
                    assert_near(value, expected[prefix + point])
            if f"v{point}_mag" in expected:
                assert_near(motion.speed, expected[f"v{point}_mag"])
                assert_near(motion.acceleration_magnitude, expected[f"a{point}_mag"])
        factor = "torque_factor_A*omega4/omega2_in"
        if factor in expected:  # of the horsehead, 180 in from O4
            assert_near(180 * found.omega4 / found.omega2, expected[factor])


@of_each_class(*FOUR_BAR_CLASSES, first=st.floats(0, 0.03))
def test_positions_agree_with_the_law_of_cosines(linkage: FourBar, first: float) -> None:
    theta2 = np.linspace(-np.pi, np.pi, 181) + first
    for sign in (1, -1):
        _, b, p = close_loop(linkage, theta2, sign)
        state = solve_position(linkage, theta2, sign)
        found_b, found_p = (point @ np.array([1, 1j]) for point in (state.b, state.p))
        # The arc cosine loses half its digits at a dead position, the only place where the two may differ.
        length = np.abs(complex(*linkage.o4) - state.a @ np.array([1, 1j]))
        room = np.minimum(linkage.r3 + linkage.r4 - length, length - np.abs(linkage.r3 - linkage.r4))
        clear = np.abs(room) > 1e-4 * linkage.r3
        np.testing.assert_array_equal(np.isnan(found_b[clear]), np.isnan(b[clear]))
        np.testing.assert_array_equal(np.isnan(found_b[clear]), room[clear] < 0)
        for found, expected in ((found_b, b), (found_p, p)):
            np.testing.assert_allclose(found[clear], expected[clear], atol=1e-9 * linkage.lengths.max())
        angles = np.array([state.theta3, state.theta4])[:, np.isfinite(state.theta3)]
        assert np.abs(angles).max() <= np.pi
        turned = np.sin(angles[1] - angles[0])
        assert (np.sign(turned[np.abs(turned) > 1e-6]) == sign).all()


@of_each_class(*SWINGING, examples=8)
def test_dead_positions_close_in_spite_of_rounding(linkage: FourBar) -> None:
    ends = driver_ranges(linkage)
    ends = ends[np.isfinite(ends)]
    state = solve_position(linkage, ends)
    assert np.isfinite(state.b).all()
    assert np.abs(np.sin(state.theta4 - state.theta3)).max() < 1e-6
    outside = solve_position(linkage, ends + np.resize([-1e-6, 1e-6], len(ends)))
    assert np.isnan(outside.b).all()
    assert np.isfinite(outside.a).all()


@pytest.mark.parametrize("away", [0.0, 1e-310, 1e-200, 1e-17])
def test_driver_pivot_on_the_output_pivot_is_open_without_a_warning(away: float) -> None:
    linkage = FourBar(o2=(0, 0), o4=(2, away), r2=2, r3=1, r4=1.5)
    assert np.isnan(solve_position(linkage, 0.0).b).all()


TRIPLE_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3, coupler_point=(0, 0))


def test_open_positions_are_nan_and_a_single_one_is_an_error() -> None:
    state = solve_kinematics(TRIPLE_ROCKER, np.radians([0, 170]))
    assert np.isfinite(state.alpha4[0])
    assert np.isnan([state.theta3[1], state.omega4[1], state.alpha3[1], state.jerk4[1]]).all()
    assert np.isnan(state.b.velocity[1]).all()
    with pytest.raises(AssemblyError, match=r"170 deg; it closes from -108\.21 to 108\.21 deg"):
        solve_kinematics(TRIPLE_ROCKER, np.radians(170))
    nowhere = FourBar(o2=(0, 0), o4=(9, 0), r2=1, r3=1, r4=1)
    with pytest.raises(AssemblyError, match="or at any other"):
        solve_kinematics(nowhere, 0.0)


def test_points_in_a_dead_position_move_as_their_links_allow() -> None:
    """Infinitely fast, but for those of the driver; the warning names the place."""
    linkage = FourBar(o2=(0, 0), o4=(5, 0), r2=4, r3=1, r4=3.5)
    end = driver_ranges(linkage)[0, 1]
    with pytest.warns(DeadPositionWarning, match=f"driver angle {np.degrees(end):.6g} deg"):
        dead = solve_kinematics(linkage, end, -2.0)
    near = solve_kinematics(linkage, end - 1e-9, -2.0)
    assert dead.b.speed == np.inf
    np.testing.assert_allclose(dead.a.velocity, near.a.velocity, atol=1e-8)
    np.testing.assert_allclose(dead.point(3, (0, 0)).jerk, dead.a.jerk)


def test_a_driver_at_rest_in_a_dead_position_has_undetermined_rates() -> None:
    end = driver_ranges(TRIPLE_ROCKER)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(TRIPLE_ROCKER, end, 0.0)
    assert np.isnan([state.omega3, state.omega4]).all()


def test_many_dead_positions_are_named_by_the_first_three() -> None:
    ends = np.resize(driver_ranges(TRIPLE_ROCKER)[0], 8)
    with pytest.warns(DeadPositionWarning, match=r"-108\.21, 108\.21, -108\.21, \.\.\. deg"):
        solve_kinematics(TRIPLE_ROCKER, ends)


def test_arguments_of_a_point_are_checked() -> None:
    state = solve_kinematics(TRIPLE_ROCKER, 0.3)
    with pytest.raises(
        ProblemError, match=r"link is 5; it must be 2 \(driver\), 3 \(coupler\) or 4 \(output\)"
    ):
        state.point(5, (0, 0))
    with pytest.raises(ProblemError, match=r"at has shape \(3,\)"):
        state.point(2, (0, 0, 1))
