"""How far a linkage is off its targets at given driver angles: squares, and their derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from grashof.analysis.curves.coupler_curve import coupler_motion
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.minimisation import Model
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray, turned_from

_ROUNDING = 1e-13  # share of the size: sums of squares that differ by less than its square are equal


def misses(linkage: Linkage, task: Task, theta2: FloatArray, assembly: IntArray) -> FloatArray:
    """|dp|^2 + (angle_length * dangle)^2 of what targets have, shape (..., N); inf where it cannot close."""
    state = solve_position(linkage, theta2, assembly)
    gap = state.p - task.positions
    miss: FloatArray = np.where(task.has_position, gap[..., 0] ** 2 + gap[..., 1] ** 2, 0.0)
    if task.has_angle.any():
        off = turned_from(state.theta3, task.angles - linkage.body_angle)
        miss = miss + np.where(task.has_angle, task.angle_length * off, 0.0) ** 2
    return np.nan_to_num(miss, nan=np.inf, posinf=np.inf)


def squares(
    linkage: Linkage,
    task: Task,
    assembly: IntArray,
    order: slice | IntArray = slice(None),
    *,
    weighted: bool = True,
) -> Callable[[FloatArray], Model]:
    """The misses as functions of driver angles (..., N), on given assemblies (..., N)."""
    weights = task.weights if weighted else np.ones(len(task))
    point = np.nan_to_num(task.positions[order] @ np.array([1, 1j]))
    angle = np.nan_to_num(task.angles[order] - linkage.body_angle)
    by_point = (weights * task.has_position)[order]
    by_angle = (weights * task.has_angle)[order] * task.angle_length**2

    def model(theta2: FloatArray) -> Model:
        p, rate, bend, theta, omega, alpha = coupler_motion(linkage, theta2, assembly)
        with np.errstate(invalid="ignore", over="ignore"):
            gap = p - point
            value = by_point * (gap.real**2 + gap.imag**2)
            slope = by_point * (rate.conj() * gap).real
            positive = by_point * (rate.real**2 + rate.imag**2)
            curved = by_point * (bend.conj() * gap).real
            if by_angle.any():
                off = turned_from(theta, angle)
                value, slope = value + by_angle * off**2, slope + by_angle * omega * off
                positive, curved = positive + by_angle * omega**2, curved + by_angle * alpha * off
            return np.nan_to_num(value, nan=np.inf), 2 * slope, 2 * positive + 2 * curved, 2 * positive

    return model


def as_good(task: Task, totals: FloatArray) -> BoolArray:
    """Which sums of weighted misses are the least but for rounding."""
    good: BoolArray = totals <= totals.min() * (1 + 1e-9) + len(task) * (_ROUNDING * task.size) ** 2
    return good
