"""Intervals, rounded outwards: each encloses the exact result of a floating-point operation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray

_OFF = 1e-15  # more than four units of the last place of a sine


@dataclass(frozen=True, slots=True)
class Range:
    """Intervals from `low` to `high`; arrays of shapes that go together.

    Sum, difference, product, quotient and square root of doubles are the nearest ones to the true values
    (IEEE 754), so that their neighbours enclose these.
    """

    low: FloatArray
    high: FloatArray

    @classmethod
    def of(cls, number: npt.ArrayLike) -> Self:
        """Numbers as they are stored."""
        exact = np.asarray(number, dtype=np.float64)
        return cls(exact, exact)

    def holds(self, number: float | FloatArray) -> bool:
        """Whether all numbers lie in it."""
        return bool(((self.low <= number) & (number <= self.high)).all())

    def __add__(self, other: Range) -> Range:
        return _outward(self.low + other.low, self.high + other.high)

    def __sub__(self, other: Range) -> Range:
        return _outward(self.low - other.high, self.high - other.low)

    def __mul__(self, other: Range) -> Range:
        ends = [one * its for one in (self.low, self.high) for its in (other.low, other.high)]
        return _outward(np.minimum.reduce(ends), np.maximum.reduce(ends))

    def __truediv__(self, other: Range) -> Range:
        """By positive numbers; anything where these may be zero or less."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = [one / its for one in (self.low, self.high) for its in (other.low, other.high)]
        sound = other.low > 0
        low = np.where(sound, np.minimum.reduce(ends), -np.inf)
        return _outward(low, np.where(sound, np.maximum.reduce(ends), np.inf))

    @property
    def size(self) -> Range:
        """The absolute value."""
        low = np.maximum(np.maximum(self.low, -self.high), 0.0)
        return Range(low, np.maximum(-self.low, self.high))

    @property
    def root(self) -> Range:
        """The square root of ranges that are not negative."""
        found = _outward(np.sqrt(np.maximum(self.low, 0.0)), np.sqrt(self.high))
        return Range(np.maximum(found.low, 0.0), found.high)

    @property
    def sine(self) -> Range:
        """That of angles, rad, which are known well."""
        return self._near(np.sin)

    @property
    def cosine(self) -> Range:
        """That of angles, rad, which are known well."""
        return self._near(np.cos)

    def _near(self, function: np.ufunc) -> Range:
        """A function that changes by no more than its argument does."""
        middle = (self.low + self.high) / 2
        off = np.maximum(self.high - middle, middle - self.low) + _OFF
        return _outward(function(middle) - off, function(middle) + off)


ONE = Range.of(1.0)
HALF_TURN = Range(np.nextafter(np.pi, 0.0), np.nextafter(np.pi, 4.0))


def hypotenuse(one: Range, other: Range) -> Range:
    """Of a right triangle with two sides."""
    one, other = one.size, other.size
    return (one * one + other * other).root


def _outward(low: FloatArray, high: FloatArray) -> Range:
    return Range(np.nextafter(low, -np.inf), np.nextafter(high, np.inf))
