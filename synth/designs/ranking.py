"""Designs sorted: which is better, which are distinct, which no other beats."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grashof.analysis.judge.missed_limits import SLACK
from grashof.problems import Problem
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import Quantity
from grashof.problems.values.specs.problem import SMALLEST
from grashof.synth.designs.candidate import Candidate, same_error
from grashof.synth.theory.distinct import DISTINCT, pick_apart, signature, signatures

BLOCK = 256  # designs compared with all others at once
# Digits that count, the others being rounding noise: of errors in sizes and of sizes, of objectives (a right
# angle is 1, so that the last one is 1e-6 deg), and of quantities that an engineer distinguishes.
DIGITS, _OBJECTIVE, _SHOWN = 9, 8, 6
DEGREES = 1e-6  # up to which transmission angles count as equal


def ranking_key(problem: Problem, candidate: Candidate) -> tuple[float, ...]:
    """The sort key of designs, best first: the one place that decides which of two is better.

    The error, zero up to `same_error`; the objective; the mechanical advantage where the transmission angle
    is a right angle, as it always is at a slide through O4; the smaller size; and the dimensions, so that no
    two designs tie. Values that differ by rounding alone tie, so that two processors rank alike.
    """
    error, objective = candidate.error(problem), candidate.objective(problem)
    bounded = problem.by_objective and not problem.requirements.is_exact(problem.task)
    counted_error = 0.0 if bounded or error <= same_error(problem) * (1 + SLACK) else round(error, DIGITS)
    upright = np.degrees(candidate.verdict.transmission_min_task) > 90 - DEGREES
    if upright and problem.objective == SMALLEST:  # which only leads the search
        objective = 1.0
    advantage = _rounded(candidate.values["mechanical_advantage"], _SHOWN) if upright else 0.0
    numbers = [_rounded(float(number), _SHOWN) for number in signature(candidate.linkage)]
    size = _rounded(candidate.verdict.size, DIGITS)
    return (counted_error, -round(objective, _OBJECTIVE), -np.nan_to_num(advantage), size, *numbers)


def _rounded(value: float, digits: int) -> float:
    """A value to some significant digits."""
    return float(f"{value:.{digits}g}")


def ranked(problem: Problem, candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Distinct candidates, best first; of two that are not distinct the better one stays."""
    best_first = sorted(candidates, key=lambda candidate: ranking_key(problem, candidate))
    return distinct(problem, best_first, DISTINCT, len(best_first))


def distinct(
    problem: Problem, candidates: Sequence[Candidate], least: float, most: int
) -> tuple[Candidate, ...]:
    """At most `most` candidates, each at least `least` from the others, in their order."""
    if not candidates:
        return ()
    every = signatures(problem.task, [candidate.linkage for candidate in candidates])
    picked = pick_apart(every, -np.arange(len(candidates), dtype=np.float64), least, most)
    return tuple(candidates[i] for i in picked)


def pareto_goals(problem: Problem) -> list[Quantity]:
    """The goals of the Pareto mark besides the error: transmission, size, torque, and weighted quantities."""
    keys = ["transmission", "size", *(["torque_peak"] if problem.dynamics is not None else [])]
    usual = [problem.requirements.as_required(QUANTITIES[key]) for key in keys]
    return list(dict.fromkeys([*usual, *(goal for goal, _ in problem.goals)]))


def pareto_optimal(problem: Problem, candidates: Sequence[Candidate]) -> BoolArray:
    """Whether each candidate (n,) is Pareto-optimal in error, from `same_error` up, and `pareto_goals`."""
    goals = pareto_goals(problem)
    costs = np.array([
        (
            max(candidate.error(problem), same_error(problem)),
            candidate.own_objective or 0.0,
            *(-goal.better * candidate.values[goal.key] for goal in goals),
        )
        for candidate in candidates
    ]).reshape(-1, 2 + len(goals))  # fmt: skip
    costs[np.isnan(costs)] = np.inf  # a missing value is worst
    return ~_beaten(costs)


def _beaten(costs: FloatArray) -> BoolArray:
    """Whether another row of costs (n, C) is no worse in any and better in some; shape (n,)."""
    beaten: BoolArray = np.zeros(len(costs), dtype=bool)
    for first in range(0, len(costs), BLOCK):  # all pairs at once take memory with the square of the list
        some = costs[first : first + BLOCK, None]
        no_worse, better = (some <= costs).all(axis=2), (some < costs).any(axis=2)
        beaten |= (no_worse & better).any(axis=0)
    return beaten
