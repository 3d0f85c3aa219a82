"""Which single requirement stands in the way, and by how much it alone would have to be relaxed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import (
    GROUPS,
    Configurations,
    Screened,
    dyad_violations,
    judge,
    keep_out_violation,
)
from grashof.synth.programme.start import Start
from grashof.synth.programme.user_constraints import screened
from grashof.synth.results.attempt import Attempt
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.relaxation import (
    ANGLES,
    Relaxation,
    limiting,
    loosest,
    relaxation,
    with_rounded_angle,
)
from grashof.synth.results.workers import Solver
from grashof.synth.starts import exact_poses, paths
from grashof.synth.starts.selection import closest_starts

SOLVES = 6  # starts for each requirement
FINDS = 20  # of a search for them
DEAD = 1e-3  # rad: a transmission angle near a dead position


def relaxations(
    scaled: ScaledProblem,
    solve: Solver,
    known: list[Candidate],
    rng: np.random.Generator,
    ended: Callable[[], bool],
) -> list[Relaxation]:
    """For each requirement that may be the only one in the way: how it would have to be relaxed.

    Parameters
    ----------
    scaled : ScaledProblem
    solve : callable
        Attempts from starts.
    known : list of Candidate
        Designs that were rejected.
    rng : numpy.random.Generator
    ended : callable
        Asked before every requirement.

    Returns
    -------
    list of Relaxation
        One for each requirement at most, the smallest miss first. The judge has accepted each of the
        designs under the relaxed requirement and all others.

    Notes
    -----
    Without the requirement a search finds linkages that meet all others; from the nearest of them the
    elastic programme makes what is missed of it as small as it can. Fixed numbers of draws and solves
    bound the time, so that the seed decides.
    """
    found = list[Relaxation]()
    for key in limiting(scaled.problem, scaled.constraints):
        if ended():
            break
        rejected = [one for one in known if {d.requirement for d in one.verdict.defects} == {key}]
        best = _least(scaled, key, _candidates(scaled, key, solve, rng) + rejected)
        if best is not None:
            found.append(_finished(scaled, best, solve))
    return sorted(found, key=lambda one: (one.miss, one.key))


def _least(scaled: ScaledProblem, key: str, candidates: list[Candidate]) -> Relaxation | None:
    """The smallest relaxation of a requirement that makes one of some designs do."""
    made = [relaxation(scaled.problem, scaled.constraints, key, candidate) for candidate in candidates]
    return min(
        (one for one in made if one is not None),
        key=lambda one: (one.miss * max(one.figures, 1), -one.candidate.score(scaled.problem)),
        default=None,
    )


def _candidates(scaled: ScaledProblem, key: str, solve: Solver, rng: np.random.Generator) -> list[Candidate]:
    """Designs that miss a requirement by little, and others by nothing if that can be."""
    loose = _loose(scaled, key)
    finds = rejudged(scaled, _finds(loose, rng))
    starts = closest_starts(scaled, finds, key, SOLVES)
    settled = scaled.motion is not None and len(scaled.targets) > 4
    if settled:
        return _judged(scaled, solve(loose, [replace(start, settled=True) for start in starts], 0))
    found = _judged(scaled, solve(loose, [replace(start, settled=True) for start in starts[:2]], 0))
    if key not in ("order", "same_branch"):  # no smooth constraint can relax these
        whole, *sides = _parts(scaled, key)
        eased = [replace(start, relaxed=whole) for start in starts]
        eased += [replace(start, relaxed=side) for side in sides for start in starts[: SOLVES // 2]]
        found += _judged(scaled, solve(scaled, eased, 0))
    return found


def _parts(scaled: ScaledProblem, key: str) -> list[tuple[str, ...]]:
    """What may be missed of a requirement: all of it, and of a box one side alone."""
    closed = [axis for axis, side in scaled.wanted.ranges(key).items() if axis and np.isfinite(side).any()]
    return [(key,), *((f"{key}.{axis}",) for axis in closed if len(closed) > 1)]


def _judged(scaled: ScaledProblem, attempts: list[Attempt]) -> list[Candidate]:
    """The designs of attempts, judged by the requirements as they were asked."""
    designs = [one.candidate for one in attempts if one.candidate is not None]
    return [one.judged(scaled.problem, scaled.constraints) for one in designs]


def _loose(scaled: ScaledProblem, key: str) -> ScaledProblem:
    problem = replace(scaled.problem, requirements=loosest(scaled.problem, key))
    return ScaledProblem.of(problem, () if key == "constraints" else scaled.constraints)


def _finished(scaled: ScaledProblem, found: Relaxation, solve: Solver) -> Relaxation:
    """The same relaxation with an angle in round figures, or a design of smaller error, if there is one.

    Both are solved under the relaxed requirement, which makes sure of it.
    """
    if scaled.exact and found.key not in ANGLES:
        return found
    asked = with_rounded_angle(scaled.problem, found) if found.key in ANGLES else found
    problem = replace(scaled.problem, requirements=asked.requirements)
    eased = ScaledProblem.of(problem, asked.constraints)
    judged = found.candidate.judged(problem, asked.constraints)
    (made,) = solve(eased, [Start.of_linkage(eased, judged.linkage, judged.verdict)], 0)
    if made.candidate is None or not made.candidate.verdict.ok:
        return found
    (candidate,) = _judged(scaled, [made])
    if not scaled.exact and found.key not in ANGLES:
        candidate = max(found.candidate, candidate, key=lambda one: one.score(problem))
    return replace(asked, candidate=candidate)


def _finds(scaled: ScaledProblem, rng: np.random.Generator) -> Screened:
    """Linkages that a search comes up with, feasible ones if there are any."""
    if scaled.motion is not None:
        return exact_poses.finds(scaled, rng)
    return paths.search(scaled, FINDS, rng)


def rejudged(scaled: ScaledProblem, finds: Screened) -> Screened:
    """Screened linkages judged again, by the requirements of another problem with the same task."""
    if not len(finds):
        return finds
    o2, o4, a, b, p = finds.points.T
    counted: FloatArray = np.take_along_axis(finds.theta2, np.argsort(finds.visit, axis=1), axis=1)
    at_a = o2[:, None] + np.abs(a - o2)[:, None] * np.exp(1j * counted)
    at_b = at_a + finds.coupler
    at_p = at_a + ((p - a) / (b - a))[:, None] * finds.coupler
    violations = dyad_violations("o2", o2, at_a, p, scaled.wanted) + dyad_violations(
        "o4", o4, at_b, p, scaled.wanted
    )
    violations[:, GROUPS.index("keep_out")] += keep_out_violation("p", at_p, scaled.wanted)
    found = Configurations(o2, o4, at_a, at_b, finds.visit, finds.theta2, finds.direction)
    judged = judge(found, p, finds.error, violations, scaled.wanted, finds.body_angle)
    if scaled.wanted.same_branch:  # at a dead position rounding decides what else is lacking
        judged.violations[judged.transmission < DEAD, GROUPS.index("same_branch")] += 1.0
    return screened(scaled, judged)
