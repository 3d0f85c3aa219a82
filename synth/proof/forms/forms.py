"""Affine forms x = centre + s_slope s + t_slope t + [-rest, rest] with ``|s|, |t| <= 1``, many at once.

They keep what two quantities have in common, so that bounds of their sums and quotients are of second
order (Stolfi & de Figueiredo, *Self-Validated Numerical Methods and Applications*, 1997).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray

ROUNDING = 1e-14  # share of the magnitude of a product: some 90 units of the last place


@dataclass(frozen=True, slots=True)
class Form:
    """Real forms; arrays of one shape."""

    centre: FloatArray
    s: FloatArray
    t: FloatArray
    rest: FloatArray

    def __getitem__(self, index: IntArray | BoolArray) -> Form:
        return Form(self.centre[index], self.s[index], self.t[index], self.rest[index])

    @property
    def slope(self) -> FloatArray:
        """How much s and t change it at most."""
        slope: FloatArray = np.abs(self.s) + np.abs(self.t)
        return slope

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
        return Form(self.centre + other.centre, self.s + other.s, self.t + other.t, self.rest + other.rest)

    def __sub__(self, other: Form) -> Form:
        return Form(self.centre - other.centre, self.s - other.s, self.t - other.t, self.rest + other.rest)

    def where(self, which: BoolArray) -> Form:
        """The same where it counts; infinite elsewhere, so that no condition on it fails there."""
        return Form(np.where(which, self.centre, np.inf), self.s, self.t, self.rest)

    def times(self, factor: float | FloatArray) -> Form:
        """Multiplied by numbers."""
        size = np.abs(factor)
        return Form(factor * self.centre, factor * self.s, factor * self.t, size * self.rest)

    def __mul__(self, other: Form) -> Form:
        squares_s, squares_t = self.s * other.s, self.t * other.t
        mixed = np.abs(self.s * other.t + self.t * other.s)
        mine, its = np.abs(self.centre) + self.slope, np.abs(other.centre) + other.slope
        return Form(
            self.centre * other.centre + (squares_s + squares_t) / 2,
            self.centre * other.s + self.s * other.centre,
            self.centre * other.t + self.t * other.centre,
            (np.abs(squares_s) + np.abs(squares_t)) / 2 + mixed + self.rest * (its + other.rest)
            + other.rest * mine + ROUNDING * mine * its,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Span:
    """Complex forms: a point middle + s_step s + t_step t + disc(rest)."""

    middle: ComplexArray
    s: ComplexArray
    t: ComplexArray
    rest: FloatArray

    def __sub__(self, other: Span) -> Span:
        return Span(self.middle - other.middle, self.s - other.s, self.t - other.t, self.rest + other.rest)

    @classmethod
    def joined(cls, *parts: Span) -> Span:
        """Several as one."""
        names = "middle", "s", "t", "rest"
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))

    @property
    def size(self) -> FloatArray:
        """Upper bound of the absolute value, the disc aside."""
        size: FloatArray = np.abs(self.middle) + np.abs(self.s) + np.abs(self.t)
        return size

    @property
    def norm(self) -> Form:
        """The absolute value.

        Notes
        -----
        Of a vector with the component L along its middle and q across, L > 0, it lies between L and
        L + q^2 / (2 L). Where L may vanish, between zero and the greatest value.
        """
        size = np.abs(self.middle)
        with np.errstate(divide="ignore", invalid="ignore"):
            unit = np.where(size > 0, self.middle / size, 1.0).conj()
            by_s, by_t = self.s * unit, self.t * unit
            least = size - np.abs(by_s.real) - np.abs(by_t.real)
            across = np.abs(by_s.imag) + np.abs(by_t.imag)
            bulge = across**2 / (2 * least)
        most = self.size
        plain = ~((least > 0) & (bulge < most))
        half = np.where(plain, most, bulge) / 2
        return Form(
            np.where(plain, half, size + half),
            np.where(plain, 0.0, by_s.real),
            np.where(plain, 0.0, by_t.real),
            half + self.rest + ROUNDING * most,
        )

    def dot(self, other: Span) -> Form:
        """Scalar product: real part of conj(self) other."""
        return self.cross(Span(1j * other.middle, 1j * other.s, 1j * other.t, other.rest))

    def cross(self, other: Span) -> Form:
        """Signed area: imaginary part of conj(self) other."""
        mine = self.middle.conj(), self.s.conj(), self.t.conj()
        (m0, ms, mt), (o0, os, ot) = mine, (other.middle, other.s, other.t)
        squares_s, squares_t = (ms * os).imag, (mt * ot).imag
        size, its = self.size, other.size
        return Form(
            (m0 * o0).imag + (squares_s + squares_t) / 2,
            (m0 * os + ms * o0).imag,
            (m0 * ot + mt * o0).imag,
            (np.abs(squares_s) + np.abs(squares_t)) / 2 + np.abs((ms * ot + mt * os).imag)
            + self.rest * (its + other.rest) + other.rest * size + ROUNDING * size * its,
        )  # fmt: skip


def greatest_quotient(above: Form, below: Form) -> FloatArray:
    """Upper bound of above / below, with what they have in common; infinite where `below` may be 0 or less.

    Notes
    -----
    With q = above / below at the centre, above - q below has no centre, and above / below =
    q + (above - q below) / below.
    """
    least = below.inf
    with np.errstate(divide="ignore", invalid="ignore"):
        q = above.centre / below.centre
        over = np.abs(above.s - q * below.s) + np.abs(above.t - q * below.t)
        over += above.rest + np.abs(q) * below.rest + ROUNDING * (np.abs(above.centre) + below.centre)
        most = q + over / least
    bound: FloatArray = np.where((least > 0) & np.isfinite(most), most, np.inf)
    return bound
