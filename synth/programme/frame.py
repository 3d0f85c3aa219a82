"""The frame of the search: a task moved to the origin and scaled to size 1."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import Box, Requirements, Task
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits


@dataclass(frozen=True, slots=True)
class Frame:
    """Origin (centroid of the targets, complex) and scale (size of the task), in the problem's unit."""

    origin: complex
    scale: float

    @classmethod
    def of(cls, task: Task) -> Frame:
        """The frame of a task."""
        return cls(complex(*np.nanmean(task.positions, axis=0)), task.size)

    def inward(self, points: FloatArray) -> ComplexArray:
        """Points (..., 2) of the problem as complex numbers in this frame."""
        return (points[..., 0] + 1j * points[..., 1] - self.origin) / self.scale

    def outward(self, points: ComplexArray) -> FloatArray:
        """Complex numbers (...) of this frame as points (..., 2) of the problem."""
        placed = np.asarray(points) * self.scale + self.origin
        return np.stack([placed.real, placed.imag], axis=-1)

    def requirements(self, requirements: Requirements) -> Requirements:
        """Resolved `requirements` with lengths in sizes and boxes in this frame."""
        whole = requirements.resolved(self.scale)
        return replace(
            whole,
            link_length=self._lengths(whole.link_length),
            r1=self._lengths(whole.r1),
            r2=self._lengths(whole.r2),
            r3=self._lengths(whole.r3),
            r4=self._lengths(whole.r4),
            coupler_arms=self._lengths(whole.coupler_arms),
            o2=self._box(whole.o2),
            o4=self._box(whole.o4),
            a=self._box(whole.a),
            b=self._box(whole.b),
            keep_out=tuple(self._area(corners) for corners in whole.keep_out),
        )

    def _lengths(self, limits: Limits | None) -> Limits | None:
        return None if limits is None else (limits[0] / self.scale, limits[1] / self.scale)

    def _area(self, corners: FloatArray) -> FloatArray:
        inside = self.inward(corners)
        return np.stack([inside.real, inside.imag], axis=-1)

    def _box(self, box: Box | None) -> Box | None:
        if box is None:
            return None
        x, y = self.origin.real, self.origin.imag
        return Box(
            x=((box.x[0] - x) / self.scale, (box.x[1] - x) / self.scale),
            y=((box.y[0] - y) / self.scale, (box.y[1] - y) / self.scale),
        )
