"""Crank-shapers, inverted slider-cranks whose block swings, by their limit positions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.loop.dyad import Block, ClosingDyad, coupler_of, root_or_zero
from grashof.synth.programme.start import Start
from grashof.synth.starts.strokes.rocker_kind import Ground, RockerKind, scales
from grashof.synth.starts.strokes.stroke_kind import KEPT
from grashof.synth.theory.limit_positions import Family, StrokeLinkages, crank_shapers

_LEAST = 1e-30  # scale


@dataclass(frozen=True, slots=True)
class ShaperKind(RockerKind):
    """Of any scale, as crank-rockers; their time ratio follows from the swing."""

    what: ClassVar[str] = "crank-shapers"
    advised: ClassVar[str] = ""
    dyad: ClassVar[type[ClosingDyad]] = Block
    kept: ClassVar[frozenset[str]] = KEPT | {"r1", "o4", "offset", "ground_angle_deg", "output_swing_deg"}
    mirrored: ClassVar[tuple[bool, ...]] = (False,)  # that is a family of its own

    def families(self, *, elsewhere: bool) -> list[tuple[Family, bool]]:
        wanted, swing = self.wanted, self.task.swing
        if swing is None:
            raise TypeError("only a swing has crank-shapers")
        least, most = wanted.offset or (-1.0, 1.0)
        sided = wanted.offset is not None or wanted.theta2_start_deg is not None or elsewhere
        sides = [1.0] * (most >= 0) + [-1.0] * (least < 0 and (sided or most < 0))
        return [(partial(crank_shapers, swing, side), False) for side in sides]

    def inside(self, members: StrokeLinkages) -> FloatArray:
        r1, r2, offset = members.lengths.T
        turns = (r1 - r2 - np.abs(offset)) / (r1 + r2 + np.abs(offset))
        low, high = self._scales(members)
        return self.least(members, r1 / r2, turns, self._angle(members), [np.log(high / low)])

    def worst(self, start: Start) -> float:
        r1, r2, _, offset = start.lengths
        return float(np.arccos(min(abs(offset) / abs(r1 - r2), 1.0)))

    def _to_b(
        self, members: StrokeLinkages, ground: ComplexArray | float, crank: ComplexArray, *lengths: FloatArray
    ) -> ComplexArray:
        """From A to B, the foot of the perpendicular from O4 on the rod."""
        (offset,) = lengths
        return coupler_of(Block(), ground, crank, offset, offset, 1.0, root_or_zero)[0]

    def _scales(self, members: StrokeLinkages) -> FloatArray:
        r1, r2, *_ = self.wanted.link_lengths
        ground = Ground.of(self.wanted).lengths(self._angle(members))
        low, high = scales(members.lengths[:, :2], (r1, r2), ground)
        if self.wanted.offset is None:
            return np.stack([low, high])
        offset, (least, most) = members.lengths[:, 2], self.wanted.offset
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.sort(np.stack([least / offset, most / offset]), axis=0)
        ends = np.maximum(ends, [[_LEAST], [_LEAST**2]])  # the greatest below the least: at no scale
        still, zero_allowed = offset == 0, least <= 0 <= most
        low = np.maximum(low, np.where(still, _LEAST, ends[0]))
        high = np.minimum(high, np.where(still, np.inf if zero_allowed else _LEAST**2, ends[1]))
        return np.stack([low, high])
