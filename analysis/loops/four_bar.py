"""The loop of a four-bar: two bars, pinned to the crank, to each other and to the ground (dyad RRR)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from grashof.analysis.loops.loop import (
    CHANGE,
    EPS,
    ROUNDING,
    GrashofClass,
    Kind,
    Loop,
    Span,
    from_zero,
    infinite_where,
)
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.linkages.four_bar import FourBar

_BY_SHORTEST = (
    GrashofClass.DOUBLE_CRANK,
    GrashofClass.CRANK_ROCKER,
    GrashofClass.DOUBLE_ROCKER,
    GrashofClass.ROCKER_CRANK,
)
FOUR_BAR_CLASSES = (*_BY_SHORTEST, GrashofClass.CHANGE_POINT, GrashofClass.NON_GRASHOF)


class FourBarSides(NamedTuple):
    """The ground vector, lengths, assembly sign, and what is rounding of a length."""

    gx: FloatArray
    gy: FloatArray
    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    sign: FloatArray
    rounding: FloatArray

    def close(self, theta2: FloatArray) -> Loop:  # closure: RRR
        """B is an intersection of the circles about A and O4 (Norton, *Design of Machinery*, sec. 4.5).

        Its distance from the diagonal A-O4 comes from Heron's product, which keeps its digits near the dead
        positions where the usual r3^2 - x^2 loses them.
        """
        gx, gy, r2, r3, r4, sign, rounding = self
        cos2, sin2 = np.cos(theta2), np.sin(theta2)
        ax, ay = r2 * cos2, r2 * sin2
        x, y = gx - ax, gy - ay
        square = x * x + y * y
        product = ((r3 + r4) ** 2 - square) * (square - (r3 - r4) ** 2)
        if np.any(product < 0):
            product = _kept_closed(product, np.sqrt(square), r3, r4, rounding)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            half = 0.5 / square
            root = sign * np.sqrt(product)
            along, beside = 0.5 + (r3 - r4) * (r3 + r4) * half, root * half
            x3, y3 = along * x - beside * y, along * y + beside * x
            sine = root / (2 * r3 * r4)
            return Loop(cos2, sin2, x3 / r3, y3 / r3, (x3 - x) / r4, (y3 - y) / r4, sine, ax, ay, r3)

    def rates(
        self, loop: Loop, dead: BoolArray, omega2: FloatArray, alpha2: FloatArray, jerk2: FloatArray
    ) -> tuple[FloatArray, ...]:
        """The loop, differentiated: two linear equations for each derivative.

        Crossing them with e^{i theta4} or e^{i theta3} leaves one unknown each (Norton, secs. 6.7, 7.3). The
        determinant, sin(theta4 - theta3), comes from the area of A-B-O4.
        """
        _, _, r2, r3, r4, sign, _ = self
        cos2, sin2, cos3, sin3, cos4, sin4, sine, *_ = loop
        inverse = 1 / (np.where(dead, np.copysign(0.0, sign), sine) if dead.any() else sine)
        over3, over4 = inverse / r3, inverse / r4
        # Sines and cosines of the angles between the links.
        sine42, sine32 = cos4 * sin2 - sin4 * cos2, cos3 * sin2 - sin3 * cos2
        cosine42, cosine32 = cos4 * cos2 + sin4 * sin2, cos3 * cos2 + sin3 * sin2
        cosine43 = cos4 * cos3 + sin4 * sin3
        tip2 = r2 * omega2
        omega3, omega4 = tip2 * sine42 * over3, tip2 * sine32 * over4
        tip3, tip4 = r3 * omega3, r4 * omega4
        # Centripetal terms, then their rates: with zeta - omega^3 for alpha and 3 omega alpha for
        # omega^2 the equations of the jerk are those of the acceleration.
        pull2, pull3, pull4 = tip2 * omega2, tip3 * omega3, tip4 * omega4
        push2 = r2 * alpha2
        alpha3 = (push2 * sine42 + pull2 * cosine42 + pull3 * cosine43 - pull4) * over3
        alpha4 = (push2 * sine32 + pull2 * cosine32 + pull3 - pull4 * cosine43) * over4
        push2 = r2 * (jerk2 - omega2**2 * omega2)
        pull2, pull3, pull4 = 3 * tip2 * alpha2, 3 * tip3 * alpha3, 3 * tip4 * alpha4
        jerk3 = (push2 * sine42 + pull2 * cosine42 + pull3 * cosine43 - pull4) * over3 + omega3**2 * omega3
        jerk4 = (push2 * sine32 + pull2 * cosine32 + pull3 - pull4 * cosine43) * over4 + omega4**2 * omega4
        rates = omega3, omega4, alpha3, alpha4, jerk3, jerk4
        if not dead.any():
            return rates
        return infinite_where(dead, _leading(omega3, omega4, r3, r4, np.sign(cosine43), sign), rates)


class FourBarKind(Kind[FourBar]):
    """The four-bar; its `apart` is the diagonal A-O4."""

    slides = False
    dead = "coupler and output lie in one line"

    def sides_of(self, linkage: FourBar, sign: FloatArray) -> FourBarSides:
        ground = linkage.o4 - linkage.o2
        reach = np.abs(linkage.o2).sum(axis=-1) + np.abs(linkage.o4).sum(axis=-1)
        rounding = 8 * EPS * (reach + linkage.r2 + linkage.r3 + linkage.r4)
        return FourBarSides(
            ground[..., 0], ground[..., 1], linkage.r2, linkage.r3, linkage.r4, sign, rounding
        )

    def span(self, linkage: FourBar, cosine: float = 1.0) -> Span:
        """4 r1 r2 a = (r1 - r2)^2 - least^2, 4 r1 r2 b = most^2 - (r1 + r2)^2: least and most diagonals.

        They are r3 -+ r4 where they may be in line, otherwise third sides of the triangle A-B-O4.
        """
        r1, r2, r3, r4 = np.moveaxis(linkage.lengths, -1, 0)
        bent = 2 * r3 * r4 * (1 - cosine)
        least, most = (r3 - r4) ** 2 + bent, (r3 + r4) ** 2 - bent
        longest, shortest = (r1 + r2) ** 2, (r1 - r2) ** 2
        more_a, more_b = longest - least, most - shortest
        return Span(shortest - least, more_a, most - longest, more_b, (more_a >= 0) & (more_b >= 0))

    def shares(self, linkage: FourBar) -> FloatArray:
        """(r3 + r4 - r1 - r2) and (|r1 - r2| - |r3 - r4|), as shares of r1 + r2 + r3 + r4."""
        r1, r2, r3, r4 = np.moveaxis(linkage.lengths, -1, 0)
        stretched, folded = r3 + r4 - r1 - r2, np.abs(r1 - r2) - np.abs(r3 - r4)
        shares: FloatArray = np.stack([stretched, folded], axis=-1) / (r1 + r2 + r3 + r4)[..., None]
        return shares

    def even(self, linkage: FourBar) -> tuple[float, float]:
        r1, r2, r3, r4 = map(float, linkage.lengths)
        if not r1 * r2 > 0:  # the ground pivots coincide: all links turn together
            return np.nan, np.nan
        stretched, folded = self.shares(linkage).tolist()
        scale = (r1 + r2 + r3 + r4) / (4 * r1 * r2)
        a = folded * scale * (abs(r1 - r2) + abs(r3 - r4)) if abs(folded) > CHANGE else 1.0
        b = stretched * scale * (r1 + r2 + r3 + r4) if abs(stretched) > CHANGE else 1.0
        return a, b

    def class_of(self, linkage: FourBar, tolerance: float) -> GrashofClass:
        """Shortest and longest against the others (Grashof 1883; Norton, sec. 2.13)."""
        lengths = linkage.lengths
        shortest, p, q, longest = np.sort(lengths)
        excess = p + q - shortest - longest
        if abs(excess) <= tolerance * lengths.sum():
            return GrashofClass.CHANGE_POINT
        return _BY_SHORTEST[int(np.argmin(lengths))] if excess > 0 else GrashofClass.NON_GRASHOF

    def apart(self, linkage: FourBar, phi: FloatArray) -> FloatArray:
        """The squared diagonal as (r1 - r2)^2 + 4 r1 r2 sin^2(phi/2), without cancellation near 0."""
        r1, r2 = linkage.r1, linkage.r2
        return np.asarray(np.sqrt((r1 - r2) ** 2 + 4 * r1 * r2 * np.sin(phi / 2) ** 2))

    def apart_on_line(self, linkage: FourBar) -> tuple[FloatArray, FloatArray]:
        return np.abs(linkage.r1 - linkage.r2), linkage.r1 + linkage.r2

    def transmission(self, linkage: FourBar, apart: FloatArray) -> FloatArray:
        """Law of cosines in A-B-O4 in its half-angle form, which keeps its digits near 0 and pi."""
        least, most = np.abs(linkage.r3 - linkage.r4), linkage.r3 + linkage.r4
        rounding = ROUNDING * (apart + most)
        with np.errstate(invalid="ignore"):
            near, far = from_zero(apart - least, rounding), from_zero(most - apart, rounding)
            return 2 * np.arctan2(np.sqrt(near * (apart + least)), np.sqrt(far * (most + apart)))

    def coupler_rates(
        self, linkage: FourBar, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The loop, differentiated, times the conjugate of the direction that drops out."""
        r2, r3, r4 = linkage.r2, linkage.r3, linkage.r4
        spread = np.sin(theta3 - theta4)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            omega3 = r2 * np.sin(theta4 - theta2) / (r3 * spread)
            omega4 = r2 * np.sin(theta3 - theta2) / (r4 * spread)
            inward = r2 * np.cos(theta2 - theta4) + r3 * omega3**2 * np.cos(theta3 - theta4)
            alpha3 = (r4 * omega4**2 - inward) / (r3 * spread)
        return omega3, alpha3

    def carried(
        self, linkage: FourBar, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        return np.asarray(-linkage.r2 / linkage.r3 * np.sin(theta4 - theta2))

    def output_rate(
        self, linkage: FourBar, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = linkage.r2 * np.sin(theta3 - theta2)
            return np.asarray(rate / (linkage.r4 * np.sin(theta3 - theta4)))

    def turning(
        self, linkage: FourBar, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """From the loop's derivative, without the division by sin(theta3 - theta4) (Norton, sec. 6.7)."""
        r2, r3, r4 = linkage.r2, linkage.r3, linkage.r4
        return (
            r3 * r4 * np.sin(theta3 - theta4),
            r2 * r4 * np.sin(theta4 - theta2),
            r2 * r3 * np.sin(theta3 - theta2),
        )

    def limits(self, linkage: FourBar) -> FloatArray:
        """O2, A and B in line: triangles O2-B-O4 with O2B = r2 + r3 or |r2 - r3| (Norton, secs. 3.2, 3.4)."""
        r1, r2, r3, r4 = np.moveaxis(linkage.lengths, -1, 0)
        reach = np.stack([r2 + r3, np.abs(r3 - r2)], axis=-1)
        r1, r4 = r1[..., None], r4[..., None]
        with np.errstate(invalid="ignore", divide="ignore"):
            half = np.arctan2(
                np.sqrt((r4 - (r1 - reach)) * (r4 + (r1 - reach))),
                np.sqrt((r1 + reach - r4) * (r1 + reach + r4)),
            )
        # B lies left of A->O4 when it lies left of O2->O4 as seen along O2->B, unless A lies beyond B.
        side = linkage.assembly[..., None] * np.stack([np.ones_like(r2), np.sign(r3 - r2)], axis=-1)
        opposite = np.stack([np.zeros_like(r2), np.where(r3 > r2, np.pi, 0.0)], axis=-1)
        return np.asarray(linkage.theta1[..., None] + 2 * side * half + opposite)

    def turned(
        self, linkage: FourBar, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The components along O4B and along AB of the varied loop equation r2 + r3 = r1 + r4 (as vectors).

        r3 sin(theta3 - theta4) dtheta3
            = dr2 cos(theta2 - theta4) + dr3 cos(theta3 - theta4) - dr1 cos(theta1 - theta4) - dr4
        r4 sin(theta4 - theta3) dtheta4
            = dr1 cos(theta1 - theta3) + dr4 cos(theta4 - theta3) - dr2 cos(theta2 - theta3) - dr3
        """
        ones = np.full_like(theta3, -1.0)
        by3 = (
            -np.cos(linkage.theta1 - theta4), np.cos(theta2 - theta4), np.cos(theta3 - theta4), ones
        )  # fmt: skip
        by4 = (
            np.cos(linkage.theta1 - theta3), -np.cos(theta2 - theta3), ones, np.cos(theta4 - theta3)
        )  # fmt: skip
        with np.errstate(divide="ignore", invalid="ignore"):
            return (
                np.stack(by3, axis=-1) / (linkage.r3 * np.sin(theta3 - theta4))[..., None],
                np.stack(by4, axis=-1) / (linkage.r4 * np.sin(theta4 - theta3))[..., None],
            )

    def way_to_4(self, linkage: FourBar) -> tuple[FloatArray, tuple[tuple[int, FloatArray], ...]]:
        return linkage.o4, ()

    def b_from(self, linkage: FourBar) -> FloatArray:
        return linkage.r4


def _kept_closed(
    product: FloatArray, diagonal: FloatArray, r3: FloatArray, r4: FloatArray, rounding: FloatArray
) -> FloatArray:
    """Heron's product, put back to 0 where only rounding carries the diagonal A-O4 past a dead position."""
    past = np.abs(diagonal - np.clip(diagonal, np.abs(r3 - r4), r3 + r4))
    return np.where((product < 0) & (past <= rounding), 0.0, product)


def _leading(
    omega3: FloatArray, omega4: FloatArray, r3: FloatArray, r4: FloatArray, same: FloatArray, sign: FloatArray
) -> tuple[FloatArray, ...]:
    """Infinite rates of links 3 and 4 with the sign of the term that grows fastest.

    With s = sin(theta4 - theta3) and `same` = cos(theta4 - theta3) = +-1, omega goes like 1/s,
    alpha like 1/s^3 and the jerk, its rate, like -3 s'/s^4.
    """
    bend3, bend4 = same / r3 - 1 / r4, 1 / r3 - same / r4
    alpha3, alpha4 = sign * bend3 * np.abs(omega3), sign * bend4 * np.abs(omega4)
    # r3 omega3 and r4 omega4 agree up to `same`; their difference decides the sign of s'.
    closing = same * np.sign(omega4) * (1 / r4 - same / r3)
    jerk3, jerk4 = -bend3 * closing * np.abs(omega3), -bend4 * closing * np.abs(omega4)
    return omega3, omega4, alpha3, alpha4, jerk3, jerk4
