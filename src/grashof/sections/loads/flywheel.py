"""The flywheel that keeps the driver's speed within a fluctuation."""

from __future__ import annotations

import numpy as np
import pandas as pd

from grashof.analysis import flywheel_speed, size_flywheel
from grashof.problems import ProblemError
from grashof.problems.values.arrays import TURN
from grashof.problems.values.checks import number_within
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.study.turn import degrees


def flywheel(study: LinkageStudy) -> Section | None:
    """Inertia, energy and the speed over the turn; None unless a fluctuation is asked for."""
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
    notes = ("its inertia comes besides that of the links; it holds for small fluctuations",)
    return Section("flywheel", "Flywheel", facts, {"flywheel": columns}, (plot,), notes)
