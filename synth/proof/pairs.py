"""Upper bounds of the transmission angle of pairs of pieces: of all linkages that their dyads make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.proof.asked import Asked
from grashof.synth.proof.forms import Form, Span, greatest_quotient
from grashof.synth.proof.square import nothing_left
from grashof.synth.proof.table import Pieces, Side


@dataclass(frozen=True, slots=True)
class Pairs:
    """Pairs of pieces, and what their linkages transmit at most.

    Parameters
    ----------
    driver, driven : ndarray of int, shape (n,)
        Numbers of pieces.
    bound : ndarray, shape (n,), rad
    """

    driver: IntArray
    driven: IntArray
    bound: FloatArray

    def __len__(self) -> int:
        return len(self.driver)

    def __getitem__(self, index: IntArray | BoolArray) -> Pairs:
        return Pairs(self.driver[index], self.driven[index], self.bound[index])

    @classmethod
    def joined(cls, parts: list[Pairs]) -> Pairs:
        """Several as one."""
        names = "driver", "driven", "bound"
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def bounded(asked: Asked, pieces: Pieces, driver: IntArray, driven: IntArray, least: float) -> Pairs:
    """The pairs that may hold a linkage with a transmission angle of more than `least`, rad."""
    rows, bound = rows_left(asked, pieces, driver, driven, np.full(len(driver), least))
    return Pairs(driver[rows], driven[rows], bound)


def rows_left(
    asked: Asked, pieces: Pieces, driver: IntArray, driven: IntArray, least: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Which pairs may hold a linkage that transmits more than `least`, rad, and their bounds."""
    one = Side.of(pieces, driver, is_driver=True)
    other = Side.of(pieces, driven, is_driver=False)
    lengths = _lengths(one, other)
    first = np.flatnonzero(_lengths_allowed(asked, lengths) & _directed(asked, one, other))
    if len(first) < len(driver):
        one, other, least = one[first], other[first], least[first]
        lengths = tuple(form[first] for form in lengths)
    pair = _Pair(asked, one, other, lengths, pieces.sense[driver[first]])
    bound, conditions = pair.bound(least)
    second = np.flatnonzero(bound > least)
    second = second[~nothing_left([each[second] for each in conditions])]
    return first[second], bound[second]


_Lengths = tuple[Form, ...]  # r1, r2, r3, r4


def _lengths(one: Side, other: Side) -> _Lengths:
    return (other.c - one.c).norm, one.length, (other.z - one.z).norm, other.length


def _lengths_allowed(asked: Asked, lengths: _Lengths) -> BoolArray:
    """Which pairs may have allowed lengths, by their limits, their ratio and the rule of Grashof."""
    limits = asked.r1, asked.driver.length, asked.r3, asked.driven.length
    lows, highs = [form.inf for form in lengths], [form.sup for form in lengths]
    keep = np.ones(len(lows[0]), dtype=bool)
    for low, high, (least, most) in zip(lows, highs, limits, strict=True):
        keep &= (high >= least) & (low <= most)
    keep &= np.maximum.reduce(lows) <= asked.ratio * np.minimum.reduce(highs)
    if asked.turns:
        total, by_sign = _turning(asked, lengths)
        keep &= total.sup >= 0
        keep &= np.logical_or.reduce([_possible(by_sign[sign]) for sign in asked.longer_ground])
    return keep


def _turning(asked: Asked, lengths: _Lengths) -> tuple[Form, dict[int, tuple[Form, Form]]]:
    """What has to be positive for a full turn: one form, and two by the sign of r1 - r2."""
    r1, r2, r3, r4 = lengths
    margin = (r1 + r2 + r3 + r4).times(asked.margin)
    ground, coupler = r1 - r2, r3 - r4
    longer = ground + coupler - margin, ground - coupler - margin
    shorter = coupler - ground - margin, ground.times(-1.0) - coupler - margin
    return r3 + r4 - r1 - r2 - margin, {1: longer, -1: shorter}


def _possible(forms: tuple[Form, Form]) -> BoolArray:
    """Where both may be positive."""
    both: BoolArray = (forms[0].sup >= 0) & (forms[1].sup >= 0)
    return both


def _directed(asked: Asked, one: Side, other: Side) -> BoolArray:
    """Which pairs may have an allowed direction of the ground line, limits less than half a turn apart."""
    ground = other.c - one.c
    keep = np.ones(len(ground.middle), dtype=bool)
    if asked.ground_angle is None:
        return keep
    middle = sum(asked.ground_angle) / 2
    inside = _crossed(ground, middle, ahead=True).sup >= 0
    low, high = asked.ground_angle
    return inside & (_crossed(ground, low).sup >= 0) & (_crossed(ground, high).inf <= 0)


def _crossed(span: Span, direction: float, *, ahead: bool = False) -> Form:
    """How far a complex form reaches to the left of a direction, or ahead along it."""
    turned = np.exp(-1j * direction)
    parts = [turned * part for part in (span.middle, span.s, span.t)]
    centre, s, t = (part.real if ahead else part.imag for part in parts)
    return Form(centre, s, t, span.rest)


@dataclass(frozen=True, slots=True)
class _Pair:
    """Pairs with forms of their lengths r1, r2, r3, r4."""

    asked: Asked
    one: Side
    other: Side
    lengths: _Lengths
    sense: IntArray

    def bound(self, least: FloatArray) -> tuple[FloatArray, list[Form]]:
        """Upper bounds of the transmission angle, rad; and forms, positive where it exceeds `least`."""
        r1, r2, r3, r4 = self.lengths
        product = r3 * r4
        bound, forms = self._at_poses(product, np.sin(least))
        apart, together = r1 + r2, r1 - r2
        squares = r3 * r3 + r4 * r4
        folded, stretched = together * together - squares, squares - apart * apart
        counted = self._passed()
        for outer, where in zip((folded, stretched), counted, strict=True):
            # -cos mu folded, and cos of pi - mu stretched: both at most cos of the least angle.
            cosine = -greatest_quotient(outer, product.times(2.0))
            at_most = np.arccos(np.clip(cosine, -1.0, 1.0))
            bound = np.where(where, np.minimum(bound, at_most), bound)
            slack = outer + product.times(2 * np.cos(least))
            forms.append(slack.where(where))
        limits = self.asked.r1, self.asked.driver.length, self.asked.r3, self.asked.driven.length
        for length, (low, high) in zip(self.lengths, limits, strict=True):
            forms.append(Form(length.centre - low, length.s, length.t, length.rest))
            forms.append(Form(high - length.centre, -length.s, -length.t, length.rest))
        if self.asked.turns:
            forms += self._turning_forms()
        return bound, forms

    def _turning_forms(self) -> list[Form]:
        """What has to be positive for a full turn, where only one sign of r1 - r2 is possible."""
        total, by_sign = _turning(self.asked, self.lengths)
        nowhere = np.zeros(len(self.sense), dtype=bool)
        can = {
            sign: _possible(by_sign[sign]) if sign in self.asked.longer_ground else nowhere
            for sign in by_sign
        }
        return [total, *(form.where(~can[-sign]) for sign, pair in by_sign.items() for form in pair)]

    def _at_poses(self, product: Form, sine: FloatArray) -> tuple[FloatArray, list[Form]]:
        """Bounds by the sine of the transmission angle at the poses; of one sign on one branch."""
        curve = self.asked.curve
        coupler = self.other.z - self.one.z
        areas = [
            coupler.cross(self.other.seen_from_body(complex(rotation), complex(shift)))
            for rotation, shift in zip(curve.rotation, curve.shift, strict=True)
        ]
        left = np.stack([greatest_quotient(area, product) for area in areas])
        right = np.stack([greatest_quotient(area.times(-1.0), product) for area in areas])
        if not self.asked.one_branch:
            best = np.maximum(left, right).min(axis=0)
            return np.arcsin(np.clip(best, -1.0, 1.0)), []
        left_worst, right_worst = left.min(axis=0), right.min(axis=0)
        best = np.maximum(left_worst, right_worst)
        both = np.minimum(left_worst, right_worst) > sine
        sign = np.where(left_worst >= right_worst, 1.0, -1.0)
        forms = [(area.times(sign) - product.times(sine)).where(~both) for area in areas]
        return np.arcsin(np.clip(best, -1.0, 1.0)), forms

    def _passed(self) -> tuple[BoolArray, BoolArray]:
        """Where A surely passes the ground line between O2 and O4, or beyond O2, while it counts."""
        everywhere = np.ones(len(self.sense), dtype=bool)
        if self.asked.over_turn:
            return everywhere, everywhere
        if not self.asked.ordered:
            return ~everywhere, ~everywhere
        # F = O2 +- (r2 / r1) O2O4 is between A1 and A4 where the triangle A1 F A4 has the sense of the order.
        curve = self.asked.curve
        (z0, z1, rest), turn = self.one.moving, curve.rotation[-1] - 1
        last = self.one.span(turn * z0 + curve.shift[-1], turn * z1, abs(turn) * rest)
        ground = (self.other.c - self.one.c).cross(last)
        crank = self.one.seen_from_body(1.0, 0.0).cross(last)
        r1, r2, _, _ = self.lengths
        across, along = r2 * ground, r1 * crank
        sense = self.sense.astype(float)
        return (across - along).times(sense).inf > 0, (across.times(-1.0) - along).times(sense).inf > 0
