"""The ranked list of function generators: found, judged, chosen."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np

from grashof.analysis import verify
from grashof.analysis.judge.design import Constraint, OwnObjective
from grashof.problems import Problem, ProblemError, Search
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.families import listed
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.claims.proof import Proof, best_listed, proof_of
from grashof.synth.proof.functions.few_pairs import bounds_of_pairs
from grashof.synth.proof.functions.five_pairs import certified_functions
from grashof.synth.proof.poses.five_poses import Certified, proof_of_all
from grashof.synth.results.result import Result
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.run import Progress
from grashof.synth.search.story import Asking, Story, now
from grashof.synth.search.tally import DISTINCT, Tally
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.search import (
    LEAST,
    LOCAL,
    MET,
    FoundFunction,
    exact_functions,
    optimal_functions,
)
from grashof.synth.theory.stopping import Stopped, overdue, stopping

_LOG = logging.getLogger(__name__)
FINE = tuple(np.arange(5.0, 86.0, 5.0).tolist())  # deg of transmission, where an error is allowed
NEAREST = 8
SAME = 1.001  # times the least error: the least


@dataclass(slots=True)
class _Judged:
    """Designs as the judge sees them."""

    problem: Problem
    constraints: tuple[Constraint, ...]
    objective: OwnObjective | None
    good: list[Candidate] = field(default_factory=list)
    bad: list[Candidate] = field(default_factory=list)
    tally: Tally = field(default_factory=Tally)

    def take(self, aims: FunctionAims, one: FoundFunction, most_square: float = np.inf) -> None:
        """Judge one more."""
        try:
            linkage = aims.linkage(one.made, one.driver)
        except ProblemError:  # pivots that coincide, lengths beyond the floats
            self.tally.add([Attempt("", None)])
            return
        verdict = verify(
            linkage, self.problem.task, self.problem.requirements, self.constraints,
            most_square=most_square, problem=self.problem,
        )  # fmt: skip
        number = sum(self.tally.outcomes.values())
        candidate = Candidate(linkage, verdict, self.problem, number, one.steps, best_at=one.best_at)
        if self.objective is not None:
            candidate = candidate.valued(self.objective)
        self.tally.add([Attempt("judged", candidate)])
        (self.good if verdict.ok else self.bad).append(candidate)


def function_list(
    problem: Problem,
    search: Search,
    asked: Asking,
    constraints: Sequence[Constraint] = (),
    objective: OwnObjective | None = None,
    progress: Callable[[Progress], object] | None = None,
    proving: Proving = Proving(),  # noqa: B008  (a frozen value)
) -> Result:
    """Find, verify and rank linkages of one kind that generate a function.

    The user's own constraints and objective judge and rank what is found; `Search.starts` has no part in it:
    its designs are not solved for one by one. `progress` is called as designs are judged. `Result.note`
    states why a list is empty.
    """
    begun, aims = perf_counter(), FunctionAims.of(problem)
    judged = _Judged(problem, tuple(constraints), objective)
    rng = np.random.default_rng(np.random.SeedSequence(search.seed))
    seconds = {"solving": 0.0, "judging": 0.0}
    least, ended = np.nan, ""
    with stopping(asked), suppress(Stopped):  # what was found until then is listed
        if not aims.obstacle:
            found: Iterable[FoundFunction]
            if aims.exact:
                found = exact_functions(aims, rng, max(search.enough, 8) + 10, search.effort)
            else:
                found = optimal_functions(aims, rng, search.effort, _levels(problem))
            for one in found:
                since = perf_counter()
                judged.take(aims, one)
                if progress is not None:
                    progress(_progress(judged, search))
                seconds["judging"] += perf_counter() - since
                if overdue():
                    break
    with stopping(asked):
        best = best_listed(problem, judged.good)
        dyads = certified_functions(aims)
        known = 0.0 if best is None else float(np.radians(best))
        pairs = None if objective is not None else bounds_of_pairs(aims, proving, known)
    if pairs is not None and constraints:
        bounds, found_by_it = pairs
        pairs = replace(bounds, left_out=(*bounds.left_out, "constraints")), found_by_it
    for one in [] if pairs is None else pairs[1][-1:]:
        judged.take(aims, one)
    seconds["solving"] = perf_counter() - begun - seconds["judging"]
    complete = not asked()
    whole = complete and len(judged.good) < search.enough
    if not aims.exact and judged.good:
        least = min(one.error(problem) for one in judged.good)
        judged.good = [named(one, problem, least, aims.unit) for one in _within(judged, least)]
    designs = listed(problem, judged.good)
    if aims.exact:
        designs = designs[: search.enough]
        ended = "" if len(designs) >= search.enough else _exhausted(aims)
    if progress is not None:
        progress(_progress(judged, search))
    judged.tally.totals[DISTINCT] = len(designs)
    note, nearest = ("", ()) if designs else _why_none(aims, judged, complete)
    _LOG.info(
        "functions: %d of %d judged are good, %d listed",
        len(judged.good),
        len(judged.good + judged.bad),
        len(designs),
    )
    return Result(
        problem=problem,
        candidates=designs,
        nearest=nearest,
        tally=judged.tally,
        seconds={**seconds, "total": perf_counter() - begun},
        note=note,
        complete=complete,
        ended=ended if complete else "the search ended before it was done: it was stopped",
        least_error=least,
        story=Story(begun=asked.begun, ended=now(), ending=asked.ending),
        proof=_proof(problem, dyads, None if pairs is None else pairs[0], designs, proving, whole=whole),
    )


def _proof(
    problem: Problem,
    dyads: Certified | None,
    bounds: Bounds | None,
    designs: Sequence[Candidate],
    proving: Proving,
    *,
    whole: bool,
) -> Proof | None:
    """What is proven of the list, of five pairs or four."""
    if dyads is not None:
        return proof_of_all(problem, dyads, designs, whole=whole)
    return None if bounds is None else proof_of(problem, bounds, best_listed(problem, designs), proving.gap)


def _levels(problem: Problem) -> tuple[float, ...] | None:
    """Transmission angles that designs are made for, closer where the objective decides."""
    factor = problem.requirements.error_factor
    if factor is None:
        return None
    asked = problem.requirements.transmission_min_deg
    return tuple(level for level in FINE if level > asked)


def _within(judged: _Judged, least: float) -> list[Candidate]:
    """Designs up to the error that is allowed."""
    factor = judged.problem.requirements.error_factor
    if factor is None:
        return judged.good
    most = factor * max(least, 1e-6) * (1 + 1e-9)
    return [one for one in judged.good if one.error(judged.problem) <= most]


def named(one: Candidate, problem: Problem, least: float, unit: float) -> Candidate:
    """The same, named by what it is best at: only the best of all has the least error, counted in `unit`."""
    if one.best_at != LEAST or one.error(problem) <= max(least * SAME, MET * unit):
        return one
    return replace(one, best_at=LOCAL)


def _progress(judged: _Judged, search: Search) -> Progress:
    count = len(judged.good) + len(judged.bad)
    return Progress(count, None, search.enough, tuple(judged.good))


def _exhausted(aims: FunctionAims) -> str:
    count = len(aims.task)
    if count >= aims.kind.EXACT:
        five = aims.kind.EXACT == 5
        have = "most sets of five have one, or three" if five else "most sets of four have one"
        return f"all {aims.kinds} through the {count} pairs were looked at; {have}"
    return f"no more distinct {aims.kinds} go through the pairs under these requirements"


def _why_none(aims: FunctionAims, judged: _Judged, complete: bool) -> tuple[str, tuple[Candidate, ...]]:
    """Why the list is empty, and what comes nearest."""
    nearest = tuple(sorted(judged.bad, key=lambda one: sum(d.miss for d in one.verdict.defects))[:NEAREST])
    if aims.obstacle:
        return f"no design: {aims.obstacle}", ()
    if not complete:
        return "no design: the search was stopped before it found one", nearest
    if aims.exact:
        count = len(aims.task)
        why = f"no {aims.kinds[:-1]} goes through the {count} pairs on one branch under these requirements"
        less = (
            "; fewer pairs, or exact = false, leave more freedom"
            if count > 3
            else "; exact = false asks for less"
        )
        return f"no design: {why}{less}", nearest
    if not nearest:
        return f"no design: no {aims.kinds[:-1]} covers the range under these requirements", nearest
    worst = nearest[0].verdict.defects
    return (
        f"no design meets all requirements; the closest one misses {' and '.join(map(str, worst))}",
        nearest,
    )
