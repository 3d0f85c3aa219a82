"""What makes one design better than another, as numbers."""

from __future__ import annotations

import numpy as np

from grashof.problems import Objective, Problem
from grashof.problems.values.arrays import FloatArray

SAME_ERROR = 1e-6  # sizes: least-squares errors up to it count as equal, or up to a greater tolerance


def weigh(
    objective: Objective, transmission: FloatArray, size: FloatArray, torque: FloatArray | None = None
) -> FloatArray:
    """Scores (n,) of transmission angles (rad), sizes (of the task) and, if any, torques (reference ones)."""
    score = objective.transmission * transmission / (np.pi / 2) - objective.compactness * size
    return score if torque is None else score - objective.torque * torque


def same_error(problem: Problem) -> float:
    """Errors up to this one count as equal; in sizes of the task."""
    tolerance = problem.requirements.tolerance
    return tolerance if problem.requirements.is_exact(problem.task) else max(SAME_ERROR, tolerance)
