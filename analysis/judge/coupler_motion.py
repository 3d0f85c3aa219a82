"""The coupler of judged linkages: its direction and rate in the task motion, and its curve."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grashof.analysis.curves.curve_distance import curve_distances
from grashof.analysis.judge.cylinder_drive import cylinder_travel
from grashof.analysis.judge.over_task import Motion, batch_of, joined_motions, samples_of
from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import DeadPositionWarning, Linkage, Problem, Task
from grashof.problems.values.arrays import TURN, FloatArray, turned_from
from grashof.problems.values.linkages.linkage import by_kind


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


def coupler_motions(
    linkages: Sequence[Linkage], problem: Problem, verdicts: Sequence[Verdict]
) -> list[CouplerMotion]:
    """The couplers of linkages with their verdicts; each as of it alone.

    Examples
    --------
    >>> from grashof.analysis.judge.planted import planted_motion
    >>> from grashof.analysis.judge.verify import verify
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=4)
    >>> problem = Problem(task=task)
    >>> (found,) = coupler_motions([linkage], problem, [verify(linkage, task, problem.requirements)])
    >>> np.degrees([found.angle_min, found.angle_max]).round(3).tolist()
    [-144.006, 20.296]
    """
    found: dict[int, CouplerMotion] = {}
    for rows, some in joined_motions(linkages, problem, verdicts):
        found |= zip(rows, _free(some), strict=True)
    return [
        found[row] if row in found else _driven(linkage, problem.task, verdict)
        for row, (linkage, verdict) in enumerate(zip(linkages, verdicts, strict=True))
    ]


def _free(some: Sequence[Motion]) -> list[CouplerMotion]:
    """Couplers of motions that join the targets."""
    batch, theta2 = batch_of(some)[:, None], samples_of(some)
    on_the_way = np.unwrap(solve_position(batch, theta2).theta3)

    def curves(angles: FloatArray) -> FloatArray:
        state = solve_kinematics(batch, angles, 1.0, 0.0)
        near = np.stack([np.interp(*row) for row in zip(angles, theta2, on_the_way, strict=True)])
        theta3 = near + turned_from(state.theta3, near)
        return np.stack([theta3, -theta3, state.omega3, -state.omega3])

    with warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
        extremes = peaks(curves, [theta2])[0].reshape(4, -1).T.tolist()
    return [_motion(-low, high, -slow, fast) for high, low, fast, slow in extremes]


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


def curve_distances_of_each(
    linkages: Sequence[Linkage], problem: Problem, verdicts: Sequence[Verdict]
) -> list[list[float]]:
    """Hausdorff and Frechet distances of closed coupler curves from the targets' polygon; NaN for others."""
    found, task = np.full((len(linkages), 2), np.nan), problem.task
    turning = [row for row, verdict in enumerate(verdicts) if verdict.full_rotation]
    for alike in by_kind([linkages[row] for row in turning]) if task.has_position.all() else ():
        rows = [turning[k] for k in alike]
        batch = linkages[rows[0]].stacked([linkages[row] for row in rows])
        senses = [verdicts[row].direction for row in rows]
        found[rows] = np.stack(curve_distances(batch, task.positions, senses), axis=-1)
    return found.tolist()
