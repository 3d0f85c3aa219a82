"""The loop of a slider-crank: a rod, pinned to the crank, and a slider on the ground (dyad RRP)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from grashof.analysis.loops.loop import (
    CHANGE,
    EPS,
    ROUNDING,
    Driven,
    GrashofClass,
    Kind,
    Loop,
    Span,
    from_zero,
    infinite_where,
)
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.linkages.slider_crank import SliderCrank


class SliderCrankSides(NamedTuple):
    """The slide's direction and offset, lengths, assembly sign, and what is rounding of a length."""

    ex: FloatArray
    ey: FloatArray
    offset: FloatArray
    r2: FloatArray
    r3: FloatArray
    sign: FloatArray
    rounding: FloatArray

    def close(self, theta2: FloatArray) -> Loop:  # closure: RRP
        """With h from A to the slide, to its left, r3 sin(theta3 - slide_angle) = h (Norton, sec. 4.6).

        The cosine comes from the product (r3 - h)(r3 + h), which keeps its digits near the dead positions.
        """
        ex, ey, offset, r2, r3, sign, rounding = self
        cos2, sin2 = np.cos(theta2), np.sin(theta2)
        ax, ay = r2 * cos2, r2 * sin2
        h = offset - (ay * ex - ax * ey)
        product = (r3 - h) * (r3 + h)
        if np.any(product < 0):
            past = np.abs(h) - r3
            product = np.where((product < 0) & (past <= rounding), 0.0, product)
        with np.errstate(invalid="ignore"):
            along = sign * np.sqrt(product) / r3
            beside = np.where(np.isnan(along), np.nan, h / r3)
            cos3, sin3 = along * ex - beside * ey, along * ey + beside * ex
            cos4, sin4 = np.where(np.isnan(along), np.nan, -ey), np.where(np.isnan(along), np.nan, ex)
            return Loop(cos2, sin2, cos3, sin3, cos4, sin4, along, ax, ay, r3)

    def rates(
        self, loop: Loop, dead: BoolArray, omega2: FloatArray, alpha2: FloatArray, jerk2: FloatArray
    ) -> tuple[FloatArray, ...]:
        """The two components of the loop, differentiated; then the slider's way along the slide."""
        ex, ey, _, r2, r3, sign, _ = self
        cosine, sine = loop.sine, loop.sin3 * ex - loop.cos3 * ey  # of theta3 - slide_angle
        cosine2, sine2 = loop.cos2 * ex + loop.sin2 * ey, loop.sin2 * ex - loop.cos2 * ey
        driven = Driven.of(r2, omega2, alpha2, jerk2)
        rise = [pull * sine2 - push * cosine2 for push, pull in zip(*driven, strict=True)]  # of h
        ahead = [-push * sine2 - pull * cosine2 for push, pull in zip(*driven, strict=True)]  # of A
        over = 1 / (r3 * (np.where(dead, np.copysign(0.0, sign), cosine) if dead.any() else cosine))
        omega3 = rise[0] * over
        alpha3 = (rise[1] + r3 * sine * omega3**2) * over
        jerk3 = (rise[2] + 3 * r3 * sine * omega3 * alpha3) * over + omega3**2 * omega3
        travel = r2 * cosine2 + r3 * cosine
        velocity = ahead[0] - r3 * sine * omega3
        acceleration = ahead[1] - r3 * (sine * alpha3 + cosine * omega3**2)
        jerk = ahead[2] - r3 * (sine * (jerk3 - omega3**2 * omega3) + 3 * cosine * omega3 * alpha3)
        still = np.where(np.isnan(cosine), np.nan, np.zeros_like(omega3))
        rates = omega3, still, alpha3, still, jerk3, still, travel, velocity, acceleration, jerk
        if not dead.any():
            return rates
        # omega goes like 1/c with c = cos(theta3 - slide_angle), alpha like S/c^3 with S = sin(...) = +-1,
        # the jerk like 3/c^5; of the slider -S/c, -1/c^3 and -3 S/c^5.
        size, side = np.abs(omega3), np.sign(sine)
        leading = (
            omega3, still, sign * side * size, still, omega3, still,
            travel, -side * omega3, -sign * size, -side * omega3,
        )  # fmt: skip
        return infinite_where(dead, leading, rates)


class SliderCrankKind(Kind[SliderCrank]):
    """The slider-crank; its `apart` is h, from A to the slide's line, positive to the left."""

    slides = True
    dead = "the rod stands square to the slide"

    def sides_of(self, linkage: SliderCrank, sign: FloatArray) -> SliderCrankSides:
        ex, ey = np.cos(linkage.slide_angle), np.sin(linkage.slide_angle)
        rounding = 8 * EPS * (linkage.r2 + linkage.r3 + np.abs(linkage.offset))
        return SliderCrankSides(ex, ey, linkage.offset, linkage.r2, linkage.r3, sign, rounding)

    def span(self, linkage: SliderCrank, cosine: float = 1.0) -> Span:
        """2 r2 a = r3 + offset - r2, 2 r2 b = r3 - offset - r2: h = offset - r2 cos(phi) within +-r3."""
        r2, r3, offset = linkage.r2, linkage.r3 * cosine, linkage.offset
        low, high = offset - r2, offset + r2
        return Span(r3 + low, r3 + high, r3 - high, r3 - low, (r3 >= low) & (r3 >= -high))

    def shares(self, linkage: SliderCrank) -> FloatArray:
        """r3 - r2 - offset and r3 - r2 + offset, as shares of r2 + r3 + |offset|."""
        r2, r3, offset = linkage.r2, linkage.r3, linkage.offset
        room = r3 - r2
        return np.stack([room - offset, room + offset], axis=-1) / (r2 + r3 + np.abs(offset))[..., None]

    def even(self, linkage: SliderCrank) -> tuple[float, float]:
        span, (stretched, folded) = self.span(linkage), self.shares(linkage).tolist()
        scale = 2 * float(linkage.r2)
        a = float(span.a) / scale if abs(folded) > CHANGE else 1.0
        return a, float(span.b) / scale if abs(stretched) > CHANGE else 1.0

    def class_of(self, linkage: SliderCrank, tolerance: float) -> GrashofClass:
        shares = self.shares(linkage)
        if np.abs(shares).min() <= tolerance:
            return GrashofClass.CHANGE_POINT
        return GrashofClass.SLIDER_CRANK if shares.min() > 0 else GrashofClass.SLIDER_ROCKER

    def apart(self, linkage: SliderCrank, phi: FloatArray) -> FloatArray:
        return np.asarray(linkage.offset - linkage.r2 * np.cos(phi))

    def apart_on_line(self, linkage: SliderCrank) -> tuple[FloatArray, FloatArray]:
        return linkage.offset - linkage.r2, linkage.offset + linkage.r2

    def transmission(self, linkage: SliderCrank, apart: FloatArray) -> FloatArray:
        """Between the rod and the normal of the slide to its left, where O4 lies at infinity."""
        r3 = linkage.r3
        rounding = ROUNDING * (np.abs(apart) + r3)
        with np.errstate(invalid="ignore"):
            near, far = from_zero(r3 + apart, rounding), from_zero(r3 - apart, rounding)
            return 2 * np.arctan2(np.sqrt(near), np.sqrt(far))

    def coupler_rates(
        self, linkage: SliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        along, turn = theta2 - linkage.slide_angle, theta3 - linkage.slide_angle
        span = linkage.r3 * np.cos(turn)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            omega3 = -linkage.r2 * np.cos(along) / span
            return omega3, (linkage.r2 * np.sin(along) + linkage.r3 * np.sin(turn) * omega3**2) / span

    def carried(
        self, linkage: SliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        return np.asarray(-linkage.r2 / linkage.r3 * np.cos(theta2 - linkage.slide_angle))

    def output_rate(
        self, linkage: SliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        """Of r2 cos(theta2 - slide_angle) + r3 cos(theta3 - slide_angle)."""
        along, turn = theta2 - linkage.slide_angle, theta3 - linkage.slide_angle
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(linkage.r2 * (np.cos(along) * np.tan(turn) - np.sin(along)))

    def turning(
        self, linkage: SliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """In the ratio r3 cos(theta3 - e) : -r2 cos(theta2 - e) : 0, e the slide's direction."""
        size = linkage.r2 + linkage.r3
        omega2 = size * linkage.r3 * np.cos(theta3 - linkage.slide_angle)
        omega3 = -size * linkage.r2 * np.cos(theta2 - linkage.slide_angle)
        return omega2, omega3, np.zeros_like(omega3)

    def limits(self, linkage: SliderCrank) -> FloatArray:
        """O2, A and B in line: sin(theta3 - slide_angle) = offset / (r3 +- r2)."""
        r2, r3, offset = (x[..., None] for x in (linkage.r2, linkage.r3, linkage.offset))
        reach = np.concatenate([r3 + r2, r3 - r2], axis=-1)
        opposite = np.array([0.0, np.pi])
        with np.errstate(invalid="ignore"):
            level = np.sqrt((np.abs(reach) - np.abs(offset)) * (np.abs(reach) + np.abs(offset)))
            rise = np.arctan2(np.where(reach < 0, -offset, offset), linkage.assembly[..., None] * level)
        return np.asarray(linkage.slide_angle[..., None] + rise + opposite)

    def turned(
        self, linkage: SliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Of h = r3 sin(theta3 - slide_angle), whose left side is offset - r2 sin(theta2 - slide_angle)."""
        along, turn = theta2 - linkage.slide_angle, theta3 - linkage.slide_angle
        by = np.stack([-np.sin(along), -np.sin(turn), np.ones_like(theta3)], axis=-1)
        with np.errstate(divide="ignore", invalid="ignore"):
            return by / (linkage.r3 * np.cos(turn))[..., None], np.zeros_like(by)

    def way_to_4(self, linkage: SliderCrank) -> tuple[FloatArray, tuple[tuple[int, FloatArray], ...]]:
        return linkage.o2, ((2, linkage.r2), (3, linkage.r3))

    def b_from(self, linkage: SliderCrank) -> FloatArray:
        return np.zeros_like(linkage.r2)

    def direction4(self, linkage: SliderCrank, theta4: FloatArray) -> FloatArray:
        """Along the slide."""
        return np.where(np.isnan(theta4), np.nan, linkage.slide_angle)
