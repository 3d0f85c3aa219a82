"""Where the two pivots of a cylinder may be, and how far one is beyond its limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import CylinderSpec
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.synth.cylinder.planes import Driven, Plane

INSET = 1e-7  # share: limits are kept with this to spare, so that the judge finds them kept


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """The limits of a cylinder on one link.

    Parameters
    ----------
    middle, joints, reach : complex, ndarray of complex, shape (J,), float, length
        Of the link, see `Plane`: its pivot Q may be that far from the middle.
    low, high : ndarray, shape (2,), length
        Corners of the box in which its base C may be.
    closed, ratio, force : pair of float
        Limits of the closed length, of the greatest length over it, and of the force.
    """

    middle: complex
    joints: ComplexArray
    reach: float
    low: FloatArray
    high: FloatArray
    closed: Limits
    ratio: float
    force: float

    @classmethod
    def of(cls, plane: Plane, spec: CylinderSpec, around: ComplexArray, force: float = np.inf) -> Room:
        """The room of a cylinder.

        Parameters
        ----------
        plane : Plane
            Of the link that it acts on.
        spec : CylinderSpec
        around : ndarray of complex, shape (N,), length
            Places that the linkage reaches.
        force : float
            Greatest force that is allowed.

        Notes
        -----
        Sides of the base that the problem leaves open are those of the box around the linkage, further out by
        its diagonal, or by what the least closed length takes.
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

    def beyond(self, found: Driven) -> FloatArray:
        """How far cylinders are beyond the limits, in logarithms; shape (K,), 0 where all are kept."""
        tiny = np.finfo(np.float64).tiny
        with np.errstate(divide="ignore"):
            closed = np.log(np.maximum(found.closed, tiny))
            over = np.maximum(np.log(np.maximum(self.closed[0], tiny)) - closed, 0.0)
            over += np.maximum(closed - np.log(self.closed[1]), 0.0)
            over += np.maximum(np.log(found.ratio) - np.log(self.ratio), 0.0)
            if np.isfinite(self.force):
                over += np.maximum(np.log(np.maximum(found.force, tiny)) - np.log(self.force), 0.0)
        return np.asarray(over)

    def kept(self, points: ComplexArray, bases: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Pivots put back to where they may be."""
        off = points - self.middle
        size = np.abs(off)
        points = self.middle + off * np.where(size > self.reach, self.reach / np.maximum(size, 1e-300), 1.0)
        x = np.clip(bases.real, self.low[0], self.high[0])
        return points, x + 1j * np.clip(bases.imag, self.low[1], self.high[1])
