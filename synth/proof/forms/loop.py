"""The four-bar loop on pieces of curves: lengths, Grashof's condition, and bounds of transmission."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, Limits
from grashof.synth.proof.forms.forms import Form, Span, greatest_quotient

STEEP = float(np.radians(50))  # from here on cosines count, too
Lengths = tuple[Form, ...]  # r1, r2, r3, r4


@dataclass(frozen=True, slots=True)
class LoopLimits:
    """The requirements on a loop."""

    lengths: tuple[Limits, Limits, Limits, Limits]  # of r1, r2, r3, r4
    ratio: float  # longest to shortest link at most
    turns: bool  # whether the driver turns fully
    margin: float  # of full rotation, a share of the sum of lengths
    longer_ground: tuple[int, ...]  # signs of r1 - r2 that are allowed where the driver turns fully
    one_branch: bool


def lengths_allowed(limits: LoopLimits, lengths: Lengths) -> BoolArray:
    """Where lengths may be allowed, by their limits, their ratio and the rule of Grashof."""
    lows, highs = [form.inf for form in lengths], [form.sup for form in lengths]
    keep = np.ones(len(lows[0]), dtype=bool)
    for low, high, (least, most) in zip(lows, highs, limits.lengths, strict=True):
        keep &= (high >= least) & (low <= most)
    keep &= np.maximum.reduce(lows) <= limits.ratio * np.minimum.reduce(highs)
    if limits.turns:
        total, by_sign = _turning(limits, lengths)
        keep &= total.sup >= 0
        keep &= np.logical_or.reduce([_possible(by_sign[sign]) for sign in limits.longer_ground])
    return keep


def transmission_bound(
    limits: LoopLimits,
    lengths: Lengths,
    arms: list[tuple[Span, Span]],
    passed: tuple[BoolArray, BoolArray],
    least: FloatArray,
) -> tuple[FloatArray, list[Form]]:
    """Upper bounds of the transmission angle, rad; and forms, positive where it exceeds `least`, rad.

    `lengths` are r1, r2, r3, r4; `arms` are from A to B and from O4 to B at each target, in any frame;
    `passed` states where A surely passes the ground line between O2 and O4, or beyond O2, while it counts.
    """
    r1, r2, r3, r4 = lengths
    product = r3 * r4
    bound, forms = at_targets(limits, [u.cross(v) for u, v in arms], product, np.sin(least))
    if least.size and least.min() > STEEP:
        closer, more = square_at_targets([u.dot(v) for u, v in arms], product, np.cos(least))
        bound, forms = np.minimum(bound, closer), forms + more
    apart, together = r1 + r2, r1 - r2
    squares = r3 * r3 + r4 * r4
    folded, stretched = together * together - squares, squares - apart * apart
    for outer, where in zip((folded, stretched), passed, strict=True):
        # -cos mu folded, and cos of pi - mu stretched: both at most cos of the least angle.
        cosine = -greatest_quotient(outer, product.times(2.0))
        at_most = np.arccos(np.clip(cosine, -1.0, 1.0))
        bound = np.where(where, np.minimum(bound, at_most), bound)
        slack = outer + product.times(2 * np.cos(least))
        forms.append(slack.where(where))
    for length, (low, high) in zip(lengths, limits.lengths, strict=True):
        forms.append(Form(length.centre - low, length.slopes, length.rest))
        forms.append(Form(high - length.centre, -length.slopes, length.rest))
    if limits.turns:
        forms += _turning_forms(limits, lengths)
    return bound, forms


def at_targets(
    limits: LoopLimits, areas: list[Form], product: Form, sine: FloatArray
) -> tuple[FloatArray, list[Form]]:
    """Bounds by the sine of the transmission angle at the targets; of one sign on one branch."""
    left = np.stack([greatest_quotient(area, product) for area in areas])
    right = np.stack([greatest_quotient(area.times(-1.0), product) for area in areas])
    if not limits.one_branch:
        best = np.maximum(left, right).min(axis=0)
        return np.arcsin(np.clip(best, -1.0, 1.0)), []
    left_worst, right_worst = left.min(axis=0), right.min(axis=0)
    best = np.maximum(left_worst, right_worst)
    both = np.minimum(left_worst, right_worst) > sine
    sign = np.where(left_worst >= right_worst, 1.0, -1.0)
    forms = [(area.times(sign) - product.times(sine)).where(~both) for area in areas]
    return np.arcsin(np.clip(best, -1.0, 1.0)), forms


def square_at_targets(dots: list[Form], product: Form, cosine: FloatArray) -> tuple[FloatArray, list[Form]]:
    """The same by the cosine, which is accurate where the sine is not: near 90 deg."""
    least = np.zeros_like(product.centre)
    forms = []
    for dot in dots:
        for either in (dot, dot.times(-1.0)):
            least = np.maximum(least, -greatest_quotient(either, product))
            forms.append(product.times(cosine) - either)
    return np.arccos(np.clip(least, 0.0, 1.0)), forms


def _turning(limits: LoopLimits, lengths: Lengths) -> tuple[Form, dict[int, tuple[Form, Form]]]:
    """Forms that are positive for a full turn: one, and two by the sign of r1 - r2."""
    r1, r2, r3, r4 = lengths
    margin = (r1 + r2 + r3 + r4).times(limits.margin)
    ground, coupler = r1 - r2, r3 - r4
    longer = ground + coupler - margin, ground - coupler - margin
    shorter = coupler - ground - margin, ground.times(-1.0) - coupler - margin
    return r3 + r4 - r1 - r2 - margin, {1: longer, -1: shorter}


def _possible(forms: tuple[Form, Form]) -> BoolArray:
    """Where both may be positive."""
    both: BoolArray = (forms[0].sup >= 0) & (forms[1].sup >= 0)
    return both


def _turning_forms(limits: LoopLimits, lengths: Lengths) -> list[Form]:
    """Forms that are positive for a full turn, where only one sign of r1 - r2 is possible."""
    total, by_sign = _turning(limits, lengths)
    nowhere = np.zeros(len(total.centre), dtype=bool)
    can = {sign: _possible(by_sign[sign]) if sign in limits.longer_ground else nowhere for sign in by_sign}
    return [total, *(form.where(~can[-sign]) for sign, pair in by_sign.items() for form in pair)]
