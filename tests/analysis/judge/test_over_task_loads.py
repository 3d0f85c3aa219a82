"""Torque and forces of designs under everything that acts, against dense samples in time."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import (
    DriverLaw,
    inverse_dynamics,
    over_task,
    solve_kinematics,
    stated_loads,
    stated_masses,
    verify,
)
from grashof.analysis.forces.joints import joints_of
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import DynamicsSpec, Problem
from grashof.problems.values.dynamics.acting import DamperSpec, FrictionSpec, LoadSpec, Place, SpringSpec
from grashof.problems.values.dynamics.motor import MotorSpec

ACTING = DynamicsSpec(
    2.0,
    speed_rpm=30,
    gravity=(0, -9.81),
    loads=(
        LoadSpec(3, (0.3, 0.1), values=((0, 0, -9), (90, 1, -20), (180, 0, -20), (360, 0, -9))),
        LoadSpec(4, values=((0, 3.0), (1, -3), (4, 2)), over="time"),
    ),
    springs=(SpringSpec((Place(1, (0, 1)), Place(4, (0.5, 0))), 20, 0.5),),
    dampers=(DamperSpec((Place(1, (0, 1)), Place(3, (0.5, 0))), 3),),
    friction=FrictionSpec(0.1, 0.02, viscous=0.3),
)
MOTORS = {
    "steady": None,
    "trapezoid": MotorSpec("trapezoid"),
    "cycloid": MotorSpec("cycloid"),
    "measured": MotorSpec(values=((0, 0), (0.5, 30), (1.5, 40), (2, 100))),
}


@pytest.mark.quick("0-steady", "2-steady")
@pytest.mark.parametrize("motor", MOTORS)
@pytest.mark.parametrize("seed", range(3))
def test_peaks_and_means_are_those_of_dense_samples_in_time(motor: str, seed: int) -> None:
    task, linkage = planted_motion(np.random.default_rng(seed), poses=4)
    spec = replace(ACTING, motor=MOTORS[motor])
    problem = Problem(task=task, length_unit="m", dynamics=spec)
    verdict = verify(linkage, task, problem.requirements)
    found = over_task(linkage, problem, verdict)
    start, rotation = float(verdict.theta2[0]), float(verdict.theta2[-1] - verdict.theta2[0])
    law = DriverLaw(start, rotation, np.copysign(np.pi, rotation), spec.motor or MotorSpec())
    beside = (law.corners[:, None] + [-1e-9, 1e-9]).ravel()
    share = np.unique(np.concatenate([np.linspace(0, 1, 80_001), beside]))
    time = share[(share > 0) & (share < 1)] * law.duration  # at rest friction may be anything
    state = solve_kinematics(linkage, *law.at_time(time), assembly=verdict.assembly[0])
    loads = stated_loads(spec, 1.0, lambda _: time)
    dynamics = inverse_dynamics(state, stated_masses(linkage, spec), loads)
    rms = np.sqrt(np.trapezoid(dynamics.torque**2, time) / law.duration)
    force = max(dynamics.joint_force(joint).max() for joint in joints_of(linkage))
    assert found.torque_rms == pytest.approx(rms, rel=2e-6)
    assert found.torque_peak == pytest.approx(np.abs(dynamics.torque).max(), rel=1e-6)
    assert found.joint_force_peak == pytest.approx(force, rel=1e-6)
    assert found.omega4_max == pytest.approx(np.abs(state.omega4).max(), rel=1e-6)
    assert found.point_acceleration_max == pytest.approx(state.p.acceleration_magnitude.max(), rel=1e-6)


def test_friction_and_dampers_depend_on_the_sense() -> None:
    """The same linkage and targets, met the other way round: what resists is on the other side."""
    task, linkage = planted_motion(np.random.default_rng(1), poses=4)
    back = replace(task, positions=task.positions[::-1], angles=task.angles[::-1])
    peaks = []
    for each in (task, back):
        problem = Problem(task=each, length_unit="m", dynamics=replace(ACTING, loads=ACTING.loads[:1]))
        peaks.append(over_task(linkage, problem, verify(linkage, each, problem.requirements)).torque_peak)
    assert abs(peaks[0] - peaks[1]) > 1e-3 * max(peaks)
