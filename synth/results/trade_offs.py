"""A list to choose from: what a little more error buys, and what the objective makes of zones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import Objective, Problem
from grashof.problems.values.arrays import FloatArray
from grashof.synth.programme.merit import same_error
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Start
from grashof.synth.results.attempt import Attempt
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.larger_zones import shares
from grashof.synth.results.ledger import Ledger
from grashof.synth.results.ranking import pareto_optimal, ranked
from grashof.synth.results.workers import Solver
from grashof.synth.theory.distinct import pick_apart, signature

FACTORS = (1.02, 1.2, 1.5, 2.0)  # times the least error: so much is offered for other virtues
GOALS = {"mu": Objective(), "size": Objective(transmission=0.0, compactness=1.0)}
NEAR = 1.6  # times the error that is allowed: least-squares designs up to there are begun from
SEEDS, MOST_SEEDS = 4, 12  # of them, for each goal; where the problem's objective decides
APART = 0.05  # share: seeds that are closer are one
SLACK = 1e-6  # share of the error: rounding
ALIKE = 5  # decimals up to which mirror images have the same transmission and size
COMPROMISE = "compromise"  # best at nothing alone, but no other design is better in every goal


@dataclass(frozen=True, slots=True)
class Chosen:
    """Designs of a list, and what was solved for them.

    Parameters
    ----------
    designs : tuple of Candidate
    rejected : list of Attempt
    solved : int
    """

    designs: tuple[Candidate, ...]
    rejected: list[Attempt]
    solved: int


def offered(scaled: ScaledProblem, ledger: Ledger, solve: Solver, ended: Callable[[], bool]) -> Chosen:
    """Beside the least error: within some times of it the best transmission and the smallest size.

    Parameters
    ----------
    scaled : ScaledProblem
    ledger : Ledger
        Of the search for the least error.
    solve : callable
        Attempts from starts.
    ended : callable
        Asked between solves.

    Returns
    -------
    Chosen
        Of all designs those that no other one beats in every goal, up to twice the least error.
    """
    problem, least = scaled.problem, max(ledger.least, same_error(scaled.problem))
    seeds = _seeds(problem, ledger.verified, FACTORS[-1] * least, SEEDS)
    every, attempts = list(ledger.verified), list[Attempt]()
    latest = dict[str, list[Candidate]]({goal: [] for goal in GOALS})
    factors = FACTORS if ledger.least > same_error(problem) else FACTORS[:1]
    there_and_back = (*factors, *factors[-2::-1])  # what much error allows may lead to more at little, too
    for before, factor in zip((0.0, *there_and_back), there_and_back, strict=False):
        if ended():
            break
        new = [one for one in seeds if before * least < _error(problem, one) <= factor * least]
        begun = [
            (goal, _under(scaled, one, objective, most_error=factor * least))
            for goal, objective in GOALS.items()
            for one in (*latest[goal], *new)
        ]
        made = solve(scaled, [start for _, start in begun], ledger.solved + len(attempts))
        attempts += made
        for goal, objective in GOALS.items():
            good = [
                each
                for (mine, _), one in zip(begun, made, strict=True)
                if mine == goal and one.candidate is not None and one.candidate.verdict.ok
                for each in (one.candidate, *one.cognates)
            ]
            every += good
            valued = replace(problem, requirements=replace(problem.requirements, error_factor=factor))
            valued = replace(valued, objective=objective)
            most = factor * least * (1 + SLACK)
            within = [one for one in (*good, *latest[goal]) if _error(problem, one) <= most]
            latest[goal] = list(ranked(valued, within)[:1]) or latest[goal]
    return Chosen(_worth_choosing(problem, every, least), _rejected(attempts), len(attempts))


def of_use(scaled: ScaledProblem) -> float:
    """Up to which error a design is of use where zones are allowed, root mean square, sizes."""
    if scaled.zones is None:
        return 0.0
    zones = np.where(np.isfinite(scaled.zones), scaled.zones, 0.0)
    square = (scaled.weights * zones[0] ** 2 + scaled.turn_weights * zones[1] ** 2).sum()
    return float(np.sqrt(square / len(scaled.targets)))


def decided(
    scaled: ScaledProblem,
    found: Sequence[Candidate],
    least: float,
    first: int,
    effort: float,
    solve: Solver,
    ended: Callable[[], bool],
) -> Chosen:
    """Where errors are allowed, the best designs by the problem's objective.

    Parameters
    ----------
    scaled : ScaledProblem
        Of the problem with its zones, or its ``error_factor``.
    found : sequence of Candidate
        Designs of the search without: exact ones, or of least squares.
    least : float
        The least error among them, sizes.
    first : int
        Number of the first solve.
    effort : float
        Of the search: more begins from more designs.
    solve : callable
        Attempts from starts.
    ended : callable
        Asked between solves.

    Returns
    -------
    Chosen
    """
    problem, factor = scaled.problem, scaled.problem.requirements.error_factor
    most = np.inf if factor is None else factor * max(least, same_error(problem))
    allowed = most if factor is not None else max(of_use(scaled), least)
    seeds = _seeds(problem, found, NEAR * allowed, round(MOST_SEEDS * max(1.0, effort)))
    starts = [
        _under(scaled, one, problem.objective, most_error=most, zoned=scaled.zones is not None)
        for one in seeds
    ]
    attempts = [] if ended() else solve(scaled, starts, first)
    solved = len(attempts)
    again = [_judged(scaled, one, most) for one in found]
    good = [one for one in again if one.verdict.ok]
    for one in attempts:
        if one.candidate is not None and one.candidate.verdict.ok:
            good += [
                one.candidate,
                *(each for each in one.cognates if _judged(scaled, each, most).verdict.ok),
            ]
    rejected = _rejected(attempts)
    if not good and scaled.zones is not None and not ended():  # how large the zones would have to be
        relaxed = [replace(start, relaxed=("within",)) for start in starts]
        lack = min((max(shares(problem, one.verdict)) for one in again), default=1.0)
        larger = replace(scaled, zones=scaled.zones * max(1.0, lack / 2))
        made = solve(larger, relaxed, first + solved)
        made += [Attempt("", one) for one in again]
        good = [one.candidate for one in made if one.candidate is not None and one.candidate.verdict.ok]
        rejected, solved = _rejected(made) + rejected, solved + len(starts)
    return Chosen(ranked(problem, good), rejected, solved)


def _judged(scaled: ScaledProblem, candidate: Candidate, most_error: float) -> Candidate:
    """A design judged by the problem as it is asked."""
    task = scaled.problem.task
    square = len(task) * (most_error * task.size) ** 2
    return candidate.judged(scaled.problem, scaled.constraints, most_square=square)


def _under(
    scaled: ScaledProblem,
    candidate: Candidate,
    objective: Objective,
    *,
    most_error: float,
    zoned: bool = False,
) -> Start:
    """A start at a design, from which the objective decides under a bound of the error."""
    start = Start.of_linkage(scaled, candidate.linkage, candidate.verdict)
    return replace(start, objective=objective, most_error=most_error, zoned=zoned)


def _seeds(problem: Problem, found: Sequence[Candidate], most: float, count: int) -> list[Candidate]:
    """Designs up to some error, or all if none are, that are well apart, the least error first."""
    every = sorted(found, key=lambda one: (_error(problem, one), one.id))
    near = [one for one in every if _error(problem, one) <= most] or every
    if not near:
        return []
    origin = np.nanmean(problem.task.positions, axis=0)
    signatures: FloatArray = np.array([signature(one.linkage, origin) for one in near])
    picked = pick_apart(signatures, -np.arange(len(near), dtype=np.float64), APART, count)
    return [near[k] for k in picked]


def _error(problem: Problem, candidate: Candidate) -> float:
    return float(np.sqrt(candidate.verdict.square / len(problem.task))) / problem.task.size


def _rejected(attempts: list[Attempt]) -> list[Attempt]:
    return [one for one in attempts if one.candidate is None or not one.candidate.verdict.ok]


def _worth_choosing(problem: Problem, every: list[Candidate], least: float) -> tuple[Candidate, ...]:
    """What no other design beats, up to twice the least error, each with what it is best at."""
    near = [one for one in every if _error(problem, one) <= FACTORS[-1] * least * (1 + SLACK)]
    distinct = ranked(problem, near)
    front = pareto_optimal(problem, distinct)
    kept = [one for one, best in zip(distinct, front, strict=True) if best]
    words: dict[int, list[str]] = {k: [] for k in range(len(kept))}
    if kept:  # the first of the list may be another one, if nobody would build it
        words[min(words, key=lambda k: round(_error(problem, kept[k]), ALIKE + 1))].append("least error")
    values = {
        "best mu": [-round(one.values["transmission"], ALIKE) for one in kept],
        "smallest": [round(one.verdict.size / problem.task.size, ALIKE) for one in kept],
    }
    for factor in FACTORS[::-1]:
        within = [k for k, one in enumerate(kept) if _error(problem, one) <= factor * least * (1 + SLACK)]
        for goal, value in values.items():
            best = min(within, key=value.__getitem__, default=None)
            if best is not None and not any(text.startswith(goal) for text in words[best]):
                words[best].append(f"{goal} within {factor:g} times")
    return tuple(replace(one, best_at="; ".join(words[k]) or COMPROMISE) for k, one in enumerate(kept))
