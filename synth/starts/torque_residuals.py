"""Deviations from a wanted torque as residuals of the batched search."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import TURN, FloatArray
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.vector import Vector
from grashof.synth.starts.closed_loop import Batch, SearchTargets
from grashof.synth.starts.limit_residuals import Placement

OPEN = 1e3  # reference torques: deviation of a linkage without a torque
Residuals = tuple[FloatArray, FloatArray]  # (n, K), and their derivatives by the unknowns, (n, K, M)


def torque_residuals(target: SearchTargets, at: Placement, batch: Batch) -> Residuals:
    """Weighted drive torques minus the wanted ones, sizes, of a batch in its present state."""
    curve, (count, _, width) = target.torque, at.by_theta3.shape
    if curve is None:
        return np.zeros((count, 0)), np.zeros((count, 0, width))
    along = at.normal
    arm = Vector(at.ap.dot(along), along.cross(at.ap))
    theta2, sense = at.theta1 + at.relative.theta2, batch.direction[:, None]
    first = theta2.column(0)
    last = first + TURN * sense if target.closed else theta2.column(-1)
    at_targets = None
    if curve.over == "target":
        index = [place % theta2.value.shape[1] for place in curve.targets]
        at_targets = Dual(theta2.value[:, index], theta2.slope[:, index])
    driver = curve.moment(np.array(curve.places), first, last, sense, at_targets)
    ground = target.kind.dyad.ground(at)
    instant = target.kind.instant(at.o2, ground, at.lengths, arm, batch.assembly[:, :1], driver)
    miss: Dual = curve.miss(instant, sense, np.array(curve.torques))
    root = curve.counted(target.count)
    shape = count, len(curve.places)
    value = np.broadcast_to(miss.value, shape)
    closed = np.isfinite(value) & (np.abs(value) < OPEN)
    slope = np.where(closed[..., None], np.broadcast_to(miss.slope, (*shape, width)), 0.0)
    return root * np.where(closed, value, OPEN), root * np.nan_to_num(slope)
