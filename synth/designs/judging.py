"""Judging: verdicts of the analysis on linkages, by the requirements of a scaled problem."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, fields, replace
from typing import Any

import numpy as np

from grashof.analysis import Verdict, verify
from grashof.problems import Cylinder, Linkage, Problem, ProblemError
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.driving import cylinder_for
from grashof.synth.programme.second_loop import SecondLoop
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import overdue

ROUNDING = 1e-6  # share, rad, sizes: greatest difference of verdicts between processors
MISSED = {"within", "angle_within_deg", "exact"}  # requirements of defects where a target is missed


def judged(
    scaled: ScaledProblem,
    points: ComplexArray,
    assembly: int,
    body_angle: float,
    second: SecondLoop | None = None,
    *,
    start: int,
    iterations: int,
    most_error: float = np.inf,
) -> Candidate | None:
    """A design with the verdict on it; None where two pivots coincide.

    O2, O4, and A, B, P at the first target are (5,) and the error that is allowed (root mean square) is in
    sizes, the body angle in rad; full poses ignore it, since the first one fixes the body on the coupler.
    `start` and `iterations` state its origin.
    """
    given = None if scaled.motion is not None else np.array(body_angle)
    try:
        linkage = scaled.linkages(points, np.array(assembly), given)
        linkage = linkage if second is None else second.added_to(linkage, scaled.frame)
    except ProblemError:
        return None
    return judged_linkage(scaled, linkage, start=start, iterations=iterations, most_error=most_error)


def judged_linkage(
    scaled: ScaledProblem,
    linkage: Linkage,
    *,
    start: int,
    iterations: int,
    most_error: float = np.inf,
    cylinder: Cylinder | None = None,
) -> Candidate:
    """A linkage with the verdict on it, as by `judged`; driven by a known cylinder, or else by the best."""
    verdict = driven_verdict(scaled, linkage, most_error, cylinder)
    candidate = _valued(scaled, Candidate(linkage, verdict, scaled.problem, start, iterations))
    if verdict.ok:
        candidate.objective(scaled.problem)  # here, where many are judged at once; the values stay known
    return candidate


def driven_verdict(
    scaled: ScaledProblem, linkage: Linkage, most_error: float = np.inf, known: Cylinder | None = None
) -> Verdict:
    """The judge's verdict on a linkage with the cylinder `known`, or else the best, where requested."""
    verdict = verdict_on(scaled, linkage, most_error, known)
    if known is not None or scaled.problem.driver is None:
        return verdict
    found = cylinder_for(scaled.problem, linkage, verdict)
    return verdict if found is None else verdict_on(scaled, linkage, most_error, found)


def verdict_on(
    scaled: ScaledProblem, linkage: Linkage, most_error: float = np.inf, cylinder: Cylinder | None = None
) -> Verdict:
    """The judge's verdict; `most_error` is the root mean square error that is allowed, sizes."""
    problem, task = scaled.problem, scaled.problem.task
    square = len(task) * (most_error * task.size) ** 2
    asked = task, problem.requirements, scaled.constraints
    return verify(linkage, *asked, most_square=square, problem=problem, cylinder=cylinder)


def judged_again(scaled: ScaledProblem, candidate: Candidate, most_error: float = np.inf) -> Candidate:
    """A design judged by the requirements of another problem with the same targets."""
    verdict = driven_verdict(scaled, candidate.linkage, most_error, candidate.verdict.cylinder)
    return _valued(scaled, replace(candidate, verdict=verdict, problem=scaled.problem))


def judged_in_time(
    scaled: ScaledProblem, found: Sequence[Candidate], most_error: float = np.inf
) -> list[Candidate]:
    """As `judged_again`, in their order; where time runs out, those of the least error."""
    errors, judged = [one.error(one.problem) for one in found], dict[int, Candidate]()
    for k in sorted(range(len(found)), key=errors.__getitem__):
        if judged and overdue():
            break
        judged[k] = judged_again(scaled, found[k], most_error)
    return [judged[k] for k in sorted(judged)]


def alike(one: Verdict, other: Verdict, size: float) -> bool:
    """Whether verdicts are the same but for rounding, which differs between processors."""
    scales = {"position_error": size, "size": size, "square": size**2}  # with which lengths are compared

    def near(x: Any, y: Any, scale: float) -> bool:
        same = np.shape(x) == np.shape(y)
        return same and np.allclose(x, y, rtol=ROUNDING, atol=ROUNDING * scale, equal_nan=True)

    if [(d.requirement, d.what, d.allowed) for d in one.defects] != [
        (d.requirement, d.what, d.allowed) for d in other.defects
    ]:
        return False
    defects = zip(one.defects, other.defects, strict=True)
    if not all(near(d.found, e.found, size) and near(d.miss, e.miss, 1.0) for d, e in defects):
        return False
    if getattr(one.cylinder, "on", None) != getattr(other.cylinder, "on", None):
        return False
    figures = {"dwell": size, "outputs": 1.0}  # of dwells in rad or lengths
    for name, scale in figures.items():
        mine, theirs = (getattr(each, name) for each in (one, other))
        if (mine is None) != (theirs is None):
            return False
        if mine is not None and not near(np.hstack(astuple(mine)), np.hstack(astuple(theirs)), scale):
            return False
    apart = ("defects", "grashof_class", "cylinder", "effort", *figures)
    names = (each.name for each in fields(Verdict) if each.name not in apart)
    return one.grashof_class is other.grashof_class and all(
        near(getattr(one, name), getattr(other, name), scales.get(name, 1.0)) for name in names
    )


def _valued(scaled: ScaledProblem, candidate: Candidate) -> Candidate:
    """The design with its value under the user's own objective, where there is one."""
    return candidate if scaled.own_objective is None else candidate.valued(scaled.own_objective)


def shares(problem: Problem, verdict: Verdict) -> tuple[float, float]:
    """Greatest ratio of a miss to its zone, of positions and of angles."""
    place, turn = np.ones((2, len(problem.task))) if problem.zones is None else problem.zones
    turned = np.nanmax(verdict.angle_error / turn, initial=0.0)
    return float(np.nanmax(verdict.position_error / place)), float(turned)
