"""Dyads of three poses: squares of moving pivots, with the one ground pivot that belongs to each point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.dyads import possible_radii
from grashof.synth.proof.curve.enclosure import At, Steps, enclosed
from grashof.synth.proof.curve.pieces import WIDER
from grashof.synth.proof.forms.forms import Span
from grashof.synth.theory.burmester import Displacements

SQUARES = 64  # along each side of the plane


@dataclass(frozen=True, slots=True)
class Patches:
    """Squares z = middle + half (s + i t) with ``|s|, |t| <= 1``, of three poses."""

    motion: Displacements
    longest: float  # of dyads that count: bounds the ground pivot where nothing else does
    middle: ComplexArray  # (n,)
    half: FloatArray  # (n,)

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
        steps = np.stack([self.half + 0j, 1j * self.half])
        return possible_radii(self.motion, Span(self.middle, steps, np.zeros(len(self))), (0.0, self.longest))

    def within(self, points: ComplexArray, radius: float | FloatArray) -> BoolArray:
        """Which squares lie wholly within a distance of one of some points."""
        apart = np.abs(self.middle[:, None] - points)
        inside: BoolArray = (apart + np.sqrt(2) * self.half[:, None] < radius).any(axis=1)
        return inside

    def may_meet(self, points: ComplexArray, radius: float | FloatArray) -> BoolArray:
        """Which squares may hold a dyad with its ground pivot within a distance of one of some points.

        Each equation k - Re(conj(c) a) = 0 is bilinear in z and c, so that its change over both is known.
        """
        reach, z = np.sqrt(2) * self.half[:, None], self.middle[:, None]
        at = At.of(self.motion, z, points, np.arange(3)[:, None, None])
        most = np.abs(at.tilted) * reach + radius * (np.abs(at.chord) + np.abs(at.alpha) * reach)
        most = most + at.off(np.abs(z) + reach, np.abs(points) + radius)
        either: BoolArray = (np.abs(at.value) <= most).all(axis=0).any(axis=1)
        return either

    @property
    def quarters(self) -> Patches:
        """Each square as four."""
        half = self.half / 2 * (1 + WIDER) + WIDER * np.abs(self.middle)
        middle = [self.middle + step * self.half / 2 for step in (1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j)]
        return Patches(self.motion, self.longest, np.concatenate(middle), np.tile(half, 4))

    @property
    def spans(self) -> tuple[Span, Span]:
        """Moving and ground pivots as forms."""
        z = self.middle
        steps = np.stack([self.half + 0j, 1j * self.half])
        fixed, unit = np.zeros_like(steps), np.stack([np.ones_like(z), 1j * np.ones_like(z)])
        across, up = Steps(steps, fixed), Steps(fixed, unit)
        _, found, known = enclosed(self.motion, (z, np.zeros_like(z)), across, up)
        known &= found.rest < self.longest
        middle, moves = np.where(known, found.middle, z), np.where(known, found.steps, steps)
        moving = Span(z, steps, WIDER * (np.abs(z) + self.half))
        return moving, Span(middle, moves, np.where(known, found.rest, self.longest))
