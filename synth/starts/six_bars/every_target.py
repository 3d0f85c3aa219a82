"""Six-bars fitted to many targets: each driver angle concerns its own target, and is eliminated.

See `grashof.synth.starts.every_target`, whose steps these are; limits are those at the ends of the motion.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray
from grashof.synth.starts.closed_loop import Batch, SearchTargets, body_turns, shares_of_turn
from grashof.synth.starts.every_target import Linear, descended
from grashof.synth.starts.limit_residuals import limit_rows, slopes_of
from grashof.synth.starts.loop_search import PLACES, project
from grashof.synth.starts.six_bars.carried import Carried, Columns, Placing
from grashof.synth.starts.six_bars.limits import SixBarView
from grashof.synth.starts.six_bars.shapes import ENDS, Shapes
from grashof.synth.starts.thinning import lengths_along

STEPS = 100
WEIGHT = 10.0  # of limits: an excess by one unit counts as an error of so many sizes


def fitted_to_all(
    target: SearchTargets, some: SearchTargets, shapes: Shapes, batch: Batch, index: IntArray
) -> tuple[Batch, ComplexArray, FloatArray]:
    """Linkages that know the targets `index`, fitted to every one; best first.

    Their driver angles follow the shape; places z0, z1, z2 (n, 3), and squared errors (n,), sizes squared.
    """
    free = replace(target, wanted=replace(target.wanted, order=False))
    with np.errstate(all="ignore"):
        z = project(some, Carried(some, shapes, batch))[0]
        begun = _with_places(target, shapes, batch, index, z)
        linearised = partial(_linearised, free, shapes)
        found = descended(target, linearised, begun, shapes.width, STEPS)
        error = linearised(found).error
        order = np.argsort(error, kind="stable")
        order = order[np.isfinite(error[order])]
    inner, places = _parts(shapes, found[order], len(target.points))
    return inner, places, error[order]


def _with_places(
    target: SearchTargets, shapes: Shapes, batch: Batch, index: IntArray, z: ComplexArray
) -> Batch:
    """The shape, driver angles at every target, between known ones by the length of the path, and places."""
    first, rest = batch.unknowns[:, : shapes.width], batch.unknowns[:, shapes.width :]
    length = lengths_along(target)
    _, gone = shares_of_turn(rest[:, 1:])
    known, at = gone, length[index]
    if target.closed:  # after the last known one the way back to the first
        end = length[-1] + abs(target.points[0] - target.points[-1])
        known, at = np.concatenate([gone, np.ones((len(gone), 1))], axis=1), np.append(at, end)
    every = np.stack([np.interp(length, at, row) for row in known])
    angles = rest[:, :1] + TURN * batch.direction[:, None] * every
    parts = np.stack([z.real, z.imag], axis=-1).reshape(len(batch), PLACES)
    return replace(batch, unknowns=np.concatenate([first, angles, np.nan_to_num(parts)], axis=1))


def _parts(shapes: Shapes, batch: Batch, count: int) -> tuple[Batch, ComplexArray]:
    """Linkages without their places, and these."""
    inner, parts = np.split(batch.unknowns, [shapes.width + count], axis=1)
    pairs = parts.reshape(len(batch), PLACES // 2, 2)
    return replace(batch, unknowns=inner), pairs[..., 0] + 1j * pairs[..., 1]


class Common(Columns):
    """Columns of what all targets share (shape, places, the body's angle), then both ends of the motion."""

    def __init__(self, theta2: FloatArray, shapes: Shapes, body: bool) -> None:
        self.theta2, self._shapes, self._body = theta2, shapes, body

    @property
    def shared(self) -> int:
        """Columns before the ends."""
        return self._shapes.width + PLACES + self._body

    @property
    def count(self) -> int:
        """All of them."""
        return self.shared + ENDS

    @property
    def by_angle(self) -> FloatArray:
        """Derivatives of driver angles by those at the ends, (1, N, C)."""
        found = np.zeros((1, self.theta2.shape[1], self.count))
        found[0, 0, -2] = found[0, -1, -1] = 1
        return found

    def slope(self, by_columns: Any) -> Any:
        """Derivatives by these columns, from those by the columns of `Made`."""
        width = self._shapes.width
        found = np.zeros((*by_columns.shape[:2], self.count), by_columns.dtype)
        found[..., :width] = by_columns[..., :width]
        if by_columns.shape[1] == self.theta2.shape[1]:
            found[:, 0, -2], found[:, -1, -1] = by_columns[:, 0, -1], by_columns[:, -1, -1]
        return found


class Standing(Placing):
    """Places that are unknowns."""

    def __init__(self, z: ComplexArray, columns: Common, width: int) -> None:
        self.z, self._columns, self._width = z, columns, width

    @property
    def by_z(self) -> ComplexArray:
        """Derivatives of z, (n, 3, C)."""
        found = np.zeros((len(self.z), 3, self._columns.count), dtype=np.complex128)
        for k in range(3):
            found[:, k, self._width + 2 * k], found[:, k, self._width + 2 * k + 1] = 1, 1j
        return found


def _linearised(target: SearchTargets, shapes: Shapes, batch: Batch) -> Linear:
    """Misses of every target, linearised."""
    width, count = shapes.width, len(target.points)
    inner, z = _parts(shapes, batch, count)
    with np.errstate(all="ignore"):
        at = Carried(target, shapes, inner)
        by_origin, by_along = at.by_origin.columns, at.by_along.columns
        root = np.sqrt(target.weights)
        missed = (target.points - z[:, :1] - z[:, 1:2] * at.origin - z[:, 2:] * at.along) * root
        slope = (z[:, 1:2, None] * by_origin + z[:, 2:, None] * by_along) * root[:, None]
        spans = [root * each for e in (np.ones_like(at.along), at.origin, at.along) for each in (e, 1j * e)]
        columns = [*np.moveaxis(slope[..., :width], -1, 0), *spans]
        columns += [np.zeros_like(missed)] * target.has_angles
        rows = [np.stack([getattr(each, part) for each in columns], -1) for part in ("real", "imag")]
        gaps, own = [missed.real, missed.imag], [slope[..., -1].real, slope[..., -1].imag]
        if target.has_angles:
            root = np.sqrt(target.turn_weights)
            turned = root[:, None] * (at.along.conj()[..., None] * by_along).imag
            body = np.broadcast_to(root[:, None], (*missed.shape, 1))
            rows.append(
                np.concatenate([turned[..., :width], np.zeros((*missed.shape, PLACES)), body], axis=-1)
            )
            gaps.append(body_turns(target, at)[0])
            own.append(turned[..., -1])
        common = Common(at.unknowns.theta2, shapes, target.has_angles)
        over = _over(target, shapes, at, Standing(z, common, width), common)
    error = sum((each**2).sum(axis=1) for each in (*gaps, over[0]))
    return Linear(
        error=np.where(at.closes & np.isfinite(error), error, np.inf),
        gap=np.nan_to_num(np.stack(gaps, axis=2)),
        common=np.nan_to_num(np.stack(rows, axis=2)),
        own=np.nan_to_num(np.stack(own, axis=2)),
        over=np.nan_to_num(over[0]),
        by_over=np.nan_to_num(over[1]),
        ends=np.broadcast_to([0, count - 1], (len(batch), 2)),
    )


def _over(
    target: SearchTargets, shapes: Shapes, at: Carried, placing: Standing, common: Common
) -> tuple[FloatArray, FloatArray]:
    """Excess over limits, weighted (n, L), and its derivatives (n, L, C)."""
    rows = [*limit_rows(target, SixBarView(shapes, at, placing, common))] if target.limited else []
    if not rows:
        return np.zeros((len(placing.z), 0)), np.zeros((len(placing.z), 0, common.count))
    over = np.concatenate([row.value for row in rows], axis=1)
    return WEIGHT * over, WEIGHT * slopes_of(rows, over.shape[1], common.count)
