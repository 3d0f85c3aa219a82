"""Zones: by how much a design misses them."""

from __future__ import annotations

import numpy as np

from grashof.analysis import Verdict
from grashof.problems import Problem

MISSED = {"within", "angle_within_deg", "exact"}  # what the judge calls a target missed by too much


def shares(problem: Problem, verdict: Verdict) -> tuple[float, float]:
    """How many times as large as its zone a miss is at most: of positions, and of angles."""
    place, turn = np.ones((2, len(problem.task))) if problem.zones is None else problem.zones
    turned = np.nanmax(verdict.angle_error / turn, initial=0.0)
    return float(np.nanmax(verdict.position_error / place)), float(turned)
