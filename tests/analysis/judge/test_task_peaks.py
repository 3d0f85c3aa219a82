"""Greatest speeds and loads of many designs at once are those of each alone."""

from dataclasses import astuple, replace

import numpy as np
import pytest

from grashof.analysis import verify
from grashof.analysis.forces.joints import Joint, joint_motion
from grashof.analysis.judge.coupler_motion import coupler_motions, curve_distances_of_each
from grashof.analysis.judge.over_task import TORQUE, as_used, each_over_task, motion_ends, task_peaks
from grashof.analysis.judge.planted import random_full_crank, random_slider_crank
from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.problems import DynamicsSpec, Linkage, PathTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.load_specs import LoadSpec
from grashof.problems.values.dynamics.motor import MotorSpec

HEAVY = DynamicsSpec(speed_rpm=40, mass_per_length=2.0, payload=3.0, gravity=(0.0, -9.81))
SOME = 4


@pytest.fixture(scope="module")
def designs() -> list[tuple[Linkage, Verdict]]:
    """Linkages of two kinds, each judged by points of a part of its own curve."""
    rng = np.random.default_rng(17)
    found = []
    for make in (random_full_crank, random_slider_crank) * SOME:
        linkage = make(rng)
        turned = rng.uniform(-3, 3) + np.linspace(0, rng.uniform(1, 5), 4)
        task = PathTask(points=solve_kinematics(linkage, turned).p.position)
        found.append((linkage, verify(linkage, task, Requirements())))
    assert sum(verdict.branch_ok for _, verdict in found) > SOME
    return found


def problem_with(dynamics: DynamicsSpec | None, mechanism: str = "four-bar") -> Problem:
    task = PathTask(points=[(0, 0), (1, 0), (2, 1), (3, 3)])
    return Problem(task=task, length_unit="m", dynamics=dynamics, mechanism=mechanism)


def together(designs: list[tuple[Linkage, Verdict]], problem: Problem) -> FloatArray:
    return task_peaks([linkage for linkage, _ in designs], problem, [verdict for _, verdict in designs])


def every_figure(designs: list[tuple[Linkage, Verdict]], problem: Problem) -> FloatArray:
    linkages, verdicts = zip(*designs, strict=True)
    over = [astuple(each) for each in each_over_task(linkages, problem, verdicts)]
    couplers = [astuple(each) for each in coupler_motions(linkages, problem, verdicts)]
    return np.hstack([over, couplers, curve_distances_of_each(linkages, problem, verdicts)])


def each_alone(designs: list[tuple[Linkage, Verdict]], problem: Problem) -> FloatArray:
    return np.concatenate([together([design], problem) for design in designs])


@pytest.mark.quick("none", "over time")
@pytest.mark.parametrize(
    "dynamics",
    [
        None,
        HEAVY,
        replace(HEAVY, motor=MotorSpec(profile="cycloid")),
        replace(HEAVY, loads=(LoadSpec(3, values=((0, 5, 1), (180, -5, 2), (360, 5, 1)), over="theta2"),)),
        replace(HEAVY, loads=(LoadSpec(3, values=((0, 5, 1), (1, -5, 2), (9, 5, 1)), over="time"),)),
    ],
    ids=["none", "masses", "motor", "over theta2", "over time"],
)
def test_many_at_once_are_as_each_alone(
    designs: list[tuple[Linkage, Verdict]], dynamics: DynamicsSpec | None
) -> None:
    """To the last digit: the figures of a design must not depend on its list."""
    problem = problem_with(dynamics)
    found = every_figure(designs, problem)
    alone = [every_figure([design], problem) for design in designs]
    np.testing.assert_array_equal(found, np.concatenate(alone))
    assert (
        np.isfinite(found[:, [1, TORQUE, -3, -1]]).sum(axis=0) > SOME
    ).all()  # speed, fit, coupler, distance
    assert np.isnan(together(designs, problem)[:, TORQUE:]).all() == (dynamics is None)


def test_the_torque_alone_is_that_with_the_rest(designs: list[tuple[Linkage, Verdict]]) -> None:
    problem, (linkages, verdicts) = problem_with(HEAVY), zip(*designs, strict=True)
    alone = task_peaks(linkages, problem, verdicts, torque_alone=True)
    np.testing.assert_array_equal(alone[:, TORQUE], together(designs, problem)[:, TORQUE])
    assert np.isnan(np.delete(alone, TORQUE, axis=1)).all()


def test_a_slide_beyond_its_load_costs_the_others_nothing(designs: list[tuple[Linkage, Verdict]]) -> None:
    sliding = [
        design for design in designs if design[0].mechanism.word == "slider-crank" and design[1].branch_ok
    ]
    travels = []
    for linkage, verdict in sliding:
        ends = motion_ends(problem_with(None).task, verdict)
        state = solve_kinematics(as_used(linkage, verdict), np.linspace(*ends, 181))
        travels.append(np.abs(joint_motion(state, Joint.O4)[0]).max())
    reach = float(np.median(travels)) * 1.001
    over_travel = LoadSpec(4, values=((-reach, 1.0, 0.0), (reach, 4.0, 0.0)), over="travel")
    problem = problem_with(replace(HEAVY, loads=(over_travel,)), "slider-crank")
    found = together(sliding, problem)
    np.testing.assert_array_equal(found, each_alone(sliding, problem))
    beyond = np.array(travels) > reach
    assert 0 < beyond.sum() < len(beyond)
    np.testing.assert_array_equal(np.isnan(found[:, TORQUE:]).all(axis=1), beyond)
    assert np.isfinite(found[:, :3]).all()
