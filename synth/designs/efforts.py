"""The struts and springs of a design: the best ones for its travel, where the problem states an effort."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from grashof.analysis.judge.effort_of_file import effort_of_file
from grashof.analysis.judge.effort_travel import effort_defects, effort_of_design
from grashof.problems import LinkageSpec, ProblemError
from grashof.problems.values.dynamics.struts import PartSpec
from grashof.synth.designs.candidate import Candidate
from grashof.synth.effort.placing import placed
from grashof.synth.theory.stopping import overdue

_OF_PARTS = "effort.parts"
_NO_SIZE = (
    "no size of effort.parts lasts the travel between places in their areas; widen the areas, or add sizes "
    "with other strokes"
)
_PLACED = {1: 24, 2: 6}  # number of designs of a list that get parts, by the number of parts


def with_best_parts(designs: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """The designs of a list; the first of them have the best struts and springs, as far as time allows."""
    dynamics = designs[0].problem.dynamics if designs else None
    if dynamics is None or dynamics.effort is None:
        return tuple(designs)
    count = _PLACED.get(len(dynamics.effort.parts), len(designs))
    return tuple(with_parts(each) if k < count and not overdue() else each for k, each in enumerate(designs))


def why_without(designs: Sequence[Candidate]) -> str:
    """Why no design of a list got struts or springs; empty where some did."""
    if any(each.verdict.effort is not None for each in designs):
        return ""
    why = "the time limit left no time to place them" if overdue() else _NO_SIZE
    return f"the designs have no struts or springs: {why}"


def with_parts(candidate: Candidate, known: Sequence[PartSpec] = ()) -> Candidate:
    """A design with struts and springs: the known ones, with their defects, or the best that are found.

    Parts that the search found and the judge rejects are left out.
    """
    linkage, problem, verdict = candidate.linkage, candidate.problem, candidate.verdict
    case = effort_of_design(linkage, problem, verdict)
    if case is None:
        return candidate
    given = bool(known) and all(part.is_placed for part in known)
    effort = replace(case.spec, parts=tuple(known)) if given else placed(case)
    if effort is None:
        return candidate
    defects = effort_defects(replace(case, dynamics=replace(case.dynamics, effort=effort)), problem)
    if given:
        return replace(
            candidate, verdict=replace(verdict, effort=effort, defects=(*verdict.defects, *defects))
        )
    if any(defect.requirement.startswith(_OF_PARTS) for defect in defects):
        return candidate
    return replace(candidate, verdict=replace(verdict, effort=effort))


def place_parts(spec: LinkageSpec) -> LinkageSpec:
    """A linkage with the best struts and springs for the effort that its file states.

    Parameters
    ----------
    spec : LinkageSpec
        Sizes and places of the parts of its effort may be open.

    Returns
    -------
    LinkageSpec
        The same where nothing is open; otherwise every part has one size, and points in place of areas.

    Raises
    ------
    ProblemError
        No size has enough stroke for the travel between places in the areas, or the travel is not known.
    """
    case = effort_of_file(spec)
    if case is None or spec.dynamics is None or case.spec.is_placed:
        return spec
    found = placed(case)
    if found is None:
        raise ProblemError(f"{spec.name}: {_NO_SIZE}")
    return replace(spec, dynamics=replace(spec.dynamics, effort=found))
