"""Poses met each by itself, where a linkage comes nearest to them, or in order, by least squares."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from grashof.analysis.judge.meeting.assignment import assigned
from grashof.analysis.judge.meeting.task_motion import (
    Targets,
    TaskMotion,
    as_good,
    misses,
    squares,
    task_motion,
)
from grashof.analysis.mechanism.even_motion import closer_at_ends
from grashof.analysis.mechanism.mobility import closes_everywhere, driver_ranges, range_index
from grashof.analysis.numerics.minimisation import lowest_in_order
from grashof.analysis.numerics.peaks import highest
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, turned_from

_EXACT = 1e-13  # errors below this share of the size are rounding
_SAMPLES = 361
_VALLEYS = 6
_MANY, _DEEPEST = 64, 2  # of more targets only the deepest valleys are followed to their ends
_AT_ONCE = 96  # targets of linkages scanned together, whose arrays fit into a cache
_BESIDE = 41  # samples about each valley: beside a cusp may lie a deeper one
_PLACES = 120  # driver angles of a turn, or of a range, among which poses are assigned in order
_MOST = 360  # such angles at most: valleys of many poses lie close together, so that some represent all
_FOLLOWED = 2.0  # times the least sum there: such guesses are followed
_FREE = np.array(np.inf)


@dataclass(frozen=True, slots=True)
class Nearest:
    """The linkages of a batch (B,) nearest to each pose by itself, on the own assembly or a nearer other.

    `valleys` has driver angles in the lowest valleys of the misses, on the own assembly, of each linkage that
    misses a pose.
    """

    targets: Targets
    valleys: Mapping[int, FloatArray]


def nearest_to_poses(linkage: Linkage, task: Task) -> Nearest:
    """The linkages of a batch (B,) nearest to each pose.

    Gauss-Newton steps begin where A would be if the body stood in the pose; where a pose is not met, a scan
    over all driver angles finds the lowest valleys.
    """
    (u, v), (x, y) = (np.moveaxis(each, -1, 0)[..., None] for each in (linkage.coupler_point, linkage.o2))
    turned = np.exp(1j * (task.angles - linkage.body_angle[:, None]))
    origin = task.positions @ np.array([1, 1j]) - (u + 1j * v) * turned
    signs = np.broadcast_to(
        (linkage.assembly[:, None] * [1, -1]).astype(np.int64)[..., None], (*linkage.shape, 2, len(task))
    )
    whole = task.has_position & task.has_angle & (linkage.mechanism.carries == 3)  # whose origin is A
    guess = np.where(whole, np.angle(origin - (x + 1j * y)), 0.0)
    ranges = driver_ranges(linkage)
    guess = _into_ranges(ranges[:, None], guess)[:, None]
    angle, miss = _descend(linkage, task, ranges, np.broadcast_to(guess, signs.shape), signs)
    theta2, assembly = _least(task, angle, signs, miss)
    missed = np.flatnonzero(~_met(miss, task))
    valleys = dict[int, FloatArray]()
    for rows in np.array_split(missed, -(-missed.size * len(task) // _AT_ONCE) or 1):
        if not rows.size:
            break
        more = _valleys(linkage[rows], task)
        every = zip((angle[rows], signs[rows], miss[rows]), more, strict=True)
        theta2[rows], assembly[rows] = _least(task, *(np.concatenate(each, axis=1) for each in every))
        valleys |= {row: _on_own(linkage[row], *more[:2], k) for k, row in enumerate(rows.tolist())}
    return Nearest(Targets.of(linkage, task, theta2, assembly), valleys)


def _on_own(linkage: Linkage, angle: FloatArray, signs: IntArray, row: int) -> FloatArray:
    """Of the valleys of a batch those of one linkage on its own assembly."""
    found: FloatArray = angle[row][signs[row] == int(linkage.assembly)]
    return found


def _least(task: Task, angle: FloatArray, signs: IntArray, miss: FloatArray) -> tuple[FloatArray, IntArray]:
    """Driver angles and assemblies of the least misses, (..., N), of several (..., K, N)."""
    miss = np.where(miss <= _rounding(task), 0.0, miss)  # of several that meet a pose the own assembly
    chosen = np.argmin(miss, axis=-2)[..., None, :]
    theta2, assembly = np.take_along_axis(angle, chosen, axis=-2), np.take_along_axis(signs, chosen, axis=-2)
    return theta2[..., 0, :], assembly[..., 0, :]


def _valleys(linkage: Linkage, task: Task) -> tuple[FloatArray, IntArray, FloatArray]:
    """Driver angles, assemblies and misses in the lowest valleys of the miss of each pose, (B, K, N)."""
    ranges = driver_ranges(linkage)
    # Closer towards dead positions, where a linkage runs away from its driver.
    around = closer_at_ends(ranges[..., :1], ranges[..., 1:], _SAMPLES)
    every, sides = linkage[:, None, None, None, None], np.array([1, -1])
    miss = misses(every, task, around[:, None, :, :, None], sides[:, None, None, None])
    beside = np.pad(miss, [(0, 0)] * 3 + [(1, 1), (0, 0)], constant_values=np.inf)
    valley = (miss <= beside[:, :, :, :-2]) & (miss <= beside[:, :, :, 2:])
    depths = np.moveaxis(np.where(valley, -miss, -np.inf).reshape(len(miss), -1, len(task)), 1, -1)
    lowest = highest(depths, _VALLEYS)
    found = np.isfinite(np.take_along_axis(depths, lowest, axis=-1))
    lowest = np.moveaxis(np.where(found, lowest, lowest[..., :1]), -1, 1)
    places = around.reshape(len(around), -1)
    angle = np.nan_to_num(places[np.arange(len(places))[:, None, None], lowest % places.shape[1]])
    signs = sides[lowest // places.shape[1]]
    width, every = TURN / _SAMPLES * np.pi / 2, linkage[:, None, None, None]  # no samples lie farther apart
    for look in (_BESIDE, *[9] * 11):
        near = angle[:, None] + width * np.linspace(-1, 1, look)[:, None, None]
        tried = _into_ranges(ranges[:, None, None, None], near)
        miss = misses(every, task, tried, signs[:, None])
        nearest = np.argmin(miss, axis=1)[:, None]
        angle, miss = (np.take_along_axis(each, nearest, axis=1)[:, 0] for each in (tried, miss))
        if look == _BESIDE and len(task) > _MANY:
            deepest = np.argsort(miss, axis=1, kind="stable")[:, :_DEEPEST]
            angle, signs = (np.take_along_axis(each, deepest, axis=1) for each in (angle, signs))
        width /= 4
    angle, miss = _descend(linkage, task, ranges, angle, signs)
    return angle, signs, miss


def _met(miss: FloatArray, task: Task) -> BoolArray:
    """Which linkages meet all poses, (...), from the misses (..., K, N)."""
    return np.asarray((miss.min(axis=-2) <= _rounding(task)).all(axis=-1))


def _rounding(task: Task) -> float:
    return (_EXACT * task.angle_length) ** 2


def _descend(
    linkage: Linkage, task: Task, ranges: FloatArray, angle: FloatArray, signs: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Driver angles of a batch (B,) after Gauss-Newton steps, and their misses; each shape (B, K, N)."""
    every, angle = linkage[:, None, None], angle.copy()
    best = misses(every, task, angle, signs)
    rows = np.arange(len(angle))
    for _ in range(6):
        rows = rows[~_met(best[rows], task)]
        if not rows.size:
            break
        some = every if len(rows) == len(angle) else every[rows]
        _, slope, _, positive = squares(some, task, signs[rows])(angle[rows])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = -slope / positive
        step = np.where(np.isfinite(step), np.clip(step, -0.5, 0.5), 0.0)
        moved = _into_ranges(ranges[rows, None, None], angle[rows] + step)
        miss = misses(some, task, moved, signs[rows])
        better = miss < best[rows]
        angle[rows] = np.where(better, moved, angle[rows])
        best[rows] = np.where(better, miss, best[rows])
        rows = rows[better.any(axis=(1, 2))]
    return angle, best


def _into_ranges(ranges: FloatArray, theta2: FloatArray) -> FloatArray:
    """Driver angles, moved to the nearest end of a range (..., K, 2) where they lie outside all."""
    low, high = ranges[..., 0], ranges[..., 1]
    inside = ((theta2[..., None] - low) % TURN <= high - low).any(axis=-1)
    inside |= np.isnan(low).all(axis=-1)
    if inside.all():
        return theta2
    ends = np.concatenate([low, high], axis=-1)
    away = np.abs(turned_from(theta2[..., None], ends))
    nearest = np.argmin(np.nan_to_num(away, nan=np.inf), axis=-1)[..., None]
    ends = np.broadcast_to(ends, away.shape)
    return np.where(inside, theta2, np.take_along_axis(ends, nearest, axis=-1)[..., 0])


def poses_in_order(
    linkage: Linkage, task: Task, nearest: Targets, motion: TaskMotion, valleys: FloatArray | None = None
) -> tuple[Targets, TaskMotion]:
    """Driver angles that do not go back, within one turn, with the least weighted squares.

    On the own assembly and in one range; `nearest` and `motion` where there are none. Poses free in part are
    met at several angles, so nearest places may be out of order: dynamic programming over samples and valleys
    of the misses, then Newton's method in all angles. `valleys` are those of `Nearest`, if known.
    """
    own = np.full(len(task), int(linkage.assembly))
    found, least = list[tuple[FloatArray, float]](), np.inf
    if valleys is None:
        valleys = _on_own(linkage, *_valleys(linkage[None], task)[:2], 0)
    for places, miss, low, high in _by_range(linkage, task, valleys):
        limits = np.full((1, len(task)), low), np.full((1, len(task)), high)
        for sense in (1, -1):  # counted backwards, driver angles that fall grow
            order = slice(None, None, sense)
            guesses, sums = _guesses(places, miss[order], least, turns=not np.isfinite(low))
            if not sums.size:
                continue
            least = min(least, float(sums[0]))
            model = squares(linkage, task, own, order)
            theta2, value = lowest_in_order(model, guesses, (-_FREE, _FREE), limits)
            found += zip(theta2[:, order], value.sum(axis=1).tolist(), strict=True)
    totals = np.array([value for _, value in found])
    if not np.isfinite(totals).any():
        return nearest, motion
    best = [theta2 for (theta2, _), good in zip(found, as_good(task, totals), strict=True) if good]
    shortest = min(best, key=lambda theta2: float(np.ptp(theta2)))
    ordered = task_motion(linkage, shortest, True)
    if not ordered.in_order:
        return nearest, motion
    return Targets.of(linkage, task, shortest, own), ordered


def _by_range(
    linkage: Linkage, task: Task, valleys: FloatArray
) -> list[tuple[FloatArray, FloatArray, float, float]]:
    """Driver angles (M,) and weighted misses there (N, M), with the ends of each range of the driver.

    The angles are samples, and those of the valleys (K,).
    """
    ranges = list[tuple[FloatArray, float, float]]()
    if closes_everywhere(linkage):
        around = linkage.theta1 + np.linspace(0, TURN, _PLACES, endpoint=False)
        ranges.append((np.concatenate([around, valleys]) % TURN, -np.inf, np.inf))
    else:
        index, inside = range_index(linkage, valleys)
        ranges += [
            (np.concatenate([closer_at_ends(low, high, _PLACES), inside[index == number]]), low, high)
            for number, (low, high) in enumerate(driver_ranges(linkage).tolist())
            if high > low
        ]
    judged = []
    for places, low, high in ranges:
        places = _some(np.unique(places))
        miss = misses(linkage, task, places[:, None], np.asarray(int(linkage.assembly)))
        judged.append((places, (miss * task.meeting_weights).T, low, high))
    return judged


def _some(places: FloatArray) -> FloatArray:
    """Driver angles in order, of too many at most `_MOST` that lie as evenly as can be."""
    if len(places) <= _MOST:
        return places
    cells = np.floor((places - places[0]) / (places[-1] - places[0]) * _MOST)
    return places[np.unique(np.minimum(cells, _MOST - 1), return_index=True)[1]]


def _guesses(
    places: FloatArray, miss: FloatArray, least: float, *, turns: bool
) -> tuple[FloatArray, FloatArray]:
    """Driver angles (K, N) among given ones (M,) that do not go back, of the least sums of misses (N, M).

    And those sums (K,), up to a share of the `least` one known.
    """
    chosen, sums = assigned(miss, lambda cost: _FOLLOWED * cost, least, cyclic=turns)
    turn, place = np.divmod(chosen, len(places))
    return places[place] + TURN * turn, sums
