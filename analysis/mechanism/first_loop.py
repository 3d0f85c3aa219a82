"""First loops in closed form, by their dyads: driver ranges, classes, limit positions.

Each kind has the same methods:

- `span`: where the loop closes with the cosine of the transmission angle at most `cosine` in size.
- `shares`: `rotatability`, shape (..., 2).
- `even`: a and b of `first_motion`, shape (...); 1 for one that is 0 (a change point), NaN where undefined.
- `class_of`: the class of a single linkage.
- `apart`: the length that the transmission angle depends on, at theta2 - theta1 = phi; `apart_on_line`: the
  same at phi = 0 and pi, where it is least and greatest.
- `limits`: driver angles at which the output turns back, shape (..., 2), rad; NaN where there are none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SixBar, SliderCrank
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind

CHANGE = 1e-12  # share of the lengths within which a linkage has a change point


class GrashofClass(StrEnum):
    """Classes of linkages by the links that turn fully (link 2 is the driver)."""

    CRANK_ROCKER = "crank-rocker"
    DOUBLE_CRANK = "double-crank"
    DOUBLE_ROCKER = "double-rocker"
    ROCKER_CRANK = "rocker-crank"
    CHANGE_POINT = "change-point"
    NON_GRASHOF = "non-Grashof"
    SLIDER_CRANK = "slider-crank"
    SLIDER_ROCKER = "slider-rocker"
    CRANK_SHAPER = "crank-shaper"
    WHITWORTH = "Whitworth"
    INVERTED_SLIDER_ROCKER = "inverted slider-rocker"


class Span(NamedTuple):
    """Where a loop closes: sin^2(phi/2) + a >= 0 and cos^2(phi/2) + b >= 0 with phi = theta2 - theta1.

    a, 1 + a, b, 1 + b times a positive number, to keep all digits; whether it closes at all. Each of shape
    (...).
    """

    a: FloatArray
    more_a: FloatArray
    b: FloatArray
    more_b: FloatArray
    closes: BoolArray


_BY_SHORTEST = (
    GrashofClass.DOUBLE_CRANK,
    GrashofClass.CRANK_ROCKER,
    GrashofClass.DOUBLE_ROCKER,
    GrashofClass.ROCKER_CRANK,
)
FOUR_BAR_CLASSES = (*_BY_SHORTEST, GrashofClass.CHANGE_POINT, GrashofClass.NON_GRASHOF)


@dataclass(frozen=True, slots=True)
class _DiagonalLoop:
    """A loop whose `apart` is the diagonal A-O4."""

    linkage: FourBar | SixBar | InvertedSliderCrank

    def apart(self, phi: FloatArray) -> FloatArray:
        """The squared diagonal as (r1 - r2)^2 + 4 r1 r2 sin^2(phi/2), without cancellation near 0."""
        r1, r2 = self.linkage.r1, self.linkage.r2
        return np.asarray(np.sqrt((r1 - r2) ** 2 + 4 * r1 * r2 * np.sin(phi / 2) ** 2))

    def apart_on_line(self) -> tuple[FloatArray, FloatArray]:
        return np.abs(self.linkage.r1 - self.linkage.r2), self.linkage.r1 + self.linkage.r2


@dataclass(frozen=True, slots=True)
class FourBarLoop(_DiagonalLoop):
    """The four-bar, that of a six-bar too."""

    linkage: FourBar | SixBar

    def span(self, cosine: float = 1.0) -> Span:
        """4 r1 r2 a = (r1 - r2)^2 - least^2, 4 r1 r2 b = most^2 - (r1 + r2)^2: least and most diagonals.

        They are r3 -+ r4 where they may be in line, otherwise third sides of the triangle A-B-O4.
        """
        r1, r2, r3, r4 = np.moveaxis(self.linkage.lengths[..., :4], -1, 0)
        bent = 2 * r3 * r4 * (1 - cosine)
        least, most = (r3 - r4) ** 2 + bent, (r3 + r4) ** 2 - bent
        longest, shortest = (r1 + r2) ** 2, (r1 - r2) ** 2
        more_a, more_b = longest - least, most - shortest
        return Span(shortest - least, more_a, most - longest, more_b, (more_a >= 0) & (more_b >= 0))

    def shares(self) -> FloatArray:
        """(r3 + r4 - r1 - r2) and (|r1 - r2| - |r3 - r4|), as shares of r1 + r2 + r3 + r4."""
        r1, r2, r3, r4 = np.moveaxis(self.linkage.lengths[..., :4], -1, 0)
        stretched, folded = r3 + r4 - r1 - r2, np.abs(r1 - r2) - np.abs(r3 - r4)
        return np.asarray(np.stack([stretched, folded], axis=-1) / (r1 + r2 + r3 + r4)[..., None])

    def even(self) -> tuple[FloatArray, FloatArray]:
        r1, r2, r3, r4 = np.moveaxis(self.linkage.lengths[..., :4], -1, 0)
        stretched, folded = np.moveaxis(self.shares(), -1, 0)
        apart = r1 * r2 > 0  # otherwise the ground pivots coincide: all links turn together
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            scale = np.where(apart, (r1 + r2 + r3 + r4) / (4 * r1 * r2), np.nan)
            a = folded * scale * (np.abs(r1 - r2) + np.abs(r3 - r4))
            b = stretched * scale * (r1 + r2 + r3 + r4)
        return _without_change(a, folded, apart), _without_change(b, stretched, apart)

    def class_of(self, tolerance: float) -> GrashofClass:
        """Shortest and longest compared with the others (Grashof 1883; Norton, sec. 2.13)."""
        lengths = self.linkage.lengths[:4]
        shortest, p, q, longest = np.sort(lengths)
        excess = p + q - shortest - longest
        if abs(excess) <= tolerance * lengths.sum():
            return GrashofClass.CHANGE_POINT
        return _BY_SHORTEST[int(np.argmin(lengths))] if excess > 0 else GrashofClass.NON_GRASHOF

    def limits(self) -> FloatArray:
        """O2, A and B in line: triangles O2-B-O4 with O2B = r2 + r3 or |r2 - r3| (Norton, secs. 3.2, 3.4)."""
        r1, r2, r3, r4 = np.moveaxis(self.linkage.lengths[..., :4], -1, 0)
        reach = np.stack([r2 + r3, np.abs(r3 - r2)], axis=-1)
        r1, r4 = r1[..., None], r4[..., None]
        with np.errstate(invalid="ignore", divide="ignore"):
            half = np.arctan2(
                np.sqrt((r4 - (r1 - reach)) * (r4 + (r1 - reach))),
                np.sqrt((r1 + reach - r4) * (r1 + reach + r4)),
            )
        # B lies left of A->O4 when it lies left of O2->O4 as seen along O2->B, unless A lies beyond B.
        side = self.linkage.assembly[..., None] * np.stack([np.ones_like(r2), np.sign(r3 - r2)], axis=-1)
        opposite = np.stack([np.zeros_like(r2), np.where(r3 > r2, np.pi, 0.0)], axis=-1)
        return np.asarray(self.linkage.theta1[..., None] + 2 * side * half + opposite)


@dataclass(frozen=True, slots=True)
class SliderCrankLoop:
    """The slider-crank; its `apart` is h, from A to the slide's line, positive to the left."""

    linkage: SliderCrank

    def span(self, cosine: float = 1.0) -> Span:
        """2 r2 a = r3 + offset - r2, 2 r2 b = r3 - offset - r2: h = offset - r2 cos(phi) within +-r3."""
        r2, r3, offset = self.linkage.r2, self.linkage.r3 * cosine, self.linkage.offset
        low, high = offset - r2, offset + r2
        return Span(r3 + low, r3 + high, r3 - high, r3 - low, (r3 >= low) & (r3 >= -high))

    def shares(self) -> FloatArray:
        """r3 - r2 - offset and r3 - r2 + offset, as shares of r2 + r3 + |offset|."""
        r2, r3, offset = self.linkage.r2, self.linkage.r3, self.linkage.offset
        room = r3 - r2
        return np.stack([room - offset, room + offset], axis=-1) / (r2 + r3 + np.abs(offset))[..., None]

    def even(self) -> tuple[FloatArray, FloatArray]:
        span, (stretched, folded), scale = self.span(), np.moveaxis(self.shares(), -1, 0), 2 * self.linkage.r2
        return _without_change(span.a / scale, folded), _without_change(span.b / scale, stretched)

    def class_of(self, tolerance: float) -> GrashofClass:
        shares = self.shares()
        if np.abs(shares).min() <= tolerance:
            return GrashofClass.CHANGE_POINT
        return GrashofClass.SLIDER_CRANK if shares.min() > 0 else GrashofClass.SLIDER_ROCKER

    def apart(self, phi: FloatArray) -> FloatArray:
        return np.asarray(self.linkage.offset - self.linkage.r2 * np.cos(phi))

    def apart_on_line(self) -> tuple[FloatArray, FloatArray]:
        return self.linkage.offset - self.linkage.r2, self.linkage.offset + self.linkage.r2

    def limits(self) -> FloatArray:
        """O2, A and B in line: sin(theta3 - slide_angle) = offset / (r3 +- r2)."""
        r2, r3, offset = (x[..., None] for x in (self.linkage.r2, self.linkage.r3, self.linkage.offset))
        reach = np.concatenate([r3 + r2, r3 - r2], axis=-1)
        opposite = np.array([0.0, np.pi])
        with np.errstate(invalid="ignore"):
            level = np.sqrt((np.abs(reach) - np.abs(offset)) * (np.abs(reach) + np.abs(offset)))
            rise = np.arctan2(np.where(reach < 0, -offset, offset), self.linkage.assembly[..., None] * level)
        return np.asarray(self.linkage.slide_angle[..., None] + rise + opposite)


@dataclass(frozen=True, slots=True)
class InvertedLoop(_DiagonalLoop):
    """The inverted slider-crank."""

    linkage: InvertedSliderCrank

    def span(self, cosine: float = 1.0) -> Span:
        """4 r1 r2 a = (r1 - r2)^2 - (offset / cosine)^2; nothing limits the diagonal where it is longest."""
        least, most, away = self._diagonals()
        away = away / cosine
        a, more_a = (least - away) * (least + away), (most - away) * (most + away)
        endless = np.full_like(a, np.inf)
        return Span(a, more_a, endless, endless, away <= most)

    def shares(self) -> FloatArray:
        """1, and |r1 - r2| - |offset| as a share of r1 + r2 + |offset|."""
        least, most, away = self._diagonals()
        folded = (least - away) / (most + away)
        return np.stack([np.ones_like(folded), folded], axis=-1)

    def even(self) -> tuple[FloatArray, FloatArray]:
        least, most, away = self._diagonals()
        scale = (most - least) * (most + least)  # 4 r1 r2
        scale = np.where(scale > 0, scale, np.nan)
        narrow = least**2 / scale  # the diagonal is shortest there
        at_change = np.where(narrow <= CHANGE, 1.0, narrow)
        changes = np.abs(least - away) <= CHANGE * (most + away)
        a = np.where(changes, at_change, (least - away) * (least + away) / scale)
        return a, np.where(np.isnan(scale), np.nan, np.inf)

    def class_of(self, tolerance: float) -> GrashofClass:
        share = float(self.shares()[1])
        if abs(share) <= tolerance:
            return GrashofClass.CHANGE_POINT
        if share < 0:
            return GrashofClass.INVERTED_SLIDER_ROCKER
        return GrashofClass.CRANK_SHAPER if self.linkage.r2 < self.linkage.r1 else GrashofClass.WHITWORTH

    def limits(self) -> FloatArray:
        """Crank perpendicular to rod: r1 sin(theta1 - theta3) = +-r2 - offset, theta2 = theta3 +- 90 deg."""
        side = np.array([1.0, -1.0])
        r1, r2, offset = (x[..., None] for x in (self.linkage.r1, self.linkage.r2, self.linkage.offset))
        beside = side * r2 - offset
        with np.errstate(invalid="ignore"):
            along = self.linkage.assembly[..., None] * np.sqrt((r1 - beside) * (r1 + beside))
            theta3 = self.linkage.theta1[..., None] - np.arctan2(beside, along)
        return np.asarray(theta3 + side * np.pi / 2)

    def _diagonals(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The shortest and the longest diagonal, and the offset's size."""
        return (*self.apart_on_line(), np.abs(self.linkage.offset))


def _without_change(value: FloatArray, share: FloatArray, defined: BoolArray | bool = True) -> FloatArray:
    """A value that is 1 where a share vanishes, at a change point; NaN where it is not defined."""
    return np.where(defined, np.where(np.abs(share) > CHANGE, value, 1.0), np.nan)


FirstLoop: TypeAlias = FourBarLoop | SliderCrankLoop | InvertedLoop
_LOOPS: dict[DyadKind, Callable[[Any], FirstLoop]] = {
    DyadKind.RRR: FourBarLoop,
    DyadKind.RRP: SliderCrankLoop,
    DyadKind.RPR: InvertedLoop,
}


def first_loop(linkage: Linkage) -> FirstLoop:
    """Closed forms of the first loop of a linkage."""
    return _LOOPS[linkage.mechanism.dyads[0].kind](linkage)


def first_ranges(linkage: Linkage, transmission: float = 0.0) -> FloatArray:
    """Driver angles at which the first loop closes, shape (..., 2, 2), rad; see `driver_ranges`."""
    a, more_a, b, more_b, assembled = first_loop(linkage).span(float(np.cos(transmission)))
    # Half-angle forms keep their digits near 0 and pi.
    half_stretched = np.arctan2(np.sqrt(np.maximum(more_b, 0)), np.sqrt(np.maximum(-b, 0)))
    half_folded = np.arctan2(np.sqrt(np.maximum(-a, 0)), np.sqrt(np.maximum(more_a, 0)))
    reach, gap = 2 * half_stretched, 2 * half_folded  # pi and 0 where there is no limit
    through_ground, through_back = half_folded == 0, half_stretched == np.pi / 2
    low = np.where(through_ground, -reach, gap)
    high = np.where(through_back & ~through_ground, 2 * np.pi - gap, reach)
    two = ~through_ground & ~through_back & assembled
    first = np.stack([np.where(assembled, low, np.nan), np.where(assembled, high, np.nan)], axis=-1)
    second = np.stack([np.where(two, -reach, np.nan), np.where(two, -gap, np.nan)], axis=-1)
    ranges, theta1 = np.stack([first, second], axis=-2), linkage.theta1[..., None, None]
    middle = theta1 + ranges.mean(axis=-1, keepdims=True)
    return np.asarray(theta1 + (ranges - TURN * np.round(middle / TURN)))
