"""The link that carries P, and the last one, of many linkages at their targets, with derivatives."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.chain import chained
from grashof.synth.loop.dyad import as_complex
from grashof.synth.loop.vector import Vector
from grashof.synth.starts.closed_loop import Batch, SearchTargets, by_angles, driver_angles
from grashof.synth.starts.loop_search import back_substituted, project
from grashof.synth.starts.six_bars.moves import Move, moves, number
from grashof.synth.starts.six_bars.shapes import ENDS, Shapes, plain


class Along:
    """A vector of the shape at every target as complex numbers (n, N), and its derivatives."""

    def __init__(self, value: ComplexArray, columns: Callable[[], ComplexArray], unknowns: Columns) -> None:
        self.value, self._columns, self._unknowns = value, columns, unknowns

    @cached_property
    def columns(self) -> ComplexArray:
        """Derivatives by the columns of `Made`, (n, N, K)."""
        return self._columns()

    @cached_property
    def slope(self) -> ComplexArray:
        """Derivatives by all unknowns, (n, N, M)."""
        return self.by(self._unknowns)

    def by(self, unknowns: Columns) -> ComplexArray:
        """Derivatives by others."""
        return np.asarray(unknowns.slope(self.columns))


class Columns(Protocol):
    """Columns of derivatives, at driver angles (n, N)."""

    theta2: FloatArray

    @property
    def count(self) -> int:
        """Their number M."""

    @property
    def by_angle(self) -> FloatArray:
        """Derivatives of the driver angles, (n, N, M)."""

    def slope(self, by_columns: Any) -> Any:
        """Derivatives (n, N, M), or (n, 1, M), from those by the columns of `Made`."""


class Unknowns(Columns):
    """The unknowns of a batch, and its driver angles: (n, N) at targets, (n, 2) at the ends, ascending."""

    def __init__(self, target: SearchTargets, shapes: Shapes, batch: Batch) -> None:
        self._target, self._shapes, self._batch = target, shapes, batch
        self.theta2 = driver_angles(target, batch.unknowns[:, shapes.width :], batch.direction)
        self._at_ends = np.where(batch.direction[:, None] < 0, [-1, 0], [0, -1])
        self.ends = np.take_along_axis(self.theta2, self._at_ends, axis=1)

    @property
    def count(self) -> int:
        """Their number."""
        return int(self._batch.unknowns.shape[1])

    @cached_property
    def by_angle(self) -> FloatArray:
        """Derivatives of the driver angles, (n, N, M)."""
        return by_angles(self._target, self._batch, self._shapes.width)

    def slope(self, by_columns: Any) -> Any:
        """Derivatives by all unknowns (n, N, M), or (n, 1, M) of what no target affects."""
        width = self._shapes.width
        if by_columns.shape[1] == self.theta2.shape[1]:
            by_every = by_columns[..., -1:] * self.by_angle
        else:
            by_every = np.zeros((*by_columns.shape[:2], self.count), by_columns.dtype)
        by_every[..., :width] += by_columns[..., :width]
        if self._shapes.by_ends:
            by_ends = np.take_along_axis(self.by_angle, self._at_ends[..., None], axis=1)
            by_every += by_columns[..., width : width + ENDS] @ by_ends
        return by_every


class Carried:
    """The link that carries P, and the last one, at every target."""

    def __init__(self, target: SearchTargets, shapes: Shapes, batch: Batch) -> None:
        """Close the loops of every linkage at every target."""
        self.unknowns, row = Unknowns(target, shapes, batch), shapes.mechanism
        free, ends = batch.unknowns[:, : shapes.width], self.unknowns.ends
        self.made = shapes.made(free, batch.longer_driver, batch.assembly, ends)
        theta2 = self.unknowns.theta2
        driver, sides = Vector(np.cos(theta2), np.sin(theta2)), list(batch.assembly.T[..., None])
        self.frames, squares = chained(row, plain(self.made.given), driver, sides)
        carries, last = row.carries, row.loops[-1].links[1]
        self.by_origin = self._along(self.frames[carries].origin, lambda: self.moves[carries].by_origin)
        self.by_along = self._along(self.frames[carries].along, lambda: self.moves[carries].by_along)
        self.by_output = self._along(self.frames[last].along, lambda: self.moves[last].by_along)
        self.direction = batch.direction  # (n,), sense of the driver
        self.origin, self.along, self.output = (
            each.value for each in (self.by_origin, self.by_along, self.by_output)
        )
        self.closes: BoolArray = np.logical_and.reduce([np.all(each > 0, axis=1) for each in squares])

    def _along(self, vector: Vector, columns: Callable[[], ComplexArray]) -> Along:
        value = np.broadcast_to(as_complex(vector), self.unknowns.theta2.shape)
        return Along(value, columns, self.unknowns)

    @cached_property
    def moves(self) -> dict[int, Move]:
        """How all links move with the columns of `Made`."""
        return moves(self.made.shapes.mechanism, self.frames, self.made.given)

    @property
    def a(self) -> Along:
        """A."""
        return self._along(self.frames[3].origin, lambda: self.moves[3].by_origin)

    @property
    def b(self) -> Along:
        """B."""
        r4 = self.made.given["r4"]
        place = self.frames[4].origin + r4.value * self.frames[4].along
        return self._along(place, lambda: self.moves[4].by_point(*number(r4)))

    @property
    def reached(self) -> ComplexArray:
        """The places of all joints at the targets, (n, K)."""
        coupler, shape = self.frames[5], self.unknowns.theta2.shape
        places = [self.frames[link].origin for link in (2, 3, 4, 5, 6)]
        places.append(coupler.origin + self.made.given["r5"].value * coupler.along)
        joints = [np.broadcast_to(as_complex(each), shape) for each in places]
        return np.concatenate([*joints, self.b.value], axis=1)


def around(shapes: Shapes, batch: Batch, z: ComplexArray, count: int) -> ComplexArray:
    """P at even driver angles of a turn, (n, count), of linkages at places z0, z1, z2 (n, 3)."""
    free, theta2 = batch.unknowns[:, : shapes.width], np.arange(count) * TURN / count
    made = shapes.made(free, batch.longer_driver, batch.assembly, np.zeros((len(batch), ENDS)))
    driver = Vector(np.cos(theta2), np.sin(theta2))
    row = shapes.mechanism
    frames = chained(row, plain(made.given), driver, list(batch.assembly.T[..., None])).frames
    origin, along = (as_complex(each) for each in frames[row.carries])
    found: ComplexArray = z[:, :1] + z[:, 1:2] * origin + z[:, 2:] * along
    return found


class Placing:
    """Where linkages fit the points best: z0, z1, z2 (n, 3), which are solved for."""

    def __init__(self, target: SearchTargets, at: Carried) -> None:
        self._target, self._at, self._root = target, at, np.sqrt(target.weights)
        self.z, self._q, self._r, _ = project(target, at)

    @cached_property
    def moved(self) -> ComplexArray:
        """Derivatives of P, weighted, with z held, (n, N, M)."""
        z, at = self.z[:, None], self._at
        moved = z[..., 1:2] * at.by_origin.slope + z[..., 2:] * at.by_along.slope
        return moved * self._root[:, None]

    @cached_property
    def share(self) -> ComplexArray:
        """The part of them that z takes up, (n, 3, M)."""
        return np.swapaxes(self._q.conj(), 1, 2) @ self.moved

    @cached_property
    def by_z(self) -> ComplexArray:
        """Derivatives of z, (n, 3, M), for small errors (Kaufman's)."""
        return -back_substituted(self._r, self.share)

    @property
    def rest(self) -> ComplexArray:
        """Derivatives of P, weighted, as z follows, (n, N, M)."""
        return self.moved - self._q @ self.share
