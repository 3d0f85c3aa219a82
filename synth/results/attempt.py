"""One attempt: a solve from one start, made exact, and judged. Runs in any process."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis import verify
from grashof.problems import ProblemError
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.programme.along_motion import overlooked
from grashof.synth.programme.limits import ADDED
from grashof.synth.programme.nonlinear_programme import Solve, solve
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import Configurations, dyad_violations, judge, met
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.results.candidate import Candidate
from grashof.synth.theory.burmester import Dyads, polish
from grashof.synth.theory.cognates import assembly_of, cognate_points, position_of
from grashof.synth.theory.polish import Polished, Wish, polish_path

TRANSMISSION = "transmission_min_deg"
UNSOLVED = frozenset({"order", "same_branch"})  # no smooth constraint can relax these
NUDGE = 0.1  # sizes: a polish that moves a start farther has lost it
SOLVED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")
EXCHANGES = 4  # times at most that a solve is repeated for what is bounded along the motion
CLOSE = 1e-4  # sizes: a least-squares design so near to its targets can be made exact
# The judge may put the ends of the motion a little farther than the programme: so many solves at most
# ask for that much more of the transmission, unless what is missing is more than a little (rad).
MORE, BEYOND, A_LITTLE = 5, 1.05, 0.2


@dataclass(frozen=True, slots=True)
class Attempt:
    """What became of a start.

    Parameters
    ----------
    status : str
        Ipopt's return status.
    candidate : Candidate or None
        The design, judged, defects or not; None when the numbers make no linkage.
    cognates : tuple of Candidate
        For a path: other linkages with the same coupler curve, without defects.
    """

    status: str
    candidate: Candidate | None
    cognates: tuple[Candidate, ...] = ()


def attempt(scaled: ScaledProblem, start: Start, number: int) -> Attempt:
    """Solve from a start, polish the design to be exact, verify.

    Parameters
    ----------
    scaled : ScaledProblem
    start : Start
    number : int
        Of the start.

    Returns
    -------
    Attempt
    """
    if scaled.motion is None and scaled.exact:
        start = _on_targets(scaled, start)
    points = (start.o2, start.o4, start.a, start.b, start.p)
    solved = Solve(points, start.theta2, start.theta3, start.body_angle, "Not_Solved", 0)
    as_it_is = start.settled or not UNSOLVED.isdisjoint(start.relaxed)
    candidate = _made(scaled, start, solved, number) if as_it_is else None
    free = scaled.motion is None or len(scaled.targets) < 5  # five poses leave nothing to solve for
    if not as_it_is or (free and start.settled and (candidate is None or not candidate.verdict.ok)):
        solved, candidate = _solved_and_made(scaled, start, number)
    if candidate is None or not candidate.verdict.ok or scaled.has_angles:
        return Attempt(solved.status, candidate)
    return Attempt(solved.status, candidate, _cognates(scaled, candidate))


def _solved_and_made(scaled: ScaledProblem, start: Start, number: int) -> tuple[Solve, Candidate | None]:
    """Solve and judge; again, asking for more, as long as the transmission alone is a little short."""
    solved = _solved(scaled, start)
    if solved.status not in SOLVED and any(Form.of(scaled, start).nearest):
        start = replace(start, loose=True)
        solved = _solved(scaled, start)
    candidate = _made(scaled, start, solved, number)
    for _ in range(0 if scaled.exact else MORE):
        short = _short_of_transmission(candidate)
        if not 0 < short < A_LITTLE:
            break
        start = replace(begun_from(start, solved), more_transmission=start.more_transmission + BEYOND * short)
        again = _solved(scaled, start)
        if again.status not in SOLVED:
            break
        solved = replace(again, iterations=solved.iterations + again.iterations)
        candidate = _made(scaled, start, solved, number)
    return solved, candidate


def _short_of_transmission(candidate: Candidate | None) -> float:
    """By how much the transmission is missed, where nothing else is, rad; else zero."""
    if candidate is None or {defect.requirement for defect in candidate.verdict.defects} != {TRANSMISSION}:
        return 0.0
    return candidate.verdict.defects[0].miss


def begun_from(start: Start, solved: Solve) -> Start:
    """A start where a solve ended."""
    o2, o4, a, b, p = solved.points
    moved = replace(start, o2=o2, o4=o4, a=a, b=b, p=p, body_angle=solved.body_angle)
    return replace(moved, theta2=solved.theta2, theta3=solved.theta3)


def _solved(scaled: ScaledProblem, start: Start) -> Solve:
    """Solve; again from there with other driver angles added, as long as a bound is exceeded there.

    An exchange method for a bound that holds over an interval (Hettich & Kortanek 1993, section 7).
    """
    solved = solve(scaled, start)
    for _ in range(EXCHANGES):
        if solved.status not in SOLVED:
            break
        points, theta2 = np.array(solved.points), np.array(solved.theta2)
        ways = points, theta2, start.direction, start.assembly
        found = {key: overlooked(scaled.problem, key, *ways, bound) for key, bound in solved.peaks.items()}
        if not any(found.values()):
            break
        added = {key: (*peaks, *start.peaks_at.get(key, ()))[:ADDED] for key, peaks in found.items()}
        start = replace(begun_from(start, solved), peaks_at=added)
        again = solve(scaled, start)
        if again.status not in SOLVED:
            break
        solved = replace(again, iterations=solved.iterations + again.iterations)
    return solved


def _on_targets(scaled: ScaledProblem, start: Start) -> Start:
    """A start of an exact path task moved onto the targets, where that takes no more than a nudge."""
    polished = _on_path(scaled, start.visit, start.points, start)
    if polished is None or np.abs(polished.points - start.points).max() > NUDGE:
        return start
    visit = list(start.visit)
    o2, o4, a, b, p = (complex(point) for point in polished.points)
    theta3 = np.unwrap(np.angle(polished.coupler[visit]))
    theta3 += 2 * np.pi * np.round((start.theta3[0] - theta3[0]) / (2 * np.pi))
    theta2, body_angle = tuple(polished.theta2[visit].tolist()), polished.body_angle
    moved = replace(start, o2=o2, o4=o4, a=a, b=b, p=p, body_angle=body_angle)
    return replace(moved, theta2=theta2, theta3=tuple(theta3.tolist()))


def _on_path(
    scaled: ScaledProblem,
    visit: tuple[int, ...],
    points: ComplexArray,
    angles: Start | Solve,
) -> Polished | None:
    """A design polished, with its angles in the order of visit; None where that leads astray."""
    order = np.argsort(visit)
    theta2, theta3 = np.array(angles.theta2)[order], np.array(angles.theta3)[order]
    o2, o4, a, b, p = points
    at_a, turned = o2 + abs(a - o2) * np.exp(1j * theta2), np.exp(1j * theta3)
    at_b, at_p = at_a + abs(b - a) * turned, at_a + (p - a) * turned / turned[0]
    if not scaled.exact and scaled.missed(at_p, theta3 + angles.body_angle) > CLOSE:
        return None
    assembly = np.where((turned.conj() * (at_b - o4)).imag >= 0, 1.0, -1.0)
    wish = Wish(
        points=scaled.targets,
        has_point=scaled.weights > 0,
        turns=scaled.turns,
        has_turn=scaled.turn_weights > 0,
        timed=scaled.timed,
    )
    polished = polish_path(points, theta2, angles.body_angle, assembly, wish)
    return polished if polished.error < CLOSE and np.isfinite(polished.points).all() else None


def _made(scaled: ScaledProblem, start: Start, solved: Solve, number: int) -> Candidate | None:
    points, body_angle = np.array(solved.points), solved.body_angle
    if not np.isfinite(points).all():
        return None
    if scaled.motion is not None:
        dyads = polish(scaled.motion, Dyads(moving=points[2:4], ground=points[:2]))
        points = np.concatenate([dyads.ground, dyads.moving, points[4:]])
    else:
        polished = None if start.bounded else _on_path(scaled, start.visit, points, solved)
        if polished is not None:
            made = _Made(polished.points, polished.body_angle, start.assembly)
            candidate = _candidate(scaled, made, number, solved.iterations, most_error=start.most_error)
            # On its targets a least-squares design may lie beyond a limit that is active.
            if scaled.exact or (candidate is not None and candidate.verdict.ok):
                return candidate
    made = _Made(points, body_angle, start.assembly)
    return _candidate(scaled, made, number, solved.iterations, most_error=start.most_error)


@dataclass(frozen=True, slots=True)
class _Made:
    points: ComplexArray
    body_angle: float
    assembly: int


def _candidate(
    scaled: ScaledProblem,
    made: _Made,
    number: int,
    iterations: int,
    cognate_of: str = "",
    most_error: float = np.inf,
) -> Candidate | None:
    body_angle = None if scaled.motion is not None else np.array(made.body_angle)
    try:
        linkage = scaled.linkages(made.points, np.array(made.assembly), body_angle)
    except ProblemError:  # two pivots coincide
        return None
    problem = scaled.problem
    verdict = verify(
        linkage,
        problem.task,
        problem.requirements,
        scaled.constraints,
        most_square=len(problem.task) * (most_error * scaled.frame.scale) ** 2,
        problem=problem,
    )
    candidate = Candidate(linkage, verdict, problem, number, iterations, cognate_of)
    if verdict.ok:
        candidate.objective(problem)  # here, where many are judged at the same time; the values stay known
    return candidate


def _cognates(scaled: ScaledProblem, candidate: Candidate) -> tuple[Candidate, ...]:
    """The cognates without defects; none where pivots or start angle are fixed."""
    wanted = scaled.wanted
    fixed = (box.x[0] == box.x[1] and box.y[0] == box.y[1] for box in (wanted.o2, wanted.o4) if box)
    if any(fixed) or wanted.theta2_start_deg is not None:
        return ()
    position = position_of(candidate.linkage, float(candidate.verdict.theta2[0]))
    points = [
        (cognate - scaled.frame.origin) / scaled.frame.scale
        for cognate in cognate_points(position, scaled.timed)
    ]
    found = []
    for cognate in points:
        if np.isfinite(cognate).all() and _worth_judging(scaled, cognate):
            made = _Made(cognate, 0.0, assembly_of(cognate))
            other = _candidate(scaled, made, candidate.start, candidate.iterations, candidate.id)
            if other is not None and other.verdict.ok:
                found.append(other)
    return tuple(found)


def _worth_judging(scaled: ScaledProblem, points: ComplexArray) -> bool:
    """Whether lengths, pivots and rotatability of a linkage are as required: cheap to know beforehand."""
    o2, o4, a, b, p = points[:, None]
    one, none = np.zeros((1, 1), dtype=np.int64), np.zeros(1)
    theta2 = np.angle(a - o2)[:, None]
    places = Configurations(o2, o4, a[:, None], b[:, None], one, theta2, none + 1)
    violations = dyad_violations("o2", o2, a[:, None], p, scaled.wanted)
    violations += dyad_violations("o4", o4, b[:, None], p, scaled.wanted)
    return bool(met(judge(places, p, none, violations, scaled.wanted).violations)[0])
