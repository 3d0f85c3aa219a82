"""What the motor of the file has to give behind its gear: torque against speed, power, inertia."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis import Kinematics, Loads, Masses, generalised_inertia, inverse_dynamics, motor_torque
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.samples import Columns, curves, line, over_driver, table
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees, turn_means, turn_peaks

_RPM = 60 / TURN
_SPEED = "speed of the motor (rpm)"


def motor(study: LinkageStudy) -> Section | None:
    """Torque, speed and power of the motor, and the inertia it feels; None where the file has none."""
    given, masses, loads = study.spec.dynamics, study.masses, study.loads
    if given is None or given.motor is None or masses is None:
        return None
    spec = given.motor
    columns = over_driver(study, lambda state: _columns(state, masses, loads, spec, study.metre**2))
    places, angles = columns["motor_rpm"], columns["theta2_deg"]
    torque, title = {"torque": line(columns["motor_torque"])}, "torque of the motor against its speed"
    inertia = {"inertia": "inertia_kg_m2"}
    plots = (
        Plot("motor-torque-speed", title, "N m", torque, places, _SPEED, angles=angles),
        curves(columns, "motor-torque", "torque of the motor", "N m", {"torque": "motor_torque"}),
        curves(columns, "motor-power", "power of the motor", "W", {"power": "motor_power"}),
        curves(columns, "motor-inertia", "inertia of the linkage at the motor", "kg m²", inertia),
    )
    facts = tuple(_facts(study, masses, loads, spec)) if study.sweep.turns else ()
    notes = (
        "gear losses are a share of the power that goes through the gear, whichever side drives",
        "the motor's own inertia is in its torque, and not in the inertia of the linkage",
    )
    return Section("motor", "Motor", facts, {"motor": table(columns)}, plots, notes)


def _columns(state: Kinematics, masses: Masses, loads: Loads, spec: MotorSpec, joule: float) -> Columns:
    torque, speed = _torque(state, masses, loads, spec, joule), spec.gear_ratio * state.omega2
    inertia = generalised_inertia(state.linkage, state.theta2, masses) * joule / spec.gear_ratio**2
    return {
        "motor_rpm": speed * _RPM + np.zeros(state.shape),
        "motor_torque": torque,
        "motor_power": torque * speed,
        "inertia_kg_m2": inertia + np.zeros(state.shape),
    }


def _torque(state: Kinematics, masses: Masses, loads: Loads, spec: MotorSpec, joule: float) -> FloatArray:
    """Of the motor, N m."""
    torque = inverse_dynamics(state, masses, loads).torque * joule
    return motor_torque(
        torque, state.omega2, state.alpha2, spec.gear_ratio, spec.gear_efficiency, spec.inertia
    )


def _facts(study: LinkageStudy, masses: Masses, loads: Loads, spec: MotorSpec) -> Iterator[Fact]:
    joule, ratio = study.metre**2, spec.gear_ratio

    def sizes(state: Kinematics) -> FloatArray:
        torque, speed = (
            _torque(state, masses, loads, spec, joule),
            ratio * state.omega2 + np.zeros(state.shape),
        )
        inertia = generalised_inertia(study.linkage, state.theta2, masses) * joule / ratio**2
        return np.stack([np.abs(torque), torque * speed, -torque * speed, np.abs(speed), inertia, -inertia])

    def parts(state: Kinematics) -> FloatArray:
        found = inverse_dynamics(state, masses, loads)
        torque = _torque(state, masses, loads, spec, joule)
        return np.stack([torque**2, torque * ratio * state.omega2, found.power * joule])

    (torque, power, back, speed, most, least), places = turn_peaks(study, sizes)
    square, mean, load = turn_means(study, parts)
    yield Fact("motor_rpm_peak", "speed of the motor, largest", float(speed) * _RPM, "rpm")
    yield Fact("motor_torque_peak", "torque of the motor, largest", float(torque), "N m")
    label = "torque of the motor, largest: theta2"
    yield Fact("motor_torque_peak_theta2_deg", label, degrees(float(places[0])), "deg")
    yield Fact("motor_torque_rms", "torque of the motor, rms over time", float(np.sqrt(square)), "N m")
    yield Fact("motor_power_peak", "power of the motor, largest", float(power), "W")
    if back > 0:
        yield Fact("motor_power_back", "power that it is driven with, largest", float(back), "W")
    mean = 0.0 if abs(mean) <= 1e-12 * power else float(mean)  # less is rounding
    yield Fact("motor_power_mean", "power of the motor, mean over time", mean, "W")
    if spec.gear_efficiency < 1:
        yield Fact("gear_loss_mean", "power lost in the gear, mean over time", mean - float(load), "W")
    yield Fact(
        "motor_load_inertia_least", "inertia of the linkage at the motor, least", -float(least), "kg m2"
    )
    yield Fact(
        "motor_load_inertia_largest", "inertia of the linkage at the motor, largest", float(most), "kg m2"
    )
    if spec.inertia > 0:
        label = "inertia of the linkage over that of the motor, largest"
        yield Fact("motor_inertia_ratio", label, float(most) / spec.inertia)
