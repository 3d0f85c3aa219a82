"""Poses met each by itself: where a linkage comes nearest to every one of them."""

from __future__ import annotations

import numpy as np

from grashof.analysis.judge.misses import misses, squares, wrapped
from grashof.analysis.judge.task_motion import Targets
from grashof.analysis.mechanism.mobility import driver_ranges
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

_EXACT = 1e-13  # errors below this share of the size are rounding
_SAMPLES = 361
_VALLEYS = 6
_BESIDE = 41  # samples about each valley: beside a cusp may lie a deeper one


def nearest_to_poses(linkage: Linkage, task: Task) -> Targets:
    """The linkage nearest to each pose, by itself, on its own assembly unless the other is nearer.

    Gauss-Newton steps begin where A would be if the body stood in the pose; where a pose is not met, a scan
    over all driver angles finds the lowest valleys.
    """
    turned = np.exp(1j * (task.angles - linkage.body_angle))
    a = task.positions @ np.array([1, 1j]) - complex(*linkage.coupler_point) * turned - complex(*linkage.o2)
    own = int(linkage.assembly)
    signs = np.broadcast_to(np.array([[own], [-own]]), (2, len(task)))
    guess = np.where(task.has_position & task.has_angle, np.angle(a), 0.0)
    angle = np.broadcast_to(_into_ranges(driver_ranges(linkage), guess), signs.shape)
    angle, miss = _descend(linkage, task, angle, signs)
    if not _met(miss, task):
        more, more_signs, more_miss = valleys(linkage, task)
        angle, signs = np.concatenate([angle, more]), np.concatenate([signs, more_signs])
        miss = np.concatenate([miss, more_miss])
    miss = np.where(miss <= _rounding(task), 0.0, miss)  # of several that meet a pose the own assembly
    chosen, target = np.argmin(miss, axis=0), np.arange(len(task))
    return Targets.of(linkage, task, angle[chosen, target], signs[chosen, target])


def valleys(linkage: Linkage, task: Task) -> tuple[FloatArray, IntArray, FloatArray]:
    """Driver angles, assemblies and misses in the lowest valleys of the miss of each pose, (K, N)."""
    angle, signs = _scan(linkage, task)
    angle, miss = _descend(linkage, task, angle, signs)
    return angle, signs, miss


def _met(miss: FloatArray, task: Task) -> bool:
    return bool((miss.min(axis=0) <= _rounding(task)).all())


def _rounding(task: Task) -> float:
    return (_EXACT * task.angle_length) ** 2


def _descend(
    linkage: Linkage, task: Task, angle: FloatArray, signs: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Driver angles after Gauss-Newton steps, and what they miss by; each shape (K, N)."""
    ends, model = driver_ranges(linkage), squares(linkage, task, signs)
    best = misses(linkage, task, angle, signs)
    for _ in range(6):
        if _met(best, task):
            break
        _, slope, _, positive = model(angle)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = -slope / positive
        step = np.where(np.isfinite(step), np.clip(step, -0.5, 0.5), 0.0)
        moved = _into_ranges(ends, angle + step)
        miss = misses(linkage, task, moved, signs)
        better = miss < best
        if not better.any():
            break
        angle, best = np.where(better, moved, angle), np.where(better, miss, best)
    return angle, best


def _scan(linkage: Linkage, task: Task) -> tuple[FloatArray, IntArray]:
    """Driver angles and assemblies in the lowest valleys of the miss over all driver angles, (K, N)."""
    ends = driver_ranges(linkage)
    ranges = ends[np.isfinite(ends[:, 0])]
    # Closer towards dead positions, where a linkage runs away from its driver.
    share = (1 - np.cos(np.linspace(0, np.pi, _SAMPLES))) / 2
    around = np.concatenate([low + (high - low) * share for low, high in ranges] or [[0.0]])
    miss = misses(linkage, task, around[:, None], np.array([1, -1])[:, None, None])
    valley = (miss <= np.roll(miss, 1, axis=1)) & (miss <= np.roll(miss, -1, axis=1))
    lowest = np.argsort(np.where(valley, miss, np.inf).reshape(-1, len(task)), axis=0)[:_VALLEYS]
    angle, signs = around[lowest % len(around)], np.where(lowest < len(around), 1, -1)
    width = TURN / _SAMPLES * np.pi / 2  # no two samples lie farther apart
    for look in (_BESIDE, *[9] * 11):
        tried = _into_ranges(ends, angle + width * np.linspace(-1, 1, look)[:, None, None])
        nearest = np.argmin(misses(linkage, task, tried, signs), axis=0)
        angle = np.take_along_axis(tried, nearest[None], axis=0)[0]
        width /= 4
    return angle, signs


def _into_ranges(ranges: FloatArray, theta2: FloatArray) -> FloatArray:
    """Driver angles, moved to the nearest end of a range where they lie outside all."""
    low, high = ranges[np.isfinite(ranges[:, 0])].T
    if not low.size:
        return theta2
    inside = ((theta2[..., None] - low) % TURN <= high - low).any(axis=-1)
    if inside.all():
        return theta2
    ends = np.concatenate([low, high])
    nearest = ends[np.argmin(np.abs(wrapped(theta2[..., None] - ends)), axis=-1)]
    return np.where(inside, theta2, nearest)
