"""Timed targets: the driver begins where the squares are least."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from grashof.analysis.judge.meeting.points import Met
from grashof.analysis.judge.meeting.task_motion import as_good, misses, squares, valleys
from grashof.analysis.mechanism.mobility import closes_everywhere, driver_ranges
from grashof.analysis.numerics.minimisation import Model, lowest
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

_BASINS = 4
STARTS = 360  # driver angles at the first target, over the range of the driver


def met_in_time(
    members: Sequence[Linkage], batch: Linkage, task: Task, same_branch: bool, theta2_start: float | None
) -> list[Met | None]:
    """Least weighted squares over the first driver angle, in either sense, of each of a batch.

    None without an assembly.
    """
    turns = np.multiply.outer([1.0, -1.0], task.driver_turns)
    own = batch.assembly.astype(np.int64)
    signs = np.stack([own] if same_branch else [own, -own])
    if theta2_start is None:
        every = [_first_angles(linkage, task, turns, same_branch) for linkage in members]
    else:
        every = [(np.full(2, theta2_start), np.array([0, 1]), *np.full((2, 2), theta2_start))] * len(members)
    of = np.repeat(np.arange(len(members)), [len(start) for start, *_ in every])
    start, sense, low, high = (np.concatenate(each) for each in zip(*every, strict=True))
    start, value = lowest(_timed(batch[of], task, turns[sense], signs[:, of]), start, low, high)
    found = list[Met | None]()
    for row, linkage in enumerate(members):
        mine = np.flatnonzero(of == row)
        if not mine.size:
            found.append(None)
            continue
        best = mine[np.argmax(as_good(task, value[mine]))]
        theta2 = start[best] + turns[sense[best]]
        side = np.argmin(misses(linkage, task, theta2, signs[:, row, None]), axis=0)
        found.append((theta2, signs[side, row], 1 - 2 * int(sense[best])))
    return found


def _timed(linkage: Linkage, task: Task, turns: FloatArray, signs: IntArray) -> Callable[[FloatArray], Model]:
    """Sums of the squares of linkages (S,), as functions of the driver angle at the first target, (S,)."""
    by_target = squares(linkage[:, None], task, signs[..., None])

    def model(start: FloatArray) -> Model:
        each = by_target(start[:, None] + turns)
        side = np.argmin(each[0], axis=0)[None]
        value, slope, second, positive = (np.take_along_axis(part, side, axis=0)[0] for part in each)
        return value.sum(axis=-1), slope.sum(axis=-1), second.sum(axis=-1), positive.sum(axis=-1)

    return model


def _first_angles(
    linkage: Linkage, task: Task, turns: FloatArray, same_branch: bool
) -> tuple[FloatArray, IntArray, FloatArray, FloatArray]:
    """Driver angle at the first target in the deepest valleys, sense (row of `turns`), and bounds."""
    own, found = int(linkage.assembly), []
    signs = np.array([own] if same_branch else [own, -own])
    for sense, turn in enumerate(turns):
        for low, high in first_ranges(linkage, float(turn[-1]), same_branch):
            grid = np.linspace(low, high, STARTS + 1)
            miss = misses(linkage, task, grid[:, None] + turn, signs[:, None, None])
            value = (task.meeting_weights * miss.min(axis=0)).sum(axis=-1)
            found += [(value[at], grid[at], sense, low, high) for at in valleys(value)]
    found.sort()
    columns = np.array(found[:_BASINS]).reshape(-1, 5).T
    return columns[1], columns[2].astype(np.int64), columns[3], columns[4]


def first_ranges(linkage: Linkage, turn: float, same_branch: bool) -> list[tuple[float, float]]:
    """Ranges of the driver angle at the first target from which the entire rotation `turn` is possible."""
    if not same_branch or closes_everywhere(linkage):
        return [(float(linkage.theta1), float(linkage.theta1) + TURN)]
    back, on = max(-turn, 0.0), max(turn, 0.0)
    ends = driver_ranges(linkage)
    return [(float(low) + back, float(high) - on) for low, high in ends if high - on >= low + back]
