"""Dyads of three poses: squares of moving pivots, with the one ground pivot that belongs to each point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.pieces import WIDER
from grashof.synth.proof.forms.forms import Span
from grashof.synth.theory.burmester import Displacements

SQUARES = 64  # along each side of the plane
_SIDES = (1, 0), (2, 0), (2, 1)
_MOST_SHIFT = 0.9  # of the matrix relative to itself, up to which its inverse is bounded


@dataclass(frozen=True, slots=True)
class _Equations:
    """Two equations k - Re(conj(c) a) = 0 for each square, shape (2, n), in the middle.

    Parameters
    ----------
    alpha, facing : ndarray of complex
        Derivative of a by z; that of k by z is Re(facing dz).
    a : ndarray of complex
    k : ndarray
    off_a, off_k : ndarray
        Rounding of `a` and `k`, anywhere in the square.
    """

    alpha: ComplexArray
    facing: ComplexArray
    a: ComplexArray
    k: FloatArray
    off_a: FloatArray
    off_k: FloatArray


@dataclass(frozen=True, slots=True)
class Patches:
    """Squares z = middle + half (s + i t) with ``|s|, |t| <= 1``.

    Parameters
    ----------
    motion : Displacements
        Of three poses.
    longest : float
        Of dyads that count: where the ground pivot is not bounded otherwise, it is so near.
    middle : ndarray of complex, shape (n,)
    half : ndarray, shape (n,)
    """

    motion: Displacements
    longest: float
    middle: ComplexArray
    half: FloatArray

    @classmethod
    def covering(cls, motion: Displacements, reach: float, longest: float) -> Patches:
        """All places within reach of the origin."""
        step = 2 * reach / SQUARES
        even = -reach + step * (np.arange(SQUARES) + 0.5)
        middle = (even[:, None] + 1j * even).ravel()
        return cls(motion, longest, middle, np.full(len(middle), step / 2))

    def __len__(self) -> int:
        return len(self.middle)

    def __getitem__(self, index: IntArray | BoolArray) -> Patches:
        return Patches(self.motion, self.longest, self.middle[index], self.half[index])

    @property
    def bounded(self) -> BoolArray:
        """Where the circle through the three places of z may be no larger than dyads that count."""
        rho, d = self.motion.rotation[:3, None], self.motion.shift[:3, None]
        places, reach = rho * self.middle + d, np.sqrt(2) * self.half
        u, v = places[1] - places[0], places[2] - places[0]
        spreads = [np.abs(rho[i] - rho[j]) * reach + WIDER * (1 + np.abs(self.middle)) for i, j in _SIDES]
        sides = [np.abs(places[i] - places[j]) for i, j in _SIDES]
        least = np.prod(
            [np.maximum(side - off, 0.0) for side, off in zip(sides, spreads, strict=True)], axis=0
        )
        most = np.abs((u.conj() * v).imag) + sides[0] * spreads[1] + sides[1] * spreads[0]
        most = most + spreads[0] * spreads[1]
        bounded: BoolArray = least <= 2 * self.longest * most * (1 + 1e-9)
        return bounded

    def within(self, points: ComplexArray, radius: float | FloatArray) -> BoolArray:
        """Which squares lie wholly within a distance of one of some points."""
        apart = np.abs(self.middle[:, None] - points)
        inside: BoolArray = (apart + np.sqrt(2) * self.half[:, None] < radius).any(axis=1)
        return inside

    def may_meet(self, points: ComplexArray, radius: float | FloatArray) -> BoolArray:
        """Which squares may hold a dyad with its ground pivot within a distance of one of some points.

        Notes
        -----
        Each equation k - Re(conj(c) a) = 0 is bilinear in z and c, so that its change over both is known.
        """
        these, back, size = self._equations, points.conj(), np.abs(points) + radius
        alpha, facing, a, k, off_a, off_k = (getattr(these, name)[..., None] for name in _Equations.__slots__)
        reach = np.sqrt(2) * self.half[:, None]
        off = np.abs(k - (back * a).real) - off_k - size * off_a
        most = np.abs(facing - back * alpha) * reach + radius * (np.abs(a) + np.abs(alpha) * reach)
        either: BoolArray = (off <= most).all(axis=0).any(axis=1)
        return either

    @property
    def _equations(self) -> _Equations:
        """Of the two pairs of places that are closest: about a pole only these bound the centre well."""
        rho, d = self.motion.rotation[:3], self.motion.shift[:3]
        z, far, squares = self.middle, np.abs(self.middle) + 2 * self.half, np.abs(d) ** 2
        facing = d.conj() * rho
        rows = [
            (rho[i] - rho[j], d[i] - d[j], facing[i] - facing[j], squares[i] - squares[j]) for i, j in _SIDES
        ]
        alpha, shift, tilt, constant = (np.array(each)[:, None] for each in zip(*rows, strict=True))
        reach = np.array([abs(d[i]) + abs(d[j]) for i, j in _SIDES])[:, None]
        a, k = alpha * z + shift, constant.real / 2 + (tilt * z).real
        near = np.argsort(np.abs(a), axis=0)[:2]
        columns = alpha, tilt, a, k, WIDER * (reach + 2 * far), WIDER * reach * (reach + far)
        return _Equations(
            *(np.take_along_axis(np.broadcast_to(one, a.shape), near, axis=0) for one in columns)
        )

    @property
    def quarters(self) -> Patches:
        """Each square as four."""
        half = self.half / 2 * (1 + WIDER) + WIDER * np.abs(self.middle)
        middle = [self.middle + step * self.half / 2 for step in (1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j)]
        return Patches(self.motion, self.longest, np.concatenate(middle), np.tile(half, 4))

    @property
    def spans(self) -> tuple[Span, Span]:
        """Moving and ground pivots as forms.

        Notes
        -----
        As of pieces of a curve (see `centres_of`): both equations are bilinear in z and c, so that what is
        left after the linear terms is a quadratic form of s and t.
        """
        z, h = self.middle, self.half
        steps = h + 0j, 1j * h
        these = self._equations
        alpha, facing, a, k = these.alpha, these.facing, these.a, these.k
        area = (a[0].conj() * a[1]).imag
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):

            def solved(right: FloatArray) -> ComplexArray:
                solution: ComplexArray = 1j * (right[1] * a[0] - right[0] * a[1]) / area
                return solution

            first = solved(k)
            by_s, by_t = (solved(((facing - first.conj() * alpha) * step).real) for step in steps)
            slopes = by_s, by_t
            squares = (by_s.conj() * alpha * steps[0]).real, (by_t.conj() * alpha * steps[1]).real
            mixed = (by_s.conj() * alpha * steps[1] + by_t.conj() * alpha * steps[0]).real
            c = solved(k - (squares[0] + squares[1]) / 2)
            left = k - (squares[0] + squares[1]) / 2 - (c.conj() * a).real
            off = [
                ((facing - c.conj() * alpha) * step).real - (slope.conj() * a).real
                for step, slope in zip(steps, slopes, strict=True)
            ]
            miss = np.abs(left) + sum(np.abs(each) for each in off) + np.abs(mixed)
            miss = miss + (np.abs(squares[0]) + np.abs(squares[1])) / 2
            moved = np.abs(by_s) + np.abs(by_t)
            miss = miss + these.off_k + (np.abs(c) + moved) * these.off_a
            size, far = np.abs(a), np.abs(alpha) * np.sqrt(2) * h
            rest = (size[1] * miss[0] + size[0] * miss[1]) / np.abs(area)
            shift = (size[1] * far[0] + size[0] * far[1]) / np.abs(area)
            rest = np.where(shift < _MOST_SHIFT, rest / (1 - shift), np.inf) * (1 + WIDER)
            rest = rest + WIDER * (np.abs(c) + moved)
        known = np.isfinite(rest) & np.isfinite(c) & np.isfinite(moved) & (rest < self.longest)
        either = ((c, z), (by_s, steps[0]), (by_t, steps[1]))
        middle, s, t = (np.where(known, yes, no).astype(np.complex128) for yes, no in either)
        ground = Span(middle, s, t, np.where(known, rest, self.longest))
        across, up = (step.astype(np.complex128) for step in steps)
        return Span(z, across, up, WIDER * (np.abs(z) + h)), ground
