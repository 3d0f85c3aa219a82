"""Limits of function generators, as smooth functions of their shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray, Limits
from grashof.synth.loop.dual import Dual

LEAST_ANGLE = float(np.radians(0.3))  # least distance from a dead position


@dataclass(frozen=True, slots=True)
class ShapeLimits:
    """Limits of a generator, zero or positive where they are kept."""

    span: float  # the last input, from the first driver angle on: rotation of the driver, rad, or a length
    # (n, n): greatest logarithm of length j over length k, of `Generators.lengths`
    caps: FloatArray = field(default_factory=lambda: np.full((4, 4), np.log(20.0)))
    transmission: float | FloatArray = 0.0  # rad, least min(mu, pi - mu) of all, or of each (M,)
    over_cycle: bool = False  # over the full turn, not only over the rotation
    # The driver turns fully, and the shares of `rotatability` are this or more
    margin: float | None = None
    shortest: int = 0  # +1 where r1 has to be longer than r2, -1 where shorter, 0 for either
    # (k, n + 1): sums of the lengths and the offset that have to be zero or positive; see `offset_rows`
    offset: FloatArray | None = None
    stroke: Limits = (-np.inf, np.inf)  # of the travel over a full turn, in units of the lengths
    # (R, 3): inputs, with the least and the greatest d(output)/d(input) there, in units of the output
    rates: FloatArray | None = None
    triangle: Rows | None = None  # of a cylinder on the driver
    places: PlaceRows | None = None  # at single inputs or all of them

    def of(self, batch: Limited) -> Dual:
        """Limits (M, L) with derivatives by the shape (M, L, K)."""
        return batch.limited(self)

    def some(self, index: IntArray | BoolArray) -> ShapeLimits:
        """Those of some of the generators."""
        if np.ndim(self.transmission) == 0:
            return self
        return replace(self, transmission=np.asarray(self.transmission)[index])

    @property
    def beyond_shape(self) -> bool:
        """Whether more than the shape is limited: the best generator may then be far from the free one."""
        return any(each is not None for each in (self.places, self.rates, self.triangle))

    @property
    def most_cosine(self) -> FloatArray:
        """Greatest absolute cosine of the transmission angle, shape (1,) or (M, 1)."""
        most: FloatArray = np.cos(np.maximum(self.transmission, LEAST_ANGLE))[..., None]
        return most


class Rows(Protocol):
    """Limits of the triangle of a cylinder, as `TriangleLimits`."""

    @property
    def unit(self) -> float:
        """The unit of the lengths of the linkage."""

    def rows(self, logs: Dual) -> Dual:
        """Limits (M, L) with derivatives, zero or positive where they are kept."""


class PlaceRows(Protocol):
    """Limits of joints and links in their places, as `PlaceLimits`."""

    @property
    def free(self) -> FloatArray:
        """1 for every number of a place that may change, 0 for one that stays, (4,)."""

    def rows(self, batch: Any) -> Dual:
        """Limits (M, L) with derivatives, zero or positive where they are kept."""


class Limited(Protocol):
    """`Generators`, for their limits."""

    def limited(self, limits: ShapeLimits) -> Dual:
        """Limits (M, L) with derivatives by the shape (M, L, K)."""


def joined_rows(parts: Sequence[Dual]) -> Dual:
    """All of several limits, (M, L) with derivatives (M, L, K)."""
    return Dual(
        np.concatenate([each.value for each in parts], axis=1),
        lambda: np.concatenate([each.slope for each in parts], axis=1),
    )


def ratio_rows(logs: FloatArray, caps: FloatArray, unknowns: int) -> Dual:
    """Limits of the ratios of lengths, from their logarithms (M, n): the unit, and the first unknowns."""
    upper, lower, most, slope = _ratios(caps.tobytes(), unknowns)
    return Dual(
        most - logs[:, upper] + logs[:, lower], np.broadcast_to(slope, (len(logs), len(upper), unknowns))
    )


@lru_cache(maxsize=16)
def _ratios(caps: bytes, unknowns: int) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Numbers of the longer and the shorter length of each limited ratio, its limit, and its slope."""
    table = np.frombuffer(caps)
    table = table.reshape(2 * (round(len(table) ** 0.5),))
    upper, lower = np.nonzero(~np.eye(len(table), dtype=bool) & np.isfinite(table))
    by_shape = np.eye(len(table), unknowns + 1)[:, 1:]
    return upper, lower, table[upper, lower], by_shape[lower] - by_shape[upper]


def cosine_rows(cosine: Dual, met: BoolArray, most: FloatArray) -> Dual:
    """Limits of a cosine (M, n) on both sides, where it is met."""

    def slope() -> FloatArray:
        by_shape = np.where(met[..., None], cosine.slope, 0.0)
        return np.concatenate([-by_shape, by_shape], axis=1)

    sides = [np.where(met, most + sign * cosine.value, 1.0) for sign in (-1.0, 1.0)]
    return Dual(np.concatenate(sides, axis=1), slope)


def linear_rows(rows: FloatArray, dimensions: Dual) -> Dual:
    """Sums of dimensions (M, n) that have to be zero or positive."""
    return Dual(dimensions.value @ rows.T, lambda: np.einsum("ln,mnk->mlk", rows, dimensions.slope))


def places_met(
    first: FloatArray, span: float | FloatArray, along: Limits, *, over_cycle: bool = False
) -> tuple[FloatArray, BoolArray, FloatArray]:
    """Where the transmission may be worst: at both ends, and at two angles if the motion passes there.

    Driver angles (M, n) in rad, whether each counts (M, n), and 1 where it moves with the first angle (n,).
    """
    turns = np.tile(np.array(along), (len(first), 1))
    if over_cycle:
        return turns, np.ones(turns.shape, dtype=bool), np.zeros(2)
    places = np.column_stack([first, first + span, turns])
    passed = np.stack([passes(first, span, angle) for angle in along], axis=1)
    met = np.concatenate([np.ones_like(passed), passed], axis=1)
    return places, met, np.array([1.0, 1.0, 0.0, 0.0])


def passes(first: FloatArray, span: float | FloatArray, angle: float) -> BoolArray:
    """Whether a rotation from a first angle passes another one, modulo full turns."""
    inside: BoolArray = (angle - first) % (2 * np.pi) <= span
    return inside


def offset_rows(sizes: list[Limits], offset: Limits) -> FloatArray:
    """Sums (k, n + 1) of lengths and offset, not negative where some scale brings all within their limits.

    With the scale 1 / t limits are low t <= q <= high t: bounds of t, each lower one below each upper one
    (elimination by Fourier and Motzkin). Bounds by two lengths are left out: they are those of
    `ShapeLimits.caps`. An offset of at most 2 where r1 is at least 1, 2 r1 - offset >= 0:

    >>> offset_rows([(1.0, np.inf)], (-np.inf, 2.0))
    array([[ 1. , -0.5]])
    """
    count = len(sizes)
    unit = np.eye(count + 1)
    upper = [unit[k] / low for k, (low, _) in enumerate(sizes) if low > 0]
    lower = [unit[k] / high for k, (_, high) in enumerate(sizes) if np.isfinite(high)]
    low, high = offset
    rows: list[FloatArray] = []
    if np.isfinite(low):
        if low >= 0:
            rows += [unit[-1], *(unit[-1] / low - row for row in lower if low > 0)]
        else:
            rows += [row - unit[-1] / low for row in upper]
    if np.isfinite(high):
        if high <= 0:
            rows += [-unit[-1], *(unit[-1] / high - row for row in lower if high < 0)]
        else:
            rows += [row - unit[-1] / high for row in upper]
    rows = [row / np.abs(row).max() for row in rows if np.abs(row).max() > 0]
    return np.array(rows).reshape(-1, count + 1)
