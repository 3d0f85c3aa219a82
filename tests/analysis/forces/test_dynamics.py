"""Inverse dynamics: published figures, powers and energies, the system of equations at once."""

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Friction,
    Joint,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    driver_motion,
    driver_ranges,
    energies,
    extremes_of,
    given_masses,
    inverse_dynamics,
    powers,
    solve_kinematics,
    system_of_equations,
    uniform_bars,
)
from grashof.analysis.forces.joints import joint_motion, joints_of
from grashof.problems import DeadPositionWarning, FourBar, ProblemError

TURN = 2 * np.pi
JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762, coupler_point=(1.7, 0.7))
FORCES = ("f12", "f32", "f43", "f14")


def assert_state(found: Any, expected: dict[str, Any], suffix: str = "") -> None:
    values = [found.torque] + [getattr(found, name) for name in FORCES]
    keys = ["T", "F12", "F32", "F43", "F14"]
    for key, value in zip(keys, values, strict=True):
        reference = np.array(expected[key + suffix], dtype=np.float64)
        np.testing.assert_allclose(value, reference, rtol=0, atol=1e-9 * np.abs(reference).max())


def test_reference_figures_of_the_pumpjack(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    given_case = golden["pumpjack_report_geometry"]["inverse_dynamics"]
    linkage = golden_linkages["pumpjack"]
    masses = given_masses(
        linkage, [float(m) for m in given_case["masses"]], [float(i) for i in given_case["inertias"]]
    )
    for case in given_case["cases"]:
        state = solve_kinematics(linkage, np.radians(case["theta2_deg"]), TURN / 3)
        assert_state(inverse_dynamics(state, masses, Loads(gravity=(0, -float(case["g"])))), case)


@pytest.mark.parametrize("name", ["bag", "table7"])
def test_reference_figures_of_the_luggage(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar], name: str
) -> None:
    bag, linkage = golden["bag_mechanism_exact"], golden_linkages[name]
    masses = given_masses(linkage, [float(m) for m in bag["masses"]], [float(i) for i in bag["inertias"]])
    states = (
        [*bag["states_at_poses"], *bag["states"]]
        if name == "bag"
        else golden["table7_lengths_theta1_0"]["states"]
    )
    checked = 0
    for expected in states:
        state = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])))
        for gravity in ("0", "9.81"):
            suffix = f"(g={gravity})"
            if "T" + suffix in expected:
                loads = Loads(gravity=(0, -float(gravity)))
                assert_state(inverse_dynamics(state, masses, loads), expected, suffix)
                checked += 1
    assert checked == {"bag": 16, "table7": 9}[name]


def test_torque_extremes_and_rms_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    table7, bag = golden["table7_lengths_theta1_0"], golden["bag_mechanism_exact"]
    linkage = golden_linkages["table7"]
    masses = given_masses(linkage, [float(m) for m in bag["masses"]], [float(i) for i in bag["inertias"]])

    def torque(theta2: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return inverse_dynamics(solve_kinematics(linkage, theta2), masses).torque

    found, expected = extremes_of(torque, -np.pi, np.pi, closed=True), table7["torque_extremes_g0"]
    peak = abs(found.low)
    assert found.high == pytest.approx(float(expected["max"]["T"]), abs=1e-9 * peak)
    assert found.low == pytest.approx(float(expected["min"]["T"]), abs=1e-9 * peak)
    assert np.degrees(found.at_high) == pytest.approx(float(expected["max"]["theta2_rel_deg"]), abs=1e-9)
    assert np.degrees(found.at_low) == pytest.approx(float(expected["min"]["theta2_rel_deg"]), abs=1e-9)
    for count in (720, 1440):
        values = torque(np.arange(count) * TURN / count)
        rms, mean = table7[f"torque_rms_mean_N{count}"]
        assert np.sqrt(np.mean(values**2)) == pytest.approx(float(rms), rel=1e-9)
        assert np.mean(values) == pytest.approx(float(mean), abs=1e-9 * peak)


def test_pin_friction_is_proportional_to_the_joint_force() -> None:
    masses = uniform_bars(JACK, 2.0)
    state = solve_kinematics(JACK, np.linspace(0, TURN, 90), 2.0)
    found = inverse_dynamics(state, masses, Loads(gravity=(0, -9.81), friction=Friction(radius=0.02)))
    for joint in joints_of(JACK):
        rubbing = -0.02 * found.joint_force(joint) * np.sign(joint_motion(state, joint)[1])
        np.testing.assert_allclose(found.joint_moments[joint], rubbing, rtol=1e-9, atol=1e-9)
    # A friction circle wider than the links locks them.
    locked = inverse_dynamics(state, masses, Loads(gravity=(0, -9.81), friction=Friction(radius=20.0)))
    assert np.isnan(locked.torque).any()


def test_dead_and_open_positions_have_no_finite_forces() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    end = driver_ranges(rocker)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(rocker, [0.0, end, 3.0])
    found = inverse_dynamics(state, uniform_bars(rocker, 2.0), Loads(gravity=(0, -9.81)))
    np.testing.assert_array_equal(np.isfinite(found.torque), [True, False, False])
    np.testing.assert_array_equal(np.isfinite(found.f43).all(axis=-1), [True, False, False])


def test_bad_input_is_reported() -> None:
    state, masses = solve_kinematics(JACK, 0.3), uniform_bars(JACK, 2.0)
    for loads, message in (
        (Loads(gravity=(0, 0, 1)), "gravity is"),
        (Loads(friction=Friction(viscous=-1)), "viscous friction"),
        (Loads(friction=Friction(radius=(1, 2))), "radius friction"),
        (Loads(moments=(AppliedMoment(1, 2.0),)), "link is 1"),
        (Loads(forces=(AppliedForce(5, (0, 0), (1, 1)),)), "link is 5"),
    ):
        with pytest.raises(ProblemError, match=message):
            inverse_dynamics(state, masses, loads)


MASSES = Masses(Body(2, 0.3, (0.4, 0.1)), Body(3, 0.5, (1.0, -0.3)), Body(1.5, 0.2, (0.7, 0.2)))
LOADS = Loads(
    gravity=(1.0, -9.81),
    forces=(AppliedForce(3, (0.3, 0.4), lambda s: np.stack([s.omega2, -3 * s.theta2], axis=-1)),),
    moments=(AppliedMoment(2, 3.0), AppliedMoment(4, lambda state: np.sin(state.theta2))),
    springs=(Spring(1, (2, 0), 4, (1, 0.2), 20, 1.0, damping=4.0), Spring(2, (0.5, 0), 4, (1, 0), 10, 0.5)),
    torsion_springs=(TorsionSpring(Joint.B, 5.0, 1.0), TorsionSpring(Joint.A, 2.0, -1.0)),
    friction=Friction(viscous=0.3, coulomb=(0.1, 0.2, 0.3, 0.4), radius=0.02),
)


def state_at(time: np.ndarray, sense: float = 1.0) -> object:
    return solve_kinematics(JACK, *driver_motion(lambda t: sense * (1.5 * t + 0.2 * np.sin(3 * t)), time))


def test_each_power_is_by_itself() -> None:
    state = state_at(np.linspace(0, 4, 30))
    smooth = replace(LOADS, friction=Friction())
    assert np.abs(powers(state, MASSES, smooth).friction).max() < 1e-12
    conservative = Loads(LOADS.gravity, springs=LOADS.springs[1:], torsion_springs=LOADS.torsion_springs)
    assert np.abs(powers(state, MASSES, conservative).loads).max() < 1e-12
    damped = Loads(springs=LOADS.springs[:1])
    assert (powers(state, MASSES, damped).loads <= 0).all()


def test_kinetic_energy_is_that_of_every_particle() -> None:
    """A bar as many points."""
    bar = Body(3.0, 3.0 * 3.048762**2 / 12, (3.048762 / 2, 0.0))
    state = state_at(np.linspace(0, 4, 5))
    found = energies(state, Masses(Body(0), Body(0), bar), Loads(gravity=(0, -9.81)))
    nodes, weights = np.polynomial.legendre.leggauss(4)
    along = 3.048762 * (nodes + 1) / 2
    points = [state.point(4, (at, 0.0)) for at in along]
    kinetic = sum(w * 1.5 / 2 * p.speed**2 for w, p in zip(weights, points, strict=True))
    height = sum(w * 1.5 * 9.81 * p.position[:, 1] for w, p in zip(weights, points, strict=True))
    np.testing.assert_allclose(found.kinetic[2], kinetic, rtol=1e-12)
    np.testing.assert_allclose(found.weight, height, rtol=1e-12)
    np.testing.assert_array_equal(found.kinetic[:2], 0)
    np.testing.assert_allclose(found.total, kinetic + height, rtol=1e-12)


def test_the_system_has_the_reference_figures_of_the_luggage(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    bag, linkage = golden["bag_mechanism_exact"], golden_linkages["table7"]
    masses = given_masses(linkage, [float(m) for m in bag["masses"]], [float(i) for i in bag["inertias"]])
    for expected in golden["table7_lengths_theta1_0"]["states"]:
        state = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])))
        system = system_of_equations(state, masses)
        solution = dict(zip(system.UNKNOWNS, system.solution, strict=True))
        torque = float(expected["T(g=0)"])
        assert solution["T12"] == pytest.approx(torque, rel=1e-9, abs=1e-9)
        for name in ("F12", "F32", "F43", "F14"):
            force = [float(part) for part in expected[f"{name}(g=0)"]]
            limit = 1e-9 * max(1.0, *map(abs, force))
            assert [solution[f"{name}x"], solution[f"{name}y"]] == pytest.approx(force, rel=1e-9, abs=limit)


def test_the_rows_are_those_of_the_textbook() -> None:
    """Link 2 of a linkage at rest, written out: arms from its centre to O2 and A."""
    linkage = FourBar(o2=(1, 2), o4=(5, 2), r2=1, r3=4, r4=3)
    masses = given_masses(linkage, (2, 3, 4), (1, 1, 1), [(0.25, 0.0), (2, 0), (1.5, 0)])
    system = system_of_equations(solve_kinematics(linkage, np.pi / 2, 0.0), masses, Loads(gravity=(0, -10)))
    assert len(system.EQUATIONS) == len(system.UNKNOWNS) == 9
    assert system.matrix[:3].round(12).tolist() == [
        [1, 0, 1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, 1, 0, 0, 0, 0, 0],
        [0.25, 0, -0.75, 0, 0, 0, 0, 0, 1],
    ]
    assert system.right_side.round(12).tolist() == [0, 20, 0, 0, 30, 0, 0, 40, 0]


def test_dead_and_open_positions_have_no_solution() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    end = driver_ranges(rocker)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(rocker, [0.0, end, 3.0])
    for masses in (uniform_bars(rocker, 2.0), Masses(Body(0), Body(0), Body(0))):
        solution = system_of_equations(state, masses, Loads(gravity=(0, -9.81))).solution
        np.testing.assert_array_equal(np.isfinite(solution).all(axis=-1), [True, False, False])
