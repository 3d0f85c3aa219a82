"""How a linkage does a path task: where it comes nearest to each point, and the way between them."""

from __future__ import annotations

import numpy as np

from grashof.analysis.curves.coupler_curve import PIECES, Track, squared_distance, tracks
from grashof.analysis.four_bar.position import solve_position
from grashof.analysis.judge.assignment import nearest_guess
from grashof.analysis.judge.nearest_poses import Targets, Way, driver_way
from grashof.analysis.judge.points_in_order import Met, met_in_order
from grashof.analysis.judge.timed_points import met_in_time
from grashof.analysis.numerics.minimisation import lowest
from grashof.problems import FourBar, PathTask
from grashof.problems.values.arrays import TURN, FloatArray

_VALLEYS = 3


def nearest_to_points(
    linkage: FourBar,
    task: PathTask,
    *,
    ordered: bool,
    same_branch: bool,
    theta2_start: float | None = None,
) -> tuple[Targets, Way]:
    """Driver angle, assembly and error at each point, and the way between them, from the linkage alone.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    task : PathTask
    ordered : bool
        Meet free points in sequence, in either sense of the driver, within one turn. Otherwise each
        by itself as near as possible.
    same_branch : bool
        Stay on the linkage's own assembly, within one range of the driver.
    theta2_start : float, rad, optional
        Driver angle at the first point.

    Returns
    -------
    Targets, Way
        Of the least sum of squared distances; of equal ones the shortest way. Distances are inf
        where the linkage cannot be assembled.

    Examples
    --------
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
    >>> task = PathTask(solve_position(crank_rocker, [0.3, 0.2, 6.0]).p)
    >>> targets, way = nearest_to_points(crank_rocker, task, ordered=True, same_branch=True)
    >>> way.theta2.round(6).tolist(), way.direction, bool(targets.position_error.max() < 1e-13)
    ([0.3, 0.2, -0.283185], -1, True)
    """
    if task.timing is not None:
        met = met_in_time(linkage, task, task.timing, same_branch, theta2_start)
    elif ordered:
        met = met_in_order(linkage, task, same_branch, theta2_start)
    else:
        met = _met_singly(linkage, task, same_branch, theta2_start)
    if met is None:
        turns = np.zeros(len(task)) if task.timing is None else task.timing
        met = Met((theta2_start or 0.0) + turns, np.full(len(task), int(linkage.assembly)), 1)
    theta2 = met.theta2
    if theta2_start is None:
        theta2 = theta2 - TURN * np.round(theta2[0] / TURN)
    gap = solve_position(linkage, theta2, met.assembly).p - task.points
    distance = np.nan_to_num(np.hypot(gap[:, 0], gap[:, 1]), nan=np.inf)
    way = _way(linkage, theta2, met.direction, task.closed)
    return Targets(way.theta2, met.assembly, distance, None), way


def _way(linkage: FourBar, theta2: FloatArray, direction: int, closed: bool) -> Way:
    if direction:
        way = Way(theta2, float(theta2[0]), float(theta2[-1]), direction, True)
    else:
        way = driver_way(linkage, theta2, False)
    if not closed:
        return way
    return Way(way.theta2, way.start, way.start + way.direction * TURN, way.direction, way.in_order)


def _met_singly(
    linkage: FourBar, task: PathTask, same_branch: bool, theta2_start: float | None
) -> Met | None:
    """Each point by itself as near as possible, on the motion on which the sum is least."""
    points = task.points @ np.array([1, 1j])
    target = np.arange(len(task))
    best, least = None, np.inf
    for track in _tracks_through(linkage, same_branch, theta2_start):
        angle, low, high, assembly = nearest_guess(track, points, _VALLEYS)
        if theta2_start is not None:
            angle[:, 0] = low[:, 0] = high[:, 0] = theta2_start
        angle, value = lowest(squared_distance(linkage, points, assembly), angle, low, high)
        chosen = np.argmin(value, axis=0)
        total = float(value[chosen, target].sum())
        if total < least:
            best, least = Met(angle[chosen, target], assembly[chosen, target], 0), total
    return best


def _tracks_through(linkage: FourBar, same_branch: bool, theta2: float | None) -> list[Track]:
    every = tracks(linkage, PIECES, same_branch)
    if theta2 is None or len(every) == 1:
        return every
    return [track for track in every if (theta2 - track.low[0]) % TURN <= track.high[-1] - track.low[0]]
