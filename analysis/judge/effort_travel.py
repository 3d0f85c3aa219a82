"""The effort of a design over its task motion, with its defects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from grashof.analysis.cylinder.travel import travel
from grashof.analysis.effort.case import EffortCase
from grashof.analysis.effort.deviation import effort_figures
from grashof.analysis.effort.parts import place_on
from grashof.analysis.judge.over_task import motion_ends
from grashof.analysis.judge.regions import distances, slack_of
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.problems import Linkage, Problem
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.dynamics.struts import BODY, EffortPlace


def effort_of_design(
    linkage: Linkage, problem: Problem, verdict: Verdict, effort: EffortSpec | None = None
) -> EffortCase | None:
    """The effort over the task motion: by default that of the verdict with its parts, or of the problem.

    None where the problem states no effort, or no motion joins the targets.
    """
    dynamics = problem.dynamics
    if dynamics is None or dynamics.effort is None:
        return None
    ends = motion_ends(problem.task, verdict) if verdict.branch_ok else None
    moved = travel(linkage, verdict.theta2, verdict.assembly, ends)
    if moved is None or moved.start == moved.end:
        return None
    given = replace(dynamics, effort=effort or verdict.effort or dynamics.effort)
    return EffortCase(linkage, given, metres(problem.length_unit), moved)


def effort_defects(case: EffortCase, problem: Problem) -> list[Defect]:
    """Strokes that end inside the travel, angles beyond it, parts too many or few, ends outside areas."""
    found = [Defect(*miss) for miss in effort_figures(case).misses]
    asked = None if problem.dynamics is None else problem.dynamics.effort
    if asked is None:
        return found
    parts, areas = case.spec.parts, asked.parts
    if (off := abs(len(parts) - len(areas))) > 0:
        what = "the number of struts and springs"
        found.append(Defect("effort.parts", what, len(parts), str(len(areas)), float(off)))
    for index, (part, area) in enumerate(zip(parts, areas, strict=False)):
        for end, pair in enumerate(zip(part.places, area.places, strict=False)):
            key = f"effort.parts[{index}].between[{end}]"
            found += _outside(key, case.linkage, *pair, problem.task.size)
    return found


def _outside(
    key: str, linkage: Linkage, place: EffortPlace, area: EffortPlace, size: float
) -> Iterator[Defect]:
    """A defect of an end on another link than its area, or outside the area; both may be on the body."""
    (link, point), (carrier, _) = place_on(linkage, place), place_on(linkage, area)
    if link != carrier:
        yield Defect(f"{key}.link", "the link of the end", link, str(carrier), 1.0)
        return
    at = complex(*point)
    if area.link == BODY:
        at = (at - complex(*linkage.coupler_point)) * np.exp(-1j * float(linkage.body_angle))
    away = float(distances(area.at, np.array(at.real), np.array(at.imag)))
    if away > slack_of(area.at) * size:
        yield Defect(f"{key}.at", "the distance of the end from its area", away, "0", away / size)


def effort_deviation(linkage: Linkage, problem: Problem, verdict: Verdict) -> float:
    """Greatest deviation from the wanted effort with the parts of the verdict, N; NaN without them."""
    case = effort_of_design(linkage, problem, verdict)
    return np.nan if case is None or verdict.effort is None else effort_figures(case).deviation.greatest
