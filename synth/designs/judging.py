"""Judging: verdicts of the analysis on linkages, by the requirements of a scaled problem."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import astuple, dataclass, fields, replace
from typing import Any, TypeAlias, TypeVar

import numpy as np

from grashof.analysis import Verdict
from grashof.analysis.judge.verify import Judge, Subject
from grashof.problems import Cylinder, Linkage, Problem, ProblemError
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.driving import cylinder_for
from grashof.synth.programme.second_loop import SecondLoop
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import overdue

T = TypeVar("T")
ROUNDING = 1e-6  # share, rad, sizes: greatest difference of verdicts between processors
AT_ONCE = 16  # designs judged between two looks at the time
MISSED = {"within", "angle_within_deg", "exact"}  # requirements of defects where a target is missed


@dataclass(frozen=True, slots=True)
class ToJudge:
    """A linkage to be judged as a design.

    `start` and `iterations` state its origin, `most_error` (sizes) is the root mean square error that is
    allowed; it is driven by the known cylinder, or else by the best.
    """

    linkage: Linkage
    start: int
    iterations: int
    most_error: float = np.inf
    cylinder: Cylinder | None = None


Steps: TypeAlias = Generator[ToJudge, Candidate, T]  # a routine that asks for designs


def in_step(scaled: ScaledProblem, routines: Sequence[Steps[T]]) -> list[T]:
    """The results of routines; all that they ask for at a time is judged together."""
    done, asked = dict[int, T](), dict[int, ToJudge]()

    def go_on(number: int, answer: Any) -> None:
        try:
            asked[number] = routines[number].send(answer)
        except StopIteration as end:
            done[number] = end.value

    for number in range(len(routines)):
        go_on(number, None)
    while asked:
        numbers, designs = list(asked), judged_linkages(scaled, list(asked.values()))
        asked.clear()
        for number, design in zip(numbers, designs, strict=True):
            go_on(number, design)
    return [done[number] for number in range(len(routines))]


def made_linkage(
    scaled: ScaledProblem,
    points: ComplexArray,
    assembly: int,
    body_angle: float,
    second: SecondLoop | None = None,
) -> Linkage | None:
    """The linkage of points in sizes; None where two pivots coincide.

    O2, O4, and A, B, P at the first target are (5,), the body angle is in rad; full poses ignore it, since
    the first one fixes the body on the coupler.
    """
    given = None if scaled.motion is not None else np.array(body_angle)
    try:
        linkage = scaled.linkages(points, np.array(assembly), given)
        return linkage if second is None else second.added_to(linkage, scaled.frame)
    except ProblemError:
        return None


def judged(
    scaled: ScaledProblem,
    points: ComplexArray,
    assembly: int,
    body_angle: float,
    *,
    start: int,
    iterations: int,
) -> Candidate | None:
    """The design of `made_linkage`, judged."""
    linkage = made_linkage(scaled, points, assembly, body_angle)
    return None if linkage is None else judged_linkage(scaled, linkage, start=start, iterations=iterations)


def judged_linkage(scaled: ScaledProblem, linkage: Linkage, **about: Any) -> Candidate:
    """A linkage judged as a design, `about` it the fields of `ToJudge`."""
    return judged_linkages(scaled, [ToJudge(linkage, **about)])[0]


def judged_linkages(scaled: ScaledProblem, asked: Sequence[ToJudge]) -> list[Candidate]:
    """Linkages judged as designs, in their order; values that a ranking needs stay known."""
    verdicts = driven_verdicts(scaled, [(each.linkage, each.most_error, each.cylinder) for each in asked])
    found = list[Candidate]()
    for each, verdict in zip(asked, verdicts, strict=True):
        design = Candidate(each.linkage, verdict, scaled.problem, each.start, each.iterations)
        found.append(_valued(scaled, design))
        if verdict.ok:
            found[-1].objective(scaled.problem)  # here, where many are judged at once
    return found


def driven_verdict(
    scaled: ScaledProblem, linkage: Linkage, most_error: float = np.inf, known: Cylinder | None = None
) -> Verdict:
    """The judge's verdict on a linkage with the cylinder `known`, or else the best, where requested."""
    return driven_verdicts(scaled, [(linkage, most_error, known)])[0]


def driven_verdicts(
    scaled: ScaledProblem, asked: Sequence[tuple[Linkage, float, Cylinder | None]]
) -> list[Verdict]:
    """Verdicts as of `driven_verdict`; `most_error` is the root mean square error that is allowed, sizes."""
    problem, task = scaled.problem, scaled.problem.task
    judge = Judge(task, problem.requirements, scaled.constraints, problem)
    designs = [
        Subject(linkage, len(task) * (most_error * task.size) ** 2, known)
        for linkage, most_error, known in asked
    ]
    verdicts = judge.verdicts(designs)
    if problem.driver is None:
        return verdicts
    driven = {
        number: replace(design, cylinder=found)
        for number, (design, verdict) in enumerate(zip(designs, verdicts, strict=True))
        if design.cylinder is None and (found := cylinder_for(problem, design.linkage, verdict)) is not None
    }
    again = dict(zip(driven, judge.verdicts(list(driven.values())), strict=True))
    return [again.get(number, verdict) for number, verdict in enumerate(verdicts)]


def judged_again(scaled: ScaledProblem, candidate: Candidate, most_error: float = np.inf) -> Candidate:
    """A design judged by the requirements of another problem with the same targets."""
    return all_judged_again(scaled, [candidate], most_error)[0]


def all_judged_again(
    scaled: ScaledProblem, found: Sequence[Candidate], most_error: float = np.inf
) -> list[Candidate]:
    """Designs judged by the requirements of another problem with the same targets, in their order."""
    asked = [(one.linkage, most_error, one.verdict.cylinder) for one in found]
    verdicts = driven_verdicts(scaled, asked)
    return [
        _valued(scaled, replace(one, verdict=verdict, problem=scaled.problem))
        for one, verdict in zip(found, verdicts, strict=True)
    ]


def judged_in_time(
    scaled: ScaledProblem, found: Sequence[Candidate], most_error: float = np.inf
) -> list[Candidate]:
    """As `judged_again`, in their order; where time runs out, those of the least error."""
    errors, judged = [one.error(one.problem) for one in found], dict[int, Candidate]()
    order = sorted(range(len(found)), key=errors.__getitem__)
    for begin in range(0, len(found), AT_ONCE):
        if judged and overdue():
            break
        some = order[begin : begin + AT_ONCE]
        judged |= zip(some, all_judged_again(scaled, [found[k] for k in some], most_error), strict=True)
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
