"""A solve repeated with more driver angles, for bounds that hold along the motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.synth.programme.limits import ADDED
from grashof.synth.programme.nonlinear_programme import Solve, solve
from grashof.synth.programme.start import Start
from grashof.synth.quantities.along_motion import overlooked
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import stop_requested

SOLVED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")
EXCHANGES = 4  # times at most that a solve is repeated


def solve_by_exchange(scaled: ScaledProblem, start: Start) -> Solve:
    """Solve; again from there with other driver angles added, as long as a bound is exceeded there.

    An exchange method for a bound that holds over an interval (Hettich & Kortanek 1993, section 7).
    """
    solved = solve(scaled, start)
    for _ in range(EXCHANGES):
        if solved.status not in SOLVED or stop_requested():
            break
        points, theta2 = np.array(solved.points), np.array(solved.theta2)
        ways = points, theta2, start.direction, start.assembly
        found = {key: overlooked(scaled, key, *ways, bound) for key, bound in solved.peaks.items()}
        if not any(found.values()):
            break
        added = {key: (*peaks, *start.terms.peaks_at.get(key, ()))[:ADDED] for key, peaks in found.items()}
        start = begun_from(start, solved).under(peaks_at=added)
        again = solve(scaled, start)
        if again.status not in SOLVED:
            break
        solved = replace(again, iterations=solved.iterations + again.iterations)
    return solved


def begun_from(start: Start, solved: Solve) -> Start:
    """A start where a solve ended."""
    return start.at(solved.points, solved.theta2, solved.theta3, solved.body_angle)
