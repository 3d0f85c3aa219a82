"""The loop of a four-bar: two bars, pinned to the crank, to each other and to the ground (dyad RRR)."""

from __future__ import annotations

import numpy as np

from grashof.analysis.loops.loop import (
    CHANGE,
    FirstLoop,
    GrashofClass,
    Span,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.four_bar import FourBar

_BY_SHORTEST = (
    GrashofClass.DOUBLE_CRANK,
    GrashofClass.CRANK_ROCKER,
    GrashofClass.DOUBLE_ROCKER,
    GrashofClass.ROCKER_CRANK,
)
FOUR_BAR_CLASSES = (*_BY_SHORTEST, GrashofClass.CHANGE_POINT, GrashofClass.NON_GRASHOF)


class FourBarLoop(FirstLoop[FourBar]):
    """The four-bar; its `apart` is the diagonal A-O4."""

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
