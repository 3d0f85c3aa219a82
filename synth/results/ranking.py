"""Designs sorted: which is better, which are distinct, which no other beats."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grashof.analysis import Verdict
from grashof.analysis.judge.limits import SLACK
from grashof.problems import Problem
from grashof.problems.values.arrays import BoolArray
from grashof.synth.programme.merit import same_error
from grashof.synth.results.candidate import Candidate
from grashof.synth.theory.distinct import DISTINCT, pick_apart, signature

DIGITS = 9  # decimals of errors (in sizes) and objectives that count; the others are rounding noise


# Nobody would build what is greater (in sizes of the task), turns its driver by less, or comes
# closer to a dead position (rad).
MOST_SIZE, LEAST_TURN, LEAST_TRANSMISSION = 10.0, float(np.radians(5)), float(np.radians(0.1))


# It is ranked as if its error were so many times as great, and its objective worse by this share.
WORSE_ERROR, WORSE_OBJECTIVE = 1.02, 0.01


def impractical(problem: Problem, verdict: Verdict) -> bool:
    """Whether nobody would build it: far too large, a driver that hardly turns, or a dead position met."""
    return bool(
        verdict.size > MOST_SIZE * problem.task.size
        or np.ptp(verdict.theta2) < LEAST_TURN
        or verdict.transmission_min_task < LEAST_TRANSMISSION
    )


def ranking_key(problem: Problem, candidate: Candidate) -> tuple[float, ...]:
    """What designs are sorted by, best first: the one place that says which of two is better.

    The error, none up to `same_error`; the objective; what people build; the smaller size; and
    the dimensions, so that no two designs tie. What nobody would build (`impractical`) counts
    with 1.02 times its least-squares error and an objective 1 % worse.
    """
    avoided = impractical(problem, candidate.verdict)
    error, objective = candidate.error(problem), candidate.objective(problem)
    if avoided:
        objective -= WORSE_OBJECTIVE * abs(objective)
        error *= 1.0 if problem.by_objective else WORSE_ERROR
    bounded = problem.by_objective and not problem.requirements.is_exact(problem.task)
    counted_error = 0.0 if bounded or error <= same_error(problem) * (1 + SLACK) else round(error, DIGITS)
    cost = np.inf if np.isnan(objective) else -round(objective, DIGITS)
    numbers = signature(candidate.linkage).tolist()
    return (counted_error, cost, float(avoided), candidate.verdict.size, *numbers)


def ranked(problem: Problem, candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Distinct candidates, best first; of two that are not distinct the better one stays."""
    best_first = sorted(candidates, key=lambda candidate: ranking_key(problem, candidate))
    return distinct(problem, best_first, DISTINCT, len(best_first))


def distinct(
    problem: Problem, candidates: Sequence[Candidate], least: float, most: int
) -> tuple[Candidate, ...]:
    """At most so many of some candidates that are at least so far apart, in their order."""
    if not candidates:
        return ()
    origin = np.nanmean(problem.task.positions, axis=0)
    signatures = np.array([signature(candidate.linkage, origin) for candidate in candidates])
    picked = pick_apart(signatures, -np.arange(len(candidates), dtype=np.float64), least, most)
    return tuple(candidates[i] for i in picked)


def pareto_optimal(problem: Problem, candidates: tuple[Candidate, ...]) -> BoolArray:
    """Which candidates no other one beats in error, worst transmission, size and torque; shape (n,).

    Errors up to `same_error` count as equal. The torque is the greatest on the task when the
    problem has dynamics; where it is not known it counts as infinite.

    Parameters
    ----------
    problem : Problem
    candidates : tuple of Candidate
    """
    over = problem.requirements.transmission_over
    costs = np.array([
        (
            max(candidate.error(problem), same_error(problem)),
            -candidate.transmission(over),
            candidate.verdict.size,
            np.inf if np.isnan(candidate.torque_peak) else candidate.torque_peak,
        )
        for candidate in candidates
    ]).reshape(-1, 4)  # fmt: skip
    if problem.dynamics is None:
        costs[:, 3] = 0.0
    no_worse = (costs[:, None] <= costs[None]).all(axis=2)
    better = (costs[:, None] < costs[None]).any(axis=2)
    beaten: BoolArray = np.any(no_worse & better, axis=0)
    return ~beaten
