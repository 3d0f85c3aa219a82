"""Poses met in order where the nearest places are not in order: least squares of near poses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from grashof.analysis.curve import ROUNDING, coupler_rates
from grashof.analysis.descent import Model, lowest_in_order
from grashof.analysis.mobility import driver_ranges, range_index, rotatability
from grashof.analysis.motion import TURN, Targets, Way, at_poses, driver_way, valleys
from grashof.analysis.position import solve_position
from grashof.problems import FourBar, MotionTask
from grashof.problems.checks import FloatArray, IntArray

LITTLE = np.pi / 4  # rad: the driver may seem to go back so far, between poses that nearly agree


def poses_in_order(linkage: FourBar, task: MotionTask, nearest: Targets, way: Way) -> tuple[Targets, Way]:
    """Driver angles that do not go back, within one turn, with the least weighted squares.

    A pose with a part left free, above all an angle alone, is met at more than one driver angle; the
    nearest place of each pose by itself may then be out of order where others are not.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    task : MotionTask
    nearest : Targets
        Where it comes nearest to each pose by itself.
    way : Way
        That motion, out of order.

    Returns
    -------
    Targets, Way
        On the linkage's own assembly and in one range of its driver; those given where there are none.

    Notes
    -----
    Dynamic programming over the valleys of the misses; then Newton's method in all angles.

    Examples
    --------
    >>> from grashof.analysis.motion import driver_way, nearest_to_poses
    >>> from grashof.analysis.planted import planted_motion
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=5)
    >>> swapped = MotionTask(task.positions[[0, 2, 1, 3, 4]], task.angles[[0, 2, 1, 3, 4]])
    >>> nearest = nearest_to_poses(linkage, swapped)
    >>> targets, way = poses_in_order(linkage, swapped, nearest, driver_way(linkage, nearest.theta2, True))
    >>> way.in_order, bool(targets.position_error.max() > 0)
    (True, True)
    """
    best, least = None, np.inf
    own = np.full(len(task), int(linkage.assembly))
    for sense in (1, -1):  # counted backwards, driver angles that fall grow
        order = slice(None, None, sense)
        model = _missed(linkage, task, own, sense)
        for angle, miss, low, high in _by_range(linkage, task):
            guess = _sequence(angle[:, order], miss[:, order], turns=not np.isfinite(low), step=task.size)
            if guess is None:
                continue
            bounds = np.full((1, len(task)), -np.inf), np.full((1, len(task)), np.inf)
            limits = np.full((1, len(task)), low), np.full((1, len(task)), high)
            theta2, value = lowest_in_order(model, guess[None], bounds, limits)
            if value.sum() < least * (1 - 1e-9) - (ROUNDING * task.size) ** 2:
                best, least = theta2[0][order], float(value.sum())
    if best is None:
        return nearest, way
    ordered = driver_way(linkage, best, True)
    return (at_poses(linkage, task, best, own), ordered) if ordered.in_order else (nearest, way)


def _by_range(linkage: FourBar, task: MotionTask) -> list[tuple[FloatArray, FloatArray, float, float]]:
    """Valleys (K, N) and weighted misses on the own assembly, with the ends of each range of the driver."""
    angle, signs, miss = valleys(linkage, task)
    miss = np.where(signs == int(linkage.assembly), miss * task.weights, np.inf)
    if (rotatability(linkage) >= 0).all():
        return [(angle, miss, -np.inf, np.inf)]
    index, inside = range_index(linkage, angle)
    return [
        (
            np.where(index == number, inside, low),
            np.where(index == number, miss, np.inf),
            float(low),
            float(high),
        )
        for number, (low, high) in enumerate(driver_ranges(linkage))
        if high > low
    ]


def _sequence(angle: FloatArray, miss: FloatArray, *, turns: bool, step: float) -> FloatArray | None:
    """Growing driver angles (N,) through the valleys (K, N), of the least sum of misses and steps back."""
    count, poses = angle.shape
    begin = angle[:, 0] if turns else np.zeros(1)
    gone = angle - begin[:, None, None]
    if turns:  # a little before the first is no turn after it
        gone = (gone + LITTLE) % TURN - LITTLE
    cost = np.where(np.eye(count) > 0, miss[:, 0], np.inf) if turns else miss[None, :, 0]
    before = np.zeros((len(begin), count, poses), dtype=np.int64)
    for k in range(1, poses):
        back = np.maximum(gone[:, :, None, k - 1] - gone[:, None, :, k], 0.0)
        way = cost[:, :, None] + (step * back) ** 2
        before[:, :, k] = way.argmin(axis=1)
        cost = way.min(axis=1) + miss[None, :, k]
    ends = cost + (ROUNDING * step) ** 2 * gone[:, :, -1]  # of equal ones the shortest
    first, last = np.unravel_index(np.argmin(ends), ends.shape)
    if not np.isfinite(cost[first, last]):
        return None
    chosen = [int(last)]
    for k in range(poses - 1, 0, -1):
        chosen.append(int(before[first, chosen[-1], k]))
    sequence = gone[first, chosen[::-1], np.arange(poses)]
    flat = (np.maximum.accumulate(sequence) + np.minimum.accumulate(sequence[::-1])[::-1]) / 2
    guess: FloatArray = begin[first] + np.maximum.accumulate(flat)
    return guess


def _missed(
    linkage: FourBar, task: MotionTask, assembly: IntArray, sense: int
) -> Callable[[FloatArray], Model]:
    """Weighted squares as functions of the driver angles, in the order of `sense`."""
    order = slice(None, None, sense)
    point = np.nan_to_num(task.positions[order] @ np.array([1, 1j]))
    angle = np.nan_to_num(task.angles[order] - linkage.body_angle)
    by_point = (task.weights * task.has_position)[order]
    by_angle = (task.weights * task.has_angle)[order] * task.angle_length**2
    arm = complex(*linkage.coupler_point)

    def model(theta2: FloatArray) -> Model:
        state = solve_position(linkage, theta2, assembly)
        omega3, alpha3 = coupler_rates(linkage, state)
        with np.errstate(invalid="ignore", over="ignore"):
            crank, turned = linkage.r2 * np.exp(1j * theta2), arm * np.exp(1j * state.theta3)
            gap = state.p @ np.array([1, 1j]) - point
            off = (state.theta3 - angle + np.pi) % TURN - np.pi
            rate, bend = 1j * (crank + omega3 * turned), -crank + (1j * alpha3 - omega3**2) * turned
            value = by_point * np.abs(gap) ** 2 + by_angle * off**2
            slope = 2 * (by_point * (rate.conj() * gap).real + by_angle * omega3 * off)
            positive = 2 * (by_point * np.abs(rate) ** 2 + by_angle * omega3**2)
            curved = 2 * (by_point * (bend.conj() * gap).real + by_angle * alpha3 * off)
            return np.nan_to_num(value, nan=np.inf), slope, positive + curved, positive

    return model
