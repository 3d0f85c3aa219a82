"""Centre points of pieces of the circle-point curve: c = c0 + c1 s + disc, with the same s as z."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.curve import Curve
from grashof.synth.proof.curve.pieces import WIDER, Tubes
from grashof.synth.proof.forms.forms import Span

_ROWS = ((0, 1), (0, 2), (1, 2))  # of the three equations, two at a time
_MOST_SHIFT = 0.9  # of the matrix relative to itself, up to which its inverse is bounded


@dataclass(frozen=True, slots=True)
class Centres:
    """Sets c0 + c1 s + disc(rest), shape (n,), sizes; s is that of the tube of z."""

    middle: ComplexArray
    along: ComplexArray
    rest: FloatArray

    def __getitem__(self, index: IntArray | BoolArray) -> Centres:
        return Centres(self.middle[index], self.along[index], self.rest[index])

    @property
    def span(self) -> Span:
        """As a form of s alone."""
        return Span(self.middle, self.along[None], self.rest)

    @classmethod
    def joined(cls, *parts: Centres) -> Centres:
        """Several as one."""
        names = "middle", "along", "rest"
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def centres_of(curve: Curve, tubes: Tubes, longest: float) -> Centres:
    """Enclosures of the centre points of tubes, for dyads not longer than `longest`.

    The centre solves F_j = k_j - Re(conj(c) a_j) = 0, with a_j = (rho_j - 1) z + d_j and k_j linear in z: F
    is bilinear in z and c, so its expansion ends after the second order, and its remainder over the norm
    of the inverse matrix bounds the disc. Of the three equations two are enough; the pair with the smallest
    disc is taken, as at a pole one equation is empty.
    """
    middle, along = tubes.middle.copy(), tubes.along.copy()
    # Wherever z is, c is within the length of the longest dyad.
    rest = np.full(len(tubes), longest) + tubes.stray
    for rows in _ROWS:
        found = of_rows(curve, tubes, rows)
        better = found.rest < rest
        middle = np.where(better, found.middle, middle)
        along = np.where(better, found.along, along)
        rest = np.where(better, found.rest, rest)
    return Centres(middle, along, rest)


def of_rows(curve: Curve, tubes: Tubes, rows: tuple[int, int]) -> Centres:
    """Enclosures of the solutions c of two of the three equations for every z in tubes."""
    z0, z1, z2 = tubes.middle, tubes.along, tubes.bend
    alpha, d, rho = (part[1:, None][list(rows)] for part in (curve.rotation - 1, curve.shift, curve.rotation))
    facing = d.conj() * rho
    a, a1 = alpha * z0 + d, alpha * z1
    k, k1 = np.abs(d) ** 2 / 2 + (facing * z0).real, (facing * z1).real
    area = (a[0].conj() * a[1]).imag
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):

        def solved(right: FloatArray) -> ComplexArray:
            solution: ComplexArray = 1j * (right[1] * a[0] - right[0] * a[1]) / area
            return solution

        # c1 from c at the middle, c from the contribution of the square of s: F + Q / 2 = 0 there.
        c1 = solved(k1 - (solved(k).conj() * a1).real)
        square = -(c1.conj() * a1).real
        c0 = solved(k + square / 2)
        left = k + square / 2 - (c0.conj() * a).real  # rounding
        slope = k1 - (c0.conj() * a1).real - (c1.conj() * a).real
        tilted = facing - c0.conj() * alpha
        bent = square + (tilted * z2).real
        stray = np.abs(z2) / 2 + tubes.rest
        miss = (
            np.abs(left)
            + np.abs(slope)
            + np.abs(bent) / 2
            + np.abs(tilted) * tubes.rest
            + np.abs(c1) * np.abs(alpha) * stray
            + WIDER * (np.abs(k) + np.abs(c0) * np.abs(a) + np.abs(c1) * (np.abs(a) + np.abs(a1)))
        )
        size = np.abs(a)
        far = np.abs(alpha) * (np.abs(z1) + stray)
        rest = (size[1] * miss[0] + size[0] * miss[1]) / np.abs(area)
        shift = (size[1] * far[0] + size[0] * far[1]) / np.abs(area)
        rest = np.where(shift < _MOST_SHIFT, rest / (1 - shift), np.inf) * (1 + WIDER)
        rest = rest + WIDER * (np.abs(c0) + np.abs(c1))
    usable = np.isfinite(rest) & np.isfinite(c0) & np.isfinite(c1)
    return Centres(np.where(usable, c0, 0), np.where(usable, c1, 0), np.where(usable, rest, np.inf))
