"""Closure of each kind of dyad and the transmission angle over intervals of the driver angle, with bisection.

A dyad states its closure alone; derivatives follow from those of the operations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from grashof.analysis.enclosure.interval import EPS, Centred, Interval, Vector, crank, unit
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, ProblemError, SliderCrank
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.linkages.mechanism import DyadKind


class Margins(NamedTuple):
    """Distances of a dyad from its dead positions: both positive, with tan^2(mu / 2) = near / far."""

    near: Centred
    far: Centred


class Rod(NamedTuple):
    """Link 3: its direction, and the distance of B from A along it."""

    direction: Vector
    ab: Centred


@dataclass(frozen=True, slots=True)
class Closure:
    """Functions of a batch of linkages for a kind of dyad.

    `margins` takes the driver's direction; `rod` also the square root of near times far with the sign of the
    assembly; `reach` is the scale of near and far.
    """

    margins: Callable[[Any, Vector], Margins]
    rod: Callable[[Any, Vector, Centred], Rod]
    reach: Callable[[Any], FloatArray]


def _number(value: FloatArray) -> Interval:
    return Interval.of(np.asarray(value, dtype=np.float64))


def _to_o4(linkage: FourBar | InvertedSliderCrank, driver: Vector) -> Vector:
    """From A to O4."""
    ground = [_number(linkage.o4[..., k]) - _number(linkage.o2[..., k]) for k in (0, 1)]
    return Vector(-(driver.x * linkage.r2) + ground[0], -(driver.y * linkage.r2) + ground[1])


def _diagonal2(linkage: FourBar | InvertedSliderCrank, driver: Vector) -> Centred:
    """|A O4|^2 = r1^2 + r2^2 - 2 r2 g.e, in which the driver angle occurs once."""
    gx, gy = (_number(linkage.o4[..., k]) - _number(linkage.o2[..., k]) for k in (0, 1))
    r2 = _number(linkage.r2)
    return -((driver.x * gx + driver.y * gy) * (2 * linkage.r2)) + (gx * gx + gy * gy + r2 * r2)


def _rrr_margins(linkage: FourBar, driver: Vector) -> Margins:
    square, r3, r4 = _diagonal2(linkage, driver), _number(linkage.r3), _number(linkage.r4)
    return Margins(square - (r3 - r4) * (r3 - r4), -square + (r3 + r4) * (r3 + r4))


def _rrr_rod(linkage: FourBar, driver: Vector, root: Centred) -> Rod:  # closure: RRR
    """e3 = w (|w|^2 + r3^2 - r4^2 + i root) / (2 r3 |w|^2), w from A to O4."""
    square, r3, r4 = _diagonal2(linkage, driver), _number(linkage.r3), _number(linkage.r4)
    twice = square * (2 * linkage.r3)
    along = (square + (r3 - r4) * (r3 + r4)) / twice
    return Rod(_to_o4(linkage, driver).times(along, root / twice), driver.x.constant(r3))


def _to_slide(linkage: SliderCrank, driver: Vector) -> Centred:
    """From A to the slide's line, to its left: offset - r2 sin(theta2 - slide_angle)."""
    cos, sin = unit(linkage.slide_angle)
    return -((driver.y * cos - driver.x * sin) * linkage.r2) + linkage.offset


def _rrp_margins(linkage: SliderCrank, driver: Vector) -> Margins:
    """Of h between +-r3."""
    h = _to_slide(linkage, driver)
    return Margins(h + linkage.r3, -h + linkage.r3)


def _rrp_rod(linkage: SliderCrank, driver: Vector, root: Centred) -> Rod:  # closure: RRP
    """e3 = slide (root + i h) / r3, h from A to the slide."""
    cos, sin = unit(linkage.slide_angle)
    h = _to_slide(linkage, driver)
    direction = Vector(root / linkage.r3, h / linkage.r3).times(cos, sin)
    return Rod(direction, driver.x.constant(linkage.r3))


def _rpr_margins(linkage: InvertedSliderCrank, driver: Vector) -> Margins:
    diagonal, away = _diagonal2(linkage, driver).root(), np.abs(linkage.offset)
    return Margins(diagonal - away, diagonal + away)


def _rpr_rod(linkage: InvertedSliderCrank, driver: Vector, root: Centred) -> Rod:  # closure: RPR
    """e3 = w (l + i offset) / |w|^2, w from A to O4, l the root."""
    square = _diagonal2(linkage, driver)
    return Rod(_to_o4(linkage, driver).times(root / square, driver.x.constant(linkage.offset) / square), root)


_CLOSURES = {
    DyadKind.RRR: Closure(_rrr_margins, _rrr_rod, lambda x: (x.r1 + x.r2 + x.r3 + x.r4) ** 2),
    DyadKind.RRP: Closure(_rrp_margins, _rrp_rod, lambda x: x.r2 + x.r3 + np.abs(x.offset)),
    DyadKind.RPR: Closure(_rpr_margins, _rpr_rod, lambda x: x.r1 + x.r2 + np.abs(x.offset)),
}


def closure_of(linkage: Linkage) -> Closure:
    """Closure of the dyad of a linkage; ProblemError for two loops."""
    kind = linkage.mechanism
    if len(kind.dyads) > 1:
        raise ProblemError(f"a {kind.word} has two loops; it cannot be proven by intervals")
    return _CLOSURES[kind.dyads[0].kind]


class Places(NamedTuple):
    """Moving pivots and coupler point in the global frame, and the direction of link 3."""

    a: Vector
    b: Vector
    p: Vector
    direction3: Vector


def places(linkage: Linkage, sign: FloatArray, driver: Vector) -> Places:
    """Positions of a linkage on the assembly `sign` for each interval of the driver; equal batch axes."""
    closure = closure_of(linkage)
    margins = closure.margins(linkage, driver)
    root = (margins.near * margins.far).root() * sign
    rod = closure.rod(linkage, driver, root)
    a = Vector(
        driver.x * linkage.r2 + linkage.o2[..., 0],
        driver.y * linkage.r2 + linkage.o2[..., 1],
    )
    u, v = linkage.coupler_point[..., 0], linkage.coupler_point[..., 1]
    e3 = rod.direction
    return Places(a, a + Vector(e3.x * rod.ab, e3.y * rod.ab), a + e3.times(u, v), e3)


_FIRST = np.pi / 24  # rad: the widest initial interval
# Accuracy of the least transmission angle, rad, where rounding allows it; finer beside its limit.
_SHARP, _AT_LIMIT = 1e-8, 2e-10
_ROUNDS = 48  # of bisection
_MOST = 2000  # intervals of a range at once, as where the angle hardly varies, at which to stop
_ARCTANGENT = 8 * EPS  # relative error of a computed arctangent, and a margin


@dataclass(frozen=True, slots=True)
class Pieces:
    """Intervals of driver angles, each a part of the range `row`; all of shape (n,)."""

    row: IntArray
    middle: FloatArray
    half: FloatArray

    @classmethod
    def covering(cls, start: FloatArray, end: FloatArray, widest: float = _FIRST) -> Pieces:
        """Pieces that cover ranges of shape (R,) between driver angles in either order."""
        low, high = np.minimum(start, end), np.maximum(start, end)
        count = np.maximum(1, np.ceil((high - low) / widest)).astype(np.int64)
        row = np.repeat(np.arange(len(count)), count)
        first = np.repeat(np.cumsum(count) - count, count)
        width = (high - low) / count
        middle = low[row] + (np.arange(len(row)) - first + 0.5) * width[row]
        rounded = 8 * EPS * (np.abs(low) + np.abs(high))  # of a middle, which may be near 0
        return cls.wide(row, middle, (width / 2 + rounded)[row])

    @classmethod
    def wide(cls, row: IntArray, middle: FloatArray, half: FloatArray) -> Pieces:
        """Pieces widened so that neighbours overlap in spite of rounding."""
        return cls(row, middle, half + 8 * EPS * (np.abs(middle) + half))

    def halves(self, chosen: IntArray) -> Pieces:
        """The two halves of some of them."""
        row, middle, half = self.row[chosen], self.middle[chosen], self.half[chosen] / 2
        return Pieces.wide(
            np.concatenate([row, row]),
            np.concatenate([middle - half, middle + half]),
            np.concatenate([half, half]),
        )


@dataclass(frozen=True, slots=True)
class Least:
    """Bounds lo and hi, shape (R,), rad, of the least min(mu, pi - mu) over each range; 0 if the loop opens.

    `gap` is an upper bound of the distance from open at the worst middle, as a share of `Closure.reach`,
    negative where the loop is open; `pieces` counts the intervals.
    """

    lo: FloatArray
    hi: FloatArray
    gap: FloatArray
    pieces: IntArray


def least_transmission(
    linkages: Linkage, start: FloatArray, end: FloatArray, required: FloatArray | None = None
) -> Least:
    """Enclose the least transmission angle of linkages (R,) over driver ranges in rad, in either order.

    Finer about `required` (rad); where that is NaN only closure counts and `lo` is any positive bound. Where
    `lo` is positive the loop closes throughout the range, without a dead position.
    """
    rows = len(start)
    lo, hi, gap = np.full(rows, np.inf), np.full(rows, np.pi / 2), np.full(rows, np.inf)
    pieces, count = Pieces.covering(start, end), np.zeros(rows, dtype=np.int64)
    closure = closure_of(linkages)
    reach = closure.reach(linkages)
    required = np.full(rows, -np.inf) if required is None else required
    for turn in range(_ROUNDS):
        if not len(pieces.row):
            break
        np.add.at(count, pieces.row, 1)
        margins = closure.margins(linkages[pieces.row], crank(pieces.middle, pieces.half))
        mid = [margin.mid for margin in margins]
        np.minimum.at(hi, pieces.row, _angle(*mid).hi)
        np.minimum.at(gap, pieces.row, np.minimum(mid[0].hi, mid[1].hi) / reach[pieces.row])
        least = _angle(*(margin.over for margin in margins)).lo
        sharp = np.where(np.abs(hi - required) < 2 * _SHARP, _AT_LIMIT, _SHARP)
        wanted = np.where(np.isnan(required), 0.0, hi - sharp)[pieces.row]
        crowded = (np.bincount(pieces.row, minlength=rows) > _MOST)[pieces.row]
        done = (least > 0) & (least >= wanted) | (hi[pieces.row] <= 0) | (turn == _ROUNDS - 1) | crowded
        np.minimum.at(lo, pieces.row[done], least[done])
        pieces = pieces.halves(np.flatnonzero(~done))
    return Least(lo, hi, gap, count)


def _angle(near: Interval, far: Interval) -> Interval:
    """min(mu, pi - mu) by tan^2(mu / 2) = near / far; 0 where one of them is not positive."""
    bounds = []
    for one, other in ((near.lo, far.hi), (far.lo, near.hi)), ((near.hi, far.lo), (far.hi, near.lo)):
        halves = [2 * np.arctan2(*(np.sqrt(np.maximum(part, 0)) for part in pair)) for pair in (one, other)]
        open_ = (one[0] <= 0) | (other[0] <= 0)
        bounds.append(np.where(open_, 0.0, np.minimum(*halves)))
    return Interval(bounds[0] * (1 - _ARCTANGENT), np.minimum(bounds[1] * (1 + _ARCTANGENT), np.pi / 2))
