"""Points met each by itself, on a motion that the driver can make."""

from __future__ import annotations

import numpy as np

from grashof.analysis.curves.coupler_curve import PIECES, Track, squared_distance, tracks
from grashof.analysis.judge.assignment import nearest_guess
from grashof.analysis.judge.points_in_order import Met
from grashof.analysis.numerics.minimisation import lowest
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN

_VALLEYS = 3


def met_singly(linkage: Linkage, task: Task, same_branch: bool, theta2_start: float | None) -> Met | None:
    """Each point by itself as near as possible, on the motion of the least squares.

    None when it cannot be assembled.
    """
    points = task.positions @ np.array([1, 1j])
    target = np.arange(len(task))
    best: Met | None = None
    least = np.inf
    for track in _tracks_through(linkage, same_branch, theta2_start):
        angle, low, high, assembly = nearest_guess(track, points, _VALLEYS)
        if theta2_start is not None:
            angle[:, 0] = low[:, 0] = high[:, 0] = theta2_start
        angle, value = lowest(squared_distance(linkage, points, assembly), angle, low, high)
        chosen = np.argmin(value, axis=0)
        total = float((task.weights * value[chosen, target]).sum())
        if total < least:
            best, least = (angle[chosen, target], assembly[chosen, target], 0), total
    return best


def _tracks_through(linkage: Linkage, same_branch: bool, theta2: float | None) -> list[Track]:
    every = tracks(linkage, PIECES, same_branch)
    if theta2 is None or len(every) == 1:
        return every
    return [track for track in every if (theta2 - track.low[0]) % TURN <= track.high[-1] - track.low[0]]
