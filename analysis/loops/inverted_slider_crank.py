"""The loop of an inverted slider-crank: a rod, pinned to the crank, through a swinging block (dyad RPR)."""

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
from grashof.problems.values.linkages.inverted_slider_crank import InvertedSliderCrank


class InvertedSides(NamedTuple):
    """The ground vector, length, offset, assembly sign, and what is rounding of a length."""

    gx: FloatArray
    gy: FloatArray
    r2: FloatArray
    offset: FloatArray
    sign: FloatArray
    rounding: FloatArray

    def close(self, theta2: FloatArray) -> Loop:  # closure: RPR
        """With l from A along the rod to B: e^(i theta3) (l - i offset) = O4 - A (Norton, sec. 4.7).

        l comes from the product (s - |offset|)(s + |offset|) of s = |O4 - A|, which keeps its digits near the
        dead positions.
        """
        gx, gy, r2, offset, sign, rounding = self
        cos2, sin2 = np.cos(theta2), np.sin(theta2)
        ax, ay = r2 * cos2, r2 * sin2
        x, y = gx - ax, gy - ay
        diagonal, away = np.hypot(x, y), np.abs(offset)
        product = (diagonal - away) * (diagonal + away)
        if np.any(product < 0):
            product = np.where((product < 0) & (away - diagonal <= rounding), 0.0, product)
        with np.errstate(invalid="ignore", divide="ignore"):
            ab = sign * np.sqrt(product)
            cosine, sine = ab / diagonal, offset / diagonal
            x, y = x / diagonal, y / diagonal
            cos3, sin3 = x * cosine - y * sine, y * cosine + x * sine
            return Loop(cos2, sin2, cos3, sin3, -sin3, cos3, cosine, ax, ay, ab)

    def rates(
        self, loop: Loop, dead: BoolArray, omega2: FloatArray, alpha2: FloatArray, jerk2: FloatArray
    ) -> tuple[FloatArray, ...]:
        """The loop, differentiated: its components along the rod and square to it."""
        _, _, r2, offset, sign, _ = self
        cosine = loop.cos2 * loop.cos3 + loop.sin2 * loop.sin3  # of theta2 - theta3
        sine = loop.sin2 * loop.cos3 - loop.cos2 * loop.sin3
        driven = Driven.of(r2, omega2, alpha2, jerk2)
        along = [push * sine + pull * cosine for push, pull in zip(*driven, strict=True)]  # of O4 - A
        beside = [pull * sine - push * cosine for push, pull in zip(*driven, strict=True)]
        over = 1 / (np.where(dead, np.copysign(0.0, sign), loop.ab) if dead.any() else loop.ab)
        omega = beside[0] * over
        square = omega**2
        velocity = along[0] - offset * omega
        alpha = (beside[1] - offset * square - 2 * omega * velocity) * over
        acceleration = along[1] + loop.ab * square - offset * alpha
        mixed = omega * alpha
        turn = (beside[2] - 3 * (offset * mixed + alpha * velocity + omega * acceleration)) * over
        jerk = along[2] - offset * turn + 3 * (loop.ab * mixed + square * velocity)
        third = turn + square * omega
        rates = omega, omega, alpha, alpha, third, third, loop.ab, velocity, acceleration, jerk
        if not dead.any():
            return rates
        # omega goes like 1/l, alpha like offset / l^3, the jerk like 3 offset^2 / l^5; of the
        # rod -offset / l, -offset^2 / l^3 and -3 offset^3 / l^5.
        size, side = np.abs(omega), np.sign(offset)
        bend = sign * side * size
        leading = (
            omega, omega, bend, bend, omega, omega, loop.ab, -side * omega, -sign * size, -side * omega
        )  # fmt: skip
        return infinite_where(dead, leading, rates)


class InvertedSliderCrankKind(Kind[InvertedSliderCrank]):
    """The inverted slider-crank; its `apart` is the diagonal A-O4."""

    slides = True
    dead = "the block is at A"

    def sides_of(self, linkage: InvertedSliderCrank, sign: FloatArray) -> InvertedSides:
        ground = linkage.o4 - linkage.o2
        reach = np.abs(linkage.o2).sum(axis=-1) + np.abs(linkage.o4).sum(axis=-1)
        rounding = 8 * EPS * (reach + linkage.r2 + np.abs(linkage.offset))
        return InvertedSides(ground[..., 0], ground[..., 1], linkage.r2, linkage.offset, sign, rounding)

    def span(self, linkage: InvertedSliderCrank, cosine: float = 1.0) -> Span:
        """4 r1 r2 a = (r1 - r2)^2 - (offset / cosine)^2; nothing limits the diagonal where it is longest."""
        least, most, away = self._diagonals(linkage)
        away = away / cosine
        a, more_a = (least - away) * (least + away), (most - away) * (most + away)
        endless = np.full_like(a, np.inf)
        return Span(a, more_a, endless, endless, away <= most)

    def shares(self, linkage: InvertedSliderCrank) -> FloatArray:
        """1, and |r1 - r2| - |offset| as a share of r1 + r2 + |offset|."""
        least, most, away = self._diagonals(linkage)
        folded = (least - away) / (most + away)
        return np.stack([np.ones_like(folded), folded], axis=-1)

    def even(self, linkage: InvertedSliderCrank) -> tuple[float, float]:
        least, most, away = map(float, self._diagonals(linkage))
        scale = (most - least) * (most + least)  # 4 r1 r2
        if not scale > 0:
            return np.nan, np.nan
        if abs(least - away) > CHANGE * (most + away):
            return (least - away) * (least + away) / scale, np.inf
        narrow = least**2 / scale  # the diagonal is shortest there
        return narrow if narrow > CHANGE else 1.0, np.inf

    def class_of(self, linkage: InvertedSliderCrank, tolerance: float) -> GrashofClass:
        share = float(self.shares(linkage)[1])
        if abs(share) <= tolerance:
            return GrashofClass.CHANGE_POINT
        if share < 0:
            return GrashofClass.INVERTED_SLIDER_ROCKER
        return GrashofClass.CRANK_SHAPER if linkage.r2 < linkage.r1 else GrashofClass.WHITWORTH

    def apart(self, linkage: InvertedSliderCrank, phi: FloatArray) -> FloatArray:
        """The squared diagonal as (r1 - r2)^2 + 4 r1 r2 sin^2(phi/2), without cancellation near 0."""
        r1, r2 = linkage.r1, linkage.r2
        return np.asarray(np.sqrt((r1 - r2) ** 2 + 4 * r1 * r2 * np.sin(phi / 2) ** 2))

    def apart_on_line(self, linkage: InvertedSliderCrank) -> tuple[FloatArray, FloatArray]:
        return np.abs(linkage.r1 - linkage.r2), linkage.r1 + linkage.r2

    def transmission(self, linkage: InvertedSliderCrank, apart: FloatArray) -> FloatArray:
        """Up to pi/2: sin mu = l / |A-O4|, by its half angle."""
        away = np.abs(linkage.offset)
        with np.errstate(invalid="ignore"):
            near = from_zero(apart - away, ROUNDING * (apart + away))
            return 2 * np.arctan2(np.sqrt(near), np.sqrt(apart + away))

    def coupler_rates(
        self, linkage: InvertedSliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        r2, turn = linkage.r2, theta2 - theta3
        along, across = r2 * np.cos(turn), r2 * np.sin(turn)
        ab = linkage.r1 * np.cos(linkage.theta1 - theta3) - along
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            omega3 = -along / ab
            velocity = across - linkage.offset * omega3
            return omega3, (across - linkage.offset * omega3**2 - 2 * omega3 * velocity) / ab

    def carried(
        self, linkage: InvertedSliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        diagonal = self.apart(linkage, theta2 - linkage.theta1)
        return np.asarray(-linkage.r2 / diagonal * np.cos(theta2 - theta3))

    def output_rate(
        self, linkage: InvertedSliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> FloatArray:
        return self.coupler_rates(linkage, theta2, theta3, theta4)[0]

    def turning(
        self, linkage: InvertedSliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """In the ratio l : -r2 cos(theta2 - theta3), l from A along the rod to B; the block turns with it."""
        size, along = linkage.r1 + linkage.r2, linkage.r2 * np.cos(theta2 - theta3)
        omega3 = -size * along
        return size * (linkage.r1 * np.cos(linkage.theta1 - theta3) - along), omega3, omega3

    def limits(self, linkage: InvertedSliderCrank) -> FloatArray:
        """Crank square to the rod: r1 sin(theta1 - theta3) = +-r2 - offset, theta2 = theta3 +- 90 deg."""
        side = np.array([1.0, -1.0])
        r1, r2, offset = (x[..., None] for x in (linkage.r1, linkage.r2, linkage.offset))
        beside = side * r2 - offset
        with np.errstate(invalid="ignore"):
            along = linkage.assembly[..., None] * np.sqrt((r1 - beside) * (r1 + beside))
            theta3 = linkage.theta1[..., None] - np.arctan2(beside, along)
        return np.asarray(theta3 + side * np.pi / 2)

    def turned(
        self, linkage: InvertedSliderCrank, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """With l from A to B, l dtheta3 = doffset + dr1 sin(theta1 - theta3) - dr2 sin(theta2 - theta3)."""
        ab = linkage.r1 * np.cos(linkage.theta1 - theta3) - linkage.r2 * np.cos(theta2 - theta3)
        parts = np.sin(linkage.theta1 - theta3), -np.sin(theta2 - theta3), np.ones_like(theta3)
        with np.errstate(divide="ignore", invalid="ignore"):
            by: FloatArray = np.stack(parts, axis=-1) / ab[..., None]
        return by, by

    def way_to_4(self, linkage: InvertedSliderCrank) -> tuple[FloatArray, tuple[tuple[int, FloatArray], ...]]:
        return linkage.o4, ()

    def b_from(self, linkage: InvertedSliderCrank) -> FloatArray:
        return linkage.offset

    @staticmethod
    def _diagonals(linkage: InvertedSliderCrank) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The shortest and the longest diagonal, and the offset's size."""
        return np.abs(linkage.r1 - linkage.r2), linkage.r1 + linkage.r2, np.abs(linkage.offset)
