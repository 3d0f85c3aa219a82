"""The effort of a linkage file over its travel, or of a listed design over its task motion."""

from __future__ import annotations

import numpy as np

from grashof.analysis.cylinder.travel import Travel, travel
from grashof.analysis.effort.case import EffortCase
from grashof.analysis.judge.effort_travel import effort_of_design
from grashof.analysis.judge.verify import verify
from grashof.analysis.mechanism.mobility import dead_ends, driver_ranges, full_rotation
from grashof.problems import Linkage, LinkageSpec, ProblemError
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.effort import EffortSpec


def effort_of_file(spec: LinkageSpec) -> EffortCase | None:
    """The effort over the travel of a linkage file, or the task motion of a listed design; None without one.

    Raises
    ------
    ProblemError
        The travel is not stated and the driver turns fully, or the linkage does not move through it.
    """
    if spec.dynamics is None or spec.dynamics.effort is None:
        return None
    effort, problem = spec.dynamics.effort, spec.problem
    if problem is not None and problem.dynamics is not None:
        verdict = verify(
            spec.linkage, problem.task, problem.requirements, problem=problem, cylinder=spec.cylinder
        )
        case = effort_of_design(spec.linkage, problem, verdict, effort)
        if case is not None:
            return case
    return EffortCase(
        spec.linkage, spec.dynamics, metres(spec.length_unit), _stated_travel(spec.linkage, effort)
    )


def _stated_travel(linkage: Linkage, effort: EffortSpec) -> Travel:
    if effort.travel_deg is not None:
        ends = np.radians(effort.travel_deg)
    elif full_rotation(linkage):
        raise ProblemError(
            "effort.travel_deg is missing; the driver turns fully, so it must be two driver angles"
        )
    else:
        ends = np.array(dead_ends(linkage, *driver_ranges(linkage)[0]))
    assembly = np.full(2, int(linkage.assembly))
    moved = travel(linkage, ends, assembly, (float(ends[0]), float(ends[1])))
    if moved is None or moved.start == moved.end:
        angles = ", ".join(f"{angle:.6g}" for angle in np.degrees(ends))
        raise ProblemError(
            f"effort.travel_deg is [{angles}]; the linkage does not move from one to the other"
        )
    return moved
