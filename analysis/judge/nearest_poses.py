"""How a linkage does a motion task: where it comes nearest to each pose, and the way between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.four_bar.mobility import driver_ranges, range_index, rotatability
from grashof.analysis.four_bar.position import solve_position
from grashof.problems import FourBar, MotionTask
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

STEADY = 1e-9  # rad: a driver step so small counts as none
_EXACT = 1e-13  # errors below this share of the size are rounding
_SAMPLES = 361
_VALLEYS = 6
_BESIDE = 41  # samples about each valley: beside a cusp may lie a deeper one


@dataclass(frozen=True, slots=True)
class Targets:
    """The linkage at each target, as near as it comes.

    Parameters
    ----------
    theta2 : ndarray, shape (N,), rad
        Driver angle.
    assembly : ndarray of int, shape (N,)
        Assembly on which it is nearest: the linkage's own unless the other one is nearer.
    position_error : ndarray, shape (N,), length
        Distance from the target position; NaN where none is given.
    angle_error : ndarray, shape (N,), rad, or None
        Turn from the target orientation, NaN where none is given; None for a path.
    """

    theta2: FloatArray
    assembly: IntArray
    position_error: FloatArray
    angle_error: FloatArray | None


@dataclass(frozen=True, slots=True)
class Way:
    """The motion of the driver that visits the targets.

    Parameters
    ----------
    theta2 : ndarray, shape (N,), rad
        Driver angles at the targets, counted on along the motion.
    start, end : float, rad
        Ends of the motion used.
    direction : int
        Sense of the driver: +1 counter-clockwise, -1 clockwise.
    in_order : bool
        The driver meets the targets in sequence, in one sense, within one turn.
    """

    theta2: FloatArray
    start: float
    end: float
    direction: int
    in_order: bool


def nearest_to_poses(linkage: FourBar, task: MotionTask) -> Targets:
    """Driver angle, assembly and error at each pose, from the linkage alone.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    task : MotionTask

    Returns
    -------
    Targets

    Notes
    -----
    The first guess turns the driver towards where A would be if the body stood in the pose;
    Gauss-Newton steps in the driver angle then reduce |dp|^2 + (angle_length * dangle)^2, on both
    assemblies. Where that does not meet every pose, a scan over all driver angles finds the lowest
    valleys, and closer scans their bottoms.
    """
    theta3 = task.angles - linkage.body_angle
    coupler = complex(*linkage.coupler_point)
    a = task.positions @ np.array([1, 1j]) - coupler * np.exp(1j * theta3) - complex(*linkage.o2)
    own = int(linkage.assembly)
    ends = driver_ranges(linkage)
    signs = np.broadcast_to(np.array([[own], [-own]]), (2, len(task)))
    guess = np.where(task.has_position & task.has_angle, np.angle(a), 0.0)
    angle = np.broadcast_to(_into_ranges(ends, guess), signs.shape)
    angle, miss = _descend(linkage, task, theta3, angle, signs)
    if not _met(miss, task):
        more, more_signs, more_miss = valleys(linkage, task)
        angle, signs = np.concatenate([angle, more]), np.concatenate([signs, more_signs])
        miss = np.concatenate([miss, more_miss])
    miss = np.where(miss <= _rounding(task), 0.0, miss)  # of several that meet a pose the own assembly
    chosen, target = np.argmin(miss, axis=0), np.arange(len(task))
    return at_poses(linkage, task, angle[chosen, target], signs[chosen, target])


def valleys(linkage: FourBar, task: MotionTask) -> tuple[FloatArray, IntArray, FloatArray]:
    """Driver angles, assemblies and misses in the lowest valleys of the miss of each pose, (K, N)."""
    theta3 = task.angles - linkage.body_angle
    angle, signs = _scan(linkage, task, theta3)
    angle, miss = _descend(linkage, task, theta3, angle, signs)
    return angle, signs, miss


def misses(linkage: FourBar, task: MotionTask, theta2: FloatArray, assembly: IntArray) -> FloatArray:
    """|dp|^2 + (angle_length * dangle)^2 of what poses give, shape (..., N); inf where it cannot close."""
    return _miss(linkage, task, task.angles - linkage.body_angle, theta2, assembly)


def at_poses(linkage: FourBar, task: MotionTask, theta2: FloatArray, assembly: IntArray) -> Targets:
    """What a linkage misses poses by at given driver angles and assemblies, each of shape (N,)."""
    state = solve_position(linkage, theta2, assembly)
    gap = state.p - task.positions
    distance = np.nan_to_num(np.hypot(gap[:, 0], gap[:, 1]), nan=np.inf)
    turned = np.abs(_wrapped(state.theta3 + linkage.body_angle - task.angles))
    return Targets(
        theta2,
        assembly,
        np.where(task.has_position, distance, np.nan),
        np.where(task.has_angle, np.nan_to_num(turned, nan=np.pi), np.nan),
    )


def driver_way(linkage: FourBar, theta2: FloatArray, ordered: bool) -> Way:
    """The motion of the driver through given angles.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    theta2 : ndarray, shape (N,), rad
        Driver angle at each target.
    ordered : bool
        Meet the targets in sequence. Otherwise in any: the shortest motion that holds them all.

    Returns
    -------
    Way
    """
    turns = bool((rotatability(linkage) >= 0).all())  # through a change point too, as circuits count it
    index, inside = range_index(linkage, theta2)
    if not turns and (index >= 0).all() and np.ptp(index) == 0:  # one range: no way around
        step = np.diff(inside)
        direction = 1 if inside[-1] >= inside[0] else -1
        in_order = bool((direction * step >= -STEADY).all())
        if ordered and in_order:
            return Way(inside, float(inside[0]), float(inside[-1]), direction, True)
        return Way(inside, float(inside.min()), float(inside.max()), direction, in_order)
    ways = [_turning(theta2, direction) for direction in (1, -1)]
    best = min(ways, key=lambda way: abs(way.end - way.start))
    return best if ordered else _shortest_arc(theta2, best)


def _turning(theta2: FloatArray, direction: int) -> Way:
    step = (direction * np.diff(theta2) + STEADY) % TURN - STEADY
    counted = theta2[0] + direction * np.concatenate([[0.0], np.cumsum(step)])
    in_order = bool(step.sum() <= TURN + STEADY)
    return Way(counted, float(counted[0]), float(counted[-1]), direction, in_order)


def _shortest_arc(theta2: FloatArray, ordered: Way) -> Way:
    around = np.sort(theta2 % TURN)
    gap = np.diff(around, append=around[0] + TURN)
    start = around[(np.argmax(gap) + 1) % len(around)]
    counted = start + (theta2 - start + STEADY) % TURN - STEADY
    return Way(counted, float(start), float(start + TURN - gap.max()), 1, ordered.in_order)


def _miss(
    linkage: FourBar, task: MotionTask, theta3: FloatArray, theta2: FloatArray, signs: IntArray
) -> FloatArray:
    state = solve_position(linkage, theta2, signs)
    gap = np.where(task.has_position, ((state.p - task.positions) ** 2).sum(axis=-1), 0.0)
    turn = np.where(task.has_angle, task.angle_length * _wrapped(state.theta3 - theta3), 0.0)
    miss: FloatArray = np.nan_to_num(gap + turn**2, nan=np.inf, posinf=np.inf)
    return miss


def _met(miss: FloatArray, task: MotionTask) -> bool:
    return bool((miss.min(axis=0) <= _rounding(task)).all())


def _rounding(task: MotionTask) -> float:
    return (_EXACT * task.angle_length) ** 2


def _descend(
    linkage: FourBar, task: MotionTask, theta3: FloatArray, angle: FloatArray, signs: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Driver angles after Gauss-Newton steps, and what they miss by; each shape (K, N)."""
    ends = driver_ranges(linkage)
    best = _miss(linkage, task, theta3, angle, signs)
    for _ in range(6):
        if _met(best, task):
            break
        moved = _into_ranges(ends, angle + _gauss_newton_step(linkage, task, theta3, angle, signs))
        miss = _miss(linkage, task, theta3, moved, signs)
        better = miss < best
        if not better.any():
            break
        angle, best = np.where(better, moved, angle), np.where(better, miss, best)
    return angle, best


def _scan(linkage: FourBar, task: MotionTask, theta3: FloatArray) -> tuple[FloatArray, IntArray]:
    """Driver angles and assemblies in the lowest valleys of the miss over all driver angles, (K, N)."""
    ends = driver_ranges(linkage)
    ranges = ends[np.isfinite(ends[:, 0])]
    # Closer towards dead positions, where a linkage runs away from its driver.
    share = (1 - np.cos(np.linspace(0, np.pi, _SAMPLES))) / 2
    around = np.concatenate([low + (high - low) * share for low, high in ranges] or [[0.0]])
    miss = _miss(linkage, task, theta3, around[:, None], np.array([1, -1])[:, None, None])
    valley = (miss <= np.roll(miss, 1, axis=1)) & (miss <= np.roll(miss, -1, axis=1))
    lowest = np.argsort(np.where(valley, miss, np.inf).reshape(-1, len(task)), axis=0)[:_VALLEYS]
    angle, signs = around[lowest % len(around)], np.where(lowest < len(around), 1, -1)
    width = TURN / _SAMPLES * np.pi / 2  # no two samples lie farther apart
    for look in (_BESIDE, *[9] * 11):
        tried = _into_ranges(ends, angle + width * np.linspace(-1, 1, look)[:, None, None])
        nearest = np.argmin(_miss(linkage, task, theta3, tried, signs), axis=0)
        angle = np.take_along_axis(tried, nearest[None], axis=0)[0]
        width /= 4
    return angle, signs


def _gauss_newton_step(
    linkage: FourBar, task: MotionTask, theta3: FloatArray, theta2: FloatArray, signs: IntArray
) -> FloatArray:
    state = solve_position(linkage, theta2, signs)
    with np.errstate(divide="ignore", invalid="ignore"):
        rate3 = (
            linkage.r2 * np.sin(state.theta4 - theta2) / (linkage.r3 * np.sin(state.theta3 - state.theta4))
        )
    coupler = complex(*linkage.coupler_point) * np.exp(1j * state.theta3)
    gap = np.where(task.has_position, (state.p - task.positions) @ np.array([1, 1j]), 0.0)
    turn = np.where(task.has_angle, _wrapped(state.theta3 - theta3), 0.0)
    square = np.where(task.has_angle, task.angle_length**2, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        rate_p = 1j * (linkage.r2 * np.exp(1j * theta2) + coupler * rate3)
        slope = (rate_p.conj() * gap).real + square * rate3 * turn
        step = -slope / (task.has_position * np.abs(rate_p) ** 2 + square * rate3**2)
    return np.where(np.isfinite(step), np.clip(step, -0.5, 0.5), 0.0)


def _into_ranges(ranges: FloatArray, theta2: FloatArray) -> FloatArray:
    """Driver angles, moved to the nearest end of a range where they lie outside all."""
    low, high = ranges[np.isfinite(ranges[:, 0])].T
    if not low.size:
        return theta2
    inside = ((theta2[..., None] - low) % TURN <= high - low).any(axis=-1)
    if inside.all():
        return theta2
    ends = np.concatenate([low, high])
    nearest = ends[np.argmin(np.abs(_wrapped(theta2[..., None] - ends)), axis=-1)]
    return np.where(inside, theta2, nearest)


def _wrapped(angle: FloatArray) -> FloatArray:
    return (angle + np.pi) % TURN - np.pi
