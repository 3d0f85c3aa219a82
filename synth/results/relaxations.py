"""Single requirements that prevent a design, and the relaxation that each would need."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.problems import ProblemError
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import judged_again
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
    fixes_angle,
    limiting,
    loosest,
    relaxation,
    with_rounded_angle,
)
from grashof.synth.search.finder import finder_for
from grashof.synth.search.run import Run
from grashof.synth.starts.finder import DesignFinder
from grashof.synth.starts.selection import closest_starts

SOLVES = 6  # starts for each requirement
DEAD = 1e-3  # rad: a transmission angle near a dead position


def relaxations(
    scaled: ScaledProblem, known: list[Candidate], rng: np.random.Generator, run: Run
) -> list[Relaxation]:
    """At most one relaxation for each requirement that may alone prevent a design, the smallest miss first.

    `known` are designs that were rejected. The judge has accepted each design under the relaxed requirement
    and all others. Without the requirement a search finds linkages that meet all others; from the nearest of
    them the elastic programme minimises the miss. Fixed numbers of draws and solves bound the time, so that
    the seed decides. Nothing is searched where a proof excludes designs even without the requirement.
    """
    found = list[Relaxation]()
    for key in limiting(scaled.problem, scaled.constraints):
        if run.ended():
            break
        try:
            loose = _loose(scaled, key)
        except ProblemError:  # another requirement needs this one
            continue
        bounds = bounds_before(loose, run.proving)
        if bounds is not None and bounds.none:
            continue
        rejected = [one for one in known if {d.requirement for d in one.verdict.defects} == {key}]
        best = _least(scaled, key, _candidates(scaled, loose, key, rng, run) + rejected)
        if best is not None:
            found.append(_with_best(_finished(scaled, best, run), bounds))
    return sorted(found, key=lambda one: (one.miss, one.key))


def _with_best(relaxed: Relaxation, bounds: Bounds | None) -> Relaxation:
    """The relaxation with the transmission angle of the best design without it, where that is proven."""
    if bounds is None or not bounds.closed or bounds.left_out:
        return relaxed
    upper = np.ceil(100 * np.degrees(bounds.upper)) / 100  # to the safe side
    best = f"without {relaxed.key} {upper:.2f} deg at best, proven"
    return replace(relaxed, words=f"{relaxed.words} ({best})")


def _least(scaled: ScaledProblem, key: str, candidates: list[Candidate]) -> Relaxation | None:
    """The smallest relaxation of a requirement that makes one of some designs do."""
    made = [relaxation(scaled.problem, scaled.constraints, key, candidate) for candidate in candidates]
    return min(
        (one for one in made if one is not None),
        key=lambda one: (one.miss * max(one.figures, 1), -one.candidate.score(scaled.problem)),
        default=None,
    )


def _candidates(
    scaled: ScaledProblem, loose: ScaledProblem, key: str, rng: np.random.Generator, run: Run
) -> list[Candidate]:
    """Designs that narrowly miss a requirement, and no others if possible."""
    finder = finder_for(loose)
    if isinstance(finder, DesignFinder):
        return _judged(scaled, loose, finder.closest_to(scaled, key, rng), run)
    linkages = rejudged(scaled, finder.near(rng))
    starts = closest_starts(scaled, linkages, key, SOLVES)
    as_they_are = [start.under(settled=True) for start in starts]
    if not finder.freedom:
        return _judged(scaled, loose, as_they_are, run)
    found = _judged(scaled, loose, as_they_are[:2], run)
    if key not in UNSMOOTH:
        whole, *sides = _parts(scaled, key)
        eased = [start.under(relaxed=whole) for start in starts]
        eased += [start.under(relaxed=side) for side in sides for start in starts[: SOLVES // 2]]
        found += _judged(scaled, scaled, eased, run)
    return found


def _parts(scaled: ScaledProblem, key: str) -> list[tuple[str, ...]]:
    """Parts of a requirement that may be missed: all of it, and single sides of a box."""
    closed = [axis for axis, side in scaled.wanted.ranges(key).items() if axis and np.isfinite(side).any()]
    return [(key,), *((f"{key}.{axis}",) for axis in closed if len(closed) > 1)]


def _judged(
    scaled: ScaledProblem, solved: ScaledProblem, starts: Sequence[Proposal], run: Run
) -> list[Candidate]:
    """The designs of starts solved under other requirements, judged by the stated ones."""
    attempts = run.solve(solved, starts, 0)
    return [judged_again(scaled, one.candidate) for one in attempts if one.candidate is not None]


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
