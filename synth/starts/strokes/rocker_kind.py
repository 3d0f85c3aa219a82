"""Crank-rockers by their limit positions: their families, and where their members lie."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from grashof.problems import Box
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.loop.dyad import Bars, ClosingDyad, coupler_of
from grashof.synth.programme.start import Start
from grashof.synth.starts.strokes.member_choice import diagonals
from grashof.synth.starts.strokes.placing import Ground, scales
from grashof.synth.starts.strokes.stroke_kind import KEPT, StrokeKind
from grashof.synth.theory.limit_positions import Family, StrokeLinkages, families_of


@dataclass(frozen=True, slots=True)
class RockerKind(StrokeKind):
    """Of any scale; the ground line, from O2 to O4, counts as 1."""

    what: ClassVar[str] = "crank-rockers"
    advised: ClassVar[str] = "swing"
    dyad: ClassVar[type[ClosingDyad]] = Bars
    kept: ClassVar[frozenset[str]] = KEPT | {"r1", "r4", "o4", "ground_angle_deg", "output_swing_deg"}

    def families(self, *, elsewhere: bool) -> list[tuple[Family, bool]]:
        families = families_of(self.task.swing, self.task.time_ratio)
        either = (False, True) if self.wanted.theta2_start_deg is not None else (False,)
        return [(family, mirrored) for family in families for mirrored in either]

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
        return diagonals(members)

    def put(self, members: StrokeLinkages, factor: FloatArray) -> ComplexArray:
        ground = Ground.of(self.wanted)
        pivots = []
        for k, angle in enumerate(self._angle(members).tolist()):
            r1 = float(factor[k] * members.lengths[k, 0])
            towards = ground.direction(r1, 0.0) if np.isnan(angle) else angle
            pivots.append(ground.pivots(r1, towards))
        return np.array(pivots, dtype=np.complex128).reshape(-1, 2)

    def put_anywhere(self, members: StrokeLinkages, room: Box, rng: np.random.Generator) -> ComplexArray:
        ground, size = Ground.of(self.wanted), self.task.size
        low, high = self._scales(members)
        low, high = np.maximum(low, np.minimum(size / 30, high)), np.minimum(high, np.maximum(30 * size, low))
        r1 = members.lengths[:, 0] * np.exp(rng.uniform(np.log(low), np.log(np.maximum(high, low))))
        preferred, fixed = rng.uniform(-np.pi, np.pi, len(r1)), self._angle(members)
        share = rng.uniform(0, 1, (len(r1), 2))
        pivots = []
        for k, angle in enumerate(fixed.tolist()):
            towards = ground.direction(float(r1[k]), float(preferred[k])) if np.isnan(angle) else angle
            pivots.append(ground.pivots(float(r1[k]), towards, share[k], room))
        return np.array(pivots, dtype=np.complex128).reshape(-1, 2)

    def moving(
        self, members: StrokeLinkages, points: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray, FloatArray]:
        o2, o4 = points.T[..., None]
        _, r2, r3, r4 = (members.lengths / members.lengths[:, :1]).T[..., None] * np.abs(o4 - o2)
        theta2 = np.stack(self.ends(members), axis=-1) + np.angle(o4 - o2)
        crank = r2 * np.exp(1j * theta2)
        coupler, _ = coupler_of(Bars(), o4 - o2, crank, r3, r4, members.assembly[:, None])
        return points[:, 1], o2 + crank, o2 + crank + coupler, theta2

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
