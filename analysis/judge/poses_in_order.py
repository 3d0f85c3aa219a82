"""Poses met in order where the nearest places are not in order: least squares of near poses."""

from __future__ import annotations

import numpy as np

from grashof.analysis.curves.coupler_curve import ROUNDING
from grashof.analysis.judge.assignment import assigned, assigned_around
from grashof.analysis.judge.misses import misses, squares
from grashof.analysis.judge.nearest_poses import valleys
from grashof.analysis.judge.task_motion import Targets, TaskMotion, task_motion
from grashof.analysis.mechanism.mobility import driver_ranges, range_index, rotatability
from grashof.analysis.numerics.minimisation import lowest_in_order
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray

SAMPLES = 120  # of a turn of the driver, or of a range
PLACES = 360  # driver angles at most; the valleys of many poses lie so close together that some stand for all
NEAR = 2.0  # times the least sum on the samples: such guesses are followed
FREE = np.array(np.inf)


def poses_in_order(
    linkage: Linkage, task: Task, nearest: Targets, motion: TaskMotion
) -> tuple[Targets, TaskMotion]:
    """Driver angles that do not go back, within one turn, with the least weighted squares.

    On the own assembly and in one range; what is given where there are none. Poses free in part are met at
    several angles, so nearest places may be out of order: dynamic programming over samples and valleys of the
    misses, then Newton's method in all angles.
    """
    own = np.full(len(task), int(linkage.assembly))
    found = list[tuple[FloatArray, float]]()
    for places, miss, low, high in _by_range(linkage, task):
        limits = np.full((1, len(task)), low), np.full((1, len(task)), high)
        for sense in (1, -1):  # counted backwards, driver angles that fall grow
            order = slice(None, None, sense)
            guesses = _guesses(places, miss[order], turns=not np.isfinite(low))
            model = squares(linkage, task, own, order)
            theta2, value = lowest_in_order(model, guesses, (-FREE, FREE), limits)
            found += zip(theta2[:, order], value.sum(axis=1).tolist(), strict=True)
    least = min((value for _, value in found), default=np.inf)
    level = least * (1 + 1e-9) + len(task) * (ROUNDING * task.size) ** 2
    best = [theta2 for theta2, value in found if value <= level < np.inf]
    if not best:
        return nearest, motion
    shortest = min(best, key=lambda theta2: float(np.ptp(theta2)))
    ordered = task_motion(linkage, shortest, True)
    if not ordered.in_order:
        return nearest, motion
    return Targets.of(linkage, task, shortest, own), ordered


def _by_range(linkage: Linkage, task: Task) -> list[tuple[FloatArray, FloatArray, float, float]]:
    """Driver angles (M,) and weighted misses there (N, M), with the ends of each range of the driver."""
    angle, signs, _ = valleys(linkage, task)
    bottoms = angle[signs == int(linkage.assembly)]
    ranges = list[tuple[FloatArray, float, float]]()
    if (rotatability(linkage) >= 0).all():
        around = linkage.theta1 + np.linspace(0, TURN, SAMPLES, endpoint=False)
        ranges.append((np.concatenate([around, bottoms]) % TURN, -np.inf, np.inf))
    else:
        index, inside = range_index(linkage, bottoms)
        share = (1 - np.cos(np.linspace(0, np.pi, SAMPLES))) / 2  # closer towards dead positions
        ranges += [
            (np.concatenate([low + (high - low) * share, inside[index == number]]), float(low), float(high))
            for number, (low, high) in enumerate(driver_ranges(linkage))
            if high > low
        ]
    judged = []
    for places, low, high in ranges:
        places = _some(np.unique(places))
        miss = misses(linkage, task, places[:, None], np.asarray(int(linkage.assembly)))
        judged.append((places, (miss * task.weights).T, low, high))
    return judged


def _some(places: FloatArray) -> FloatArray:
    """Driver angles in order, of too many at most `PLACES` that lie as evenly as can be."""
    if len(places) <= PLACES:
        return places
    cells = np.floor((places - places[0]) / (places[-1] - places[0]) * PLACES)
    return places[np.unique(np.minimum(cells, PLACES - 1), return_index=True)[1]]


def _guesses(places: FloatArray, miss: FloatArray, *, turns: bool) -> FloatArray:
    """Driver angles (K, N) among given ones (M,) that do not go back, of the least sums of misses (N, M)."""
    if turns:
        chosen, costs, cuts = assigned_around(miss)
        chosen = chosen + cuts
    else:
        chosen, costs = assigned(miss[:, :, None])
    turn, place = np.divmod(chosen, len(places))
    near = np.isfinite(costs) & (costs <= NEAR * costs.min(initial=np.inf))
    guesses: FloatArray = (places[place] + TURN * turn).T[near]
    return guesses
