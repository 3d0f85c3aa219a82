"""Upper bounds of the transmission angle of slider-cranks, whose crank is in a piece of its curve."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, Limits
from grashof.synth.proof.curve.curve import Curve
from grashof.synth.proof.curve.dyads import allowed, lengths_of
from grashof.synth.proof.curve.required import ANY_LENGTH, SLACK, Dyad, Required
from grashof.synth.proof.curve.sliding import Slide
from grashof.synth.proof.forms.forms import Form, Span, greatest_quotient
from grashof.synth.proof.forms.loop import STEEP, at_targets, square_at_targets
from grashof.synth.proof.forms.square import nothing_left
from grashof.synth.quantities.scaled_problem import ScaledProblem

_NOBODY = Dyad((np.inf, 0.0), ANY_LENGTH, Box(), Box(), Box())  # no dyad of the curve is the driven one


@dataclass(frozen=True, slots=True)
class Cranks:
    """The requirements on cranks that go with a slide."""

    required: Required  # of the crank; nothing of the curve is a driven dyad
    slider: Dyad  # the requirements on B
    slide: Slide
    offset: Limits  # sizes, of the slide from O2, positive to the left of its direction
    directions: tuple[float, ...]  # which of the slide's are allowed: 1 for that of `slide`, -1 for the other

    @classmethod
    def of(cls, scaled: ScaledProblem, slide: Slide, at_least: float | None = None) -> Cranks:
        """Of a problem with displacements of the body; `at_least` an angle that counts, deg."""
        required, offset = Required.of(scaled, at_least), scaled.wanted.offset or (-np.inf, np.inf)
        around = offset[0] - SLACK, offset[1] + SLACK
        slider = replace(required.driven, length=ANY_LENGTH, ground=Box(), keep_out=())
        return cls(
            replace(required, driven=_NOBODY), slider, slide, around, _directions(scaled.wanted, slide)
        )

    @staticmethod
    def curve_of(scaled: ScaledProblem) -> Curve:
        """The curve of a problem with displacements of the body."""
        return Required.of(scaled).curve

    @property
    def may_slide(self) -> bool:
        """Whether B and its slide may be within their limits."""
        point, _ = self.slide.spans(1)
        arm = lengths_of(point, Span(0 * point.middle, point.steps, 0 * point.rest))
        inside = arm.within(self.slider.arm) & allowed(self.required, self.slider, point, point)
        return bool(self.directions) and bool(inside.all())

    def rows_left(self, z: Span, c: Span, sense: IntArray, least: FloatArray) -> tuple[IntArray, FloatArray]:
        """Which cranks may belong to a linkage that transmits more than `least`, rad, and their bounds.

        `z` and `c` are A at the first pose, and O2, of one symbol; `sense` is that in which they meet the
        poses, 0 where that is open.
        """
        point, along = self.slide.spans(len(z))
        rod, across = point - z, along.placed(1j)
        r2, r3, offset = (z - c).norm, rod.norm, across.dot(point - c)
        conditions = self._of_lengths(r2, r3, offset)
        bound, forms = self._at_poses(rod, along, r3, least)
        cosine = np.cos(least)
        for sign, where in zip((1.0, -1.0), self._passed(z, c, across, r2, sense), strict=True):
            # There A is at its farthest to one side: its distance from the slide is offset -+ r2.
            distance = offset - r2.times(sign)
            for side in (1.0, -1.0):
                outer = distance.times(side)
                at_most = np.arccos(np.clip(-greatest_quotient(outer.times(-1.0), r3), -1.0, 1.0))
                bound = np.where(where, np.minimum(bound, at_most), bound)
                forms.append((r3.times(cosine) - outer).where(where))
        missed = [each.sup < 0 for each in conditions]
        rows = np.flatnonzero(~(bound <= least) & ~np.logical_or.reduce(missed))
        rows = rows[self._offsets(offset[rows])]
        rows = rows[~nothing_left([each[rows] for each in conditions + forms])]
        return rows, bound[rows]

    def _of_lengths(self, r2: Form, r3: Form, offset: Form) -> list[Form]:
        """Forms that are positive within limits of lengths, their ratio and the rule of full rotation."""
        required, loop, forms = self.required, self.required.loop, list[Form]()
        for length, (low, high) in ((r2, required.driver.length), (r3, loop.lengths[2])):
            forms.append(Form(length.centre - low, length.slopes, length.rest))
            forms.append(Form(high - length.centre, -length.slopes, length.rest))
        forms += [r3.times(loop.ratio) - r2, r2.times(loop.ratio) - r3]
        if loop.turns:
            # r3 - r2 - |offset| >= margin (r2 + r3 + |offset|)
            room = r3.times(1 - loop.margin) - r2.times(1 + loop.margin)
            forms += [room - offset.times(sign * (1 + loop.margin)) for sign in (1.0, -1.0)]
        return forms

    def _offsets(self, offset: Form) -> IntArray:
        """Which may have an allowed offset, seen along an allowed direction of the slide."""
        low, high = self.offset
        seen = [offset.times(sign) for sign in self.directions]
        return np.flatnonzero(np.logical_or.reduce([(each.sup >= low) & (each.inf <= high) for each in seen]))

    def _at_poses(self, rod: Span, along: Span, r3: Form, least: FloatArray) -> tuple[FloatArray, list[Form]]:
        """By the poses: sin mu is the component of AB along the slide over r3, as the body sees both."""
        seen = [along.placed(complex(turn.conj())) for turn in self.required.curve.rotation]
        bound, forms = at_targets(self.required.loop, [each.dot(rod) for each in seen], r3, np.sin(least))
        if least.size and least.min() > STEEP:
            beside = [each.placed(1j).dot(rod) for each in seen]
            closer, more = square_at_targets(beside, r3, np.cos(least))
            bound, forms = np.minimum(bound, closer), forms + more
        return bound, forms

    def _passed(
        self, z: Span, c: Span, across: Span, r2: Form, sense: IntArray
    ) -> tuple[BoolArray, BoolArray]:
        """Where A surely passes O2 + r2 across, or O2 - r2 across, while the transmission angle counts."""
        required, everywhere = self.required, np.ones(len(sense), dtype=bool)
        if required.over_turn:
            return everywhere, everywhere
        if not required.ordered:
            return ~everywhere, ~everywhere
        # F is between A1 and A4 where the triangle A1 F A4 has the sense of the order.
        curve = required.curve
        last = z.placed(complex(curve.rotation[-1]) - 1, complex(curve.shift[-1]))
        beside, crank = r2 * across.cross(last), (z - c).cross(last)
        sign = sense.astype(np.float64)
        return (beside - crank).times(sign).inf > 0, (beside.times(-1.0) - crank).times(sign).inf > 0


def _directions(wanted: Requirements, slide: Slide) -> tuple[float, ...]:
    """Which directions of a slide are allowed, of that which is known and its opposite."""
    given = wanted.slide_angle_deg
    if given is None:
        return 1.0, -1.0
    low, high = np.radians(given if isinstance(given, tuple) else (given, given))
    off = 2 * slide.turned + SLACK
    ahead = {sign: (np.angle(sign * slide.along) - low + off) % TURN for sign in (1.0, -1.0)}
    return tuple(sign for sign, angle in ahead.items() if angle <= high - low + 2 * off)
