"""The effort of a design over its task motion, with its defects."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.analysis.cylinder.travel import travel
from grashof.analysis.effort.case import EffortCase
from grashof.analysis.effort.deviation import effort_figures
from grashof.analysis.judge.over_task import motion_ends
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.problems import Linkage, Problem
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.effort import EffortSpec


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


def effort_defects(case: EffortCase) -> list[Defect]:
    """Strokes that end inside the travel, and angles of the effort beyond it."""
    return [Defect(*miss) for miss in effort_figures(case).misses]


def effort_deviation(linkage: Linkage, problem: Problem, verdict: Verdict) -> float:
    """Greatest deviation from the wanted effort with the parts of the verdict, N; NaN without them."""
    case = effort_of_design(linkage, problem, verdict)
    return np.nan if case is None or verdict.effort is None else effort_figures(case).deviation.greatest
