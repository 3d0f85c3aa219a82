"""Which single requirement stands in the way, and by how much it alone would have to be relaxed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import judged_again
from grashof.synth.programme.start import UNSMOOTH, Proposal, Start
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
from grashof.synth.starts.design_finder import DesignFinder
from grashof.synth.starts.selection import closest_starts

SOLVES = 6  # starts for each requirement
DEAD = 1e-3  # rad: a transmission angle near a dead position


def relaxations(
    scaled: ScaledProblem, known: list[Candidate], rng: np.random.Generator, run: Run
) -> list[Relaxation]:
    """For each requirement that may be the only one in the way: how it would have to be relaxed.

    One relaxation for each requirement at most, the smallest miss first; `known` are designs that were
    rejected. The judge has accepted each design under the relaxed requirement and all others. Without the
    requirement a search finds linkages that meet all others; from the nearest of them the elastic programme
    makes what is missed of it as small as it can. Fixed numbers of draws and solves bound the time, so that
    the seed decides. Where it is proven that even without the requirement there is no design, nothing is
    searched.
    """
    found = list[Relaxation]()
    for key in limiting(scaled.problem, scaled.constraints):
        if run.ended():
            break
        try:
            loose = _loose(scaled, key)
        except ProblemError:  # something else that is asked needs this requirement
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
    """The same with what the best design without the requirement transmits, where that is proven."""
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
    """Designs that miss a requirement by little, and others by nothing if that can be."""
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
    """What may be missed of a requirement: all of it, and of a box one side alone."""
    closed = [axis for axis, side in scaled.wanted.ranges(key).items() if axis and np.isfinite(side).any()]
    return [(key,), *((f"{key}.{axis}",) for axis in closed if len(closed) > 1)]


def _judged(
    scaled: ScaledProblem, solved: ScaledProblem, starts: Sequence[Proposal], run: Run
) -> list[Candidate]:
    """The designs of starts solved under other requirements, judged by those that were asked."""
    attempts = run.solve(solved, starts, 0)
    return [judged_again(scaled, one.candidate) for one in attempts if one.candidate is not None]


def _loose(scaled: ScaledProblem, key: str) -> ScaledProblem:
    problem = replace(scaled.problem, requirements=loosest(scaled.problem, key))
    return replace(scaled.of_problem(problem), constraints=() if key == "constraints" else scaled.constraints)


def _finished(scaled: ScaledProblem, found: Relaxation, run: Run) -> Relaxation:
    """The same relaxation with an angle rounded, or a design of smaller error, if there is one."""
    angle = fixes_angle(scaled.problem.requirements, found.key)
    if scaled.exact and not angle:
        return found
    asked = with_rounded_angle(scaled.problem, found) if angle else found
    problem = replace(scaled.problem, requirements=asked.requirements)
    eased = replace(scaled.of_problem(problem), constraints=asked.constraints)
    under_it = judged_again(eased, found.candidate)
    # solved under the relaxed requirement, which makes sure of it
    (made,) = run.solve(eased, [Start.of_linkage(eased, under_it.linkage, under_it.verdict)], 0)
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
    o2, o4, a, b, p = linkages.points.T
    counted: FloatArray = np.take_along_axis(linkages.theta2, np.argsort(linkages.visit, axis=1), axis=1)
    at_a = o2[:, None] + np.abs(a - o2)[:, None] * np.exp(1j * counted)
    at_b = at_a + linkages.coupler
    at_p = at_a + ((p - a) / (b - a))[:, None] * linkages.coupler
    found = Configurations(
        o2, o4, at_a, at_b, linkages.visit, linkages.theta2, linkages.direction, linkages.kind
    )
    violations = violations_apart(found, p, at_p, scaled.wanted)
    first_turn = None if scaled.motion is None else np.full(len(linkages), scaled.motion.first_turn)
    judged = judge(found, p, linkages.error, violations, scaled.wanted, linkages.body_angle, first_turn)
    if scaled.wanted.same_branch:  # at a dead position rounding decides what else is lacking
        judged.violations[judged.transmission < DEAD, GROUPS.index("same_branch")] += 1.0
    return fully_screened(scaled, judged)
