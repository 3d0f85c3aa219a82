"""Inverse dynamics: published figures, powers and energies, the system of equations at once."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from loaded_linkages import JACK, LOADS, MASSES, ROCKER, TURN, WEIGHT, closed_dead_and_open

from grashof import analysis
from grashof.analysis import Friction, Loads, inverse_dynamics, powers, solve_kinematics, uniform_bars
from grashof.analysis.forces.joints import joint_motion, joints_of
from grashof.problems import FourBar, ProblemError


def masses_of(figures: dict[str, Any], linkage: FourBar) -> analysis.Masses:
    return analysis.given_masses(
        linkage, *([float(each) for each in figures[name]] for name in ("masses", "inertias"))
    )


def test_reference_figures(golden: dict[str, Any], golden_linkages: dict[str, FourBar]) -> None:
    jack, bag = golden["pumpjack_report_geometry"]["inverse_dynamics"], golden["bag_mechanism_exact"]
    cases = [("pumpjack", TURN / 3, jack, case, case["g"], "") for case in jack["cases"]]
    cases += [
        (name, 1.0, bag, state, gravity, f"(g={gravity})")
        for name, states in (
            ("bag", [*bag["states_at_poses"], *bag["states"]]),
            ("table7", golden["table7_lengths_theta1_0"]["states"]),
        )
        for state in states
        for gravity in ("0", "9.81")
        if f"T(g={gravity})" in state
    ]
    assert len(cases) == len(jack["cases"]) + 16 + 9
    for name, speed, masses, expected, gravity, suffix in cases:
        linkage = golden_linkages[name]
        state = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])), speed)
        loads = Loads(gravity=(0, -float(gravity)))
        found = inverse_dynamics(state, masses_of(masses, linkage), loads)
        for key in ("T", "F12", "F32", "F43", "F14"):
            value = found.torque if key == "T" else getattr(found, key.lower())
            reference = np.array(expected[key + suffix], dtype=np.float64)
            np.testing.assert_allclose(value, reference, rtol=0, atol=1e-9 * np.abs(reference).max())


def test_torque_extremes_and_rms_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    table7, bag = golden["table7_lengths_theta1_0"], golden["bag_mechanism_exact"]
    linkage = golden_linkages["table7"]
    masses = masses_of(bag, linkage)

    def torque(theta2: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return inverse_dynamics(solve_kinematics(linkage, theta2), masses).torque

    found, expected = analysis.extremes_of(torque, -np.pi, np.pi, closed=True), table7["torque_extremes_g0"]
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
    state = closed_dead_and_open()
    found = inverse_dynamics(state, uniform_bars(ROCKER, 2.0), WEIGHT)
    systems = [
        analysis.system_of_equations(state, masses, WEIGHT)
        for masses in (uniform_bars(ROCKER, 2.0), analysis.WEIGHTLESS)
    ]
    for values in (found.torque[:, None], found.f43, *(system.solution for system in systems)):
        np.testing.assert_array_equal(np.isfinite(values).all(axis=-1), [True, False, False])


def test_bad_input_is_reported() -> None:
    state, masses = solve_kinematics(JACK, 0.3), uniform_bars(JACK, 2.0)
    for loads, message in (
        (Loads(gravity=(0, 0, 1)), "gravity is"),
        (Loads(friction=Friction(viscous=-1)), "viscous friction"),
        (Loads(friction=Friction(radius=(1, 2))), "radius friction"),
        (Loads(moments=(analysis.AppliedMoment(1, 2.0),)), "link is 1"),
        (Loads(forces=(analysis.AppliedForce(5, (0, 0), (1, 1)),)), "link is 5"),
    ):
        with pytest.raises(ProblemError, match=message):
            inverse_dynamics(state, masses, loads)


def test_each_power_is_by_itself() -> None:
    time = np.linspace(0, 4, 30)
    state = solve_kinematics(JACK, *analysis.driver_motion(lambda t: 1.5 * t + 0.2 * np.sin(3 * t), time))
    assert np.abs(powers(state, MASSES, LOADS).friction).max() < 1e-12
    conservative = Loads(LOADS.gravity, springs=LOADS.springs[1:], torsion_springs=LOADS.torsion_springs)
    assert np.abs(powers(state, MASSES, conservative).loads).max() < 1e-12
    damped = Loads(springs=LOADS.springs[:1])
    assert (powers(state, MASSES, damped).loads <= 0).all()


def test_the_rows_are_those_of_the_textbook() -> None:
    """Link 2 of a linkage at rest, written out: arms from its centre to O2 and A."""
    linkage = FourBar(o2=(1, 2), o4=(5, 2), r2=1, r3=4, r4=3)
    masses = analysis.given_masses(linkage, (2, 3, 4), (1, 1, 1), [(0.25, 0.0), (2, 0), (1.5, 0)])
    system = analysis.system_of_equations(
        solve_kinematics(linkage, np.pi / 2, 0.0), masses, Loads(gravity=(0, -10))
    )
    assert len(system.EQUATIONS) == len(system.UNKNOWNS) == 9
    assert system.matrix[:3].round(12).tolist() == [
        [1, 0, 1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, 1, 0, 0, 0, 0, 0],
        [0.25, 0, -0.75, 0, 0, 0, 0, 0, 1],
    ]
    assert system.right_side.round(12).tolist() == [0, 20, 0, 0, 30, 0, 0, 40, 0]
