"""A least-squares list to choose from: better transmission or size for slightly more error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import Objective, Problem
from grashof.synth.designs.candidate import SAME_ERROR, Candidate, same_error
from grashof.synth.designs.ranking import distinct, pareto_optimal, ranked
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.surrogate import Surrogate, on_all_targets
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.ledger import EXACT_ERROR, Ledger
from grashof.synth.search.run import Run
from grashof.synth.starts.coupler_search import leaves_freedom

FACTORS = (1.02, 1.2, 1.5, 2.0)  # times the least error, traded for transmission and size
GOALS = {"mu": Objective(), "size": Objective(transmission=0.0, compactness=1.0)}
SEEDS = 4  # designs from which solves begin, for each goal
MET = 1e-10  # sizes: rounding
APART = 0.05  # share: seeds that are closer are one
SLACK = 1e-6  # share of the error: rounding
ALIKE = 5  # decimals up to which mirror images have the same transmission and size
LEAST = "least error"
COMPROMISE = "compromise"  # best at nothing alone, but no other design is better in every goal


@dataclass(frozen=True, slots=True)
class Chosen:
    """Designs of a list, the designs rejected, and the number of solves."""

    designs: tuple[Candidate, ...]
    rejected: list[Attempt]
    solved: int


def trade_offs(scaled: ScaledProblem, ledger: Ledger, run: Run) -> Chosen:
    """The least error, and within some times of it the best transmission and the smallest size."""
    problem = scaled.problem
    exact = ledger.least <= EXACT_ERROR and same_error(problem) <= SAME_ERROR
    if exact and not leaves_freedom(scaled):  # all targets met: nothing to trade
        met = [one for one in ledger.verified if _error(problem, one) <= max(ledger.least, MET)]
        return Chosen(ranked(problem, met), [], 0)
    times = FACTORS[-1] * float(np.sqrt(len(problem.task)))
    least = max(ledger.least, same_error(problem) / times)  # where all targets are met to `same_error`
    seeds = seeds_of(problem, ledger.verified, FACTORS[-1] * least, SEEDS)
    surrogate = Surrogate.of(scaled, seeds[0], ledger.least) if seeds else Surrogate(scaled)
    begun_from = [(_error(problem, one), surrogate.taken(one)) for one in seeds]
    found, attempts, latest = list[Candidate](), list[Attempt](), dict[str, list[Candidate]]()
    factors = FACTORS if ledger.least > same_error(problem) else FACTORS[:1]  # exact but for rounding
    there_and_back = (*factors, *factors[-2::-1])  # designs of much error may lead to better ones of little
    for before, factor in zip((0.0, *there_and_back), there_and_back, strict=False):
        if run.ended():
            break
        new = [one for error, one in begun_from if before * least < error <= factor * least]
        most = surrogate.most_error(factor * least, problem.task.size)
        begun = [
            (goal, started_at(surrogate.scaled, one, objective, most_error=most))
            for goal, objective in GOALS.items()
            for one in (*latest.get(goal, ()), *new)
        ]
        made = run.solve(surrogate.scaled, [start for _, start in begun], ledger.solved + len(attempts))
        attempts += made
        for goal in GOALS:
            mine = zip(begun, made, strict=True)
            good = [each for (aim, _), one in mine if aim == goal for each in one.verified]
            every = (*good, *latest.get(goal, ()))
            latest[goal] = _best_at(surrogate, goal, every, factor, most) or latest.get(goal, [])
            found += good if surrogate.is_itself else latest[goal]
    if exact:  # the freedom that targets leave has been used; back onto them
        nearly = [] if run.ended() else [Start.of_linkage(scaled, one.linkage, one.verdict) for one in found]
        again = [start.under(settled=True) for start in nearly]
        back = run.solve(scaled, again, ledger.solved + len(attempts))
        attempts += back
        found = [each for one in back for each in one.verified]
    elif not surrogate.is_itself:
        found = on_all_targets(scaled, found, FACTORS[-1] * least)
    # of all designs those that no other one beats in every goal, up to twice the least error
    designs = _worth_choosing(problem, [*ledger.verified, *found], least)
    return Chosen(designs, [one for one in attempts if not one.verified], len(attempts))


def _best_at(
    surrogate: Surrogate, goal: str, found: Sequence[Candidate], factor: float, most: float
) -> list[Candidate]:
    """The best design at a goal up to some error; none where all have more."""
    problem = surrogate.scaled.problem
    wanted = replace(problem.requirements, error_factor=factor)
    valued = replace(problem, requirements=wanted, objective=GOALS[goal])
    within = [one for one in found if _error(problem, one) <= most * (1 + SLACK)]
    return list(ranked(valued, within)[:1])


def started_at(
    scaled: ScaledProblem,
    candidate: Candidate,
    objective: Objective | None,
    *,
    most_error: float,
    zoned: bool = False,
) -> Start:
    """A start at a design, for a solve by the objective under a bound of the error."""
    start = Start.of_linkage(scaled, candidate.linkage, candidate.verdict)
    return start.under(objective=objective, most_error=most_error, zoned=zoned)


def seeds_of(problem: Problem, found: Sequence[Candidate], most: float, count: int) -> tuple[Candidate, ...]:
    """Designs up to some error, or all if there are none, well apart, the least error first."""
    every = sorted(found, key=lambda one: (_error(problem, one), one.id))
    near = [one for one in every if _error(problem, one) <= most] or every
    return distinct(problem, near, APART, count)


def _error(problem: Problem, candidate: Candidate) -> float:
    return float(np.sqrt(candidate.verdict.square / len(problem.task))) / problem.task.size


def _worth_choosing(problem: Problem, every: list[Candidate], least: float) -> tuple[Candidate, ...]:
    """Pareto-optimal designs up to twice the least error, each with its strengths in words."""
    near = [one for one in every if _error(problem, one) <= FACTORS[-1] * least * (1 + SLACK)]
    best_first = ranked(problem, near)
    front = pareto_optimal(problem, best_first)
    kept = [one for one, best in zip(best_first, front, strict=True) if best]
    words: dict[int, list[str]] = {k: [] for k in range(len(kept))}
    if kept:  # the first of the list may be another one, if it is impractical
        words[min(words, key=lambda k: round(_error(problem, kept[k]), ALIKE + 1))].append(LEAST)
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
