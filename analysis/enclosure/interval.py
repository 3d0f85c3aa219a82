"""Intervals of numbers, and functions of the driver angle over intervals of it, in centred form.

Rounding: sums, products, quotients and roots of doubles are correctly rounded, so each bound is moved outward
by 2 EPS of itself (four times what one rounding can do) and by the least normal double. Sines and cosines
are moved by 8 EPS: NumPy promises 4 units in the last place.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from grashof.problems.values.arrays import FloatArray

EPS = float(np.finfo(np.float64).eps)
_TINY = float(np.finfo(np.float64).tiny)
TRIGONOMETRY = 8 * EPS  # absolute error of a computed sine or cosine, and a margin


@dataclass(frozen=True, slots=True)
class Interval:
    """Numbers from `lo` to `hi`, arrays of the same shape; the entire line where undefined."""

    lo: FloatArray
    hi: FloatArray

    @classmethod
    def of(cls, number: FloatArray) -> Interval:
        """An exact number."""
        return cls(number, number)

    @classmethod
    def about(cls, middle: FloatArray, radius: FloatArray | float) -> Interval:
        """Numbers within a radius of the middle."""
        return _outward(middle - radius, middle + radius)

    def __neg__(self) -> Interval:
        return Interval(-self.hi, -self.lo)

    def __add__(self, other: Interval) -> Interval:
        return _outward(self.lo + other.lo, self.hi + other.hi)

    def __sub__(self, other: Interval) -> Interval:
        return _outward(self.lo - other.hi, self.hi - other.lo)

    def __mul__(self, other: Interval) -> Interval:
        with np.errstate(invalid="ignore", over="ignore"):
            a, b = self.lo * other.lo, self.lo * other.hi
            c, d = self.hi * other.lo, self.hi * other.hi
            low, high = np.minimum(a, b), np.maximum(a, b)
            return _outward(np.minimum(low, np.minimum(c, d)), np.maximum(high, np.maximum(c, d)))

    def __truediv__(self, other: Interval) -> Interval:
        holds_zero = (other.lo <= 0) & (other.hi >= 0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            inverse = _outward(1 / other.hi, 1 / other.lo)
        return self * Interval(
            np.where(holds_zero, -np.inf, inverse.lo), np.where(holds_zero, np.inf, inverse.hi)
        )

    def root(self) -> Interval:
        """Square root of the part that is not negative."""
        found = _outward(np.sqrt(np.maximum(self.lo, 0)), np.sqrt(np.maximum(self.hi, 0)))
        return Interval(np.maximum(found.lo, 0), found.hi)

    def within(self, other: Interval) -> Interval:
        """Intersection of two enclosures of one number."""
        return Interval(np.maximum(self.lo, other.lo), np.minimum(self.hi, other.hi))

    def row(self, k: int) -> Interval:
        """Those of one row."""
        return Interval(self.lo[k], self.hi[k])

    @property
    def size(self) -> Interval:
        """Absolute values."""
        high = np.maximum(-self.lo, self.hi)
        return Interval(np.maximum(0, np.maximum(self.lo, -self.hi)), high)


def _outward(lo: FloatArray, hi: FloatArray) -> Interval:
    with np.errstate(invalid="ignore"):
        lo, hi = lo - (2 * EPS * np.abs(lo) + _TINY), hi + (2 * EPS * np.abs(hi) + _TINY)
        return Interval(np.fmax(lo, -np.inf), np.fmin(hi, np.inf))  # which replace NaN alone


def unit(angle: FloatArray, error: FloatArray | float = 0.0) -> tuple[Interval, Interval]:
    """Cosine and sine of an angle known to an absolute error."""
    radius = TRIGONOMETRY + error
    return Interval.about(np.cos(angle), radius), Interval.about(np.sin(angle), radius)


Number: TypeAlias = "Centred | Interval | FloatArray | float"


@dataclass(frozen=True, slots=True)
class Centred:
    """A function over driver angles within `half` (rad) of a middle: mean-value form, of second order.

    `mid` encloses its value at the middle, `over` all its values and `slope` those of its derivative.
    """

    mid: Interval
    over: Interval
    slope: Interval
    half: FloatArray

    @classmethod
    def of(cls, mid: Interval, over: Interval, slope: Interval, half: FloatArray) -> Centred:
        """With `over` narrowed by the mean-value theorem."""
        return cls(mid, over.within(mid + slope * Interval(-half, half)), slope, half)

    def constant(self, other: Number) -> Centred:
        """A number as a function over the same driver angles; a function unchanged."""
        if isinstance(other, Centred):
            return other
        number = other if isinstance(other, Interval) else Interval.of(np.asarray(other, dtype=np.float64))
        return Centred(number, number, Interval.of(np.zeros_like(number.lo)), self.half)

    def __neg__(self) -> Centred:
        return Centred(-self.mid, -self.over, -self.slope, self.half)

    def __add__(self, other: Number) -> Centred:
        other = self.constant(other)
        return Centred.of(self.mid + other.mid, self.over + other.over, self.slope + other.slope, self.half)

    def __sub__(self, other: Number) -> Centred:
        return self + -self.constant(other)

    def __mul__(self, other: Number) -> Centred:
        other = self.constant(other)
        slope = self.slope * other.over + self.over * other.slope
        return Centred.of(self.mid * other.mid, self.over * other.over, slope, self.half)

    def __truediv__(self, other: Number) -> Centred:
        other = self.constant(other)
        over = self.over / other.over
        slope = (self.slope - over * other.slope) / other.over
        return Centred.of(self.mid / other.mid, over, slope, self.half)

    def root(self) -> Centred:
        """Square root of a function that is not negative."""
        over = self.over.root()
        return Centred.of(self.mid.root(), over, self.slope / (over + over), self.half)


@dataclass(frozen=True, slots=True)
class Vector:
    """A point or a direction of the plane over driver angles, with the products of x + iy."""

    x: Centred
    y: Centred

    def __add__(self, other: Vector) -> Vector:
        return Vector(self.x + other.x, self.y + other.y)

    def times(self, x: Number, y: Number) -> Vector:
        """The complex product with x + iy."""
        return Vector(self.x * x - self.y * y, self.x * y + self.y * x)


def crank(middle: FloatArray, half: FloatArray) -> Vector:
    """Direction of the driver at driver angles within `half` of a middle, both of shape (n,), rad.

    cos(m + d) = cos m cos d - sin m sin d with cos d from 1 - half^2 / 2 to 1 and sin d within +-half.
    """
    cos, sin = unit(middle)
    d = Interval(-half, half)
    near = Interval(1 - half * half / 2 * (1 + 4 * EPS) - EPS, np.ones_like(half))
    over_cos, over_sin = cos * near - sin * d, sin * near + cos * d
    return Vector(Centred.of(cos, over_cos, -over_sin, half), Centred.of(sin, over_sin, over_cos, half))
