"""Single requirements that prevent a design, and the relaxation that each would need."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias, TypeVar

import numpy as np

from grashof.problems import Linkage, Problem, ProblemError
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import all_judged_again, judged_again
from grashof.synth.programme.start import UNSMOOTH, DrivenLinkage, Proposal, Start
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.proof.claims.bounds import Bounds
from grashof.synth.proof.provers import bounds_before
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import (
    GROUPS,
    Configurations,
    Screened,
    judge,
    violations_apart,
)
from grashof.synth.results.relaxed_limits import (
    Relaxation,
    first_accepted,
    fixes_angle,
    limiting,
    loosest,
    proposals,
    with_rounded_angle,
)
from grashof.synth.search.finder import finder_for
from grashof.synth.search.run import Run
from grashof.synth.starts.finder import DesignFinder
from grashof.synth.starts.selection import closest_starts

# Elastic solves for each requirement, and fewer, but not fewer than `FEWEST`, where there are many of them;
# solves without it.
SOLVES, SOLVES_IN_ALL, FEWEST, SETTLED = 4, 30, 2, 2
WITH_CYLINDER, WITH_BODY = 3.0, 1.5  # times as long as usual: solves of designs with these
FINISHED = 8  # designs that are judged where the targets leave nothing to solve
DEAD = 1e-3  # rad: a transmission angle near a dead position

T = TypeVar("T")
_For: TypeAlias = tuple[str, T]  # a requirement, and a start or design without it


@dataclass(frozen=True, slots=True)
class _Without:
    """A problem without one of its requirements, and what is proven of it."""

    key: str
    loose: ScaledProblem
    bounds: Bounds | None


@dataclass(frozen=True, slots=True)
class Relaxations:
    """Sufficient relaxations, the smallest miss first."""

    found: list[Relaxation]
    effort: float  # with which nothing would have been left out


def relaxations(
    scaled: ScaledProblem, known: Sequence[Candidate], rng: np.random.Generator, run: Run, most: float = 1.0
) -> Relaxations:
    """At most one relaxation for each requirement that may alone prevent a design.

    `known` are designs that were rejected. The judge has accepted each design under the relaxed requirement
    and all others. Without the requirement a search finds linkages that meet all others; from the nearest of
    them the elastic programme minimises the miss. Fixed numbers of draws and solves bound the time, so that
    the seed decides: `most` times the usual ones, and more for a greater effort. Nothing is searched where a
    proof excludes designs even without the requirement.
    """
    plan = _Plan.of(scaled, list(_ways(scaled, run)), known, most * max(run.search.effort, 1.0))
    eased, sought = list[_For[Start]](), list[_For[Candidate]](("", one) for one in known)
    for way in plan.searched:
        if run.ended():
            break
        solved, starts, others = _begun(scaled, way, plan, rng)
        sought += _designs(scaled, solved, [(way.key, each) for each in starts], run)
        eased += [(way.key, each) for each in others]
    if not run.ended():
        sought += _designs(scaled, scaled, eased, run)  # all at once, since they are judged together
    found = list[Relaxation]()
    for way in plan.ways:
        best = _least(scaled, way.key, [one for key, one in sought if way.key in (key, _alone(one))])
        if best is not None:
            found.append(_with_best(_finished(scaled, best, run), way.bounds))
    found.sort(key=lambda one: (one.miss, one.key))
    return Relaxations(found, max(plan.times_searches, plan.times_solves if eased else 0.0) / most)


@dataclass(frozen=True, slots=True)
class _Plan:
    """The work for the relaxations of a problem."""

    ways: list[_Without]
    searched: list[_Without]  # those for which linkages are looked for; for the others some are known
    solves: int  # elastic ones, for each
    near: float  # share of the draws, for each
    times_searches: float  # effort that leaves no search out
    times_solves: float  # and no solve

    @classmethod
    def of(
        cls, scaled: ScaledProblem, ways: list[_Without], known: Sequence[Candidate], share: float
    ) -> _Plan:
        """The plan for a `share` of the usual work."""
        in_all = SOLVES_IN_ALL / work_of(scaled.problem)
        solves = min(SOLVES, max(FEWEST, int(share * in_all) // max(len(ways), 1)))
        most, searched, times = finder_for(scaled).searches_near, ways, 0.0
        if np.isfinite(most):
            missed = {_alone(one) for one in known}
            unknown = [way for way in ways if way.key not in missed]
            searched, times = unknown[: int(share * most)], len(unknown) / most
        times_solves = SOLVES * len(ways) / in_all if solves < SOLVES else 0.0
        near = min(share / max(len(ways), 1), 1.0)
        return cls(ways, searched, solves, near, times, times_solves)


def work_of(problem: Problem) -> float:
    """Time of a solve and of the judgement of its design; 1 is usual."""
    swept = (
        set(problem.requirements.keep_out_for) & {"body", "links"} if problem.requirements.keep_out else ()
    )
    return WITH_CYLINDER if problem.driver is not None else WITH_BODY if swept else 1.0


def _alone(candidate: Candidate) -> str:
    """The only requirement that a design misses; empty where there are several."""
    missed = {defect.requirement for defect in candidate.verdict.defects}
    return missed.pop() if len(missed) == 1 else ""


def _ways(scaled: ScaledProblem, run: Run) -> Iterator[_Without]:
    """The requirements without which there may be a design."""
    for key in limiting(scaled.problem, scaled.constraints):
        if run.ended():
            return
        try:
            loose = _loose(scaled, key)
        except ProblemError:  # another requirement needs this one
            continue
        bounds = bounds_before(loose, run.proving)
        if bounds is None or not bounds.none:
            yield _Without(key, loose, bounds)


def _with_best(relaxed: Relaxation, bounds: Bounds | None) -> Relaxation:
    """The relaxation with the transmission angle of the best design without it, where that is proven."""
    if bounds is None or not bounds.closed or bounds.left_out:
        return relaxed
    upper = np.ceil(100 * np.degrees(bounds.upper)) / 100  # to the safe side
    best = f"without {relaxed.key} {upper:.2f} deg at best, proven"
    return replace(relaxed, words=f"{relaxed.words} ({best})")


def _least(scaled: ScaledProblem, key: str, candidates: Sequence[Candidate]) -> Relaxation | None:
    """The smallest relaxation of a requirement that makes one of some designs do."""
    asked = scaled.problem, scaled.constraints
    proposed = [each for one in candidates if (each := proposals(*asked, key, one))]

    def rank(each: Sequence[Relaxation]) -> tuple[float, float]:
        return (each[0].miss * max(each[0].figures, 1), -each[0].candidate.score(scaled.problem))

    accepted = (first_accepted(scaled.problem, each) for each in sorted(proposed, key=rank))
    return next((one for one in accepted if one is not None), None)


def _begun(
    scaled: ScaledProblem, way: _Without, plan: _Plan, rng: np.random.Generator
) -> tuple[ScaledProblem, Sequence[Proposal], list[Start]]:
    """Where to begin without a requirement: at designs to be judged, or solved, and of the elastic programme.

    They narrowly miss the requirement, and no others if possible. The former are solved under the problem
    that is returned, the latter under the stated one.
    """
    finder = finder_for(way.loose)
    if isinstance(finder, DesignFinder):
        designs = finder.closest_to(scaled, way.key, rng)
        # nothing remains to be solved; but without its cylinder a linkage is given one by the requirements
        known = DrivenLinkage if scaled.problem.driver is not None else (Linkage, DrivenLinkage)
        finished = all(isinstance(each, known) for each in designs)
        return scaled if finished else way.loose, designs, []
    near = rejudged(scaled, finder.near(rng, plan.near))
    most = plan.solves if finder.freedom else FINISHED
    starts = closest_starts(scaled, near, way.key, most)
    as_they_are = [start.under(settled=True) for start in starts]
    if not finder.freedom:
        return way.loose, as_they_are, []
    parts = [] if way.key in UNSMOOTH else _parts(scaled, way.key)
    counts = [most, *[most // 2] * (len(parts) - 1)]  # of single sides of a box fewer
    eased = [
        start.under(relaxed=part)
        for part, count in zip(parts, counts, strict=False)
        for start in starts[:count]
    ]
    return way.loose, as_they_are[: min(SETTLED, most // 2)], eased


def _designs(
    scaled: ScaledProblem, solved: ScaledProblem, starts: Sequence[_For[Proposal]], run: Run
) -> list[_For[Candidate]]:
    """The designs of starts solved under other requirements, judged by the stated ones."""
    attempts = run.solve(solved, [start for _, start in starts], 0)
    made = [(key, one.candidate) for (key, _), one in zip(starts, attempts, strict=True) if one.candidate]
    if solved is scaled:
        return made
    judged = all_judged_again(scaled, [one for _, one in made])
    return [(key, one) for (key, _), one in zip(made, judged, strict=True)]


def _parts(scaled: ScaledProblem, key: str) -> list[tuple[str, ...]]:
    """Parts of a requirement that may be missed: all of it, and single sides of a box."""
    closed = [axis for axis, side in scaled.wanted.ranges(key).items() if axis and np.isfinite(side).any()]
    return [(key,), *((f"{key}.{axis}",) for axis in closed if len(closed) > 1)]


def _loose(scaled: ScaledProblem, key: str) -> ScaledProblem:
    problem = replace(scaled.problem, requirements=loosest(scaled.problem, key))
    return replace(scaled.of_problem(problem), constraints=() if key == "constraints" else scaled.constraints)


def _finished(scaled: ScaledProblem, found: Relaxation, run: Run) -> Relaxation:
    """The relaxation with its angle rounded, or with a design of smaller error, if there is one."""
    angle = fixes_angle(scaled.problem.requirements, found.key)
    if scaled.exact and not angle:
        return found
    asked = with_rounded_angle(scaled.problem, found) if angle else found
    problem = replace(scaled.problem, requirements=asked.requirements)
    eased = replace(scaled.of_problem(problem), constraints=asked.constraints)
    under_it = judged_again(eased, found.candidate)
    # solved under the relaxed requirement, to be certain
    start: Proposal = under_it.linkage
    if eased.problem.task.lengthens and under_it.verdict.cylinder is not None:
        start = DrivenLinkage(under_it.linkage, under_it.verdict.cylinder)
    if eased.has_targets:
        start = Start.of_linkage(eased, under_it.linkage, under_it.verdict)
    (made,) = run.solve(eased, [start], 0)
    if not made.verified:
        return found
    candidate = judged_again(scaled, made.verified[0])
    if not angle:
        candidate = max(found.candidate, candidate, key=lambda one: one.score(problem))
    return replace(asked, candidate=candidate)


def rejudged(scaled: ScaledProblem, linkages: Screened) -> Screened:
    """Screened linkages judged again, by the requirements of another problem with the same task."""
    if not len(linkages):
        return linkages
    o2, o4, _, _, p = linkages.points.T
    in_order = np.argsort(linkages.visit, axis=1)[None]
    at_a, at_b, at_p = np.take_along_axis(linkages.track, in_order, axis=2)
    found = Configurations(
        o2, o4, at_a, at_b, linkages.visit, linkages.theta2, linkages.direction, linkages.kind
    )
    violations = violations_apart(found, p, at_p, scaled.wanted)
    first_turn = None if scaled.motion is None else np.full(len(linkages), scaled.motion.first_turn)
    judged = judge(found, p, linkages.error, violations, scaled.wanted, linkages.body_angle, first_turn)
    if scaled.wanted.same_branch:  # at a dead position rounding decides on other violations
        judged.violations[judged.transmission < DEAD, GROUPS.index("same_branch")] += 1.0
    return fully_screened(scaled, judged)
