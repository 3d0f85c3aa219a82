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
STRIDE, STRIDES = 0.5, 8  # longest links: greatest move of a pivot in a solve; greatest number of such solves
AT_EDGE = 0.999  # share of such a move
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
    origin = {one.id: (error, one.id) for error, one in begun_from}  # error and seed that led to each design
    led = dict[tuple[str, float], str]()  # the seed that led to the best at a goal up to some error
    found, attempts, latest = list[Candidate](), list[Attempt](), dict[str, list[Candidate]]()
    factors = FACTORS if ledger.least > same_error(problem) else FACTORS[:1]  # exact but for rounding
    there_and_back = (*factors, *factors[-2::-1])  # designs of much error may lead to better ones of little
    for before, factor in zip((0.0, *there_and_back), there_and_back, strict=False):
        if run.ended():
            break
        new = [one for error, one in begun_from if before * least < error <= factor * least]
        most = surrogate.most_error(factor * least, problem.task.size)
        # no way leads back to less error than its seed has, and one that came from here leads back here
        begun = [
            (goal, one)
            for goal in GOALS
            for one in (*latest.get(goal, ()), *new)
            if origin[one.id][0] <= factor * least and origin[one.id][1] != led.get((goal, factor))
        ]
        made = _improved(surrogate.scaled, begun, most, run, ledger.solved + len(attempts))
        attempts += [one for each in made for one in each]
        for goal in GOALS:
            mine = [(seed, each) for (aim, seed), each in zip(begun, made, strict=True) if aim == goal]
            origin |= {each.id: origin[seed.id] for seed, tries in mine for each in _verified(tries)}
            good = [each for _, tries in mine for each in _verified(tries)]
            every = (*good, *latest.get(goal, ()))
            latest[goal] = _best_at(surrogate, goal, every, factor, most) or latest.get(goal, [])
            for one in latest[goal]:
                led[goal, factor] = origin[one.id][1]
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


def _improved(
    scaled: ScaledProblem, begun: Sequence[tuple[str, Candidate]], most: float, run: Run, solved: int
) -> list[list[Attempt]]:
    """The solves from each design, for its goal, up to an error `most`.

    Free to go anywhere, the solver leaves for linkages that miss the targets by far, and rarely returns. So a
    solve keeps near its start, and another one follows where it ends at the edge.
    """
    tries: list[list[Attempt]] = [[] for _ in begun]
    going = list(enumerate(begun))
    for _ in range(STRIDES):
        if not going or run.ended():
            break
        starts = [
            started_at(scaled, one, GOALS[goal], most_error=most, stride=STRIDE) for _, (goal, one) in going
        ]
        made = run.solve(scaled, starts, solved)
        solved += len(made)
        farther = list[tuple[int, tuple[str, Candidate]]]()
        for (number, (goal, _)), start, one in zip(going, starts, made, strict=True):
            tries[number].append(one)
            if one.verified and _at_edge(scaled, start, one.verified[0]):
                farther.append((number, (goal, one.verified[0])))
        going = farther
    return tries


def _at_edge(scaled: ScaledProblem, start: Start, found: Candidate) -> bool:
    """Whether a solve moved a pivot as far as it might."""
    moved = Start.of_linkage(scaled, found.linkage, found.verdict).points[:4] - start.points[:4]
    return bool(max(np.abs(moved.real).max(), np.abs(moved.imag).max()) > AT_EDGE * start.terms.radius)


def _verified(tries: Sequence[Attempt]) -> list[Candidate]:
    return [each for one in tries for each in one.verified]


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
    stride: float = np.inf,
) -> Start:
    """A start at a design, for a solve by the objective under a bound of the error.

    Pivots move by `stride` of the longest link at most.
    """
    start = Start.of_linkage(scaled, candidate.linkage, candidate.verdict)
    if objective is not None and objective.transmission:
        start = replace(start, transmission=candidate.values["transmission"])
    radius = stride * max(map(abs, start.lengths))
    return start.under(objective=objective, most_error=most_error, zoned=zoned, radius=radius)


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
