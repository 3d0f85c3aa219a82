"""Crank-rockers by their limit positions: families, and their scale, direction and place in the plane."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, Limits
from grashof.synth.loop.dyad import Bars, ClosingDyad, coupler_of
from grashof.synth.programme.start import Start
from grashof.synth.starts.strokes.stroke_kind import KEPT, POSITIONS, StrokeKind, across
from grashof.synth.theory.limit_positions import Family, StrokeLinkages, families_of, mirrored

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


@dataclass(frozen=True, slots=True)
class RockerKind(StrokeKind):
    """Of any scale; the ground line, from O2 to O4, counts as 1."""

    what: ClassVar[str] = "crank-rockers"
    advised: ClassVar[str] = "swing"
    dyad: ClassVar[type[ClosingDyad]] = Bars
    kept: ClassVar[frozenset[str]] = KEPT | {"r1", "r4", "o4", "ground_angle_deg", "output_swing_deg"}

    def families(self, *, elsewhere: bool) -> list[tuple[Family, bool]]:
        families = families_of(self.task.swing, self.task.time_ratio)
        if self.wanted.theta2_start_deg is None and not elsewhere:
            return [(family, False) for family in families]
        return [each for family in families for each in ((family, False), (partial(mirrored, family), True))]

    def inside(self, members: StrokeLinkages) -> FloatArray:
        r1, r2, r3, r4 = lengths = members.lengths.T
        turns = np.minimum(r3 + r4 - r1 - r2, r1 - r2 - np.abs(r3 - r4)) / lengths.sum(axis=0)
        low, high = self._scales(members)
        ratio = lengths.max(axis=0) / lengths.min(axis=0)
        return self.least(members, ratio, turns, self._angle(members), [np.log(high / low)])

    def factor(self, members: StrokeLinkages, preferred: float | FloatArray = 1.0) -> FloatArray:
        low, high = self._scales(members)
        factor: FloatArray = np.minimum(np.maximum(preferred, low), high)
        return factor

    def diagonals(self, members: StrokeLinkages) -> FloatArray:
        _, r2, *others = members.lengths.T[..., None]
        a = r2 * np.exp(1j * np.linspace(0, TURN, POSITIONS))
        b = a + np.nan_to_num(self._to_b(members, 1.0, a, *others))
        return across(np.concatenate([a, b, np.ones_like(a[:, :1])], axis=1))

    def put(self, members: StrokeLinkages, factor: FloatArray) -> ComplexArray:
        return self._pivots(members, factor * members.lengths[:, 0], np.zeros(len(members)))

    def put_anywhere(self, members: StrokeLinkages, room: Box, rng: np.random.Generator) -> ComplexArray:
        size, (low, high) = self.task.size, self._scales(members)
        low, high = np.maximum(low, np.minimum(size / 30, high)), np.minimum(high, np.maximum(30 * size, low))
        r1 = members.lengths[:, 0] * np.exp(rng.uniform(np.log(low), np.log(np.maximum(high, low))))
        preferred, share = rng.uniform(-np.pi, np.pi, len(r1)), rng.uniform(0, 1, (len(r1), 2))
        return self._pivots(members, r1, preferred, share, room)

    def moving(
        self, members: StrokeLinkages, points: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray, FloatArray]:
        o2, o4 = points.T[..., None]
        _, r2, *others = (members.lengths / members.lengths[:, :1]).T[..., None] * np.abs(o4 - o2)
        theta2 = np.stack(self.ends(members), axis=-1) + np.angle(o4 - o2)
        crank = r2 * np.exp(1j * theta2)
        a = o2 + crank
        return points[:, 1], a, a + self._to_b(members, o4 - o2, crank, *others), theta2

    def in_boxes(self, a: FloatArray, b: FloatArray) -> bool:
        for box, places in ((self.wanted.a, a), (self.wanted.b, b)):
            if box is not None:
                x, y = places.T
                if x.min() < box.x[0] or x.max() > box.x[1] or y.min() < box.y[0] or y.max() > box.y[1]:
                    return False
        return True

    def worst(self, start: Start) -> float:
        r1, r2, r3, r4 = start.lengths
        cosines = [(r3**2 + r4**2 - end**2) / (2 * r3 * r4) for end in (r1 - r2, r1 + r2)]
        return float(np.arccos(max(map(abs, cosines))))

    def _pivots(
        self,
        members: StrokeLinkages,
        r1: FloatArray,
        preferred: FloatArray,
        share: FloatArray | None = None,
        room: Box | None = None,
    ) -> ComplexArray:
        """O2 and O4, (n, 2), where O2O4 has the direction that the limits fix, or one near a preferred."""
        ground, pivots = Ground.of(self.wanted), []
        for k, angle in enumerate(self._angle(members).tolist()):
            length = float(r1[k])
            towards = ground.direction(length, float(preferred[k])) if np.isnan(angle) else angle
            pivots.append(ground.pivots(length, towards, None if share is None else share[k], room))
        return np.array(pivots, dtype=np.complex128).reshape(-1, 2)

    def _to_b(
        self, members: StrokeLinkages, ground: ComplexArray | float, crank: ComplexArray, *lengths: FloatArray
    ) -> ComplexArray:
        """From A to B, (n, N), by the ground line, the crank and the lengths that follow r2."""
        r3, r4 = lengths
        return coupler_of(Bars(), ground, crank, r3, r4, members.assembly[:, None])[0]

    def _scales(self, members: StrokeLinkages) -> FloatArray:
        ground = Ground.of(self.wanted).lengths(self._angle(members))
        return scales(members.lengths, self.wanted.link_lengths, ground)

    def _angle(self, members: StrokeLinkages) -> FloatArray:
        """Direction of O2O4 that the limits fix, rad; NaN where they do not; shape (n,)."""
        start, fixed = self.wanted.theta2_start_deg, self.wanted.angle_of("ground_angle_deg")
        if start is not None:
            turned: FloatArray = np.radians(start) - self.ends(members)[0]
            return turned
        return np.full(len(members.share), np.nan if fixed is None else fixed)
