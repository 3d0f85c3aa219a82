"""The struts and springs of a design: the best ones for its travel, where the problem states an effort."""

from __future__ import annotations

from dataclasses import replace

from grashof.analysis.effort.deviation import effort_figures
from grashof.analysis.judge.effort_of_file import effort_of_file
from grashof.analysis.judge.effort_travel import effort_defects, effort_of_design
from grashof.problems import LinkageSpec, ProblemError
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.synth.designs.candidate import Candidate
from grashof.synth.effort.placing import placed

_OF_PARTS = "effort.parts"


def with_parts(candidate: Candidate, known: EffortSpec | None = None) -> Candidate:
    """A design with struts and springs: those that are known, with their defects, or the best that are found.

    Parts that the search found and the judge rejects are left out.
    """
    linkage, problem, verdict = candidate.linkage, candidate.problem, candidate.verdict
    case = effort_of_design(linkage, problem, verdict, known)
    if case is None:
        return candidate
    if known is not None and known.is_placed:
        defects = (*verdict.defects, *effort_defects(case))
        return replace(candidate, verdict=replace(verdict, effort=known, defects=defects))
    found = placed(case)
    if found is None:
        return candidate
    judged = effort_of_design(linkage, problem, verdict, found)
    if judged is None or any(miss.key.startswith(_OF_PARTS) for miss in effort_figures(judged).misses):
        return candidate
    return replace(candidate, verdict=replace(verdict, effort=found))


def place_parts(spec: LinkageSpec) -> LinkageSpec:
    """A linkage with the best struts and springs for the effort that its file states.

    Parameters
    ----------
    spec : LinkageSpec
        Its effort may leave sizes and places of parts open.

    Returns
    -------
    LinkageSpec
        The same where nothing is open; otherwise every part has one size, and points in place of areas.

    Raises
    ------
    ProblemError
        No size of the tables lasts the travel between places in the areas.
    """
    case = effort_of_file(spec)
    if case is None or spec.dynamics is None or case.spec.is_placed:
        return spec
    found = placed(case)
    if found is None:
        raise ProblemError(
            f"{spec.name}: no size of effort.parts lasts the travel between places in their areas; widen the "
            "areas, or add sizes with other strokes"
        )
    return replace(spec, dynamics=replace(spec.dynamics, effort=found))
