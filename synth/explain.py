"""Why there is no design: the closest misses, and what stands in the way."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from grashof.analysis import verify
from grashof.problems import Problem, Rotatability
from grashof.synth.attempt import Attempt
from grashof.synth.result import Candidate, Result
from grashof.synth.setup import Setup


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


def approximate(setup: Setup, solve: Callable[[Problem], Result]) -> tuple[Candidate, ...]:
    """For exact poses that leave nothing to choose: designs that come as near as they can.

    Parameters
    ----------
    setup : Setup
    solve : callable
        A search of its own for another problem.
    """
    problem = setup.problem
    if setup.motion is None or len(setup.targets) < 5:
        return ()
    loose = replace(problem, requirements=replace(problem.requirements, exact=False))
    wanted, own = problem.requirements, setup.constraints
    judged = (
        replace(found, verdict=verify(found.linkage, problem.task, wanted, own))
        for found in solve(loose).candidates
    )
    return tuple(found for found in judged if not found.verdict.ok)


def exhausted(counts: Mapping[str, int]) -> str:
    """What is known of a task of which all linkages were computed; empty for others."""
    every = counts.get("linkages through the points", 0)
    return f"none of the {every} linkages through the points meets all requirements" if every else ""


def why_none(setup: Setup, nearest: tuple[Candidate, ...], complete: bool, obstacle: str) -> str:
    """The note of an empty list."""
    if not complete:
        return "no design: the search was stopped before it found one"
    if obstacle:
        closest = f"; the closest one misses {_missed(setup, nearest[0])}" if nearest else ""
        return f"no design: {obstacle}{closest}"
    if not nearest:
        return "no design: the search found none, nor a near miss"
    return f"no design meets all requirements; the closest one misses {_missed(setup, nearest[0])}"


def _missed(setup: Setup, candidate: Candidate) -> str:
    """What a design misses, and which line of the problem file would ask for less."""
    defects = candidate.verdict.defects
    missed, less = {defect.requirement for defect in defects}, ""
    if "rotatability" in missed and setup.wanted.rotatability is not Rotatability.ANY:
        less = '; rotatability = "any" asks for less'
    if "exact" in missed:
        less += "; exact = false asks for less"
    return " and ".join(map(str, defects)) + less
