"""The motor behind its gear: against the drive's torque of the same analysis, and by energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import facts, in_both_units

from grashof.analysis import inverse_dynamics, motor_torque, solve_kinematics
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage_spec
from grashof.problems.values.dynamics.load_specs import FrictionSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.study import LinkageStudy
from grashof.survey import Asked, Section, report_on

Sections = Callable[..., dict[str, Section]]
JACK = load_linkage_spec("pumpjack")
GEAR = MotorSpec(gear_ratio=30, gear_efficiency=0.9, inertia=0.05)


def jack(motor: MotorSpec | None, **given: Any) -> LinkageSpec:
    assert JACK.dynamics is not None
    return replace(JACK, dynamics=replace(JACK.dynamics, motor=motor, **given))


def test_no_motor_no_section(sections: Sections) -> None:
    assert "motor" not in sections(JACK)
    assert "motor" not in sections(replace(JACK, dynamics=DynamicsSpec(motor=GEAR)))


@pytest.mark.slow
@pytest.mark.quick("20.0-constant")
@pytest.mark.parametrize("profile", ["constant", "cycloid", "trapezoid"])
@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_the_motor_gives_what_the_drive_and_its_rotor_take(
    sections: Sections, profile: str, speed: float
) -> None:
    spec = jack(replace(GEAR, profile=profile), speed_rpm=speed)
    table, drive = sections(spec)["motor"].tables["motor"], report_on(spec).tables["dynamics"]
    study = LinkageStudy.of(spec, Asked())
    state = study.states[0]
    torque = drive["torque"].to_numpy()
    losses = np.where(torque * state.omega2 >= 0, 1 / 0.9, 0.9)
    expected = torque * losses / 30 + 0.05 * 30 * state.alpha2
    np.testing.assert_allclose(table["motor_torque"], expected, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(table["motor_rpm"], 30 * state.omega2 * 30 / np.pi, rtol=1e-12, atol=1e-12)


@pytest.mark.slow
def test_means_are_over_time_and_peaks_over_all_of_it(sections: Sections) -> None:
    spec = jack(replace(GEAR, profile="trapezoid"), friction=FrictionSpec(viscous=(500.0,)))
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


def test_the_inertia_at_the_motor_is_that_of_the_torque(sections: Sections) -> None:
    """Another acceleration of the driver takes so much more."""
    found = sections(jack(GEAR))["motor"]
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
def test_a_driver_that_swings_and_inches(sections: Sections) -> None:
    rocker = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
    swings = LinkageSpec(
        rocker, "it", length_unit="m", dynamics=DynamicsSpec(2.0, gravity=(0, -9.8), motor=GEAR)
    )
    assert facts(sections(swings)["motor"]) == {}
    heavy = DynamicsSpec(300.0, speed_rpm=20, gravity=(0, -9.8), motor=GEAR)
    metres, inches = (facts(sections(spec)["motor"]) for spec in in_both_units(JACK.linkage, heavy))
    for key, value in metres.items():
        assert inches[key] == pytest.approx(value, rel=1e-7, abs=1e-7), key
