"""Crank-rockers put into the plane: scale, direction and place, as limits of lengths and pivots allow."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import FloatArray, Limits

_SAME = 1e-9  # of directions and of shares of a length
_LEAST, _MOST = 1e-30, 1e30  # of scales


@dataclass(frozen=True, slots=True)
class Ground:
    """Where O4 may lie as seen from O2."""

    o2: Box
    o4: Box
    x: Limits  # limits of O4 - O2, as y; length
    y: Limits

    @classmethod
    def of(cls, wanted: Requirements) -> Ground:
        """As resolved requirements have it."""
        o2, o4 = wanted.o2 or Box(), wanted.o4 or Box()
        x, y = ((four[0] - two[1], four[1] - two[0]) for two, four in ((o2.x, o4.x), (o2.y, o4.y)))
        return cls(o2, o4, x, y)

    def lengths(self, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Least and greatest r1 in directions of the ground line (n,); of NaN, in any direction."""
        low, high = np.zeros_like(angle), np.full_like(angle, np.inf)
        for (least, most), along in ((self.x, np.cos(angle)), (self.y, np.sin(angle))):
            still = np.abs(along) < _SAME
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                ends = np.sort(np.stack([least / along, most / along]), axis=0)
            inside = least <= _SAME and most >= -_SAME
            low = np.maximum(low, np.where(still, 0.0 if inside else np.inf, ends[0]))
            high = np.minimum(high, np.where(still, np.inf if inside else 0.0, ends[1]))
        near = math.hypot(*(max(least, -most, 0.0) for least, most in (self.x, self.y)))
        far = math.hypot(*(max(-least, most) for least, most in (self.x, self.y)))
        free = np.isnan(angle)
        return np.where(free, near, low), np.where(free, far, high)

    def direction(self, r1: float, preferred: float) -> float:
        """The direction of O2O4 nearest to a preferred, rad, in which O4 may be at a distance r1 from O2."""
        if np.isinf([*self.x, *self.y]).all():
            return preferred
        corners = [preferred]
        for side in self.x:
            if abs(side) <= r1:
                corners += [np.arccos(side / r1), -np.arccos(side / r1)]
        for side in self.y:
            if abs(side) <= r1:
                corners += [np.arcsin(side / r1), np.pi - np.arcsin(side / r1)]
        tried = np.array(corners)
        slack = _SAME * r1
        inside = np.ones(len(tried), dtype=bool)
        for (least, most), at in ((self.x, r1 * np.cos(tried)), (self.y, r1 * np.sin(tried))):
            inside &= (at >= least - slack) & (at <= most + slack)
        turned = np.abs((tried - preferred + np.pi) % (2 * np.pi) - np.pi)
        return float(tried[np.argmin(np.where(inside, turned, np.inf))]) if inside.any() else preferred

    def pivots(
        self, r1: float, angle: float, share: FloatArray | None = None, room: Box | None = None
    ) -> tuple[complex, complex]:
        """O2, as near to the origin as it may be, or at shares (2,) of its room; and O4.

        `angle` in rad; `room` is where O2 is put that is not bounded.
        """
        way = r1 * np.exp(1j * angle)
        place = []
        sides = ((self.o2.x, self.o4.x, way.real), (self.o2.y, self.o4.y, way.imag))
        for axis, (two, four, step) in enumerate(sides):
            low, high = max(two[0], four[0] - step), min(two[1], four[1] - step)
            at = min(max(0.0, low), high)
            if share is not None and room is not None:
                least, most = (room.x, room.y)[axis]
                low, high = max(low, min(least, high)), min(high, max(most, low))
                at = low + float(share[axis]) * (high - low)
            place.append(at)
        o2 = complex(*place)
        return o2, o2 + way


def scales(lengths: FloatArray, limits: tuple[Limits, ...], r1: tuple[FloatArray, FloatArray]) -> FloatArray:
    """Least and greatest factor of lengths (n, 4), within limits of each and of r1; shape (2, n)."""
    low = np.max([least / each for (least, _), each in zip(limits, lengths.T, strict=True)], axis=0)
    high = np.min([most / each for (_, most), each in zip(limits, lengths.T, strict=True)], axis=0)
    low, high = np.maximum(low, r1[0] / lengths[:, 0]), np.minimum(high, r1[1] / lengths[:, 0])
    ends: FloatArray = np.clip([low, high], _LEAST, _MOST)
    return ends
