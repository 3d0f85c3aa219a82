"""Poses met in order where the nearest places are not in order: least squares of near poses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from grashof.analysis.curves.coupler_curve import ROUNDING, coupler_rates
from grashof.analysis.four_bar.mobility import driver_ranges, range_index, rotatability
from grashof.analysis.four_bar.position import solve_position
from grashof.analysis.judge.assignment import assigned, assigned_around
from grashof.analysis.judge.nearest_poses import Targets, Way, at_poses, driver_way, misses, valleys
from grashof.analysis.numerics.minimisation import Model, lowest_in_order
from grashof.problems import FourBar, MotionTask
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

SAMPLES = 120  # of a turn of the driver, or of a range
NEAR = 2.0  # times the least sum on the samples: such guesses are followed
FREE = np.array(np.inf)


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
    Dynamic programming over driver angles, among them the bottoms of the valleys of the misses; then
    Newton's method in all angles.

    Examples
    --------
    >>> from grashof.analysis.judge.nearest_poses import driver_way, nearest_to_poses
    >>> from grashof.analysis.judge.planted import planted_motion
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=5)
    >>> swapped = MotionTask(task.positions[[0, 2, 1, 3, 4]], task.angles[[0, 2, 1, 3, 4]])
    >>> nearest = nearest_to_poses(linkage, swapped)
    >>> targets, way = poses_in_order(linkage, swapped, nearest, driver_way(linkage, nearest.theta2, True))
    >>> way.in_order, bool(targets.position_error.max() > 0)
    (True, True)
    """
    own = np.full(len(task), int(linkage.assembly))
    found = list[tuple[FloatArray, float]]()
    for places, miss, low, high in _by_range(linkage, task):
        limits = np.full((1, len(task)), low), np.full((1, len(task)), high)
        for sense in (1, -1):  # counted backwards, driver angles that fall grow
            order = slice(None, None, sense)
            guesses = _guesses(places, miss[order], turns=not np.isfinite(low))
            theta2, value = lowest_in_order(
                _missed(linkage, task, own, sense), guesses, (-FREE, FREE), limits
            )
            found += zip(theta2[:, order], value.sum(axis=1).tolist(), strict=True)
    least = min((value for _, value in found), default=np.inf)
    level = least * (1 + 1e-9) + len(task) * (ROUNDING * task.size) ** 2
    best = [theta2 for theta2, value in found if value <= level < np.inf]
    if not best:
        return nearest, way
    shortest = min(best, key=lambda theta2: float(np.ptp(theta2)))
    ordered = driver_way(linkage, shortest, True)
    return (at_poses(linkage, task, shortest, own), ordered) if ordered.in_order else (nearest, way)


def _by_range(linkage: FourBar, task: MotionTask) -> list[tuple[FloatArray, FloatArray, float, float]]:
    """Driver angles (M,) and weighted misses there (N, M), with the ends of each range of the driver."""
    angle, signs, _ = valleys(linkage, task)
    bottoms = angle[signs == int(linkage.assembly)]
    ways = list[tuple[FloatArray, float, float]]()
    if (rotatability(linkage) >= 0).all():
        around = linkage.theta1 + np.linspace(0, TURN, SAMPLES, endpoint=False)
        ways.append((np.concatenate([around, bottoms]) % TURN, -np.inf, np.inf))
    else:
        index, inside = range_index(linkage, bottoms)
        share = (1 - np.cos(np.linspace(0, np.pi, SAMPLES))) / 2  # closer towards dead positions
        ways += [
            (np.concatenate([low + (high - low) * share, inside[index == number]]), float(low), float(high))
            for number, (low, high) in enumerate(driver_ranges(linkage))
            if high > low
        ]
    judged = []
    for places, low, high in ways:
        places = np.unique(places)
        miss = misses(linkage, task, places[:, None], np.asarray(int(linkage.assembly)))
        judged.append((places, (miss * task.weights).T, low, high))
    return judged


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
