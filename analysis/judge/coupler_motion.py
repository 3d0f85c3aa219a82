"""Direction and rate of the coupler in the task motion of judged linkages."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from grashof.analysis.judge.cylinder_drive import cylinder_travel
from grashof.analysis.judge.over_task import as_used, joins, motion_ends, sampled
from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import DeadPositionWarning, Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, turned_from


@dataclass(frozen=True, slots=True)
class CouplerMotion:
    """Extremes over the motion from the first target to the last; NaN where none joins the targets.

    Parameters
    ----------
    angle_min, angle_max : float, rad
        Direction of link 3; `angle_min` is above -pi and at most pi.
    rate_min, rate_max : float
        Derivative of this direction with respect to the driver angle; infinite where a cylinder carries the
        linkage through dead positions of link 2.
    """

    angle_min: float
    angle_max: float
    rate_min: float
    rate_max: float


def coupler_motion(linkage: Linkage, task: Task, verdict: Verdict) -> CouplerMotion:
    """The coupler of a single linkage with its verdict.

    Examples
    --------
    >>> from grashof.analysis.judge.planted import planted_motion
    >>> from grashof.analysis.judge.verify import verify
    >>> from grashof.problems import Requirements
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=4)
    >>> found = coupler_motion(linkage, task, verify(linkage, task, Requirements()))
    >>> np.degrees([found.angle_min, found.angle_max]).round(3).tolist()
    [-144.006, 20.296]
    """
    used = as_used(linkage, verdict)
    theta2 = sampled(used, *motion_ends(task, verdict))
    if not joins(used, verdict, theta2):
        return _driven(linkage, task, verdict)
    on_the_way = np.unwrap(solve_position(used, theta2).theta3)

    def curves(angles: FloatArray) -> FloatArray:
        state = solve_kinematics(used, angles, 1.0, 0.0)
        near = np.interp(angles, theta2, on_the_way)
        theta3 = near + turned_from(state.theta3, near)
        return np.stack([theta3, -theta3, state.omega3, -state.omega3])

    with warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
        high, low, fast, slow = peaks(curves, [theta2])[0].ravel().tolist()
    return _motion(-low, high, -slow, fast)


def _driven(linkage: Linkage, task: Task, verdict: Verdict) -> CouplerMotion:
    """The coupler where a cylinder drives it through dead positions of link 2; NaN without one."""
    moved = None if verdict.cylinder is None else cylinder_travel(linkage, task, verdict)
    if moved is None:
        return CouplerMotion(np.nan, np.nan, np.nan, np.nan)
    places, at = moved.places, moved.at
    on_the_way = np.unwrap(at(places).theta3)

    def curves(there: FloatArray) -> FloatArray:
        near = np.interp(there, places, on_the_way)
        theta3 = near + turned_from(at(there).theta3, near)
        return np.stack([theta3, -theta3])

    high, low = peaks(curves, [places])[0].ravel().tolist()
    return _motion(-low, high, -np.inf, np.inf)


def _motion(low: float, high: float, slow: float, fast: float) -> CouplerMotion:
    turns = TURN * np.ceil((low - np.pi) / TURN)
    return CouplerMotion(float(low - turns), float(high - turns), slow, fast)
