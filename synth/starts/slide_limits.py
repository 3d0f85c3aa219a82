"""Stroke and time ratio: slider-cranks in closed form; see `limit_positions`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from grashof.problems import SliderCrank
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.starts.limit_positions import LimitPositions, Places
from grashof.synth.starts.member_choice import slide_diagonals
from grashof.synth.theory.limit_positions import Members

_KEPT = (
    "transmission_min_deg", "link_length", "r2", "r3", "offset", "link_ratio_max", "o2", "slide_angle_deg",
    "theta2_start_deg", "driver_sense", "stroke", "time_ratio", "coupler_arms",
)  # fmt: skip


@dataclass(frozen=True)
class SlideLimits(LimitPositions):
    """All slider-cranks with a stroke and a time ratio; the stroke is their scale."""

    beginning: ClassVar[str] = "computing slider-cranks by their limit positions"
    mechanism: ClassVar[str] = SliderCrank.MECHANISM
    kept: ClassVar[tuple[str, ...]] = _KEPT

    @property
    def handed(self) -> bool:
        """Also where the offset is limited, whose sign the mirror image changes."""
        return super().handed or self.wanted.offset is not None

    @property
    def fixed_angle(self) -> float | None:
        """Direction of the slide that is asked for, deg."""
        return self.wanted.slide_angle_deg

    def _links(self, members: Members) -> FloatArray:
        """r2 and r3."""
        return members.lengths[:, :2]

    def _turns(self, members: Members) -> FloatArray:
        r2, r3, offset = members.lengths.T
        room: FloatArray = (r3 - r2 - np.abs(offset)) / (r3 + r2 + np.abs(offset))
        return room

    def _fit(self, members: Members) -> FloatArray:
        """Of the links in logarithms, of the offset in strokes."""
        sizes, wanted = self.task.size * members.lengths, self.wanted
        inside = []
        for (low, high), size in zip(wanted.link_lengths[1:3], sizes.T[:2], strict=True):
            with np.errstate(divide="ignore"):
                inside += [np.log(size) - np.log(low), np.log(high) - np.log(size)]
        if wanted.offset is not None:
            low, high = wanted.offset
            inside += [(sizes[:, 2] - low) / self.task.size, (high - sizes[:, 2]) / self.task.size]
        fit: FloatArray = np.min(inside, axis=0)
        return fit

    def _scales(self, members: Members) -> FloatArray:
        """The stroke, whatever the member."""
        return np.full((2, len(members.share)), self.task.size)

    def _diagonals(self, members: Members) -> FloatArray:
        return slide_diagonals(members)

    def _taken(self, members: Members, mirrored: bool) -> Members:
        """Mirrored about the slide."""
        if not mirrored:
            return members
        return replace(members.mirrored, lengths=members.lengths * (1, 1, -1), assembly=members.assembly)

    def _moving(self, members: Members, at: ComplexArray) -> Places:
        """From O2 and what lies a stroke from it in the direction of the slide, (n, 2)."""
        o2, end = at.T[..., None]
        stroke = np.abs(end - o2)
        along = (end - o2) / stroke
        r2, r3, offset = members.lengths.T[..., None] * stroke
        theta2 = self._ends(members) + np.angle(along)
        crank = r2 * np.exp(1j * theta2)
        apart = offset - (along.conj() * crank).imag
        b = o2 + crank + along * (np.sqrt((r3 - apart) * (r3 + apart)) + 1j * apart)
        return o2[:, 0], (b[:, :1] + r3 * along)[:, 0], o2 + crank, b, theta2
