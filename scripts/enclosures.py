"""Polynomials of degree 3 in two parameters of [-1, 1] with remainders, for scripts/check_certificate.py.

A remainder bounds all omitted terms and all rounding, in each operation as much as IEEE 754 allows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Bools: TypeAlias = NDArray[np.bool_]
Ends: TypeAlias = tuple[Floats, Floats]

UNIT, HAIR = 2.0**-52, 1e-300
TERMS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)]
AT = {term: k for k, term in enumerate(TERMS)}
DEGREE = np.array([i + j for i, j in TERMS])
PRODUCTS = [
    (a, b, AT[p[0] + q[0], p[1] + q[1]])
    for a, p in enumerate(TERMS)
    for b, q in enumerate(TERMS)
    if sum(p) + sum(q) <= 3
]
ROUNDED = [UNIT / 2 * sum(k == each for *_, k in PRODUCTS) for each in range(10)]  # of a coefficient


class Poly:
    """Polynomials, arrays of shape (10, n), and bounds of their errors, shape (n,)."""

    def __init__(self, c: Floats, r: Floats) -> None:
        self.c = c
        self.r: Floats = r * (1 + 64 * UNIT) + HAIR

    @classmethod
    def of(cls, value: Any, s: Any = 0.0, t: Any = 0.0, r: Any = 0.0) -> Poly:
        """The linear one with these coefficients."""
        value, s, t, r = np.broadcast_arrays(value, s, t, r)
        c = np.zeros((10, len(value)))
        c[0], c[1], c[2] = value, s, t
        return cls(c, np.array(r, float))

    @property
    def size(self) -> Floats:
        """Greatest magnitude, the remainder aside."""
        size: Floats = np.abs(self.c).sum(axis=0)
        return size

    def __neg__(self) -> Poly:
        return Poly(-self.c, self.r)

    def __add__(self, other: Poly | Floats | float) -> Poly:
        if not isinstance(other, Poly):
            value = np.full(self.c.shape[1], other)
            other = Poly.of(value, r=4 * UNIT * np.abs(value))
        c = self.c + other.c
        return Poly(c, self.r + other.r + UNIT * np.abs(c).sum(axis=0))

    def __sub__(self, other: Poly) -> Poly:
        return self + (-other)

    def __mul__(self, other: Poly | Floats | float) -> Poly:
        if not isinstance(other, Poly):
            return Poly(self.c * other, (self.r + 8 * UNIT * self.size) * np.abs(other))
        c, rounding = np.zeros_like(self.c), np.zeros_like(self.r)
        for a, b, k in PRODUCTS:
            product = self.c[a] * other.c[b]
            c[k] += product
            rounding += ROUNDED[k] * np.abs(product)
        mine, its = ([np.abs(one.c[d == DEGREE]).sum(axis=0) for d in range(4)] for one in (self, other))
        over = sum((mine[a] * its[b] for a in range(4) for b in range(4) if a + b > 3), rounding)
        return Poly(c, over + self.r * (other.size + other.r) + self.size * other.r)

    def inverse(self) -> Poly:
        """Reciprocal; of no use where it may vanish."""
        return self._series(lambda v: 1 / v, (-1, 1, -1), lambda w: w**4 / (1 - w))

    def root(self) -> Poly:
        """Square root; between zero and the root of the greatest value where it may vanish."""
        made = self._series(
            lambda v: np.sqrt(np.abs(v)), (0.5, -0.125, 0.0625), lambda w: 0.0391 * w**4 / (1 - w) ** 3.5
        )
        most = np.sqrt(self.size + self.r) * (1 + 1e-12)
        plain = ~(made.r + made.size < 1.5 * most) | (self.c[0] <= 0)
        return chosen(plain, Poly.of(most / 2, r=most / 2), made)

    def _series(
        self, first: Callable[[Floats], Floats], factors: Sequence[float], tail: Callable[[Floats], Floats]
    ) -> Poly:
        """First * (1 + f1 u + f2 u^2 + f3 u^3), u = self / centre - 1; unbounded where |u| may reach 0.9."""
        good = np.abs(self.c[0]) > HAIR
        centre = np.where(good, self.c[0], 1.0)
        u = self * (1 / centre)
        u.c[0], u.r = 0.0, u.r + 4 * UNIT
        w = u.size + u.r
        good &= w < 0.9
        square, w = u * u, np.where(good, w, 0.0)
        made = u * factors[0] + square * factors[1] + square * u * factors[2] + 1.0
        made.r = made.r + tail(w)
        made = made * first(centre)
        return Poly(np.where(good, made.c, 0.0), np.where(good, made.r + 4 * UNIT * made.size, inf))


Vector: TypeAlias = tuple[Poly, Poly]


def chosen(which: Bools, yes: Poly, no: Poly) -> Poly:
    """One or the other, entry by entry."""
    return Poly(np.where(which, yes.c, no.c), np.where(which, yes.r, no.r))


def square(v: Vector) -> Poly:
    """Squared length."""
    return dot(v, v)


def minus(v: Vector, w: Vector) -> Vector:
    """From w to v."""
    return v[0] - w[0], v[1] - w[1]


def cross(v: Vector, w: Vector) -> Poly:
    """Signed area."""
    return v[0] * w[1] - v[1] * w[0]


def dot(v: Vector, w: Vector) -> Poly:
    """Scalar product."""
    return v[0] * w[0] + v[1] * w[1]


def turned(v: Vector, re: Floats | float, im: Floats | float) -> Vector:
    """V times a complex number."""
    return v[0] * re - v[1] * im, v[0] * im + v[1] * re


def _ranges(box: Sequence[Ends], term: tuple[int, int]) -> Ends:
    """Bounds of a power product of degree 2 or 3 in a box."""
    factors = []
    for (low, high), power in zip(box, term, strict=True):
        if power:
            a, b = low**power, high**power
            inside = (power == 2) & (low < 0) & (high > 0)
            factors.append((np.where(inside, 0.0, np.minimum(a, b)), np.maximum(a, b)))
    if len(factors) == 1:
        return factors[0]
    every = [x * y for x in factors[0] for y in factors[1]]
    return np.minimum.reduce(every), np.maximum.reduce(every)


def most(g: Poly, box: Sequence[Ends] | None = None, without: int = 0) -> Floats:
    """Greatest value in a box, or everywhere, perhaps without the linear term of one parameter."""
    n = len(g.r)
    box = box or [(-np.ones(n), np.ones(n))] * 2
    total: Floats = g.c[0] + g.r + 64 * UNIT * g.size
    for k, double, (low, high) in ((1, 3, box[0]), (2, 5, box[1])):
        line, bend = g.c[k] if k != without else np.zeros(n), g.c[double]
        with np.errstate(all="ignore"):
            top = -line / (2 * bend)
        top = np.where((bend < 0) & (top > low) & (top < high), top, low)
        total = total + np.maximum.reduce([line * x + bend * x * x for x in (low, high, top)])
    for k in (4, 6, 7, 8, 9):
        if g.c[k].any():
            low, high = _ranges(box, TERMS[k])
            total = total + np.maximum(g.c[k] * low, g.c[k] * high)
    return np.where(np.isnan(total), inf, total)


def zero_free(f: Poly) -> Bools:
    """Where a polynomial is of one sign."""
    return (most(f) < 0) | (most(-f) < 0)


def empty(forms: Sequence[Poly]) -> Bools:
    """Where not all forms can be zero or greater at one point of the square."""
    n = len(forms[0].r)
    box: list[Ends] = [(-np.ones(n), np.ones(n))] * 2
    gone = np.zeros(n, bool)
    for _ in range(3):
        for g in forms:
            for k in (1, 2):
                slope, rest = g.c[k], most(g, box, k)
                root = -rest / np.where(slope == 0, 1.0, slope)
                low, high = box[k - 1]
                gone |= (slope == 0) & (rest < 0)
                root, usable = np.where(np.isfinite(root), root, 0.0), np.isfinite(root)
                slack = 1e-12 * (1 + np.abs(root))
                low = np.where((slope > 0) & usable, np.maximum(low, root - slack), low)
                high = np.where((slope < 0) & usable, np.minimum(high, root + slack), high)
                gone |= low > high
                box[k - 1] = (np.minimum(low, high), np.maximum(low, high))
    return gone
