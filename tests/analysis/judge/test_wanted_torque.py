"""Deviations from a wanted torque: by virtual work, in both senses of the driver, at every kind of place."""

from dataclasses import replace

import numpy as np
import pytest
from loaded_linkages import planted_path_torque, planted_torque

from grashof.analysis import solve_position, verify
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.wanted_torque import places_of, torque_misses
from grashof.problems import DynamicsSpec, MotionTask, Problem, Requirements, WantedTorque
from grashof.problems.values.dynamics.motor import MotorSpec

GRAVITY, MASS = 9.80665, 20.0
SEEDS = [0, 1, 4, 5]


def weighed(seed: int, over: str = "share", **others: object) -> tuple[Problem, object]:
    """A planted task with a payload alone, turned slowly."""
    problem, linkage = planted_torque(seed, 4)
    spec = DynamicsSpec(payload=MASS, gravity=(0, -GRAVITY), speed_rpm=1e-4, **others)  # type: ignore[arg-type]
    places = {"share": (0.1, 0.5, 0.9), "target": (1, 2, 4), "driver": (5.0, 20.0, 60.0)}[over]
    wanted = Requirements(driver_rotation_deg=(60, 360)) if over == "driver" else problem.requirements
    torque = WantedTorque([(place, 3.0) for place in places], over)
    return replace(problem, dynamics=spec, torque=torque, requirements=wanted), linkage


@pytest.mark.parametrize("over", ["share", "target", "driver"])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_weight_takes_the_slope_of_its_height(seed: int, over: str) -> None:
    problem, linkage = weighed(seed, over)
    verdict = verify(linkage, problem.task, problem.requirements, problem=problem)  # type: ignore[arg-type]
    theta2 = places_of(problem.torque, problem, verdict)  # type: ignore[arg-type]
    start, end = verdict.theta2[[0, -1]]
    expected = {
        "share": start + (end - start) * np.array([0.1, 0.5, 0.9]),
        "target": verdict.theta2[[0, 1, 3]],
        "driver": start + verdict.direction * np.radians([5, 20, 60]),
    }[over]
    np.testing.assert_allclose(theta2, expected, atol=1e-12)
    step = 1e-5
    ahead, behind = (
        solve_position(linkage, theta2 + by, verdict.assembly[0]).p[:, 1] for by in (step, -step)
    )  # type: ignore[arg-type]
    torque = MASS * GRAVITY * (ahead - behind) / (2 * step) * verdict.direction
    found = torque_misses(linkage, problem, verdict)  # type: ignore[arg-type]
    np.testing.assert_allclose(found, torque - 3.0, atol=1e-6 * np.abs(torque).max())


def test_both_senses_occur_in_these_tasks() -> None:
    problems = (weighed(seed) for seed in SEEDS)
    senses = {verify(each, problem.task, problem.requirements).direction for problem, each in problems}  # type: ignore[arg-type]
    assert senses == {1, -1}


def test_shares_are_those_of_the_way_whatever_the_profile_of_the_motor() -> None:
    steady, linkage = weighed(1)
    resting, _ = weighed(1, motor=MotorSpec(profile="cycloid"))
    verdict = verify(linkage, steady.task, steady.requirements)  # type: ignore[arg-type]
    slow = [torque_misses(linkage, problem, verdict) for problem in (steady, resting)]  # type: ignore[arg-type]
    np.testing.assert_allclose(slow[0], slow[1], rtol=1e-6)


def test_values_are_the_root_mean_square_and_the_greatest() -> None:
    problem, linkage = weighed(0)
    verdict = verify(linkage, problem.task, problem.requirements, problem=problem)  # type: ignore[arg-type]
    misses = torque_misses(linkage, problem, verdict)  # type: ignore[arg-type]
    values = Values(linkage, verdict, problem)  # type: ignore[arg-type]
    assert values["torque_deviation"] == pytest.approx(np.sqrt((misses**2).sum() / 3), rel=1e-12)
    assert values["torque_deviation_max"] == pytest.approx(max(misses.max(), -misses.min()), rel=1e-12)


def test_limits_missed_are_defects() -> None:
    problem, linkage = weighed(0)
    found = np.abs(torque_misses(linkage, problem, verify(linkage, problem.task, problem.requirements)))  # type: ignore[arg-type]
    wanted = replace(problem.requirements, torque_deviation_max=(0.0, 0.9 * float(found.max())))
    limited = replace(problem, requirements=wanted)
    (defect,) = verify(linkage, limited.task, wanted, problem=limited).defects  # type: ignore[arg-type]
    assert defect.requirement == "torque_deviation_max"
    assert defect.found == pytest.approx(found.max())


def test_no_motion_has_no_deviation() -> None:
    problem, linkage = weighed(0)
    verdict = replace(verify(linkage, problem.task, problem.requirements), branch_ok=False)  # type: ignore[arg-type]
    assert np.isnan(torque_misses(linkage, problem, verdict)).all()  # type: ignore[arg-type]


def test_the_weight_counts_as_an_error_of_position() -> None:
    problem, linkage = planted_path_torque(3, 8, weight=0.5)
    torque = problem.torque
    assert torque is not None
    off = WantedTorque([(place, value + 2.0) for place, value in torque.wanted], "share", 0.5)
    missed = replace(problem, torque=off)
    verdict = verify(linkage, missed.task, missed.requirements, problem=missed)
    error = Values(linkage, verdict, missed)["error"]
    assert error == pytest.approx(0.5 * missed.task.size * 2.0 / off.greatest, rel=1e-6)
    assert verdict.error_rms < 1e-6 * missed.task.size


def test_a_wanted_torque_needs_a_problem_that_has_one() -> None:
    problem, linkage = weighed(0)
    plain = Problem(task=MotionTask(problem.task.positions, problem.task.angles))
    with pytest.raises(TypeError):
        torque_misses(linkage, plain, verify(linkage, plain.task, plain.requirements))  # type: ignore[arg-type]
