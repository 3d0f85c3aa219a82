"""How each kind of dyad closes, over intervals of the driver angle: its only formulas here.

Derivatives come from those of the operations, so a dyad states its closure alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from grashof.analysis.enclosure.interval import Centred, Interval, Vector, unit
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, ProblemError, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind


class Margins(NamedTuple):
    """How far a dyad is from its dead positions: both are positive, tan^2(mu / 2) = near / far."""

    near: Centred
    far: Centred


class Rod(NamedTuple):
    """Link 3: its direction, and how far B lies from A along it."""

    direction: Vector
    ab: Centred


@dataclass(frozen=True, slots=True)
class Closure:
    """A kind of dyad, as functions of a batch of linkages.

    `margins` takes the driver's direction; `rod` besides the square root of near times far, with the sign of
    the assembly; `reach` is of the order of near and far.
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
    """|A O4|^2 = r1^2 + r2^2 - 2 r2 g.e, which holds the driver angle once."""
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
    """How the dyad of a linkage closes; ProblemError for two loops: intervals are known of one."""
    kind = linkage.mechanism
    if len(kind.dyads) > 1:
        raise ProblemError(f"a {kind.word} has two loops; it cannot be proven by intervals")
    return _CLOSURES[kind.dyads[0].kind]


class Places(NamedTuple):
    """Moving pivots and coupler point from O2 on in the global frame, and the direction of link 3."""

    a: Vector
    b: Vector
    p: Vector
    direction3: Vector


def places(linkage: Linkage, sign: FloatArray, driver: Vector) -> Places:
    """Where a linkage is, on the assembly of a sign, for each interval of the driver; batch axes alike."""
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
