"""The frame of the search: a task moved to the origin and scaled to size 1."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from grashof.problems import Box, Requirements, Task
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.requirements.limit_kinds import Kind, Limit
from grashof.problems.values.requirements.named_limits import NamedLimits


@dataclass(frozen=True, slots=True)
class Frame:
    """Origin (centroid of the targets, complex) and scale (size of the task), in the problem's unit."""

    origin: complex
    scale: float
    scale_free: bool = False

    @classmethod
    def of(cls, task: Task) -> Frame:
        """The frame of a task."""
        return cls(complex(*task.middle), task.size, task.scale_free)

    def inward(self, points: FloatArray) -> ComplexArray:
        """Points (..., 2) of the problem as complex numbers in this frame."""
        return (points[..., 0] + 1j * points[..., 1] - self.origin) / self.scale

    def outward(self, points: ComplexArray) -> FloatArray:
        """Complex numbers (...) of this frame as points (..., 2) of the problem."""
        placed = np.asarray(points) * self.scale + self.origin
        return np.stack([placed.real, placed.imag], axis=-1)

    def requirements(self, requirements: Requirements) -> Requirements:
        """Resolved `requirements` with lengths in sizes and boxes in this frame."""
        full = requirements.resolved(self.scale, scale_free=self.scale_free)
        limits = {name: self._limit(getattr(full, name), limit) for name, limit in full.limited.items()}
        inside = [self.inward(corners) for corners in full.keep_out]
        areas = tuple(np.stack([corners.real, corners.imag], axis=-1) for corners in inside)
        return replace(full, **limits, keep_out=areas)

    def _limit(self, value: Any, limit: Limit) -> Any:
        """The value of a field in this frame."""
        if isinstance(value, Box):
            begin = self.origin if limit.kind is Kind.INSIDE else 0j
            return value.moved(begin, self.scale)
        power = limit.quantity.unit.lengths
        if not power:
            return value
        if isinstance(value, NamedLimits):
            return value.over(self.scale**power)
        return (
            tuple(each / self.scale**power for each in value)
            if isinstance(value, tuple)
            else value / self.scale**power
        )
