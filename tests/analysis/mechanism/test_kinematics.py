"""Kinematics: published figures, and a second implementation by root-finding and finite differences."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import root

from grashof.analysis import GrashofClass, driver_ranges, full_rotation, solve_kinematics, solve_position
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import AssemblyError, DeadPositionWarning, FourBar, ProblemError

CHECKED = settings(max_examples=25)
TURN = 2 * np.pi
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
Curves = Callable[[float], npt.NDArray[np.float64]]
TURNING = [GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK]


def all_states(golden: dict[str, Any]) -> list[tuple[str, int, float, dict[str, Any]]]:
    pumpjack, bag = golden["pumpjack_report_geometry"]["states"], golden["bag_mechanism_exact"]
    lufkin = golden["pumpjack_lufkin_C912D_427_144"]["states(omega2=1 rad/s, inches)"]
    return [
        *(("pumpjack", 1, TURN / 3, state) for state in pumpjack["sigma=+1"]),
        *(("pumpjack", -1, TURN / 3, state) for state in pumpjack["sigma=-1"]),
        *(("lufkin", 1, 1.0, state) for state in lufkin),
        *(("bag", 1, 1.0, state) for state in [*bag["states_at_poses"], *bag["states"]]),
        *(("table7", 1, 1.0, state) for state in golden["table7_lengths_theta1_0"]["states"]),
    ]


def assert_near(found: npt.ArrayLike, expected: npt.ArrayLike, share: float = 1e-12) -> None:
    """Within a share of the largest component of the vector."""
    expected = np.asarray(expected, dtype=np.float64)
    np.testing.assert_allclose(found, expected, rtol=0, atol=share * np.abs(expected).max())


def test_every_state_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    states = all_states(golden)
    assert len(states) == 10 + 2 + 8 + 9
    for name, assembly, speed, expected in states:
        linkage = golden_linkages[name]
        found = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])), speed, assembly=assembly)
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


def test_driver_pin_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    given_values = golden["pumpjack_report_geometry"]["extremes_sigma+1"]
    where = golden["pumpjack_report_geometry"]
    a = solve_kinematics(golden_linkages["pumpjack"], np.linspace(0, TURN, 9), TURN / 3).a
    for name, values in (("vA_mag", a.speed), ("aA_mag", a.acceleration_magnitude)):
        np.testing.assert_allclose(values, float({**where, **given_values}[name]), rtol=1e-12)
    b = solve_kinematics(golden_linkages["pumpjack"], np.pi / 2).b
    assert_near(b.position, where["mass_com"]["B@90deg"])


@pytest.mark.parametrize(
    ("assembly", "rates"),
    [
        (1, (-4.1209144153476975, 6.997985242176776, 296.0891931743102, 470.13353026102243)),
        (-1, (-9.25877229953975, -20.37767195706422, 597.6224000762809, 423.57806298956854)),
    ],
)
def test_examples_6_7_and_7_1_of_norton(assembly: int, rates: tuple[float, ...]) -> None:
    linkage = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80, assembly=assembly)
    state = solve_kinematics(linkage, np.radians(40), 25, 15)
    found = (state.omega3, state.omega4, state.alpha3, state.alpha4)
    np.testing.assert_allclose(found, rates, rtol=1e-12)


@pytest.fixture(scope="module")
def differences() -> Callable[[Curves, float, float], list[npt.NDArray[np.float64]]]:
    """Value and first three derivatives of curves, from a polynomial through points nearby."""

    def derive(curves: Curves, at: float, step: float) -> list[npt.NDArray[np.float64]]:
        nodes = np.cos(np.pi * (np.arange(15) + 0.5) / 15)
        values = np.array([curves(at + step * node) for node in nodes])
        fitted = np.polynomial.chebyshev.chebfit(nodes, values, 14)
        derived = (np.polynomial.chebyshev.chebder(fitted, order) for order in range(4))
        return [np.polynomial.chebyshev.chebval(0.0, d) / step**order for order, d in enumerate(derived)]

    return derive


@pytest.mark.quick("double-crank", "double-rocker", "non-Grashof")
@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@CHECKED
def test_root_finding_and_differences_agree(
    four_bars: Drawer, differences: Callable[..., Any], kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    low, high = driver_ranges(linkage)[0]
    theta2 = data.draw(st.floats(0.15, 0.85)) * (high - low) + low
    start = solve_position(linkage, theta2)
    if abs(np.sin(start.theta4 - start.theta3)) < 0.2:
        return
    speed, jerk = data.draw(st.floats(0.5, 2)), data.draw(st.floats(-1, 1))
    acceleration = data.draw(st.floats(-1, 1))
    ground = linkage.o4 - linkage.o2

    def positions(time: float) -> npt.NDArray[np.float64]:
        """Angles and points at a time, the loop closed by a root-finder from the position at time 0."""
        driver = theta2 + speed * time + acceleration * time**2 / 2 + jerk * time**3 / 6
        crank = linkage.r2 * np.array([np.cos(driver), np.sin(driver)]) - ground

        def gap(angles: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
            coupler, output = angles
            return (
                crank
                + linkage.r3 * np.array([np.cos(coupler), np.sin(coupler)])
                - linkage.r4 * np.array([np.cos(output), np.sin(output)])
            )

        found = root(gap, [start.theta3, start.theta4], tol=1e-14).x
        turn = np.exp(1j * found[0])
        p = (crank + linkage.o4) @ [1, 1j] + complex(*linkage.coupler_point) * turn
        b = linkage.o4 @ [1, 1j] + linkage.r4 * np.exp(1j * found[1])
        return np.array([*found, b.real, b.imag, p.real, p.imag])

    state = solve_kinematics(linkage, theta2, speed, acceleration, jerk)
    b, p = state.b, state.p
    found = [
        [*angles, *at_b, *at_p]
        for angles, at_b, at_p in (
            ((state.theta3, state.theta4), b.position, p.position),
            ((state.omega3, state.omega4), b.velocity, p.velocity),
            ((state.alpha3, state.alpha4), b.acceleration, p.acceleration),
            ((state.jerk3, state.jerk4), b.jerk, p.jerk),
        )
    ]
    for order, expected in enumerate(differences(positions, 0.0, 0.02 / speed)):
        assert_near(found[order], expected, share=(1e-12, 1e-10, 1e-7, 1e-4)[order])


@pytest.mark.parametrize("kind", TURNING)
@given(data=st.data())
@CHECKED
def test_points_of_one_link_keep_their_distance(
    four_bars: Drawer, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    theta2 = np.linspace(0, TURN, 50)
    state = solve_kinematics(linkage, theta2, 1.3, 0.4, -0.2)
    on_coupler = state.point(3, (float(linkage.r3), 0.0))
    for name in ("position", "velocity", "acceleration", "jerk"):
        value, scale = getattr(on_coupler, name), np.abs(getattr(on_coupler, name)).max()
        np.testing.assert_allclose(getattr(state.b, name), value, rtol=0, atol=1e-10 * scale)
    np.testing.assert_array_equal(state.a.position, solve_position(linkage, theta2).a)


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
    theta2, speed = np.linspace(0, 6, 7), np.linspace(1, 2, 7)
    together = solve_kinematics(batch[:, None], theta2, speed, 0.3)
    assert together.shape == (5, 7) == together.omega2.shape == together.jerk4.shape
    assert together.p.position.shape == (5, 7, 2)
    for index in range(5):
        alone = solve_kinematics(batch[index], theta2, speed, 0.3)
        for name in ("theta2", "omega3", "omega4", "alpha3", "alpha4", "jerk3", "jerk4"):
            np.testing.assert_array_equal(getattr(together, name)[index], getattr(alone, name))
        np.testing.assert_array_equal(together.p.jerk[index], alone.p.jerk)


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


@pytest.mark.parametrize("assembly", [1, -1])
@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize("speed", [2.0, -2.0])
@pytest.mark.parametrize("lengths", [(4, 2, 2, 3), (4, 3, 1, 3), (5, 4, 1, 3.5), (3, 4, 2, 2.5)])
def test_dead_positions_are_infinite_with_the_sign_of_their_neighbourhood(
    assembly: int, end: int, speed: float, lengths: tuple[float, ...]
) -> None:
    r1, r2, r3, r4 = lengths
    linkage = FourBar(o2=(0, 0), o4=(r1, 0), r2=r2, r3=r3, r4=r4, assembly=assembly)
    ends = driver_ranges(linkage)[0]
    inside = ends[end] + (1e-9, -1e-9)[end]
    with pytest.warns(DeadPositionWarning, match=f"driver angle {np.degrees(ends[end]):.6g} deg"):
        dead = solve_kinematics(linkage, ends[end], speed)
    near = solve_kinematics(linkage, inside, speed)
    for name in ("omega3", "omega4", "alpha3", "alpha4", "jerk3", "jerk4"):
        assert np.isinf(getattr(dead, name)), name
        assert np.sign(getattr(dead, name)) == np.sign(getattr(near, name)), name
    assert dead.b.speed == np.inf
    np.testing.assert_allclose(dead.a.velocity, near.a.velocity, atol=1e-8)
    np.testing.assert_allclose(dead.point(3, (0, 0)).jerk, dead.a.jerk)


def test_a_driver_at_rest_in_a_dead_position_leaves_the_rates_open() -> None:
    end = driver_ranges(TRIPLE_ROCKER)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(TRIPLE_ROCKER, end, 0.0)
    assert np.isnan([state.omega3, state.omega4]).all()


def test_many_dead_positions_are_named_by_the_first_three() -> None:
    ends = np.resize(driver_ranges(TRIPLE_ROCKER)[0], 8)
    with pytest.warns(DeadPositionWarning, match=r"-108\.21, 108\.21, -108\.21, \.\.\. deg"):
        solve_kinematics(TRIPLE_ROCKER, ends)


def test_no_warning_where_the_driver_turns() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    assert full_rotation(linkage)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solve_kinematics(linkage, np.linspace(0, TURN, 1000))


def test_what_is_asked_of_a_point_is_checked() -> None:
    state = solve_kinematics(TRIPLE_ROCKER, 0.3)
    with pytest.raises(
        ProblemError, match=r"link is 5; it must be 2 \(driver\), 3 \(coupler\) or 4 \(output\)"
    ):
        state.point(5, (0, 0))
    with pytest.raises(ProblemError, match=r"at has shape \(3,\)"):
        state.point(2, (0, 0, 1))
