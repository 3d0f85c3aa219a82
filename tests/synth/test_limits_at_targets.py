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
    Region,
    Requirements,
    Rotatability,
    TargetLimits,
    Task,
)
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.synth import Candidate

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
        verdict = each.verdict
        past = np.degrees(past_toggle(each.linkage, verdict.theta2, verdict.assembly, last - 1))
        assert 2 <= round(past, 6) <= 5


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


@pytest.mark.slow
def test_a_concave_polygon_at_one_target_is_kept() -> None:
    """Where the hull is larger, all designs ended in the notch, and were refused."""
    task = MotionTask([[0, 0], [2, 1.5], [4, 2], [5, 3.5], [5, 5]], np.radians([0, 15, 40, 60, 95]))
    notched = Region(inside=[[-9, -9], [9, -9], [9, 9], [0, 2], [-9, 9]])
    wanted = Requirements(exact=False, rotatability="any", at=(TargetLimits(targets=[5], b=notched),))
    result = synthesize(Problem(task=task, requirements=wanted), seed=0)
    assert min(each.values["error"] for each in result.candidates) < 0.14
    for each in result.candidates:
        (theta2,), (assembly,) = each.verdict.theta2[4:], each.verdict.assembly[4:]
        (x, y) = solve_position(each.linkage, theta2, assembly).b
        assert max(abs(x), abs(y)) <= 9 + 1e-9
        assert y <= 2 + abs(x) * 7 / 9 + 1e-9


def direction(design: Candidate, theta2: float, target: int) -> float:
    """Of the coupler, by the intersection of circles about A and O4."""
    linkage = design.linkage
    a = complex(*linkage.o2) + linkage.r2 * np.exp(1j * theta2)
    way = complex(*linkage.o4) - a
    cosine = (linkage.r3**2 + abs(way) ** 2 - linkage.r4**2) / (2 * linkage.r3 * abs(way))
    return float(np.angle(way) + design.verdict.assembly[target] * np.arccos(cosine))


@pytest.mark.slow
def test_a_fixed_distance_and_ranges_of_the_coupler_at_single_targets_are_kept() -> None:
    at = (
        TargetLimits(targets=[3], distances={"a-o4": 2.5}),
        TargetLimits(targets=[2], coupler_angle_deg=(130, 131), coupler_rate=(0.8, 0.9)),
    )
    wanted = Requirements(rotatability=Rotatability.ANY, at=at)
    result = synthesize(Problem(task=THREE, requirements=wanted), seed=0, enough=5, starts=40)
    assert len(result) > 0
    for each in result.candidates:
        linkage, (_, second, third) = each.linkage, each.verdict.theta2.tolist()
        a = complex(*linkage.o2) + linkage.r2 * np.exp(1j * third)
        assert abs(a - complex(*linkage.o4)) == pytest.approx(2.5, abs=1e-8)
        angle = np.degrees(direction(each, second, 1)) % 360
        rate = (direction(each, second + 1e-6, 1) - direction(each, second - 1e-6, 1)) / 2e-6
        assert 130 - 1e-6 <= angle <= 131 + 1e-6
        assert 0.8 - 1e-6 <= rate <= 0.9 + 1e-6


def test_files_state_limits_at_targets() -> None:
    at = (TOGGLE, TargetLimits(targets=[1, 2], b=Box((0, 1), (2, 3)), transmission_min_deg=30))
    problem = Problem(task=THREE, requirements=Requirements(at=at))
    again = problem_of(problem_toml(problem), "again.toml", "again")
    assert again.requirements == problem.requirements
