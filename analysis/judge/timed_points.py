"""Timed points: one unknown, the driver angle at the first."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from grashof.analysis.curves.coupler_curve import ROUNDING, coupler_curve, squared_distance
from grashof.analysis.four_bar.mobility import driver_ranges, rotatability
from grashof.analysis.four_bar.position import solve_position
from grashof.analysis.judge.points_in_order import Met
from grashof.analysis.numerics.minimisation import Model, lowest
from grashof.problems import FourBar, PathTask
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray

_STARTS = 360
_BASINS = 4


def met_in_time(
    linkage: FourBar, task: PathTask, timing: FloatArray, same_branch: bool, theta2_start: float | None
) -> Met | None:
    """The least sum of squared distances over the driver angle at the first point, in either sense.

    Returns
    -------
    Met, or None when the linkage cannot be assembled at all points.
    """
    turns = np.multiply.outer([1.0, -1.0], np.abs(timing))
    points = task.points @ np.array([1, 1j])
    own = int(linkage.assembly)
    signs = np.array([own] if same_branch else [own, -own])
    if theta2_start is None:
        start, sense, low, high = _valleys(linkage, points, turns, signs)
        if not start.size:
            return None
    else:
        start, sense = np.full(2, theta2_start), np.array([0, 1])
        low = high = start
    start, value = lowest(_model(linkage, points, turns[sense], signs), start, low, high)
    level = value <= value.min() * (1 + 1e-9) + len(task) * (ROUNDING * task.size) ** 2
    best = int(np.argmax(level))
    theta2 = start[best] + turns[sense[best]]
    gap = np.abs(coupler_curve(linkage, theta2, signs[:, None])[0] - points)
    side = np.argmin(np.nan_to_num(gap, nan=np.inf), axis=0)
    return Met(theta2, signs[side], 1 - 2 * int(sense[best]))


def _model(
    linkage: FourBar, points: ComplexArray, turns: FloatArray, signs: IntArray
) -> Callable[[FloatArray], Model]:
    """Sum of squared distances, as a function of the driver angle at the first point; shapes (S,)."""

    def model(start: FloatArray) -> Model:
        each = squared_distance(linkage, points, signs[:, None, None])(start[:, None] + turns)
        side = np.argmin(each[0], axis=0)[None]
        value, slope, second, positive = (
            np.take_along_axis(part, side, axis=0)[0].sum(axis=-1) for part in each
        )
        return value, slope, second, positive

    return model


def _valleys(
    linkage: FourBar, points: ComplexArray, turns: FloatArray, signs: IntArray
) -> tuple[FloatArray, IntArray, FloatArray, FloatArray]:
    """Driver angle at the first point in the deepest valleys, sense (row of `turns`), and bounds."""
    found = []
    for sense, turn in enumerate(turns):
        for low, high in _ranges(linkage, float(turn[-1]), len(signs) == 1):
            grid = np.linspace(low, high, _STARTS + 1)
            value = _values(linkage, points, grid[:, None] + turn, signs)
            padded = np.pad(value, 1, constant_values=np.inf)
            valley = np.flatnonzero((value <= padded[:-2]) & (value <= padded[2:]) & np.isfinite(value))
            found += [(value[at], grid[at], sense, low, high) for at in valley]
    found.sort()
    columns = np.array(found[:_BASINS]).reshape(-1, 5).T
    return columns[1], columns[2].astype(np.int64), columns[3], columns[4]


def _values(linkage: FourBar, points: ComplexArray, theta2: FloatArray, signs: IntArray) -> FloatArray:
    p = solve_position(linkage, theta2, signs[:, None, None]).p @ np.array([1, 1j])
    gap = np.abs(p - points)
    total: FloatArray = (np.nan_to_num(gap, nan=np.inf).min(axis=0) ** 2).sum(axis=-1)
    return total


def _ranges(linkage: FourBar, turn: float, same_branch: bool) -> list[tuple[float, float]]:
    """Where the driver may stand at the first point for the whole rotation `turn` to be possible."""
    if not same_branch or (rotatability(linkage) >= 0).all():
        return [(float(linkage.theta1), float(linkage.theta1) + TURN)]
    back, on = max(-turn, 0.0), max(turn, 0.0)
    ends = driver_ranges(linkage)
    return [(float(low) + back, float(high) - on) for low, high in ends if high - on >= low + back]
