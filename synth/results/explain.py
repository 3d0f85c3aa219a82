"""Why there is no design: what alone would have to be relaxed, and the closest misses."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis import Verdict
from grashof.problems import Problem, Rotatability
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Start
from grashof.synth.programme.user_constraints import relaxed as relaxed_own
from grashof.synth.results.attempt import Attempt
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.larger_zones import up, wider
from grashof.synth.results.relaxation import Relaxation
from grashof.synth.results.result import Result
from grashof.synth.results.single_relaxations import relaxations
from grashof.synth.results.workers import Solver
from grashof.synth.starts import exact_poses, paths

STOPPED = "no design: the search was stopped before it found one"
SHOWN = 8  # least-squares designs that stand for the nearest
ALTERNATIVES = 6  # that the note names


@dataclass(frozen=True, slots=True)
class Failure:
    """A search that ended empty.

    Parameters
    ----------
    scaled : ScaledProblem
    starts : list of Start
        Of its last round.
    rejected : list of Attempt
        What was solved, in vain.
    counts : mapping of str to int
        See `Result`.
    """

    scaled: ScaledProblem
    starts: list[Start]
    rejected: list[Attempt]
    counts: Mapping[str, int]


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why a list is empty.

    Parameters
    ----------
    note : str
    nearest : tuple of Candidate
        The closest misses, the smallest first.
    designs : tuple of Candidate
        Designs that do meet all requirements, where looking for near ones came upon some.
    """

    note: str
    nearest: tuple[Candidate, ...] = ()
    designs: tuple[Candidate, ...] = ()


@dataclass(frozen=True, slots=True)
class _Near:
    """A design of least squares: judged as such, and against the requirements as they were asked."""

    by_squares: Verdict
    candidate: Candidate


def explain(
    failure: Failure,
    solve: Solver,
    search: Callable[[Problem], Result],
    rng: np.random.Generator,
    ended: Callable[[], bool],
) -> Explanation:
    """Say why a search found nothing: what would do instead, and how near designs come.

    Parameters
    ----------
    failure : Failure
    solve : callable
        Attempts from starts.
    search : callable
        A search of limited effort for another problem, which explains nothing.
    rng : numpy.random.Generator
    ended : callable
        Asked between solves: to be content with what there is.

    Returns
    -------
    Explanation
    """
    scaled = failure.scaled
    known = [one.candidate for one in failure.rejected if one.candidate is not None]
    ways = relaxations(scaled, solve, known, rng, ended) + wider(scaled.problem, scaled.constraints, known)
    ways.sort(key=lambda way: (way.miss, way.key))
    near = [] if ended() else _by_least_squares(scaled, search)
    designs = tuple(one.candidate for one in near if one.candidate.verdict.ok)
    if designs:
        return Explanation("", designs=designs)
    why = exact_poses.obstacle(scaled, rng) if scaled.motion is not None else _exhausted(failure.counts)
    if ways:
        size = scaled.problem.task.size
        near = [one for one in near[:1] if _miss(one, size) < 1]  # farther away than the task is long
        missed = [(way.miss, way.candidate) for way in ways] + [
            (_miss(one, size), one.candidate) for one in near
        ]
        missed.sort(key=lambda pair: pair[0])
        return Explanation(_ways_note(scaled, ways, near, why), tuple(one for _, one in missed))
    if near:
        note = f"no design: {why or 'exact: none'}; {_comes_within(scaled, near[0])}, with exact = false"
        return Explanation(note, tuple(one.candidate for one in near))
    relaxed = _relaxed_starts(failure, rng)
    nearest = () if ended() else closest_misses(solve(scaled, relaxed, len(failure.rejected)))
    nearest = nearest or closest_misses(failure.rejected)
    return Explanation(_none_note(scaled, nearest, why), nearest)


def closest_misses(attempts: list[Attempt]) -> tuple[Candidate, ...]:
    """The closest miss for each set of missed requirements, fewest and smallest misses first."""
    closest: dict[frozenset[str], tuple[float, Candidate]] = {}
    for result in attempts:
        if result.candidate is None or result.candidate.verdict.ok:
            continue
        defects = result.candidate.verdict.defects
        kind = frozenset(defect.requirement for defect in defects)
        miss = sum(defect.miss for defect in defects)
        if kind not in closest or miss < closest[kind][0]:
            closest[kind] = (miss, result.candidate)
    if not closest:
        return ()
    fewest = min(len(kind) for kind in closest)
    found = [
        (miss, sorted(kind), candidate) for kind, (miss, candidate) in closest.items() if len(kind) == fewest
    ]
    return tuple(candidate for _, _, candidate in sorted(found, key=lambda item: item[:2]))


def _by_least_squares(scaled: ScaledProblem, search: Callable[[Problem], Result]) -> list[_Near]:
    """For targets to be met exactly: designs that come as near as they can, the nearest first."""
    problem = scaled.problem
    if not scaled.exact or not _may_be_near(scaled):
        return []
    wanted = replace(problem.requirements, exact=False)
    found = search(replace(problem, requirements=wanted)).candidates[:SHOWN]
    return [_Near(one.verdict, one.judged(problem, scaled.constraints)) for one in found]


def _may_be_near(scaled: ScaledProblem) -> bool:
    """Whether least squares can be tried: two poses leave it nothing to make small."""
    return len(scaled.targets) > 2


def _relaxed_starts(failure: Failure, rng: np.random.Generator) -> list[Start]:
    """Starts that may miss the smallest set of requirements that is known to do."""
    scaled = failure.scaled
    find = paths.relaxed_starts if scaled.motion is None else exact_poses.relaxed_starts
    return find(scaled, rng) + relaxed_own(scaled, failure.starts)


def _miss(near: _Near, size: float) -> float:
    """By how much a least-squares design misses its targets: sizes or rad."""
    verdict = near.by_squares
    turned = np.nanmax(verdict.angle_error, initial=0.0)
    return max(verdict.error_max / size, float(turned))


def _exhausted(counts: Mapping[str, int]) -> str:
    """What is known of a task of which all linkages were computed; empty for others."""
    every = counts.get("linkages through the points", 0)
    return f"none of the {every} linkages through the points meets all requirements" if every else ""


def _ways_note(scaled: ScaledProblem, ways: list[Relaxation], near: list[_Near], why: str) -> str:
    """The note that names single requirements, the smallest miss first."""
    priced = [(way.miss, way.words) for way in ways]
    if near:
        priced.append(
            (
                _miss(near[0], scaled.problem.task.size),
                f"exact = false ({_comes_within(scaled, near[0], then='then ')})",
            )
        )
    words = [text for _, text in sorted(priced)][:ALTERNATIVES]
    said = f"no design: {why}" if why else "no design meets all requirements"
    alone = "this alone would do" if len(words) == 1 else "each of these alone would do"
    return f"{said}; {alone}: {'; '.join(words)}"


def _comes_within(scaled: ScaledProblem, near: _Near, then: str = "") -> str:
    """How near a least-squares design comes; figures are rounded up, so that they hold."""
    unit = f" {scaled.problem.length_unit}" if scaled.problem.length_unit else ""
    text = f"the closest design {then}comes within {up(near.by_squares.error_max):g}{unit}"
    turned = near.by_squares.angle_error
    if np.isnan(turned).all():
        return f"{text} everywhere"
    return f"{text} and {up(float(np.degrees(np.nanmax(turned)))):g} deg everywhere"


def _none_note(scaled: ScaledProblem, nearest: tuple[Candidate, ...], why: str) -> str:
    """The note where no single requirement does."""
    squares = ", nor a least-squares design" if scaled.exact and _may_be_near(scaled) else ""
    closest = f"; the closest one misses {_missed(scaled, nearest[0])}" if nearest else ""
    if why:
        return f"no design: {why}{'; least squares finds none either' if squares else ''}{closest}"
    if not nearest:
        return f"no design: the search found none{squares}, nor a near miss"
    alone = len({defect.requirement for defect in nearest[0].verdict.defects}) == 1
    return f"no design meets all requirements{'' if alone else ', nor all but one'}{closest}"


def _missed(scaled: ScaledProblem, candidate: Candidate) -> str:
    """What a design misses, and which line of the problem file would ask for less."""
    defects = candidate.verdict.defects
    missed, less = {defect.requirement for defect in defects}, ""
    if "rotatability" in missed and scaled.wanted.rotatability is not Rotatability.ANY:
        less = '; rotatability = "any" asks for less'
    return " and ".join(map(str, defects)) + less
