"""Poses met in order where the nearest places are not in order: least squares of near poses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from grashof.analysis.curve import coupler_rates
from grashof.analysis.descent import Model, lowest_in_order
from grashof.analysis.mobility import driver_ranges, range_index, rotatability
from grashof.analysis.motion import TURN, Targets, Way, at_poses, driver_way
from grashof.analysis.position import solve_position
from grashof.problems import FourBar, MotionTask
from grashof.problems.checks import FloatArray, IntArray


def poses_in_order(linkage: FourBar, task: MotionTask, nearest: Targets, way: Way) -> tuple[Targets, Way]:
    """Driver angles that do not go back, near the nearest ones, with the least weighted squares.

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
        Those given where no angles in order are near: on different assemblies or ranges.

    Examples
    --------
    >>> from grashof.analysis.motion import nearest_to_poses
    >>> from grashof.analysis.planted import planted_motion
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=5)
    >>> swapped = MotionTask(task.positions[[0, 2, 1, 3, 4]], task.angles[[0, 2, 1, 3, 4]])
    >>> nearest = nearest_to_poses(linkage, swapped)
    >>> targets, way = poses_in_order(linkage, swapped, nearest, driver_way(linkage, nearest.theta2, True))
    >>> way.in_order, bool(targets.position_error.max() > 0)
    (True, True)
    """
    if np.ptp(nearest.assembly) > 0:
        return nearest, way
    ends = _ends(linkage, nearest.theta2)
    if ends is None:
        return nearest, way
    theta2, low, high = ends
    best, least = None, np.inf
    for sense in (1, -1):
        guess = _guess(theta2, sense, turns=not np.isfinite(low))[::sense]
        model = _missed(linkage, task, nearest.assembly, sense)
        bounds = np.full((1, len(task)), -np.inf), np.full((1, len(task)), np.inf)
        limits = np.full((1, len(task)), low), np.full((1, len(task)), high)
        angle, value = lowest_in_order(model, guess[None], bounds, limits)
        if value.sum() < least:
            best, least = angle[0][::sense], float(value.sum())
    if best is None:
        return nearest, way
    ordered = driver_way(linkage, best, True)
    return at_poses(linkage, task, best, nearest.assembly), ordered if ordered.in_order else way


def _ends(linkage: FourBar, theta2: FloatArray) -> tuple[FloatArray, float, float] | None:
    """Driver angles counted in their range, and its ends, infinite when it turns; None for two ranges."""
    if (rotatability(linkage) >= 0).all():
        return theta2, -np.inf, np.inf
    index, inside = range_index(linkage, theta2)
    if np.ptp(index) > 0 or index[0] < 0:
        return None
    low, high = driver_ranges(linkage)[index[0]]
    return inside, float(low), float(high)


def _guess(theta2: FloatArray, sense: int, *, turns: bool) -> FloatArray:
    """Driver angles counted on in one sense; small steps back are taken as such, and flattened."""
    step = sense * np.diff(theta2)
    if turns:
        step = (step + np.pi / 2) % TURN - np.pi / 2
    gone = np.concatenate([[0.0], np.cumsum(step)])
    flat = np.minimum((np.maximum.accumulate(gone) + np.minimum.accumulate(gone[::-1])[::-1]) / 2, TURN)
    guess: FloatArray = theta2[0] + sense * np.maximum.accumulate(flat)
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
