"""Energies, friction, motor and flywheel: against the analysis, dense sums, and in every unit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import HEAVY, JACK, ONE_RANGE, facts, in_both_units, loaded

from grashof.analysis import (
    inverse_dynamics,
    mechanical_energy,
    motor_torque,
    size_flywheel,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec
from grashof.problems.values.dynamics.load_specs import DamperSpec, FrictionSpec, LoadSpec, Place, SpringSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.study import LinkageStudy
from grashof.survey import Asked, report_on

CRANK_ROCKER = LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3, (1, 1)), "one", length_unit="m")
LOADED = DynamicsSpec(
    300.0,
    speed_rpm=-10,
    gravity=(0, -9.81),
    loads=(LoadSpec(4, at=(-4, 0), values=((0, 0, -9e3), (90, 0, -2e4), (200, 0, -1e4), (360, 0, -9e3))),),
    springs=(SpringSpec((Place(1, (0, 2)), Place(4, (1, 0))), 500.0, 1.2),),
    dampers=(DamperSpec((Place(1, (0, 2)), Place(4, (1, 0))), 30.0),),
    friction=FrictionSpec(coulomb=0.1, pin_radius=0.05, viscous=2.0),
    motor=MotorSpec(profile="trapezoid"),
)
GEAR = MotorSpec(gear_ratio=30, gear_efficiency=0.9, inertia=0.05)


@pytest.mark.slow
def test_the_energy_table_adds_up(sections: Any) -> None:
    table = sections(JACK)["energies"].tables["energies"]
    np.testing.assert_allclose(table["energy"], table["kinetic"] + table["weights"] + table["springs"])
    spread = np.fft.fft(table["energy"].to_numpy()[:-1])
    number = np.fft.fftfreq(360, 1 / 360)
    rate = np.fft.ifft(1j * number * spread).real * 20 * np.pi / 30
    np.testing.assert_allclose(table["drive_power"].to_numpy()[:-1], rate, atol=1e-6)
    heavy = DynamicsSpec(300.0, speed_rpm=20, gravity=(0, -9.8))
    both = [sections(spec)["energies"] for spec in in_both_units(JACK.linkage, heavy)]
    assert facts(both[1]) == pytest.approx(facts(both[0]), rel=1e-7)
    metres, inches = (each.tables["energies"] for each in both)
    np.testing.assert_allclose(inches["energy"], metres["energy"], rtol=1e-9)
    np.testing.assert_allclose(inches["drive_power"], metres["drive_power"], rtol=1e-9, atol=1e-6)


@pytest.mark.slow
def test_the_powers_of_loads_springs_and_friction_are_the_rate_of_the_energy(sections: Any) -> None:
    spec = replace(JACK, dynamics=LOADED)
    table = sections(spec)["energies"].tables["energies"].iloc[5:-5]
    study = LinkageStudy.of(spec, Asked())
    time, step = study.sweep.time(np.radians(table["theta2_deg"].to_numpy())), 1e-3
    law = study.sweep.laws[0]
    total = [
        mechanical_energy(
            solve_kinematics(spec.linkage, *law.at_time(time + k * step)), study.masses, study.loads
        )
        for k in (-2, -1, 1, 2)
    ]
    rate = (total[0] - 8 * total[1] + 8 * total[2] - total[3]) / (12 * step)
    given = table["drive_power"] + table["load_power"] + table["friction_power"]
    corner = np.min(np.abs(time[:, None] - law.duration * law.corners), axis=1) < 3 * step
    np.testing.assert_allclose(given[~corner], rate[~corner], atol=1e-6 * np.abs(rate).max())
    assert (table["friction_power"] < 0).all()


@pytest.mark.quick("20.0-None", "20.0-motor2", "-20.0-motor2")
@pytest.mark.parametrize("motor", [None, MotorSpec("trapezoid"), MotorSpec("cycloid")])
@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_the_drive_gives_what_the_load_takes_and_friction(
    sections: Any, motor: MotorSpec | None, speed: float
) -> None:
    """A moment always against the rocker: useful work is what the drive gives, times the efficiency."""
    against = ((0, 50.0), (20, 50), (60, -50), (200, -50), (240, 50), (360, 50))
    spec = DynamicsSpec(
        3.0,
        speed_rpm=speed,
        gravity=(0, -9.81),
        loads=(LoadSpec(4, values=against),),
        friction=FrictionSpec(0.1, 0.05, viscous=0.4),
        motor=motor,
    )
    section = sections(replace(CRANK_ROCKER, dynamics=spec))
    found, study, linkage = facts(section["energies"]), section.study, CRANK_ROCKER.linkage
    (law,) = study.sweep.laws
    share = (np.arange(6_000) + 0.5) / 6_000
    state = law.state(linkage, law.at_time(share * law.duration).theta2)
    masses, loads = stated_masses(linkage, spec), stated_loads(spec, 1.0)
    given = inverse_dynamics(state, masses, loads).power
    taken = np.interp(np.degrees(state.theta2) % 360, *np.array(against).T)  # nearly the table's curve
    curve = loads.moments[0].moment
    assert callable(curve)
    assert np.abs(np.asarray(curve(state)) - taken).max() < 20
    work = float(np.mean(given)) * law.duration
    useful = -float(np.mean(np.asarray(curve(state)) * state.omega4)) * law.duration
    put_in = max(work, 0.0) + max(-useful, 0.0)
    assert found["friction_work"] == pytest.approx(work - useful, rel=1e-3)
    assert found["efficiency"] == pytest.approx(1 - (work - useful) / put_in, abs=1e-4)


def test_friction_takes_all_without_loads_and_nothing_without_motion(sections: Any) -> None:
    def efficiency(**dynamics: Any) -> float | None:
        spec = replace(CRANK_ROCKER, dynamics=DynamicsSpec(3.0, **dynamics))
        return facts(sections(spec)["energies"]).get("efficiency")

    assert efficiency(friction=FrictionSpec(viscous=1.0)) == pytest.approx(0, abs=1e-7)
    assert efficiency() is None
    assert efficiency(friction=FrictionSpec()) is None
    assert efficiency(speed_rpm=0, friction=FrictionSpec(viscous=1.0)) is None


def test_no_motor_without_masses_or_loads(sections: Any) -> None:
    assert "motor" not in sections(replace(JACK, dynamics=DynamicsSpec(motor=GEAR)))


@pytest.mark.slow
@pytest.mark.quick("20.0-constant")
@pytest.mark.parametrize("profile", ["constant", "cycloid", "trapezoid"])
@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_the_motor_gives_what_the_drive_and_its_rotor_take(sections: Any, profile: str, speed: float) -> None:
    spec = loaded(JACK, motor=replace(GEAR, profile=profile), speed_rpm=speed)
    table, drive = sections(spec)["motor"].tables["motor"], report_on(spec).tables["dynamics"]
    study = LinkageStudy.of(spec, Asked())
    state = study.states[0]
    torque = drive["torque"].to_numpy()
    losses = np.where(torque * state.omega2 >= 0, 1 / 0.9, 0.9)
    expected = torque * losses / 30 + 0.05 * 30 * state.alpha2
    np.testing.assert_allclose(table["motor_torque"], expected, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(table["motor_rpm"], 30 * state.omega2 * 30 / np.pi, rtol=1e-12, atol=1e-12)


@pytest.mark.slow
def test_means_are_over_time_and_peaks_over_all_of_it(sections: Any) -> None:
    spec = loaded(JACK, motor=replace(GEAR, profile="trapezoid"), friction=FrictionSpec(viscous=(500.0,)))
    given = facts(sections(spec)["motor"])
    study = LinkageStudy.of(spec, Asked())
    law = study.sweep.laws[0]
    time = (np.arange(40_000) + 0.5) / 40_000 * law.duration
    motion = law.at_time(time)

    assert study.masses is not None
    torque = inverse_dynamics(solve_kinematics(spec.linkage, *motion), study.masses, study.loads).torque
    motor = motor_torque(torque, motion.omega2, motion.alpha2, 30, 0.9, 0.05)
    power = motor * 30 * motion.omega2
    assert given["motor_torque_rms"] == pytest.approx(np.sqrt(np.mean(motor**2)), rel=1e-5)
    assert given["motor_power_mean"] == pytest.approx(power.mean(), rel=1e-5)
    assert given["gear_loss_mean"] == pytest.approx((power - torque * motion.omega2).mean(), rel=1e-5)
    assert given["gear_loss_mean"] > 0
    assert given["motor_torque_peak"] == pytest.approx(np.abs(motor).max(), rel=1e-4)
    assert given["motor_power_peak"] == pytest.approx(power.max(), rel=1e-6)
    assert given["motor_power_back"] == pytest.approx(-power.min(), rel=1e-6)
    assert given["motor_rpm_peak"] == pytest.approx(20 * 30 * 1.5)


def test_the_inertia_at_the_motor_is_that_of_the_torque(sections: Any) -> None:
    """Another acceleration of the driver takes so much more."""
    found = sections(loaded(JACK, motor=GEAR))["motor"]
    table = found.tables["motor"]

    study = LinkageStudy.of(JACK, Asked())
    assert study.masses is not None
    theta2 = np.radians(table["theta2_deg"].to_numpy())
    slow, fast = (
        inverse_dynamics(solve_kinematics(JACK.linkage, theta2, 2.0, alpha), study.masses).torque
        for alpha in (0.0, 9.0)
    )
    np.testing.assert_allclose(table["inertia_kg_m2"], (fast - slow) / 9 / 30**2, rtol=1e-9)
    given = facts(found)
    assert given["motor_load_inertia_largest"] >= table["inertia_kg_m2"].max()
    assert given["motor_inertia_ratio"] == pytest.approx(given["motor_load_inertia_largest"] / 0.05)


@pytest.mark.slow
def test_a_driver_that_swings_and_inches(sections: Any) -> None:
    assert facts(sections(replace(ONE_RANGE, dynamics=replace(HEAVY, motor=GEAR)))["motor"]) == {}
    heavy = DynamicsSpec(300.0, speed_rpm=20, gravity=(0, -9.8), motor=GEAR)
    metres, inches = (facts(sections(spec)["motor"]) for spec in in_both_units(JACK.linkage, heavy))
    for key, value in metres.items():
        assert inches[key] == pytest.approx(value, rel=1e-7, abs=1e-7), key


def test_the_flywheel_is_that_of_the_analysis(sections: Any) -> None:
    found = sections(JACK, flywheel=0.05)["flywheel"]
    study = LinkageStudy.of(JACK, Asked())
    assert study.masses is not None
    wheel = size_flywheel(JACK.linkage, study.masses, 20 * np.pi / 30, 0.05, study.loads)
    given = facts(found)
    assert given["flywheel_inertia"] == wheel.inertia
    assert given["flywheel_energy"] == wheel.energy
    speed = found.plots[0].series["speed"]
    assert np.ptp(speed) == pytest.approx(0.05 * 20, rel=1e-3)
