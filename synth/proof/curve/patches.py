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

    def within(self, points: ComplexArray, radius: float) -> BoolArray:
        """Which squares lie wholly within a distance of one of some points."""
        apart = np.abs(self.middle[:, None] - points)
        inside: BoolArray = (apart + np.sqrt(2) * self.half[:, None] < radius).any(axis=1)
        return inside

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
        rho, d = self.motion.rotation[1:3, None], self.motion.shift[1:3, None]
        alpha, facing = rho - 1, d.conj() * rho
        a, k = alpha * z + d, np.abs(d) ** 2 / 2 + (facing * z).real
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
            miss = miss + WIDER * (np.abs(k) + (np.abs(c) + moved) * (np.abs(a) + np.abs(alpha) * h))
            size, far = np.abs(a), np.abs(alpha) * np.sqrt(2) * h
            rest = (size[1] * miss[0] + size[0] * miss[1]) / np.abs(area)
            shift = (size[1] * far[0] + size[0] * far[1]) / np.abs(area)
            rest = np.where(shift < _MOST_SHIFT, rest / (1 - shift), np.inf) * (1 + WIDER)
            rest = rest + WIDER * (np.abs(c) + moved)
        known = np.isfinite(rest) & np.isfinite(c) & np.isfinite(moved) & (rest < self.longest)
        across = np.stack(steps)
        middle, moves = np.where(known, c, z), np.where(known, np.stack(slopes), across)
        ground = Span(middle, moves, np.where(known, rest, self.longest))
        return Span(z, across, WIDER * (np.abs(z) + h)), ground
