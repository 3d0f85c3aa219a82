"""Upper bounds of the transmission angle of pairs of pieces: of all linkages that their dyads make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import Pieces, Side
from grashof.synth.proof.forms.forms import Form, Span
from grashof.synth.proof.forms.loop import Lengths, lengths_allowed, transmission_bound
from grashof.synth.proof.forms.square import nothing_left


@dataclass(frozen=True, slots=True)
class Pairs:
    """Pairs of pieces, and upper bounds of the transmission angles of their linkages."""

    driver: IntArray  # (n,), numbers of pieces
    driven: IntArray  # (n,), numbers of pieces
    bound: FloatArray  # (n,), rad

    def __len__(self) -> int:
        return len(self.driver)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Pairs:
        return Pairs(self.driver[index], self.driven[index], self.bound[index])

    @classmethod
    def joined(cls, parts: list[Pairs]) -> Pairs:
        """Several as one."""
        names = "driver", "driven", "bound"
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def bounded(required: Required, pieces: Pieces, driver: IntArray, driven: IntArray, least: float) -> Pairs:
    """The pairs that may hold a linkage with a transmission angle of more than `least`, rad."""
    rows, bound = rows_left(required, pieces, driver, driven, np.full(len(driver), least))
    return Pairs(driver[rows], driven[rows], bound)


def rows_left(
    required: Required, pieces: Pieces, driver: IntArray, driven: IntArray, least: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Which pairs may hold a linkage that transmits more than `least`, rad, and their bounds."""
    sides = Side.of(pieces, driver, is_driver=True), Side.of(pieces, driven, is_driver=False)
    return sides_left(required, *sides, pieces.sense[driver], least)


def sides_left(
    required: Required, one: Side, other: Side, sense: IntArray, least: FloatArray
) -> tuple[IntArray, FloatArray]:
    """The same of drivers, which meet the poses in a sense, and driven dyads, entry by entry."""
    _, _, rows, bound = sifted(required, one, other, sense, least)
    return rows, bound


def sifted(
    required: Required, one: Side, other: Side, sense: IntArray, least: FloatArray
) -> tuple[IntArray, IntArray, IntArray, FloatArray]:
    """Pairs left by tests of lengths, then of transmission, then of both together, and their bounds."""
    count = len(sense)
    lengths: Lengths = (other.c - one.c).norm, one.length, (other.z - one.z).norm, other.length
    first = np.flatnonzero(lengths_allowed(required.loop, lengths) & _directed(required, one, other))
    if len(first) < count:
        one, other, sense, least = one[first], other[first], sense[first], least[first]
        lengths = tuple(form[first] for form in lengths)
    passed = _passed(required, one, other, lengths, sense)
    bound, conditions = transmission_bound(required.loop, lengths, _arms(required, one, other), passed, least)
    second = np.flatnonzero(bound > least)
    third = second[~nothing_left([each[second] for each in conditions])]
    return first, first[second], first[third], bound[third]


def _arms(required: Required, one: Side, other: Side) -> list[tuple[Span, Span]]:
    """AB and O4B at each pose, as the body sees them."""
    curve, coupler = required.curve, other.z - one.z
    poses = zip(curve.rotation, curve.shift, strict=True)
    return [(coupler, other.seen_from_body(complex(turn), complex(move))) for turn, move in poses]


def _directed(required: Required, one: Side, other: Side) -> BoolArray:
    """Which pairs may have an allowed direction of the ground line, limits less than half a turn apart."""
    ground = other.c - one.c
    keep = np.ones(len(ground.middle), dtype=bool)
    if required.ground_angle is None:
        return keep
    middle = sum(required.ground_angle) / 2
    inside = _crossed(ground, middle, ahead=True).sup >= 0
    low, high = required.ground_angle
    return inside & (_crossed(ground, low).sup >= 0) & (_crossed(ground, high).inf <= 0)


def _crossed(span: Span, direction: float, *, ahead: bool = False) -> Form:
    """Extent of a complex form to the left of a direction, or ahead along it."""
    turned = np.exp(-1j * direction)
    centre, slopes = (
        part.real if ahead else part.imag for part in (turned * span.middle, turned * span.steps)
    )
    return Form(centre, slopes, span.rest)


def _passed(
    required: Required, one: Side, other: Side, lengths: Lengths, sense: IntArray
) -> tuple[BoolArray, BoolArray]:
    """Where A surely passes the ground line between O2 and O4, or beyond O2, while it counts."""
    everywhere = np.ones(len(sense), dtype=bool)
    if required.over_turn:
        return everywhere, everywhere
    if not required.ordered:
        return ~everywhere, ~everywhere
    # F = O2 +- (r2 / r1) O2O4 is between A1 and A4 where the triangle A1 F A4 has the sense of the order.
    curve = required.curve
    last = one.z.placed(complex(curve.rotation[-1]) - 1, complex(curve.shift[-1]))
    ground = (other.c - one.c).cross(last)
    crank = one.seen_from_body(1.0, 0.0).cross(last)
    r1, r2, _, _ = lengths
    across, along = r2 * ground, r1 * crank
    sign = sense.astype(np.float64)
    return (across - along).times(sign).inf > 0, (across.times(-1.0) - along).times(sign).inf > 0
