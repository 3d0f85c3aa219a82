"""Which single requirement stands in the way, and by how much it alone would have to be relaxed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from grashof.analysis import verify
from grashof.problems import Box
from grashof.problems.checks import FloatArray
from grashof.synth import exact_poses, paths
from grashof.synth.attempt import Attempt
from grashof.synth.choose import closest_starts
from grashof.synth.finds import GROUPS, Configurations, Finds, dyad_lacks, judge, keep_out_lack
from grashof.synth.looser import ANGLES, Relaxation, limiting, loosest, relaxation, with_rounded_angle
from grashof.synth.own import screened
from grashof.synth.result import Candidate
from grashof.synth.setup import Setup
from grashof.synth.start import LENGTHS, Start
from grashof.synth.workers import Solver

SOLVES = 6  # starts for each requirement
FINDS = 20  # of a search for them
DEAD = 1e-3  # rad: a transmission angle near a dead position


def relaxations(
    setup: Setup,
    solve: Solver,
    known: list[Candidate],
    rng: np.random.Generator,
    ended: Callable[[], bool],
) -> list[Relaxation]:
    """For each requirement that may be the only one in the way: how it would have to be relaxed.

    Parameters
    ----------
    setup : Setup
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
    for key in limiting(setup.problem, setup.constraints):
        if ended():
            break
        rejected = [one for one in known if {d.requirement for d in one.verdict.defects} == {key}]
        best = _least(setup, key, _candidates(setup, key, solve, rng) + rejected)
        if best is not None:
            found.append(_finished(setup, best, solve))
    return sorted(found, key=lambda one: (one.miss, one.key))


def _least(setup: Setup, key: str, candidates: list[Candidate]) -> Relaxation | None:
    """The smallest relaxation of a requirement that makes one of some designs do."""
    made = [relaxation(setup.problem, setup.constraints, key, candidate) for candidate in candidates]
    return min(
        (one for one in made if one is not None),
        key=lambda one: (one.miss * max(one.figures, 1), -one.candidate.score(setup.problem)),
        default=None,
    )


def _candidates(setup: Setup, key: str, solve: Solver, rng: np.random.Generator) -> list[Candidate]:
    """Designs that miss a requirement by little, and others by nothing if that can be."""
    loose = _loose(setup, key)
    finds = rejudged(setup, _finds(loose, rng))
    group = "link_length" if key in LENGTHS else key
    starts = closest_starts(setup, finds, group, SOLVES)
    settled = setup.motion is not None and len(setup.targets) > 4
    if settled:
        return _judged(setup, solve(loose, [replace(start, settled=True) for start in starts], 0))
    found = _judged(setup, solve(loose, [replace(start, settled=True) for start in starts[:2]], 0))
    if key not in ("order", "same_branch"):  # no smooth constraint can relax these
        whole, *sides = _parts(setup, key)
        eased = [replace(start, relaxed=whole) for start in starts]
        eased += [replace(start, relaxed=side) for side in sides for start in starts[: SOLVES // 2]]
        found += _judged(setup, solve(setup, eased, 0))
    return found


def _parts(setup: Setup, key: str) -> list[tuple[str, ...]]:
    """What may be missed of a requirement: all of it, and of a box one side alone."""
    if key in LENGTHS:
        return [("link_length", key)]
    if key == "link_length":
        return [(key, *(name for name in LENGTHS if getattr(setup.wanted, name) is None))]
    box = getattr(setup.wanted, key) if key in ("o2", "o4") else Box()
    closed = [axis for axis in "xy" if np.isfinite(getattr(box, axis)).any()]
    return [(key,), *((key, f"{key}.{axis}") for axis in closed if len(closed) > 1)]


def _judged(setup: Setup, attempts: list[Attempt]) -> list[Candidate]:
    """The designs of attempts, judged by the requirements as they were asked."""
    task, wanted = setup.problem.task, setup.problem.requirements
    return [
        replace(one.candidate, verdict=verify(one.candidate.linkage, task, wanted, setup.constraints))
        for one in attempts
        if one.candidate is not None
    ]


def _loose(setup: Setup, key: str) -> Setup:
    problem = replace(setup.problem, requirements=loosest(setup.problem, key))
    return Setup.of(problem, () if key == "constraints" else setup.constraints)


def _finished(setup: Setup, found: Relaxation, solve: Solver) -> Relaxation:
    """The same relaxation with an angle in round figures, or a design of smaller error, if there is one.

    Both are solved under the relaxed requirement, which makes sure of it.
    """
    if setup.exact and found.key not in ANGLES:
        return found
    asked = with_rounded_angle(setup.problem, found) if found.key in ANGLES else found
    problem = replace(setup.problem, requirements=asked.requirements)
    eased, linkage = Setup.of(problem, asked.constraints), found.candidate.linkage
    judged = verify(linkage, problem.task, asked.requirements, asked.constraints)
    (made,) = solve(eased, [Start.of_linkage(eased, linkage, judged)], 0)
    if made.candidate is None or not made.candidate.verdict.ok:
        return found
    (candidate,) = _judged(setup, [made])
    if not setup.exact and found.key not in ANGLES:
        candidate = max(found.candidate, candidate, key=lambda one: one.score(problem))
    return replace(asked, candidate=candidate)


def _finds(setup: Setup, rng: np.random.Generator) -> Finds:
    """Linkages that a search comes up with, feasible ones if there are any."""
    if setup.motion is not None:
        return exact_poses.finds(setup, rng)
    return paths.search(setup, FINDS, rng)


def rejudged(setup: Setup, finds: Finds) -> Finds:
    """Finds with what they lack of the requirements of another setup of the same task."""
    if not len(finds):
        return finds
    o2, o4, a, b, p = finds.points.T
    counted: FloatArray = np.take_along_axis(finds.theta2, np.argsort(finds.visit, axis=1), axis=1)
    at_a = o2[:, None] + np.abs(a - o2)[:, None] * np.exp(1j * counted)
    at_b = at_a + finds.coupler
    at_p = at_a + ((p - a) / (b - a))[:, None] * finds.coupler
    lacks = dyad_lacks("o2", o2, at_a, p, setup.wanted) + dyad_lacks("o4", o4, at_b, p, setup.wanted)
    lacks[:, GROUPS.index("keep_out")] += keep_out_lack("p", at_p, setup.wanted)
    found = Configurations(o2, o4, at_a, at_b, finds.visit, finds.theta2, finds.direction)
    judged = judge(found, p, finds.error, lacks, setup.wanted, finds.body_angle)
    if setup.wanted.same_branch:  # at a dead position rounding decides what else is lacking
        judged.lacks[judged.transmission < DEAD, GROUPS.index("same_branch")] += 1.0
    return screened(setup, judged)
