"""Closure and transmission angle over ranges of the driver: bisected where the least may be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.enclosure.closure import Margins, closure_of
from grashof.analysis.enclosure.interval import EPS, Interval, crank
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray, IntArray

_FIRST = np.pi / 24  # rad: the widest interval to begin with
# How near the least transmission angle is known, rad, where rounding allows it; nearer beside its limit.
_SHARP, _AT_LIMIT = 1e-8, 2e-10
_ROUNDS = 48  # of bisection; those that are left then keep what they have
_MOST = 2000  # intervals of a range at once, as where the angle hardly varies: then all keep what they have
_ARCTANGENT = 8 * EPS  # relative error of a computed arctangent, and a margin


@dataclass(frozen=True, slots=True)
class Pieces:
    """Intervals of driver angles: `row` is the range that each is a part of, all of shape (n,)."""

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
        """Wide enough that neighbours overlap whatever was rounded on the way to their middles."""
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
    """The least min(mu, pi - mu) over each range, in [lo, hi], shape (R,), rad; 0 where the loop opens.

    `gap` bounds from above how far the loop is from open at the worst middle, as a share of `Closure.reach`:
    less than 0 where it is open. `pieces` counts the intervals.
    """

    lo: FloatArray
    hi: FloatArray
    gap: FloatArray
    pieces: IntArray


def least_transmission(
    linkages: Linkage, start: FloatArray, end: FloatArray, required: FloatArray | None = None
) -> Least:
    """Enclose the least transmission angle of linkages (R,) over driver ranges in rad, in either order.

    It is known nearer about `required` (rad); where that is NaN closure alone counts and `lo` is any positive
    bound. Where `lo` is positive the loop closes all over the range, without a dead position.

    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=[(0, 0)], o4=(100, 0), r2=40, r3=120, r4=80)
    >>> least = least_transmission(norton, np.array([0.0]), np.array([6.3]))
    >>> np.degrees([least.lo, least.hi]).round(4).ravel().tolist()
    [26.3843, 26.3843]
    """
    rows = len(start)
    lo, hi, gap = np.full(rows, np.inf), np.full(rows, np.pi / 2), np.full(rows, np.inf)
    pieces, count = Pieces.covering(start, end), np.zeros(rows, dtype=np.int64)
    reach = closure_of(linkages).reach(linkages)
    required = np.full(rows, -np.inf) if required is None else required
    for turn in range(_ROUNDS):
        if not len(pieces.row):
            break
        np.add.at(count, pieces.row, 1)
        margins = _margins(linkages, pieces)
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


def _margins(linkages: Linkage, pieces: Pieces) -> Margins:
    return closure_of(linkages).margins(linkages[pieces.row], crank(pieces.middle, pieces.half))


def _angle(near: Interval, far: Interval) -> Interval:
    """min(mu, pi - mu) by tan^2(mu / 2) = near / far; 0 where one of them is not positive."""
    bounds = []
    for one, other in ((near.lo, far.hi), (far.lo, near.hi)), ((near.hi, far.lo), (far.hi, near.lo)):
        halves = [2 * np.arctan2(*(np.sqrt(np.maximum(part, 0)) for part in pair)) for pair in (one, other)]
        open_ = (one[0] <= 0) | (other[0] <= 0)
        bounds.append(np.where(open_, 0.0, np.minimum(*halves)))
    return Interval(bounds[0] * (1 - _ARCTANGENT), np.minimum(bounds[1] * (1 + _ARCTANGENT), np.pi / 2))
