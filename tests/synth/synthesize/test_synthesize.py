"""From a problem to a list: exact, verified, distinct designs, or the obstacle."""

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from known_designs import share_apart

from grashof import load, synthesize
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import (
    Box,
    FourBar,
    MotionTask,
    NoSolutionError,
    Objective,
    Problem,
    ProblemError,
    Requirements,
)
from grashof.synth import Result

LIMITS = {"link_length": (0.3, 8.0), "coupler_arms": (0.3, 8.0)}
HIGH = Box(y=(0.0, np.inf))


def luggage_with(**wanted: Any) -> Problem:
    return Problem(task=load("luggage").task, requirements=Requirements(**(LIMITS | wanted)))


def check_designs(result: Result, judge: Callable[[FourBar, MotionTask], Any], turns: bool = True) -> None:
    """Every design is exact, in order, on one branch, inside the limits, and none is there twice."""
    task = result.problem.task
    for candidate in result.candidates:
        found = judge(candidate.linkage, task)
        assert candidate.verdict.ok
        assert found.exact
        assert found.turns or not turns
        found.check_limits(candidate, 0.02, 1e-6)
    pairs = combinations(result.candidates, 2)
    assert all(share_apart(task, x.linkage, y.linkage) > 0.01 for x, y in pairs)


def test_luggage_gives_twenty_and_more(luggage_result: Result, independent_judge: Any) -> None:
    assert len(luggage_result) >= 20
    assert luggage_result.complete
    assert luggage_result.note == luggage_result.ended == ""
    assert luggage_result.nearest == ()
    check_designs(luggage_result, independent_judge)
    assert all(np.degrees(c.verdict.transmission_min_task) >= 15 - 1e-6 for c in luggage_result.candidates)
    # A choice, not one optimum many times: half of all pairs are farther than 20 % apart.
    task, pairs = luggage_result.problem.task, combinations(luggage_result.candidates, 2)
    shares = [share_apart(task, x.linkage, y.linkage) for x, y in pairs]
    assert np.median(shares) > 0.2


PUBLISHED: dict[str, tuple[float, dict[str, Any]]] = {
    "5": (13.4, {"link_length": (0.3, 5), "coupler_arms": (0, 5)}),
    "8": (22.6, {"link_length": (0.3, 8), "coupler_arms": (0, 8)}),
    "12": (30.1, {"link_length": (0.3, 12), "coupler_arms": (0, 12)}),
    "8, pivots up": (15.7, {"link_length": (0.3, 8), "coupler_arms": (0, 8), "o2": HIGH, "o4": HIGH}),
}


@pytest.mark.quick("5")
@pytest.mark.slow
@pytest.mark.parametrize("limit", PUBLISHED)
def test_best_worst_case_transmission_over_the_turn(limit: str, independent_judge: Any) -> None:
    least, wanted = PUBLISHED[limit]
    result = synthesize(luggage_with(transmission_over="cycle", **wanted), enough=20)
    check_designs(result, independent_judge)
    every = [independent_judge(each.linkage, result.problem.task) for each in result.candidates]
    best = max(every, key=lambda each: each.transmission_cycle)  # that of 12 m links comes last, for its size
    assert best.transmission_cycle >= least
    assert best.lengths.max() <= float(limit.split(",")[0]) + 1e-8
    for candidate in result.candidates:
        for pivot, box in (("o2", wanted.get("o2")), ("o4", wanted.get("o4"))):
            assert box is None or getattr(candidate.linkage, pivot)[1] >= -1e-8


@pytest.mark.slow
def test_best_transmission_over_the_task_of_any_driver(independent_judge: Any) -> None:
    result = synthesize(luggage_with(rotatability="any", link_length=(0.3, 5), coupler_arms=(0, 5)))
    check_designs(result, independent_judge, turns=False)
    assert independent_judge(result.best.linkage, result.problem.task).transmission_task >= 23.7


@pytest.mark.quick("101")
@pytest.mark.usefixtures("small_search")
@pytest.mark.parametrize("seed", [101, 102, 103, 104, 105, 106, 107, 108])
def test_planted_problems_are_solved(seed: int, independent_judge: Any) -> None:
    task, _ = planted_motion(np.random.default_rng(seed), poses=4)
    result = synthesize(Problem(task=task), enough=8)
    assert len(result) >= 1
    check_designs(result, independent_judge)


@pytest.mark.slow
def test_an_objective_of_compactness_gives_small_designs(luggage_result: Result) -> None:
    compact = replace(luggage_result.problem, objective=Objective(transmission=0, compactness=1))
    result = synthesize(compact, enough=20)
    heads = len(result.families)
    sizes = [candidate.verdict.size for candidate in result.candidates]
    assert sizes[:heads] == sorted(sizes[:heads])
    assert sizes[heads:] == sorted(sizes[heads:])
    assert sizes[0] < min(candidate.verdict.size for candidate in luggage_result.candidates) * (1 + 1e-6)


IMPOSSIBLE: dict[str, tuple[str, str, Problem]] = {
    "o2 far away": ("o2", "o2.x from 8 instead of 100", luggage_with(o2=Box((100, 101), (100, 101)))),
    "double-crank": ("rotatability", 'instead of "double-crank"', luggage_with(rotatability="double-crank")),
    "short links": (
        "link_length",
        "link_length up to 3.14 instead of 1.5",
        luggage_with(link_length=(0.3, 1.5)),
    ),
    "ground angle": ("ground_angle_deg", "ground_angle_deg 46.", luggage_with(ground_angle_deg=0)),
    "start angle": ("theta2_start_deg", "theta2_start_deg ", luggage_with(theta2_start_deg=30)),
    "order": (
        "order",
        "order = false",
        Problem(
            task=MotionTask.from_degrees([[5, 4, 0], [2, 3, -5], [1, 0, 0], [3.5, 4, -5]]),
            requirements=Requirements(**LIMITS),
        ),
    ),
}


@pytest.mark.slow
@pytest.mark.quick("order")
@pytest.mark.parametrize("kind", IMPOSSIBLE)
def test_the_requirement_in_the_way_is_named(kind: str, relaxing_only: Callable[..., None]) -> None:
    key, said, problem = IMPOSSIBLE[kind]
    relaxing_only(key)
    result = synthesize(problem, starts=4)
    assert len(result) == 0
    assert result.complete
    assert said in result.note
    kinds = [{defect.requirement for defect in near.verdict.defects} for near in result.nearest]
    assert {key} in kinds
    assert result.counts["verified and distinct"] == 0


def off_required(result: Result, key: str) -> np.ndarray:
    """How far each design is from the angle or the line that is required: rad, or sizes."""
    if key == "o2":
        places = np.array([each.linkage.o2[1] for each in result.candidates])
        return np.abs(places + 3) / result.problem.task.size
    if key == "theta2_start_deg":
        return np.abs(np.array([each.verdict.theta2[0] for each in result.candidates]) - np.radians(75))
    ground = np.array([each.linkage.o4 - each.linkage.o2 for each in result.candidates])
    return np.abs(np.arctan2(ground[:, 1], ground[:, 0]))


@pytest.mark.slow
@pytest.mark.usefixtures("small_search")
@pytest.mark.parametrize(
    "problem",
    [
        Problem(task=load("luggage").task, requirements=Requirements(ground_angle_deg=0)),
        luggage_with(o2=Box(y=(-3, -3))),
        luggage_with(theta2_start_deg=75),
    ],
    ids=["ground_angle_deg", "o2", "theta2_start_deg"],
)
def test_required_angles_and_lines_are_kept(
    problem: Problem, request: pytest.FixtureRequest, independent_judge: Any
) -> None:
    key = request.node.callspec.id
    result = synthesize(problem, enough=5 if key == "ground_angle_deg" else 8)
    assert len(result) > 1
    check_designs(result, independent_judge)
    assert off_required(result, key).max() < 1e-9


def rotation_about(x: float, y: float) -> list[list[float]]:
    turns = (0, 30, 50, 120)
    return [[x + 2 * np.cos(np.radians(t)), y + 2 * np.sin(np.radians(t)), t] for t in turns]


DEGENERATE = {
    "pure translation": ([[0, 0, 10], [1, 0, 10], [2, 1, 10], [0, 3, 370]], "pure translations"),
    "pure rotation": (rotation_about(3, 1), r"pure rotation about \(3, 1\)"),
}


@pytest.mark.quick("pure rotation")
@pytest.mark.usefixtures("small_search")
@pytest.mark.parametrize("kind", DEGENERATE)
def test_degenerate_poses_are_explained(kind: str) -> None:
    rows, why = DEGENERATE[kind]
    result = synthesize(Problem(task=MotionTask.from_degrees(rows)))
    assert len(result) == 0
    with pytest.raises(NoSolutionError, match=f"no design: .*{why}"):
        _ = result.best


def test_equal_poses_are_refused() -> None:
    rows = [[0, 0, 0], [1, 0, 20], [0, 0, 360], [0, 3, 30]]
    with pytest.raises(ProblemError, match=r"\[0\] and .*\[2\] are equal"):
        synthesize(Problem(task=MotionTask.from_degrees(rows)))


def test_counts_add_up(luggage_result: Result) -> None:
    counts = luggage_result.counts
    solves = sum(count for name, count in counts.items() if name.startswith("solver: "))
    ends = ("verified", "no linkage")
    outcomes = sum(count for name, count in counts.items() if name in ends or name.startswith("rejected: "))
    assert solves == outcomes
    assert counts["verified and distinct"] == len(luggage_result)
    assert counts["feasible finds"] > 1000
    assert {"screening", "solving", "total"} <= set(luggage_result.seconds)
