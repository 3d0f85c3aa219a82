"""The loop of a slider-crank: a rod, pinned to the crank, and a slider on the ground (dyad RRP)."""

from __future__ import annotations

import numpy as np

from grashof.analysis.loops.loop import (
    CHANGE,
    FirstLoop,
    GrashofClass,
    Span,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.slider_crank import SliderCrank


class SliderCrankLoop(FirstLoop[SliderCrank]):
    """The slider-crank; its `apart` is h, from A to the slide's line, positive to the left."""

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

    def limits(self, linkage: SliderCrank) -> FloatArray:
        """O2, A and B in line: sin(theta3 - slide_angle) = offset / (r3 +- r2)."""
        r2, r3, offset = (x[..., None] for x in (linkage.r2, linkage.r3, linkage.offset))
        reach = np.concatenate([r3 + r2, r3 - r2], axis=-1)
        opposite = np.array([0.0, np.pi])
        with np.errstate(invalid="ignore"):
            level = np.sqrt((np.abs(reach) - np.abs(offset)) * (np.abs(reach) + np.abs(offset)))
            rise = np.arctan2(np.where(reach < 0, -offset, offset), linkage.assembly[..., None] * level)
        return np.asarray(linkage.slide_angle[..., None] + rise + opposite)
