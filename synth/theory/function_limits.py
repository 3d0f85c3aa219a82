"""What limits function generators, as smooth functions of their shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, Limits
from grashof.synth.loop.dual import Dual

LEAST_ANGLE = float(np.radians(0.3))  # so near to a dead position no generator may come


@dataclass(frozen=True, slots=True)
class ShapeLimits:
    """Limits of a generator, zero or positive where they are kept.

    Parameters
    ----------
    span : float, rad
        Rotation of the driver from its first angle.
    caps : ndarray, shape (n, n)
        Greatest logarithm of length j over length k, of `Generators.lengths`.
    transmission : float, rad
        Least min(mu, pi - mu).
    over_cycle : bool
        Over the whole turn, not only over the rotation.
    margin : float, optional
        The driver turns fully, and the shares that `rotatability` tells are this or more.
    shortest : int
        +1 where r1 has to be longer than r2, -1 where it has to be shorter, 0 for either.
    offset : ndarray, shape (k, n + 1)
        Sums of the lengths and the offset that have to be zero or positive; see `offset_rows`.
    stroke : tuple of float
        Limits of the travel over a whole turn, in units of the lengths.

    Examples
    --------
    >>> from grashof.synth.theory.function_four_bar import FourBars
    >>> limits = ShapeLimits(1.0, transmission=0.5)
    >>> rows = limits.of(FourBars(np.array([[0.1, 0.2, 0.3, 0.4]]), np.array([1.0])))
    >>> rows.value.shape, rows.slope.shape
    ((1, 20), (1, 20, 4))
    """

    span: float
    caps: FloatArray = field(default_factory=lambda: np.full((4, 4), np.log(20.0)))
    transmission: float = 0.0
    over_cycle: bool = False
    margin: float | None = None
    shortest: int = 0
    offset: FloatArray | None = None
    stroke: Limits = (-np.inf, np.inf)

    def of(self, made: Limited) -> Dual:
        """Limits (M, L) with derivatives by the shape (M, L, K)."""
        return made.limited(self)

    @property
    def most_cosine(self) -> float:
        """Greatest absolute cosine of the transmission angle."""
        return float(np.cos(max(self.transmission, LEAST_ANGLE)))


class Limited(Protocol):
    """What knows its limits: `Generators`."""

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
    upper, lower = np.nonzero(~np.eye(len(caps), dtype=bool) & np.isfinite(caps))
    by_shape = np.eye(len(caps), unknowns + 1)[:, 1:]
    slope = np.broadcast_to(by_shape[lower] - by_shape[upper], (len(logs), len(upper), unknowns))
    return Dual(caps[upper, lower] - logs[:, upper] + logs[:, lower], slope)


def cosine_rows(cosine: Dual, met: BoolArray, most: float) -> Dual:
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
    first: FloatArray, span: float, along: Limits, *, over_cycle: bool = False
) -> tuple[FloatArray, BoolArray, FloatArray]:
    """Where the transmission may be worst: at both ends, and at two angles if the motion passes there.

    Returns
    -------
    places, met, moving : ndarray, shape (M, n), (M, n) and (n,)
        Driver angles, whether each of them counts, and 1 where it moves with the first angle.
    """
    turns = np.tile(np.array(along), (len(first), 1))
    if over_cycle:
        return turns, np.ones(turns.shape, dtype=bool), np.zeros(2)
    places = np.concatenate([first[:, None] + [0.0, span], turns], axis=1)
    passed = np.stack([passes(first, span, angle) for angle in along], axis=1)
    met = np.concatenate([np.ones_like(passed), passed], axis=1)
    return places, met, np.array([1.0, 1.0, 0.0, 0.0])


def passes(first: FloatArray, span: float, angle: float) -> BoolArray:
    """Whether a rotation from a first angle passes another one, whatever its whole turns."""
    inside: BoolArray = (angle - first) % (2 * np.pi) <= span
    return inside


def offset_rows(sizes: list[Limits], offset: Limits) -> FloatArray:
    """Sums of lengths and offset that are not negative where some scale brings all within their limits.

    Parameters
    ----------
    sizes : list of tuple of float
        Of n lengths.
    offset : tuple of float
        Of the signed offset.

    Returns
    -------
    ndarray, shape (k, n + 1)

    Notes
    -----
    With the scale 1 / t limits are low t <= q <= high t: bounds of t, of which each lower one has to be
    below each upper one (elimination by Fourier and Motzkin). Bounds by two lengths are left out: they
    are those of `ShapeLimits.caps`.

    Examples
    --------
    An offset of at most 2 where r1 is at least 1: 2 r1 - offset >= 0.

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
