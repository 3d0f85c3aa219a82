"""What speaks against building a design that does all that is asked: such designs come last in a list."""

from __future__ import annotations

import numpy as np

from grashof.analysis import rotatability
from grashof.problems import Objective, Problem
from grashof.problems.values.requirements.requirements import Rotatability, TransmissionOver
from grashof.problems.values.specs.problem import SMALLEST
from grashof.synth.designs.candidate import Candidate

# In sizes of the task; rad of the driver; rad over the turn of a full crank; as `rotatability_margin`.
MOST_SIZE, LEAST_ROTATION, LEAST_TRANSMISSION, LEAST_MARGIN = 3.0, np.radians(15.0), np.radians(15.0), 0.01


def caution(problem: Problem, candidate: Candidate) -> str:
    """Why a design is hard to build or to drive, in words; empty where nothing is known against it."""
    # designs for an objective that the user states are judged by that
    if candidate.own_objective is not None or problem.objective not in (Objective(), SMALLEST):
        return ""
    wanted, verdict, found = problem.requirements, candidate.verdict, list[str]()
    # functions and strokes have no size to compare with, lists by least squares offer small designs anyway
    sized = problem.task.in_plane and problem.by_objective and wanted.size is None
    if sized and verdict.size > MOST_SIZE * problem.task.size:
        found.append(f"{verdict.size / problem.task.size:.1f} times the size of the task")
    turned = float(np.ptp(verdict.theta2))
    # what the user limits is judged by those limits alone
    chosen = wanted.driver_rotation_deg is not None or problem.task.is_timed
    if not chosen and turned < LEAST_ROTATION:
        found.append(f"the driver turns by {np.degrees(turned):.1f} deg alone")
    if wanted.rotatability is not Rotatability.ANY and verdict.full_rotation:
        limited = wanted.transmission_over is TransmissionOver.CYCLE and wanted.transmission_min_deg > 0
        if not limited and verdict.transmission_min_cycle < LEAST_TRANSMISSION:
            worst = np.degrees(verdict.transmission_min_cycle)
            found.append(f"transmission angle {worst:.1f} deg somewhere in the turn")
        margin = float(rotatability(candidate.linkage).min())
        if wanted.rotatability_margin == problem.task.usual_margin and margin < LEAST_MARGIN:
            found.append(f"it nearly folds: {margin:.4f} left of its lengths")
    return "; ".join(found)
