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
    >>> values, slopes = limits.of(FourBars(np.array([[0.1, 0.2, 0.3, 0.4]]), np.array([1.0])))
    >>> values.shape, slopes.shape
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

    def of(self, made: Limited) -> tuple[FloatArray, FloatArray]:
        """Values (M, L) and their derivatives by the shape (M, L, K)."""
        return made.limited(self)

    @property
    def most_cosine(self) -> float:
        """Greatest absolute cosine of the transmission angle."""
        return float(np.cos(max(self.transmission, LEAST_ANGLE)))


class Limited(Protocol):
    """What knows its limits: `Generators`."""

    def limited(self, limits: ShapeLimits) -> tuple[FloatArray, FloatArray]:
        """Values and derivatives."""


Rows = tuple[FloatArray, FloatArray]  # values (M, L), derivatives (M, L, K)


def joined_rows(parts: list[Rows]) -> Rows:
    """All of several limits."""
    values, slopes = zip(*parts, strict=True)
    return np.concatenate(values, axis=1), np.concatenate(slopes, axis=1)


def as_rows(numbers: Sequence[Dual]) -> Rows:
    """Numbers (M, 1) with derivatives as columns."""
    values, slopes = zip(*((each.value, each.slope) for each in numbers), strict=True)
    return np.concatenate(values, axis=1), np.concatenate(slopes, axis=1)


def ratio_rows(logs: FloatArray, unit: FloatArray, caps: FloatArray) -> Rows:
    """Limits of the ratios of lengths, from their logarithms (M, n) and derivatives of these (n, K)."""
    upper, lower = np.nonzero(~np.eye(len(caps), dtype=bool) & np.isfinite(caps))
    slopes = np.broadcast_to(unit[lower] - unit[upper], (len(logs), len(upper), unit.shape[1]))
    return caps[upper, lower] - logs[:, upper] + logs[:, lower], slopes


def cosine_rows(cosine: FloatArray, slope: FloatArray, met: BoolArray, most: float) -> Rows:
    """Limits of a cosine (M, n) on both sides, where it is met."""
    values = np.concatenate([np.where(met, most - cosine, 1.0), np.where(met, most + cosine, 1.0)], axis=1)
    slope = np.where(met[..., None], slope, 0.0)
    return values, np.concatenate([-slope, slope], axis=1)


def linear_rows(rows: FloatArray, dimensions: FloatArray, slopes: FloatArray) -> Rows:
    """Sums of dimensions (M, n) that have to be zero or positive, with their derivatives (M, n, K)."""
    return dimensions @ rows.T, np.einsum("ln,mnk->mlk", rows, slopes)


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
