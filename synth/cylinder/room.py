"""Where the two pivots of a cylinder may be, and how far one is beyond its limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import CylinderSpec
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.synth.cylinder.planes import Performance, Plane

INSET = 1e-7  # share: limits are kept with this to spare, so that the judge finds them kept
_TINY = float(np.finfo(np.float64).tiny)


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """The limits of a cylinder on one link."""

    middle: complex  # of the link, as `joints` and `reach`, see `Plane`: its pivot may be that far from there
    joints: ComplexArray
    reach: float
    low: FloatArray  # corners (2,) of the box in which its base may be
    high: FloatArray
    closed: Limits
    ratio: float  # most of the greatest length over the closed one
    force: float

    @classmethod
    def of(cls, plane: Plane, spec: CylinderSpec, around: ComplexArray, force: float = np.inf) -> Room:
        """The room of a cylinder on the link of a plane.

        Sides of the base that the problem leaves open are those of the box around the places (N,) that the
        linkage reaches, further out by its diagonal, or by what the least closed length takes.
        """
        corners = np.array([[np.min(part), np.max(part)] for part in (around.real, around.imag)])
        closed = (0.0, np.inf) if spec.closed is None else spec.closed
        out = max(float(np.hypot(*np.ptp(corners, axis=1))), spec.ratio_max * closed[0])
        low, high = corners[:, 0] - out, corners[:, 1] + out
        if spec.base is not None:
            sides = np.array([spec.base.x, spec.base.y])
            fixed_low, fixed_high = np.isfinite(sides).T
            low = np.where(fixed_low, sides[:, 0], np.minimum(low, sides[:, 1]))
            high = np.where(fixed_high, sides[:, 1], np.maximum(high, sides[:, 0]))
        ratio = 1 + (spec.ratio_max - 1) * (1 - INSET)
        least, most = closed[0] * (1 + INSET), closed[1] * (1 - INSET)
        if least > most:
            least = most = closed[0] / 2 + closed[1] / 2
        carried = plane.middle, plane.joints, plane.reach
        return cls(*carried, low, high, (least, most), ratio, force * (1 - INSET))

    def left(self, found: Performance) -> FloatArray:
        """What limits leave K cylinders, in logarithms, a column each, negative beyond."""
        with np.errstate(divide="ignore"):
            closed, force = (np.log(np.maximum(each, _TINY)) for each in (found.closed, found.force))
            columns = [np.log(self.ratio) - np.log(found.ratio)]
            columns += [closed - np.log(self.closed[0])] if self.closed[0] > 0 else []
            columns += [np.log(self.closed[1]) - closed] if np.isfinite(self.closed[1]) else []
            columns += [np.log(self.force) - force] if np.isfinite(self.force) else []
        return np.stack(columns, axis=1)

    def beyond(self, found: Performance) -> FloatArray:
        """How far cylinders are beyond the limits, in logarithms; shape (K,), 0 where all are kept."""
        return np.asarray(np.maximum(-self.left(found), 0.0).sum(axis=1))

    def kept(self, points: ComplexArray, bases: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Pivots put back to where they may be."""
        off = points - self.middle
        size = np.abs(off)
        points = self.middle + off * np.where(size > self.reach, self.reach / np.maximum(size, 1e-300), 1.0)
        x = np.clip(bases.real, self.low[0], self.high[0])
        return points, x + 1j * np.clip(bases.imag, self.low[1], self.high[1])
