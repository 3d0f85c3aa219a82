"""Torque and forces of designs under everything that acts, against dense samples in time."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import (
    DriverLaw,
    Verdict,
    inverse_dynamics,
    over_task,
    solve_kinematics,
    solve_position,
    stated_loads,
    stated_masses,
    verify,
)
from grashof.analysis.forces.joints import joints_of
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.planted import planted_motion
from grashof.analysis.judge.sampled_motion import motion_ends
from grashof.problems import DynamicsSpec, InvertedSliderCrank, PathTask, Problem, Requirements, SliderCrank
from grashof.problems.values.dynamics.acting import DamperSpec, FrictionSpec, LoadSpec, Place, SpringSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.linkages.linkage import Linkage

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


ENGINE = SliderCrank((0.3, 0), 0.4, 1.5, 0.2, 0.7, (0.5, 0.2))
SHAPER = InvertedSliderCrank((0, 0), (0, -1.6), 0.6, 0.2, (2.5, 0.3))
SPEC = DynamicsSpec(
    masses=(1.0, 2.0, 3.0),
    inertias=(0.1, 0.3, 0.2),
    payload=0.5,
    speed_rpm=25.0,
    gravity=(1.0, -9.0),
    loads=(LoadSpec(4, values=((-5, 3, 1), (1.2, -6, 2), (5, 2, 2)), over="travel"),),
    friction=FrictionSpec(viscous=0.2, slide_viscous=0.3, slide_force=0.1),
)


@pytest.mark.quick("1-linkage0-1.0", "1-linkage1-1.0", "-1-linkage0-0.001", "-1-linkage1-0.001")
@pytest.mark.parametrize("metre", [1.0, 1e-3])
@pytest.mark.parametrize("linkage", [ENGINE, SHAPER])
@pytest.mark.parametrize("sense", [1, -1])
def test_figures_are_those_of_dense_samples(linkage: Linkage, sense: int, metre: float) -> None:
    own, problem, verdict = judged(linkage, sense, metre)
    spec, task = problem.dynamics, problem.task
    assert spec is not None
    found = over_task(own, problem, verdict)
    start, end = motion_ends(task, verdict)
    assert np.sign(end - start) == sense
    theta2 = np.linspace(start, end, 20_001)
    state = solve_kinematics(own, theta2, sense * spec.omega2)
    dynamics = inverse_dynamics(state, stated_masses(own, spec, metre), stated_loads(spec, metre))
    torque = dynamics.torque * metre**2
    force = max(float(dynamics.joint_force(joint).max()) for joint in joints_of(own)) * metre
    assert found.torque_peak == pytest.approx(np.abs(torque).max(), rel=1e-6)
    assert found.torque_rms == pytest.approx(np.sqrt((torque**2).mean()), rel=1e-3)
    assert found.joint_force_peak == pytest.approx(force, rel=1e-6)
    assert Values(own, verdict, problem)["torque_peak"] == found.torque_peak
    if metre != 1:  # the same machine in another unit
        whole = over_task(*judged(linkage, sense, 1.0))
        assert found.torque_peak == pytest.approx(whole.torque_peak, rel=1e-8)


def judged(linkage: Linkage, sense: int, metre: float) -> tuple[Linkage, Problem, Verdict]:
    """A task of points that the linkage passes, in metres or millimetres, and the verdict on it."""
    own = linkage.scaled(1 / metre, np.zeros(2))
    task = PathTask(solve_position(own, 0.4 + sense * np.array([0.0, 0.9, 2.1, 3.0])).p)
    wanted = Requirements(rotatability="any")
    unit, spec = ("m", SPEC) if metre == 1 else ("mm", in_millimetres(SPEC))
    word = own.mechanism.word
    problem = Problem(task=task, requirements=wanted, length_unit=unit, dynamics=spec, mechanism=word)
    return own, problem, verify(own, task, wanted)


def in_millimetres(spec: DynamicsSpec) -> DynamicsSpec:
    (load,) = spec.loads
    rows = tuple((place * 1e3, *values) for place, *values in load.values or ())
    return DynamicsSpec(
        masses=spec.masses,
        inertias=tuple(1e6 * each for each in spec.inertias or ()),  # type: ignore[arg-type]
        payload=spec.payload,
        speed_rpm=spec.speed_rpm,
        gravity=spec.gravity,
        loads=(LoadSpec(4, values=rows, over="travel"),),
        friction=spec.friction,
    )
