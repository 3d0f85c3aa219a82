"""The loop of an inverted slider-crank: a rod, pinned to the crank, through a swinging block (dyad RPR)."""

from __future__ import annotations

import numpy as np

from grashof.analysis.loops.loop import (
    CHANGE,
    FirstLoop,
    GrashofClass,
    Span,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.inverted_slider_crank import InvertedSliderCrank


class InvertedLoop(FirstLoop[InvertedSliderCrank]):
    """The inverted slider-crank; its `apart` is the diagonal A-O4."""

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

    def limits(self, linkage: InvertedSliderCrank) -> FloatArray:
        """Crank square to the rod: r1 sin(theta1 - theta3) = +-r2 - offset, theta2 = theta3 +- 90 deg."""
        side = np.array([1.0, -1.0])
        r1, r2, offset = (x[..., None] for x in (linkage.r1, linkage.r2, linkage.offset))
        beside = side * r2 - offset
        with np.errstate(invalid="ignore"):
            along = linkage.assembly[..., None] * np.sqrt((r1 - beside) * (r1 + beside))
            theta3 = linkage.theta1[..., None] - np.arctan2(beside, along)
        return np.asarray(theta3 + side * np.pi / 2)

    @staticmethod
    def _diagonals(linkage: InvertedSliderCrank) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The shortest and the longest diagonal, and the offset's size."""
        return np.abs(linkage.r1 - linkage.r2), linkage.r1 + linkage.r2, np.abs(linkage.offset)
