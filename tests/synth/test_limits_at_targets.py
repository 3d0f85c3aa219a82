"""Designs found under limits at single targets keep them; files state them and are written back."""

from dataclasses import replace

import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import solve_position
from grashof.analysis.judge.at_targets import past_toggle
from grashof.problems import (
    Box,
    MotionTask,
    PathTask,
    Problem,
    Requirements,
    Rotatability,
    TargetLimits,
    Task,
)
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml

THREE = MotionTask([[0, 0], [2, 1.5], [3, 3]], np.radians([0, 25, 60]))
FIVE = PathTask([[0, 0], [1, 0.4], [2, 0.5], [3, 0.2], [3.6, -0.3]])
TOGGLE = TargetLimits(targets=[3], past_deg=(2, 5))


@pytest.mark.parametrize(
    ("task", "last"), [pytest.param(THREE, 3, marks=pytest.mark.slow), (FIVE, 5)], ids=["poses", "points"]
)
def test_a_toggle_closes_past_its_position(task: Task, last: int) -> None:
    at = (TargetLimits(targets=[last], past_deg=(2, 5)),)
    wanted = Requirements(rotatability=Rotatability.ANY, at=at)
    result = synthesize(Problem(task=task, requirements=wanted), seed=0, enough=5, starts=20)
    assert len(result) > 0
    for each in result.candidates:
        assert 2 <= round(np.degrees(past_toggle(each.linkage, each.verdict, last - 1)), 6) <= 5


@pytest.mark.slow
def test_a_place_at_one_target_alone_binds_there() -> None:
    free = replace(load("luggage"), requirements=Requirements(at=()))
    first = synthesize(free, seed=0, enough=5).best
    a = solve_position(first.linkage, first.verdict.theta2).a
    box = Box(x=(float(a[0, 0]) + 0.3, np.inf))
    bound = replace(free, requirements=Requirements(at=(TargetLimits(targets=[1], a=box),)))
    best = synthesize(bound, seed=0, enough=5).best
    there = solve_position(best.linkage, best.verdict.theta2).a
    assert there[0, 0] >= box.x[0] - 1e-9


def test_files_state_limits_at_targets() -> None:
    at = (TOGGLE, TargetLimits(targets=[1, 2], b=Box((0, 1), (2, 3)), transmission_min_deg=30))
    problem = Problem(task=THREE, requirements=Requirements(at=at))
    again = problem_of(problem_toml(problem), "again.toml", "again")
    assert again.requirements == problem.requirements
