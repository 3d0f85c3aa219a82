"""A solve repeated with more driver angles at which the torque is bounded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.synth.programme.drive_torque import overlooked
from grashof.synth.programme.nonlinear_programme import Solve, solve
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import ADDED

SOLVED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")
EXCHANGES = 4  # times at most that a solve is repeated


def solve_for_torque(scaled: ScaledProblem, start: Start) -> Solve:
    """Solve; again from there with other driver angles added, as long as the torque exceeds its bound there.

    An exchange method for a bound that holds over an interval (Hettich & Kortanek 1993, section 7).
    """
    solved = solve(scaled, start)
    for _ in range(EXCHANGES):
        if np.isnan(solved.torque) or solved.status not in SOLVED:
            break
        points, theta2 = np.array(solved.points), np.array(solved.theta2)
        peaks = overlooked(scaled.problem, points, theta2, start.direction, start.assembly, solved.torque)
        if not peaks:
            break
        start = replace(begun_from(start, solved), torque_at=(*peaks, *start.torque_at)[:ADDED])
        again = solve(scaled, start)
        if again.status not in SOLVED:
            break
        solved = replace(again, iterations=solved.iterations + again.iterations)
    return solved


def begun_from(start: Start, solved: Solve) -> Start:
    """A start where a solve ended."""
    return start.at(solved.points, solved.theta2, solved.theta3, solved.body_angle)
