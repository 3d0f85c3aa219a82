"""Couplers of four-bars that generate three or four pairs of a function: a plane of them, or a curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import ComplexArray, IntArray
from grashof.synth.proof.curve.curve import poles
from grashof.synth.proof.curve.patches import Patches
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import Side, Table
from grashof.synth.proof.forms.forms import Span
from grashof.synth.theory.burmester import Displacements, Dyads, centre_points, polish

NEAR = 0.1  # of the distance of a pole, or of r1: nearer to it A is left to B
BOTH = 0.03  # of that: nearer to one of its poles B is left to A again
ABOUT = 1e-3  # of r1: nearer to poles both are in discs


@dataclass(slots=True)
class CurveOfCouplers:
    """Couplers of four pairs: pieces of a curve."""

    table: Table

    @classmethod
    def of(cls, motion: Displacements, ratio: float) -> CurveOfCouplers:
        """All within a ratio of lengths."""
        return cls(Table.covering(Required.within(motion, ratio, 1 / ratio)))

    def __len__(self) -> int:
        return len(self.table)

    def spans(self, which: IntArray) -> tuple[Span, Span]:
        """A and B as forms."""
        side = Side.of(self.table.pieces, which, is_driver=True)
        return side.z, side.c

    def divided(self, which: IntArray) -> IntArray:
        """Halves."""
        halves = self.table.halve(which).ravel()
        return halves[halves >= 0]

    def dyads(self, which: IntArray) -> Dyads:
        """Those in the middle."""
        motion = self.table.required.curve
        points: ComplexArray = motion.onto(self.table.pieces.tubes.middle[which])
        return dyads_at(Displacements(motion.rotation, motion.shift), points)


@dataclass(slots=True)
class PlaneOfCouplers:
    """Couplers of three pairs: squares of the plane, of A but near poles, and of B with A near a pole.

    With A at a pole of two pairs B is anywhere on a line; seen from there, B decides where A is. So squares
    of A hold all linkages but those with A near a pole and B near none of its own; squares of B hold these.
    Where both pivots are next to poles, they are in discs.
    """

    of_a: Patches
    of_b: Patches
    poles: ComplexArray  # of A
    others: ComplexArray  # of B

    @classmethod
    def of(cls, motion: Displacements, reach: float) -> PlaneOfCouplers:
        """All within a ratio of lengths."""
        back = motion.inverse()
        of_a, of_b = Patches.covering(motion, reach, reach), Patches.covering(back, 1 + reach, reach)
        return cls(of_a, of_b, poles(motion)[1], poles(back)[1])._cut()

    def _cut(self) -> PlaneOfCouplers:
        """Squares without the part that other squares, or the discs, cover."""
        near, its = (NEAR * np.maximum(1.0, np.abs(each)) for each in (self.poles, self.others))
        of_a = self.of_a[self.of_a.bounded & ~self.of_a.within(self.poles, ABOUT)]
        of_a = of_a[~of_a.within(self.poles, near) | of_a.may_meet(self.others, BOTH * its)]
        of_b = self.of_b[self.of_b.bounded & ~self.of_b.within(self.others, ABOUT)]
        left_to_a = of_b.within(self.others, BOTH * its)[:, None]
        of_b = of_b[of_b.may_meet(self.poles, np.where(left_to_a, ABOUT, near))]
        places = of_b.spans[1]
        beyond = (np.abs(places.middle[:, None] - self.poles) - near).min(axis=1, initial=np.inf)
        of_b = of_b[beyond <= places.reach]
        return PlaneOfCouplers(of_a, of_b, self.poles, self.others)

    def __len__(self) -> int:
        return len(self.of_a) + len(self.of_b)

    def _parts(self, which: IntArray) -> tuple[Patches, Patches]:
        mine = which < len(self.of_a)
        return self.of_a[which[mine]], self.of_b[which[~mine] - len(self.of_a)]

    def spans(self, which: IntArray) -> tuple[Span, Span]:
        """A and B as forms; `which` in rising order."""
        of_a, of_b = self._parts(which)
        (a, b), (other_b, other_a) = of_a.spans, of_b.spans
        return Span.joined(a, other_a), Span.joined(b, other_b)

    @property
    def discs(self) -> tuple[Span, Span]:
        """A and B each about one of its poles: what no square holds."""
        a, b = (each.ravel() for each in np.meshgrid(self.poles, self.others))
        nothing, rest = np.zeros((2, len(a)), dtype=np.complex128), np.full(len(a), ABOUT)
        return Span(a, nothing, rest), Span(b, nothing, rest)

    def divided(self, which: IntArray) -> IntArray:
        """Quarters, which take the place of all squares."""
        of_a, of_b = (part.quarters for part in self._parts(which))
        made = PlaneOfCouplers(of_a, of_b, self.poles, self.others)._cut()
        self.of_a, self.of_b = made.of_a, made.of_b
        return np.arange(len(self))

    def dyads(self, which: IntArray) -> Dyads:
        """Those in the middle."""
        of_a, of_b = self._parts(np.sort(which))
        mine = dyads_at(of_a.motion, of_a.middle)
        others = dyads_at(of_b.motion, of_b.middle)
        return Dyads(
            np.concatenate([mine.moving, others.ground]), np.concatenate([mine.ground, others.moving])
        )


def dyads_at(motion: Displacements, points: ComplexArray) -> Dyads:
    """The dyads with given moving pivots, polished."""
    centres = centre_points(motion, points)
    return polish(motion, Dyads(points, np.where(np.isfinite(centres), centres, 0.0)), steps=2)
