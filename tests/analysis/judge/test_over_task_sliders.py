"""Torque and joint forces of slider kinds in their task motion, against dense sampling."""

import numpy as np
import pytest

from grashof.analysis import (
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
from grashof.analysis.judge.sampled_motion import motion_ends
from grashof.problems import DynamicsSpec, InvertedSliderCrank, PathTask, Problem, Requirements, SliderCrank
from grashof.problems.values.dynamics.acting import FrictionSpec, LoadSpec
from grashof.problems.values.linkages.linkage import Linkage

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
    own = linkage.scaled(1 / metre, np.zeros(2))
    spec = SPEC if metre == 1 else in_millimetres(SPEC)
    task = PathTask(solve_position(own, 0.4 + sense * np.array([0.0, 0.9, 2.1, 3.0])).p)
    wanted = Requirements(rotatability="any")
    problem = Problem(
        task=task, requirements=wanted, length_unit="m" if metre == 1 else "mm", dynamics=spec,
        mechanism=own.mechanism.word,
    )  # fmt: skip
    verdict = verify(own, task, wanted)
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
        whole = over_task(linkage, metric(problem, linkage, sense), verify(linkage, *asked(linkage, sense)))
        assert found.torque_peak == pytest.approx(whole.torque_peak, rel=1e-8)


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


def asked(linkage: Linkage, sense: int) -> tuple[PathTask, Requirements]:
    points = solve_position(linkage, 0.4 + sense * np.array([0.0, 0.9, 2.1, 3.0])).p
    return PathTask(points), Requirements(rotatability="any")


def metric(problem: Problem, linkage: Linkage, sense: int) -> Problem:
    task, wanted = asked(linkage, sense)
    return Problem(
        task=task, requirements=wanted, length_unit="m", dynamics=SPEC, mechanism=problem.mechanism
    )
