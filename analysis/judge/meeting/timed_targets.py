"""Timed targets: one unknown, the driver angle at the first."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from grashof.analysis.judge.meeting.misses import as_good, misses, squares
from grashof.analysis.judge.meeting.points import Met
from grashof.analysis.mechanism.mobility import driver_ranges, rotatability
from grashof.analysis.numerics.minimisation import Model, lowest
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

_STARTS = 360
_BASINS = 4


def met_in_time(linkage: Linkage, task: Task, same_branch: bool, theta2_start: float | None) -> Met | None:
    """Least weighted squares over the first driver angle, in either sense; None without an assembly."""
    turns = np.multiply.outer([1.0, -1.0], task.driver_turns)
    own = int(linkage.assembly)
    signs = np.array([own] if same_branch else [own, -own])
    if theta2_start is None:
        start, sense, low, high = _valleys(linkage, task, turns, signs)
        if not start.size:
            return None
    else:
        start, sense = np.full(2, theta2_start), np.array([0, 1])
        low = high = start
    start, value = lowest(_model(linkage, task, turns[sense], signs), start, low, high)
    best = int(np.argmax(as_good(task, value)))
    theta2 = start[best] + turns[sense[best]]
    side = np.argmin(misses(linkage, task, theta2, signs[:, None]), axis=0)
    return theta2, signs[side], 1 - 2 * int(sense[best])


def _model(linkage: Linkage, task: Task, turns: FloatArray, signs: IntArray) -> Callable[[FloatArray], Model]:
    """Sum of the squares, as a function of the driver angle at the first target; shapes (S,)."""
    by_target = squares(linkage, task, signs[:, None, None])

    def model(start: FloatArray) -> Model:
        each = by_target(start[:, None] + turns)
        side = np.argmin(each[0], axis=0)[None]
        value, slope, second, positive = (np.take_along_axis(part, side, axis=0)[0] for part in each)
        return value.sum(axis=-1), slope.sum(axis=-1), second.sum(axis=-1), positive.sum(axis=-1)

    return model


def _valleys(
    linkage: Linkage, task: Task, turns: FloatArray, signs: IntArray
) -> tuple[FloatArray, IntArray, FloatArray, FloatArray]:
    """Driver angle at the first target in the deepest valleys, sense (row of `turns`), and bounds."""
    found = []
    for sense, turn in enumerate(turns):
        for low, high in _ranges(linkage, float(turn[-1]), len(signs) == 1):
            grid = np.linspace(low, high, _STARTS + 1)
            miss = misses(linkage, task, grid[:, None] + turn, signs[:, None, None])
            value = (task.weights * miss.min(axis=0)).sum(axis=-1)
            padded = np.pad(value, 1, constant_values=np.inf)
            valley = np.flatnonzero((value <= padded[:-2]) & (value <= padded[2:]) & np.isfinite(value))
            found += [(value[at], grid[at], sense, low, high) for at in valley]
    found.sort()
    columns = np.array(found[:_BASINS]).reshape(-1, 5).T
    return columns[1], columns[2].astype(np.int64), columns[3], columns[4]


def _ranges(linkage: Linkage, turn: float, same_branch: bool) -> list[tuple[float, float]]:
    """Where the driver may stand at the first target for the whole rotation `turn` to be possible."""
    if not same_branch or (rotatability(linkage) >= 0).all():
        return [(float(linkage.theta1), float(linkage.theta1) + TURN)]
    back, on = max(-turn, 0.0), max(turn, 0.0)
    ends = driver_ranges(linkage)
    return [(float(low) + back, float(high) - on) for low, high in ends if high - on >= low + back]
