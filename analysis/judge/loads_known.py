"""The judge of loads over a travel: whether their rows cover what the slide travels."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis.forces.stated import TRAVEL_ROUNDING
from grashof.analysis.judge.sampled_motion import as_used, joins, motion_ends, sampled
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import Linkage, Problem
from grashof.problems.values.arrays import FloatArray


def load_defects(linkage: Linkage, problem: Problem, verdict: Verdict) -> Iterator[Defect]:
    """A defect for every load over the travel of a slide that does not say what it is all the way."""
    loads = () if problem.dynamics is None else problem.dynamics.loads
    over = {index: load.values for index, load in enumerate(loads) if load.over == "travel" and load.values}
    if not over or not linkage.mechanism.slides:
        return
    linkage = as_used(linkage, verdict)
    theta2 = sampled(linkage, *motion_ends(problem.task, verdict))
    if not joins(linkage, verdict, theta2):
        return

    def travels(angles: FloatArray) -> FloatArray:
        travel = solve_position(linkage, angles).travel
        return np.stack([travel, -travel])

    high, low = peaks(travels, [theta2])[0] * [1.0, -1.0]
    for index, rows in over.items():
        least, most = rows[0][0], rows[-1][0]
        slack = TRAVEL_ROUNDING * max(abs(least), abs(most))
        for found, miss in ((low, least - low), (high, high - most)):
            if miss > slack:
                what = f"the travel of the slide under loads[{index}]"
                yield Defect(
                    "loads", what, float(found), f"{least:g} to {most:g}", float(miss / problem.task.size)
                )
