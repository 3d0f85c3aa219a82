"""The drive of the linkage: energy and power, the motor behind its gear, the flywheel."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import (
    Kinematics,
    Loads,
    Masses,
    energies,
    flywheel_speed,
    generalised_inertia,
    inverse_dynamics,
    motor_torque,
    powers,
    size_flywheel,
    solve_kinematics,
)
from grashof.analysis.mechanism.driver_law import mean_in_time
from grashof.problems import ProblemError
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.checks import number_within
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.samples import Columns, curves, line, over_driver, table
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees, extreme_facts, turn_extremes, turn_means, turn_peaks

_CERTAIN = 1e-7  # share of the input work: error up to which an efficiency is reported
_RPM = 60 / TURN


def energy_section(study: LinkageStudy) -> Section | None:
    """Kinetic energy of each link, energy of weights and springs, and the powers that change them."""
    masses, loads = study.masses, study.loads
    if masses is None:
        return None
    columns = over_driver(study, lambda state: _energy_columns(state, masses, loads, study.metre**2))
    numbers = [link.number for link in study.linkage.mechanism.links[1:]]
    kinetic = {f"link {n}": f"kinetic_{n}" for n in numbers} | {"together": "kinetic"}
    total = {"kinetic": "kinetic", "weights": "weights", "springs": "springs", "sum": "energy"}
    given = {"drive": "drive_power", "loads": "load_power", "friction": "friction_power"}
    for labels in (total, given):  # lines that are zero throughout are left out
        for label, key in list(labels.items()):
            if label in ("springs", "loads", "friction") and not np.nan_to_num(columns[key]).any():
                del labels[label]
    plots = (
        curves(columns, "kinetic-energy", "kinetic energy", "J", kinetic),
        curves(columns, "energy", "energy", "J", total),
        curves(columns, "powers", "power that changes the energy", "W", given),
    )
    notes = ("the energy of weights counts from the origin", "powers together are the rate of the energy")
    facts = (*_energy_facts(study, masses), *_losses(study, masses, loads))
    return Section("energies", "Energies", facts, {"energies": table(columns)}, plots, notes)


def _energy_columns(state: Kinematics, masses: Masses, loads: Loads, joule: float) -> Columns:
    found, given = energies(state, masses, loads), powers(state, masses, loads)
    none = np.zeros(state.shape)
    return {
        **{f"kinetic_{link}": each * joule for link, each in enumerate(found.kinetic, start=2)},
        "kinetic": found.kinetic.sum(axis=0) * joule,
        "weights": found.weight * joule + none,
        "springs": found.springs * joule + none,
        "energy": found.total * joule,
        "drive_power": given.drive * joule,
        "load_power": given.loads * joule + none,
        "friction_power": given.friction * joule + none,
    }


def _energy_facts(study: LinkageStudy, masses: Masses) -> Iterator[Fact]:
    if not (study.sweep.turns and masses.total > 0):
        return
    found = turn_extremes(study, lambda state: energies(state, masses).kinetic.sum(axis=0))
    yield from extreme_facts("kinetic_energy", "kinetic energy", found, "J", study.metre**2)


def _losses(study: LinkageStudy, masses: Masses, loads: Loads) -> Iterator[Fact]:
    """Work of friction in a turn, and the efficiency: the share of the input work that friction leaves."""
    friction, law = study.spec.dynamics and study.spec.dynamics.friction, study.sweep.laws[0]
    if friction is None or not study.sweep.turns or not np.isfinite(law.duration):
        return

    def given(place: FloatArray) -> FloatArray:
        found = powers(solve_kinematics(study.linkage, *law.at_place(place)), masses, loads)
        return np.stack(np.broadcast_arrays(found.drive, found.loads, found.friction))

    mean, error = mean_in_time(study.linkage, law, given)
    put_in, lost = float(np.maximum(mean[:2], 0.0).sum()), -float(mean[2])
    if np.isfinite(lost) and 0 < lost <= put_in * (1 + _CERTAIN) and error.max() < _CERTAIN * put_in:
        work = lost * law.duration * study.metre**2
        yield Fact("friction_work", "work of friction in the joints, a turn", work, "J")
        left = 1 - lost / put_in
        label = "efficiency: work put in that friction leaves"
        yield Fact("efficiency", label, left if left > _CERTAIN else 0.0)


def motor(study: LinkageStudy) -> Section | None:
    """Torque, speed and power of the motor, and the inertia that it drives; None without a motor."""
    given, masses, loads = study.spec.dynamics, study.masses, study.loads
    if given is None or given.motor is None or masses is None:
        return None
    spec = given.motor
    columns = over_driver(study, lambda state: _motor_columns(state, masses, loads, spec, study.metre**2))
    places, angles = columns["motor_rpm"], columns["theta2_deg"]
    against_speed = {"torque": line(columns["motor_torque"])}
    title = "torque of the motor against its speed"
    over = "speed of the motor (rpm)"
    inertia = {"inertia": "inertia_kg_m2"}
    plots = (
        Plot("motor-torque-speed", title, "N m", against_speed, places, over, angles=angles),
        curves(columns, "motor-torque", "torque of the motor", "N m", {"torque": "motor_torque"}),
        curves(columns, "motor-power", "power of the motor", "W", {"power": "motor_power"}),
        curves(columns, "motor-inertia", "inertia of the linkage at the motor", "kg m²", inertia),
    )
    facts = tuple(_motor_facts(study, masses, loads, spec)) if study.sweep.turns else ()
    notes = (
        "gear losses are a share of the power that goes through the gear, whichever side drives",
        "the motor's own inertia is in its torque, and not in the inertia of the linkage",
    )
    return Section("motor", "Motor", facts, {"motor": table(columns)}, plots, notes)


def _motor_columns(state: Kinematics, masses: Masses, loads: Loads, spec: MotorSpec, joule: float) -> Columns:
    ratio = spec.gear_ratio
    torque = inverse_dynamics(state, masses, loads).torque * joule
    torque = motor_torque(torque, state.omega2, state.alpha2, ratio, spec.gear_efficiency, spec.inertia)
    speed = ratio * state.omega2 + np.zeros(state.shape)
    inertia = generalised_inertia(state.linkage, state.theta2, masses) * joule / ratio**2
    return {
        "motor_rpm": speed * _RPM,
        "motor_torque": torque,
        "motor_power": torque * speed,
        "inertia_kg_m2": inertia + np.zeros(state.shape),
    }


def _motor_facts(study: LinkageStudy, masses: Masses, loads: Loads, spec: MotorSpec) -> Iterator[Fact]:
    joule = study.metre**2

    def sizes(state: Kinematics) -> FloatArray:
        speed, torque, power, inertia = _motor_columns(state, masses, loads, spec, joule).values()
        return np.stack([np.abs(torque), power, -power, np.abs(speed), inertia, -inertia])

    def parts(state: Kinematics) -> FloatArray:
        _, torque, power, _ = _motor_columns(state, masses, loads, spec, joule).values()
        return np.stack([torque**2, power, inverse_dynamics(state, masses, loads).power * joule])

    (torque, power, back, speed, most, least), places = turn_peaks(study, sizes)
    square, mean, load = turn_means(study, parts)
    yield Fact("motor_rpm_peak", "speed of the motor, largest", float(speed), "rpm")
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
    label = "inertia of the linkage at the motor"
    yield Fact("motor_load_inertia_least", f"{label}, least", -float(least), "kg m2")
    yield Fact("motor_load_inertia_largest", f"{label}, largest", float(most), "kg m2")
    if spec.inertia > 0:
        label = "inertia of the linkage over that of the motor, largest"
        yield Fact("motor_inertia_ratio", label, float(most) / spec.inertia)


def flywheel(study: LinkageStudy) -> Section | None:
    """Inertia, energy and the speed over the turn; None unless a fluctuation is requested."""
    if study.asked.flywheel is None:
        return None
    fluctuation = number_within(study.asked.flywheel, 1e-6, 1.0, "flywheel")
    masses, loads, sweep = study.masses, study.loads, study.sweep
    if masses is None:
        raise ProblemError("flywheel needs masses or loads; the file states none")
    if not sweep.turns:
        raise ProblemError("flywheel needs a driver that turns fully; this one swings")
    if sweep.speed_rpm == 0 or not sweep.laws[0].motor.steady:
        raise ProblemError("flywheel needs a steady speed of the driver, other than 0")
    omega2, joule = sweep.speed_rpm * TURN / 60, study.metre**2
    wheel = size_flywheel(study.linkage, masses, omega2, fluctuation, loads)
    theta2 = np.radians(np.arange(361.0))
    speed = flywheel_speed(study.linkage, masses, omega2, wheel, theta2, loads) * 60 / TURN
    facts = (
        Fact("flywheel_fluctuation", "fluctuation of the driver's speed", fluctuation),
        Fact("flywheel_inertia", "flywheel on the driver's shaft: inertia", wheel.inertia * joule, "kg m2"),
        Fact("flywheel_energy", "energy that it takes up and gives back", wheel.energy * joule, "J"),
        Fact("flywheel_mean_torque", "torque of an even drive", wheel.mean_torque * joule, "N m"),
        Fact("flywheel_slowest_theta2_deg", "slowest at theta2", degrees(wheel.slowest), "deg"),
        Fact("flywheel_fastest_theta2_deg", "fastest at theta2", degrees(wheel.fastest), "deg"),
    )
    places = np.degrees(theta2).round(9)
    plot = Plot("flywheel-speed", "speed of the driver with the flywheel", "rpm", {"speed": speed}, places)
    columns = pd.DataFrame({"theta2_deg": places, "speed_rpm": speed})
    notes = ("its inertia is additional to that of the links; valid for small fluctuations",)
    return Section("flywheel", "Flywheel", facts, {"flywheel": columns}, (plot,), notes)
