"""Affine forms x = centre + slopes . s + [-rest, rest] with all ``|s_k| <= 1``, many at once.

They keep the common part of two quantities, so that bounds of their sums and quotients are of second
order (Stolfi & de Figueiredo, *Self-Validated Numerical Methods and Applications*, 1997). Symbols come
first in arrays: a pair of pieces of curves has two, a pair of squares of the plane four.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray

ROUNDING = 1e-14  # share of the magnitude of a product: some 90 units of the last place


@dataclass(frozen=True, slots=True)
class Form:
    """Real forms centre + slopes . s + [-rest, rest]."""

    centre: FloatArray  # (n,)
    slopes: FloatArray  # (k, n), by symbol
    rest: FloatArray  # (n,)

    def __getitem__(self, index: IntArray | BoolArray) -> Form:
        return Form(self.centre[index], self.slopes[:, index], self.rest[index])

    @property
    def slope(self) -> FloatArray:
        """Greatest change by all symbols."""
        return _total(np.abs(self.slopes))

    @property
    def sup(self) -> FloatArray:
        """Upper bound."""
        sup: FloatArray = self.centre + self.slope + self.rest
        return sup

    @property
    def inf(self) -> FloatArray:
        """Lower bound."""
        inf: FloatArray = self.centre - self.slope - self.rest
        return inf

    def __add__(self, other: Form) -> Form:
        return Form(self.centre + other.centre, self.slopes + other.slopes, self.rest + other.rest)

    def __sub__(self, other: Form) -> Form:
        return Form(self.centre - other.centre, self.slopes - other.slopes, self.rest + other.rest)

    def where(self, which: BoolArray) -> Form:
        """The same where it counts; infinite elsewhere, so that no condition on it fails there."""
        return Form(np.where(which, self.centre, np.inf), self.slopes, self.rest)

    def times(self, factor: float | FloatArray) -> Form:
        """Multiplied by numbers."""
        return Form(factor * self.centre, factor * self.slopes, np.abs(factor) * self.rest)

    def __mul__(self, other: Form) -> Form:
        squares = self.slopes * other.slopes
        mine, its = np.abs(self.centre) + self.slope, np.abs(other.centre) + other.slope
        return Form(
            self.centre * other.centre + _total(squares) / 2,
            self.centre * other.slopes + self.slopes * other.centre,
            _total(np.abs(squares)) / 2 + _mixed(self.slopes, other.slopes) + self.rest * (its + other.rest)
            + other.rest * mine + ROUNDING * mine * its,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Span:
    """Complex forms: a point middle + steps . s + disc(rest)."""

    middle: ComplexArray  # (n,)
    steps: ComplexArray  # (k, n), by symbol
    rest: FloatArray  # (n,)

    def __len__(self) -> int:
        return len(self.middle)

    def __getitem__(self, index: IntArray | BoolArray) -> Span:
        return Span(self.middle[index], self.steps[:, index], self.rest[index])

    def __add__(self, other: Span) -> Span:
        return Span(self.middle + other.middle, self.steps + other.steps, self.rest + other.rest)

    def __sub__(self, other: Span) -> Span:
        return Span(self.middle - other.middle, self.steps - other.steps, self.rest + other.rest)

    @classmethod
    def joined(cls, *parts: Span) -> Span:
        """Several as one."""
        names = "middle", "steps", "rest"
        return cls(*(np.concatenate([getattr(part, name) for part in parts], axis=-1) for name in names))

    def placed(self, turn: complex, move: complex = 0j) -> Span:
        """Turned about the origin by a unit number, or stretched, and moved."""
        return Span(turn * self.middle + move, turn * self.steps, abs(turn) * self.rest)

    @property
    def reach(self) -> FloatArray:
        """Greatest distance from its middle."""
        reach: FloatArray = farthest(self.steps) + self.rest
        return reach

    @property
    def size(self) -> FloatArray:
        """Upper bound of the absolute value, the disc aside."""
        size: FloatArray = np.abs(self.middle) + _total(np.abs(self.steps))
        return size

    @property
    def norm(self) -> Form:
        """The absolute value.

        For a vector with the component L along its middle and q across, L > 0, it lies between L and
        L + q^2 / (2 L). Where L may vanish, between zero and the greatest value.
        """
        size = np.abs(self.middle)
        with np.errstate(divide="ignore", invalid="ignore"):
            unit = np.where(size > 0, self.middle / size, 1.0).conj()
            turned = self.steps * unit
            least = size - _total(np.abs(turned.real))
            across = _total(np.abs(turned.imag))
            bulge = across**2 / (2 * least)
        most = self.size
        plain = ~((least > 0) & (bulge < most))
        half = np.where(plain, most, bulge) / 2
        return Form(
            np.where(plain, half, size + half),
            np.where(plain, 0.0, turned.real),
            half + self.rest + ROUNDING * most,
        )

    def dot(self, other: Span) -> Form:
        """Scalar product: real part of conj(self) other."""
        return self.cross(other.placed(1j))

    def cross(self, other: Span) -> Form:
        """Signed area: imaginary part of conj(self) other."""
        middle, steps = self.middle.conj(), self.steps.conj()
        squares = (steps * other.steps).imag
        size, its = self.size, other.size
        return Form(
            (middle * other.middle).imag + _total(squares) / 2,
            (middle * other.steps + steps * other.middle).imag,
            _total(np.abs(squares)) / 2 + _mixed(steps, other.steps)
            + self.rest * (its + other.rest) + other.rest * size + ROUNDING * size * its,
        )  # fmt: skip


def farthest(steps: ComplexArray) -> FloatArray:
    """Greatest distance by which symbols move a point; for two symbols, to the farther corners."""
    pairs = range(0, len(steps) - 1, 2)
    corners = [np.maximum(np.abs(steps[k] + steps[k + 1]), np.abs(steps[k] - steps[k + 1])) for k in pairs]
    corners += [np.abs(steps[-1])] * (len(steps) % 2)
    return _total(np.stack(corners))


def _total(each: FloatArray) -> FloatArray:
    """Sum over symbols; as plain sums, which are quicker than those of an axis so short."""
    total: FloatArray = sum(each[1:], each[0])
    return total


def _mixed(one: FloatArray | ComplexArray, other: FloatArray | ComplexArray) -> FloatArray:
    """The greatest change by products of two different symbols; of complex ones in the imaginary part."""
    most = np.zeros(one.shape[1:])
    for i, j in combinations(range(len(one)), 2):
        product = one[i] * other[j] + one[j] * other[i]
        most = most + np.abs(product.imag if np.iscomplexobj(product) else product)
    return most


def greatest_quotient(above: Form, below: Form) -> FloatArray:
    """Upper bound of above / below, with their common part; infinite where `below` may be 0 or less.

    With q = above / below at the centre, above - q below has no centre, and above / below =
    q + (above - q below) / below.
    """
    least = below.inf
    with np.errstate(divide="ignore", invalid="ignore"):
        q = above.centre / below.centre
        over = _total(np.abs(above.slopes - q * below.slopes))
        over += above.rest + np.abs(q) * below.rest + ROUNDING * (np.abs(above.centre) + below.centre)
        most = q + over / least
    bound: FloatArray = np.where((least > 0) & np.isfinite(most), most, np.inf)
    return bound
