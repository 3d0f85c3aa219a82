"""All linkages with a swing or a stroke and a time ratio, enclosed: transmission angles and missed limits.

In the limit positions driver and coupler are in line, B1 and B2 are at r3 + r2 and r3 - r2 from O2, and are
seen from there under the lag, by which the driver turns more than half a turn in the slow stroke. With
x = r2 / r3, a = lag / 2 and b = swing / 2 - a,

    r1 sin(swing / 2) = r3 hypot(x cos b, sin b)        r4 sin(swing / 2) = r3 hypot(x cos a, sin a)

and at worst, folded or stretched along the ground line,

    cos mu = ((1 - x²) |sin a cos b| + x hypot(x cos b, sin b)) / hypot(x cos a, sin a)

Both positions are on one assembly where x |cos a cos b| >= |sin a sin b|. Of a slide the swing is 0 there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from grashof.problems.values.arrays import Limits
from grashof.synth.proof.strokes.ranges import HALF_TURN, ONE, Range, hypotenuse

_TWO = Range.of(2.0)
# The first of each pair has to be at most the second.
Conditions: TypeAlias = list[tuple[Range, Range]]


@dataclass(frozen=True, slots=True)
class StrokeLimits:
    """The requirements on the sizes of linkages, with the slack of the judge."""

    lengths: Mapping[str, Limits]  # by their names
    ratio: float  # longest to shortest link at most
    margin: float  # of full rotation, a share of the sum of lengths
    offset: Limits = (0.0, np.inf)  # of the distance of the slide, on the side of a family


@dataclass(frozen=True, slots=True)
class MemberBounds:
    """Pieces of a family."""

    cosine: Range  # of the worst transmission angle over the turn
    slope: Range  # its derivative by the parameter of the family
    conditions: Conditions  # for members to be allowed


@dataclass(frozen=True, slots=True)
class Family:
    """Linkages by one parameter, from `low` to `high`."""

    low: float
    high: float
    members: Callable[[Range], MemberBounds]


def crank_rockers(swing: float, time_ratio: float, side: int, limits: StrokeLimits) -> Family:
    """Crank-rockers with a swing (rad) and a time ratio, by r2 / r3.

    `side`, 1 or -1, distinguishes two families that differ where the time ratio is not 1: the sense in which
    link 4 swings in the slow stroke of a driver that turns counter-clockwise.
    """
    half = Range.of(swing) / _TWO
    a = _half_lag(time_ratio) * Range.of(float(side))
    unit = half.sine

    def members(x: Range) -> MemberBounds:
        line = _InLine.of(x, a, half - a)
        r1, r2, r3, r4 = line.ground, x * unit, unit, line.output
        lengths = {"r1": r1, "r2": r2, "r3": r3, "r4": r4}
        more, less = _margins(limits)
        turns = [
            (more * (r1 + r2), less * (r3 + r4)),
            (more * (r2 + r3), less * (r1 + r4)),
            (more * (r2 + r4), less * (r1 + r3)),
        ]
        of_scale = _some_scale(lengths, limits.lengths)
        alike = _alike(lengths.values(), limits)
        return MemberBounds(line.cosine, line.slope, [line.assembled, *turns, *alike, *of_scale])

    return Family(*_shares(limits), members)


def slider_cranks(stroke: float, time_ratio: float, limits: StrokeLimits) -> Family:
    """Slider-cranks with a stroke and a time ratio, by r2 / r3."""
    a = _half_lag(time_ratio)
    way = Range.of(stroke)

    def members(x: Range) -> MemberBounds:
        line = _InLine.of(x, a, Range.of(0.0) - a)
        r3 = way / (_TWO * line.output)
        r2, offset = x * r3, line.across * r3 / line.output
        more, less = _margins(limits)
        turns = [(more * (r2 + offset), less * r3)]
        sizes = [*_inside(r2, limits.lengths["r2"]), *_inside(r3, limits.lengths["r3"])]
        sizes += _inside(offset, limits.offset)
        alike = _alike((r2, r3), limits)
        return MemberBounds(line.cosine, line.slope, [line.assembled, *turns, *alike, *sizes])

    return Family(*_shares(limits), members)


def crank_shapers(swing: float, limits: StrokeLimits) -> Family:
    """Inverted slider-cranks whose block swings by an angle (rad); their time ratio follows from it.

    The rod has the directions -asin(r2 - offset) and asin(r2 + offset) from the ground line in its limit
    positions, r1 = 1, and half the difference of both angles is p, from 0 to 90 deg - swing / 2. By
    w = tan(p / 2), r1 : r2 : offset = 1 + w² : (1 - w²) sin(swing / 2) : 2 w cos(swing / 2), and at worst
    cos mu = offset / (r1 - r2).
    """
    half = Range.of(swing) / _TWO
    sine, cosine = half.sine, half.cosine
    room = (HALF_TURN / _TWO - half) / _TWO  # half of the greatest p, which is 90 deg less half the swing
    flat = _TWO * room.sine * room.sine  # 1 - sin(swing / 2)

    def members(w: Range) -> MemberBounds:
        r1, r2 = ONE + w * w, (ONE - w) * (ONE + w) * sine
        offset = _TWO * w * cosine
        more, less = _margins(limits)
        turns = [(more * (r2 + offset), less * r1)]
        lengths = {"r1": r1, "r2": r2, "offset": offset}
        of_scale = _some_scale(lengths, {**limits.lengths, "offset": limits.offset})
        alike = _alike((r1, r2), limits)
        square = (ONE + sine) * w * w
        apart = flat + square  # r1 - r2
        slope = _TWO * cosine * (flat - square) / (apart * apart)
        return MemberBounds(offset / apart, slope, [*turns, *alike, *of_scale])

    return Family(0.0, float((room.sine / room.cosine).high), members)


def _half_lag(time_ratio: float) -> Range:
    """Half the angle by which the driver turns more than half a turn in the slow stroke, rad."""
    ratio = Range.of(time_ratio)
    return HALF_TURN / _TWO * (ratio - ONE) / (ratio + ONE)


@dataclass(frozen=True, slots=True)
class _InLine:
    """Ranges of linkages whose driver and coupler are in line in the limit positions."""

    ground: Range  # its length times sin(swing / 2) / r3
    output: Range  # its length times sin(swing / 2) / r3
    across: Range  # (1 - x²) |sin a cos b|
    cosine: Range
    slope: Range
    assembled: tuple[Range, Range]  # the first is at most the second where both positions are on one assembly

    @classmethod
    def of(cls, x: Range, a: Range, b: Range) -> _InLine:
        """By r2 / r3 and the two angles."""
        sine_a, cosine_a, sine_b, cosine_b = (each.size for each in (a.sine, a.cosine, b.sine, b.cosine))
        ground, output = hypotenuse(x * cosine_b, sine_b), hypotenuse(x * cosine_a, sine_a)
        across = (ONE - x) * (ONE + x) * sine_a * cosine_b
        cosine = (across + x * ground) / output
        rise = ground + x * x * cosine_b * cosine_b / ground - _TWO * x * sine_a * cosine_b
        slope = (rise - cosine * x * cosine_a * cosine_a / output) / output
        return cls(ground, output, across, cosine, slope, (sine_a * sine_b, x * cosine_a * cosine_b))


def _margins(limits: StrokeLimits) -> tuple[Range, Range]:
    """1 + margin and 1 - margin: longer - shorter >= margin (longer + shorter), without differences."""
    margin = Range.of(limits.margin)
    return ONE + margin, ONE - margin


def _shares(limits: StrokeLimits) -> Limits:
    """Least and greatest allowed r2 / r3."""
    return float((ONE / Range.of(limits.ratio)).low), 1.0


def _alike(lengths: Iterable[Range], limits: StrokeLimits) -> Conditions:
    ratio, each = Range.of(limits.ratio), list(lengths)
    return [(one, ratio * other) for one in each for other in each if one is not other]


def _inside(length: Range, limits: Limits) -> Conditions:
    least, most = limits
    over = [(Range.of(least), length)] if least > 0 else []
    return over + ([(length, Range.of(most))] if most < np.inf else [])


def _some_scale(lengths: Mapping[str, Range], limits: Mapping[str, Limits]) -> Conditions:
    """Conditions for lengths to be inside their limits at some scale: each two of them are."""
    return [
        (Range.of(least) * other, Range.of(most) * one)
        for name, one in lengths.items()
        for its, other in lengths.items()
        if name != its and (least := limits[name][0]) > 0 and (most := limits[its][1]) < np.inf
    ]
