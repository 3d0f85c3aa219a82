"""Linkages of a long task fitted to every target: each target concerns its own driver angle only.

The normal equations are a small block that all targets share, bordered by one number a target, which is
eliminated (Schur complement): a step takes time and memory in proportion to the targets.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from grashof.analysis.numerics.isotonic import isotonic_regression
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.quantities.driver_motion import meeting_order
from grashof.synth.starts.closed_loop import PROPORTIONS, Batch, Loop, SearchTargets, body_turns, by_theta3_of
from grashof.synth.starts.limit_residuals import Placement, oversteps
from grashof.synth.starts.loop_search import PLACES, PULL, missed_places, project
from grashof.synth.theory.stopping import raise_if_overdue, stop_requested

STEPS = 30
DONE = 1e-8  # share of its error: a linkage that gains less is done
LONGEST = 0.3  # rad: no driver angle moves farther in a step
LEAST_GAP = 1e-9  # share of a turn, between driver angles that are the same
HEAVY = 1e6  # damping under which no step is worth trying


@dataclass(frozen=True, slots=True)
class Linear:
    """Misses of every target, linearised: gap - common @ what all share - own * its driver angle."""

    error: FloatArray  # (n,)
    gap: FloatArray  # (n, N, 3), as own
    common: FloatArray  # (n, N, 3, C)
    own: FloatArray
    over: FloatArray  # (n, L): excess over limits
    by_over: FloatArray  # (n, L, C + 2), derivatives by what all share and the driver angles at the ends
    ends: IntArray  # (n, 2), of the motion

    def __getitem__(self, rows: IntArray) -> Linear:
        return Linear(*(getattr(self, name)[rows] for name in self.__slots__))

    def where(self, better: BoolArray, fresh: Linear) -> Linear:
        """The fresh one of the linkages that are better."""
        pairs = ((getattr(fresh, name), getattr(self, name)) for name in self.__slots__)
        return Linear(*(np.where(better.reshape(-1, *[1] * (new.ndim - 1)), new, old) for new, old in pairs))


def fitted_to_all(
    target: SearchTargets, batch: Batch, steps: int = STEPS, *, weight: float = PULL, placed: bool = False
) -> Batch:
    """Linkages with the least squares over all (untimed) targets, in at most `steps` Gauss-Newton steps.

    The batch has driver angles at every target, near the best ones; where it is not `placed` (`with_places`),
    linkages stand where they fit the targets best. Overstepping a limit by one unit counts as an error of
    `weight`, in sizes. Damped as Levenberg and Marquardt do. Of targets in order, driver angles that would go
    back are projected on the order by weighted isotonic regression, which is the solution of the step for
    given proportions; those that stand together are eliminated together.
    """
    linearised = partial(_linearised, target, weight=weight)
    now = descended(target, linearised, _with_angles(target, batch, PLACES * placed), PROPORTIONS, steps)
    return now if target.jumbled else _by_gaps(now, len(target.points))


def descended(
    target: SearchTargets, linearised: Callable[[Batch], Linear], begun: Batch, shape: int, steps: int
) -> Batch:
    """Linkages after these steps; `shape` columns of a batch precede its driver angles at every target."""
    now = begun
    found, rows, model = now.unknowns.copy(), np.arange(len(now)), linearised(now)
    damping, idle = np.full(len(now), 1e-3), np.zeros(len(now), dtype=np.int64)
    raise_if_overdue()
    for _ in range(steps):
        if stop_requested() or not rows.size:
            break
        tried = _stepped(target, now, model, damping, shape)
        fresh = linearised(tried)
        better = fresh.error < model.error
        idle = np.where(better & (fresh.error < (1 - DONE) * model.error), 0, idle + better)
        now = replace(now, unknowns=np.where(better[:, None], tried.unknowns, now.unknowns))
        model = model.where(better, fresh)
        damping = np.clip(np.where(better, damping / 5, damping * 8), 1e-12, 10 * HEAVY)
        found[rows] = now.unknowns
        left = np.flatnonzero((idle <= 3) & (damping <= HEAVY))
        if len(left) < len(rows):
            rows, now, model = rows[left], now[left], model[left]
            damping, idle = damping[left], idle[left]
    return replace(begun, unknowns=found)


def costs_of_all(target: SearchTargets, batch: Batch, weight: float) -> FloatArray:
    """Squared errors with what limits add, of linkages with places, shape (n,), sizes squared."""
    return _linearised(target, _with_angles(target, batch, PLACES), weight).error


def _with_angles(target: SearchTargets, batch: Batch, places: int) -> Batch:
    """Linkages with driver angles in place of the gaps between them, before `places` columns of places."""
    inner, last = np.split(batch.unknowns, [batch.unknowns.shape[1] - places], axis=1)
    angles = Loop.of(target, replace(batch, unknowns=inner)).theta2
    return replace(batch, unknowns=np.concatenate([inner[:, :3], angles, last], axis=1))


def _linearised(target: SearchTargets, batch: Batch, weight: float) -> Linear:
    """Misses of every target, linearised: of linkages as placed, or else where they fit best."""
    count = len(target.points)
    free = replace(target, wanted=replace(target.wanted, order=False))
    inner = replace(batch, unknowns=batch.unknowns[:, : 3 + count])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        loop = Loop.of(free, inner)
        if batch.unknowns.shape[1] > 3 + count:
            parts = batch.unknowns[:, 3 + count :].reshape(-1, 3, 2)
            z = parts[..., 0] + 1j * parts[..., 1]
        else:
            z = project(free, loop)[0]
        by_theta2 = np.zeros((len(batch), count, 4))
        by_theta2[..., 3] = 1
        by_theta3 = by_theta3_of(loop, by_theta2)
        residual, by_p = missed_places(free, loop, z, by_theta2, by_theta3)
        turned, _ = body_turns(free, loop)
        ends = _ends(target, loop)
        over, by_over = _overstepped(target, loop, z, ends)
    root = np.sqrt(free.weights)
    spans = [root * each for e in (np.ones_like(loop.e2), loop.e2, loop.e3) for each in (e, 1j * e)]
    spread = np.stack(spans, axis=-1)
    rows = [
        np.concatenate([by_p[:, 0, :, :3], spread.real], -1),
        np.concatenate([by_p[:, 1, :, :3], spread.imag], -1),
    ]
    gaps, own = [residual.real, residual.imag], [by_p[:, 0, :, 3], by_p[:, 1, :, 3]]
    if free.has_angles:
        root = np.sqrt(free.turn_weights)
        by_turn = root[:, None] * by_theta3
        still, body = np.zeros((*loop.theta2.shape, 6)), np.broadcast_to(root, loop.theta2.shape)
        rows = [np.concatenate([row, np.zeros((*row.shape[:2], 1))], axis=-1) for row in rows]
        rows.append(np.concatenate([by_turn[..., :3], still, body[..., None]], axis=-1))
        by_over = np.insert(by_over, 9, 0.0, axis=2)
        gaps.append(turned)
        own.append(by_turn[..., 3])
    error = (np.abs(residual) ** 2).sum(axis=1) + (turned**2).sum(axis=1) + weight**2 * (over**2).sum(axis=1)
    return Linear(
        error=np.where(loop.closes & np.isfinite(error), error, np.inf),
        gap=np.nan_to_num(np.stack(gaps, axis=2)),
        common=np.nan_to_num(np.stack(rows, axis=2)),
        own=np.nan_to_num(np.stack(own, axis=2)),
        over=np.nan_to_num(weight * over),
        by_over=np.nan_to_num(weight * by_over),
        ends=ends,
    )


def _ends(target: SearchTargets, loop: Loop) -> IntArray:
    """Targets whose driver angles limits may depend on: those at both ends of the motion; shape (n, 2)."""
    ends = np.broadcast_to([0, len(target.points) - 1], (len(loop.r2), 2))
    if target.jumbled:
        ends = meeting_order(np.nan_to_num(loop.theta2))[0][:, [0, -1]]
        if target.wanted.theta2_start_deg is not None:
            ends[:, 0] = 0
    return ends


def _overstepped(
    target: SearchTargets, loop: Loop, z: ComplexArray, ends: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Excess over limits (n, L); its derivative by what all share and the angles at both ends (n, L, 11)."""
    n, count = loop.theta2.shape
    by_theta2 = np.zeros((n, count, 11))
    by_theta2[np.arange(n)[:, None], ends, [9, 10]] = 1
    by_z = np.zeros((n, 3, 11), dtype=np.complex128)
    for k in range(3):
        by_z[:, k, 3 + 2 * k], by_z[:, k, 4 + 2 * k] = 1, 1j
    placed = Placement(target, loop, by_theta2, by_theta3_of(loop, by_theta2), z, by_z)
    # limits at single targets, most of them between the ends, are left to the programme
    return oversteps(replace(target, at=()) if target.at else target, placed)


def _stepped(target: SearchTargets, batch: Batch, model: Linear, damping: FloatArray, shape: int) -> Batch:
    """Linkages after a damped step."""
    common, own, gap, count = model.common, model.own, model.gap, model.gap.shape[1]
    flat, transposed = _flat(common), np.swapaxes(_flat(common), 1, 2)
    normal, right = transposed @ flat, (transposed @ gap.reshape(len(batch), -1, 1))[..., 0]
    border, pull = (own[..., None] * common).sum(axis=2), (own * gap).sum(axis=2)
    by_common, by_ends = model.by_over[..., :-2], model.by_over[..., -2:]
    normal += np.swapaxes(by_common, 1, 2) @ by_common
    right -= (np.swapaxes(by_common, 1, 2) @ model.over[..., None])[..., 0]
    each = np.arange(len(batch))[:, None]
    border[each, model.ends] += np.swapaxes(by_ends, 1, 2) @ by_common
    pull[each, model.ends] -= (np.swapaxes(by_ends, 1, 2) @ model.over[..., None])[..., 0]
    diagonal = np.einsum("sii->si", normal)
    ridge = damping[:, None] * (diagonal + 1e-12 * diagonal.max(axis=1, keepdims=True)) + 1e-300
    normal = normal + ridge[..., None] * np.eye(normal.shape[1])
    heavy = _weights(own)
    heavy[each, model.ends] += (by_ends**2).sum(axis=1)
    heavy *= (1 + damping)[:, None]
    parts = np.concatenate([border, heavy[..., None]], axis=2)
    angles = batch.unknowns[:, shape : shape + count]
    if not target.jumbled:
        parts = _summed(parts, np.diff(angles, axis=1, prepend=np.nan) == 0)
    share = np.swapaxes(parts[..., :-1] / parts[..., -1:], 1, 2)
    step = np.clip(_solved(normal - share @ border, right - (share @ pull[..., None])[..., 0]), -1.5, 1.5)
    moved = _moved(target, batch, angles, (pull - (border @ step[..., None])[..., 0]) / heavy, heavy)
    places = batch.unknowns[:, shape + count :]
    places = places + step[:, shape : shape + places.shape[1]]
    first = batch.unknowns[:, :shape] + step[:, :shape]
    return replace(batch, unknowns=np.concatenate([first, moved, places], axis=1))


def _weights(own: FloatArray) -> FloatArray:
    """Resistance of each driver angle to being moved, shape (n, N)."""
    square: FloatArray = (own**2).sum(axis=2)
    least: FloatArray = np.maximum(square, 1e-12 * square.max(axis=1, keepdims=True)) + 1e-300
    return least


def _moved(
    target: SearchTargets, batch: Batch, angles: FloatArray, step: FloatArray, weights: FloatArray
) -> FloatArray:
    """Driver angles after a step (n, N), in order where that is required."""
    sense = batch.direction[:, None]
    if target.jumbled:
        moved: FloatArray = angles + np.clip(step, -LONGEST, LONGEST)
        return moved
    desired = sense * (angles + np.clip(step, -LONGEST, LONGEST))
    return sense * _in_order(desired, weights)


def _flat(common: FloatArray) -> FloatArray:
    return common.reshape(len(common), -1, common.shape[-1])


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solutions (n, C) of small equations; none where the numbers are not finite."""
    both = np.concatenate([matrix, right[..., None]], axis=2)
    both[~np.isfinite(both).all(axis=(1, 2))] = np.eye(*both.shape[1:])
    found: FloatArray = np.linalg.solve(both[..., :-1], both[..., -1:])[..., 0]
    return found


def _summed(parts: FloatArray, together: BoolArray) -> FloatArray:
    """Of each target the sum of parts (n, N, C) of those that stand `together` (n, N: with the last)."""
    if not together.any():
        return parts
    first = np.flatnonzero(~together.ravel())
    sums = np.add.reduceat(parts.reshape(-1, parts.shape[2]), first, axis=0)
    count = np.diff(np.append(first, together.size))
    every: FloatArray = np.repeat(sums, count, axis=0).reshape(parts.shape)
    return every


def _in_order(angles: FloatArray, weights: FloatArray) -> FloatArray:
    """The nearest angles (n, N), by weight, that do not go back, within one turn."""
    ordered = isotonic_regression(angles, weights)
    first, last = ordered[:, :1], ordered[:, -1:]
    over = np.maximum(last - first - TURN * (1 - LEAST_GAP), 0.0)
    within: FloatArray = np.clip(ordered, first + over / 2, last - over / 2)
    return within


def _by_gaps(found: Batch, count: int) -> Batch:
    """Linkages with driver angles as the ordered search has them: the first one, and gaps."""
    angles, places = found.unknowns[:, 3 : 3 + count], found.unknowns[:, 3 + count :]
    gone = found.direction[:, None] * (angles - angles[:, :1]) / TURN
    gaps = np.concatenate([np.diff(gone, axis=1), 1 - gone[:, -1:]], axis=1)
    logs = np.log(np.maximum(gaps, LEAST_GAP))
    return replace(found, unknowns=np.concatenate([found.unknowns[:, :4], logs, places], axis=1))
