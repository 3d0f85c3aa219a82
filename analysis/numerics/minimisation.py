"""Newton's method for many small minimisations at once, each in one driver angle or in several in order."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from grashof.analysis.numerics.isotonic import isotonic_regression
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray

# The objective: its value, first and second derivative, and a positive substitute for the second.
Model: TypeAlias = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
_STEPS = 60  # enough for more than half a turn at _REACH
_REACH = 0.1  # rad: the longest first step
_SAME, _LITTLE = 1e-12, 1e-7  # rad: shorter steps are the last, or the last if they fail
_EDGE = 3e-7  # share of a range beside its end where derivatives have no digits
_FIXED = 1e12  # relative weight of an angle that must not move
_LEAST_WEIGHT = 1e-12  # of the mean


def lowest(
    model: Callable[[FloatArray], Model], angle: FloatArray, low: FloatArray, high: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Each angle (...) in rad moved to its local minimum, and the value there.

    Bounds are infinite, or the ends of the driver's range; the model is inf where undefined. No angle depends
    on the others.
    """
    unknown = _Unknown(model, low, high)
    angle, low, high = unknown.of(np.clip(angle, low, high)), unknown.of(low), unknown.of(high)
    current = unknown.model(angle)
    reach, going = np.full(angle.shape, _REACH), np.full(angle.shape, True)
    for _ in range(_STEPS):
        step = np.clip(-_quotient(current[1], _curvature(current)), -reach, reach)
        tried = np.clip(angle + step, low, high)
        fresh = unknown.model(tried)
        with np.errstate(invalid="ignore"):  # where the values agree to rounding, the slope decides
            level = (fresh[0] <= current[0] * (1 + 1e-14)) & (np.abs(fresh[1]) < np.abs(current[1]))
        better = going & ((fresh[0] < current[0]) | level)
        moved = np.abs(tried - angle)
        reach = np.where(better, np.maximum(reach, 2 * moved), moved / 4)
        angle = np.where(better, tried, angle)
        current = _chosen(better, fresh, current)
        going &= (moved > _SAME) & (better | (moved > _LITTLE))
        if not going.any():
            break
    return unknown.found(angle, current[0])


def lowest_in_order(
    model: Callable[[FloatArray], Model],
    angle: FloatArray,
    bounds: tuple[FloatArray, FloatArray],
    ends: tuple[FloatArray, FloatArray],
) -> tuple[FloatArray, FloatArray]:
    """Rows of angles (K, N) moved to a least sum of values, in ascending order within one turn.

    Each value depends on its own angle only; bounds, in order, and ends of the driver's range in rad. Newton
    steps with the diagonal second derivative (shared by equal angles), projected on the order by weighted
    isotonic regression (Best & Chakravarti 1990), the exact solution of the quadratic step. No row depends on
    the others.
    """
    unknown = _Unknown(model, *ends)
    low, high = (np.clip(bound, *ends) for bound in bounds)
    angle, low, high = unknown.of(np.clip(angle, low, high)), unknown.of(low), unknown.of(high)
    current = unknown.model(angle)
    fixed = low == high
    damping, going = np.zeros((len(angle), 1)), np.full((len(angle), 1), True)
    for _ in range(_STEPS):
        weight = _pooled(angle, current) * (1 + damping)
        weight = np.maximum(weight, _LEAST_WEIGHT * weight.mean(axis=1, keepdims=True) + 1e-300)
        wish = np.where(fixed, angle, angle - _quotient(current[1], weight))
        weight = np.where(fixed, weight.max(axis=1, keepdims=True) * _FIXED, weight)
        tried = _in_order(wish, weight, low, high)
        longest = np.abs(tried - angle).max(axis=1, keepdims=True)
        tried = angle + (tried - angle) * (_REACH / np.maximum(longest, _REACH))
        fresh = unknown.model(tried)
        better = going & _better_rows(current, fresh, angle, tried)
        moved = np.abs(tried - angle).max(axis=1, keepdims=True)
        damping = np.where(better, damping / 8 * (damping > 1e-3), 4 * damping + 1)
        angle = np.where(better, tried, angle)
        current = _chosen(np.broadcast_to(better, angle.shape), fresh, current)
        going &= (moved > _SAME) & (better | (moved > _LITTLE))
        if not going.any():
            break
    angle, value = unknown.found(angle, current[0])
    return np.clip(angle, *bounds), value


class _Unknown:
    """The unknown x in place of an angle t = low + (high - low) (1 - cos pi x) / 2 of a range.

    Near the dead positions at its ends a linkage moves with the square root of t, so smoothly with x. Scaled
    to [low, high]; t itself without a range.
    """

    def __init__(self, model: Callable[[FloatArray], Model], low: FloatArray, high: FloatArray) -> None:
        self._given, self._low, self._high = model, low, high
        self._span = high - low
        self._swings = np.isfinite(self._span) & (self._span > 0)
        self._span = np.where(self._swings, self._span, 1.0)
        self._floor = np.where(self._swings, low, 0.0)

    def of(self, angle: FloatArray) -> FloatArray:
        share = np.clip((angle - self._floor) / self._span, 0, 1)
        smooth = self._floor + self._span * np.arccos(1 - 2 * share) / np.pi
        return np.where(self._swings, smooth, angle)

    def model(self, unknown: FloatArray) -> Model:
        if not self._swings.any():
            return self._given(unknown)
        turn = np.pi * np.clip((unknown - self._floor) / self._span, _EDGE, 1 - _EDGE)
        angle = self._floor + self._span * np.sin(turn / 2) ** 2
        value, slope, second, positive = self._given(np.where(self._swings, angle, unknown))
        rate = np.where(self._swings, np.pi / 2 * np.sin(turn), 1.0)
        bend = np.where(self._swings, np.pi**2 / 2 * np.cos(turn) / self._span, 0.0)
        return value, slope * rate, second * rate**2 + slope * bend, positive * rate**2

    def found(self, unknown: FloatArray, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The angles, moved to the ends of their ranges when within the edge of them, and their values."""
        if not self._swings.any():
            return unknown, value
        share = np.clip((unknown - self._floor) / self._span, 0, 1)
        share = np.where(share <= _EDGE, 0.0, np.where(share >= 1 - _EDGE, 1.0, share))
        angle = self._floor + self._span * np.sin(np.pi / 2 * share) ** 2
        angle = np.where(self._swings, np.clip(angle, self._low, self._high), unknown)
        return angle, self._given(angle)[0]


def _quotient(slope: FloatArray, curvature: FloatArray) -> FloatArray:
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.nan_to_num(slope / curvature, nan=0.0, posinf=0.0, neginf=0.0)


def _curvature(model: Model) -> FloatArray:
    _, _, second, positive = model
    with np.errstate(invalid="ignore"):
        return np.where(second > 0.01 * positive, second, positive)


def _better_rows(current: Model, fresh: Model, angle: FloatArray, tried: FloatArray) -> BoolArray:
    before, after = current[0].sum(axis=1), fresh[0].sum(axis=1)
    way = tried - angle
    with np.errstate(invalid="ignore"):
        falls = np.abs((fresh[1] * way).sum(axis=1)) < np.abs((current[1] * way).sum(axis=1))
    better: BoolArray = (after < before) | ((after <= before * (1 + 1e-14)) & falls)
    return better[:, None]


def _chosen(better: BoolArray, fresh: Model, current: Model) -> Model:
    value, slope, second, positive = (
        np.where(better, new, old) for new, old in zip(fresh, current, strict=True)
    )
    return value, slope, second, positive


def _pooled(angle: FloatArray, model: Model) -> FloatArray:
    """Curvature of each value, large enough to limit the step; equal angles of a row share theirs."""
    weight = np.maximum(_curvature(model), np.abs(model[1]) / _REACH)
    together = np.abs(np.diff(angle, axis=1, prepend=np.nan)) <= _SAME
    rows = np.flatnonzero(together.any(axis=1))
    if rows.size:
        first = np.flatnonzero(~together[rows].ravel())
        count = np.diff(np.append(first, together[rows].size))
        slope, second, positive = (
            np.repeat(np.add.reduceat(np.nan_to_num(part[rows]).ravel(), first) / count, count)
            for part in model[1:]
        )
        pooled = np.maximum(_curvature((slope, slope, second, positive)), np.abs(slope) / _REACH)
        weight[rows] = pooled.reshape(len(rows), -1)
    return weight


def _in_order(wish: FloatArray, weight: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """The nearest ascending angles, by weight, within one turn and their bounds."""
    ordered = isotonic_regression(wish, weight)
    for row in np.flatnonzero(ordered[:, -1] - ordered[:, 0] > TURN):
        ordered[row] = _within_a_turn(ordered[row], weight[row])
    return np.clip(ordered, low, high)


def _within_a_turn(ordered: FloatArray, weight: FloatArray) -> FloatArray:
    """Ordered angles compressed into one turn at the least weighted cost."""
    first = (ordered[0] + ordered[-1] - TURN) / 2
    for _ in range(2 * len(ordered)):
        under, over = ordered < first, ordered > first + TURN
        pushed = np.where(under, ordered, ordered - TURN)
        share = weight * (under | over)
        if not share.sum() > 0:
            break
        fresh = float((share * pushed).sum() / share.sum())
        if abs(fresh - first) <= _SAME:
            break
        first = fresh
    return np.clip(ordered, first, first + TURN)
