"""The rotation of link 2 by the input of a function: its angle, or the lengthening of a cylinder on it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grashof.problems import Cylinder, CylinderSpec, Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, Limits

_ROUNDING = 1e-9  # rad, or share of the lengths: a value that misses a range by less is at its end


@dataclass(frozen=True, slots=True)
class Driven:
    """The cylinder that drives a linkage, if any, its limits, and its least lever angle, rad."""

    cylinder: Cylinder | None = None
    spec: CylinderSpec | None = None
    lever: float = 0.0


class Input(ABC):
    """The input that turns link 2, from the first target on. Starts are driver angles there, in rad."""

    @abstractmethod
    def turned(self, starts: FloatArray, direction: int, inputs: FloatArray) -> FloatArray:
        """Rotation of link 2 in a sense from starts (...) at inputs (N,), (..., N), rad; NaN beyond reach."""

    @abstractmethod
    def rate(self, starts: FloatArray, direction: int, inputs: FloatArray) -> FloatArray:
        """Derivative of that rotation by the input, shape (..., N), rad for a unit of the input."""

    @abstractmethod
    def moved_by_start(self, start: float, direction: int, inputs: FloatArray) -> FloatArray:
        """Derivative of the driver angle at inputs by the start, shape (N,)."""

    @property
    def limited(self) -> bool:
        """Whether limits of the input depend on where it begins."""
        return False

    @property
    def even(self) -> bool:
        """Whether even inputs turn link 2 evenly, wherever it begins."""
        return False

    def missed(self, starts: FloatArray, direction: int, task: Task) -> FloatArray:
        """Excess over its limits from starts (S,), sizes, ratio or rad; not positive where they are kept."""
        return np.zeros(len(starts))

    @abstractmethod
    def starts(self, reach: Limits, direction: int, span: Limits) -> Sequence[Limits]:
        """Ranges of starts from which link 2 stays within angles `reach` while the input covers `span`."""

    @abstractmethod
    def starts_of_turn(self, turn: Limits, direction: int, span: Limits) -> Sequence[Limits]:
        """The same where link 2 turns fully, and all angles of `turn` are possible."""


@dataclass(frozen=True, slots=True)
class ByAngle(Input):
    """The input is the rotation of link 2."""

    @property
    def even(self) -> bool:
        return True

    def turned(self, starts: FloatArray, direction: int, inputs: FloatArray) -> FloatArray:
        return np.broadcast_to(inputs, (*np.shape(starts), len(inputs)))

    def rate(self, starts: FloatArray, direction: int, inputs: FloatArray) -> FloatArray:
        return np.ones((*np.shape(starts), len(inputs)))

    def moved_by_start(self, start: float, direction: int, inputs: FloatArray) -> FloatArray:
        return np.ones(len(inputs))

    def starts(self, reach: Limits, direction: int, span: Limits) -> Sequence[Limits]:
        back, on = (-span[0], span[1]) if direction > 0 else (span[1], -span[0])
        low, high = reach[0] + back, reach[1] - on
        # A range as long as the linkage's own leaves one start; rounding must not lose it.
        return [(min(low, high), max(low, high))] if high - low >= -_ROUNDING else []

    def starts_of_turn(self, turn: Limits, direction: int, span: Limits) -> Sequence[Limits]:
        return [turn]


@dataclass(frozen=True, slots=True)
class ByLength(Input):
    """The input is the lengthening of a cylinder on link 2, from its length at the first target.

    In the triangle of O2, the cylinder's base at the distance b and its pivot at the arm c, the cosine of the
    angle at O2 is (b^2 + c^2 - L^2) / (2 b c): link 2 turns away from the base while the cylinder lengthens.
    `zero` is the driver angle at which the arm points to the base.
    """

    base: float
    arm: float
    zero: float
    closed: Limits = (0.0, np.inf)
    ratio_max: float = np.inf  # of the greatest length over the least
    lever: float = 0.0  # rad, least angle between cylinder and arm

    @classmethod
    def of(cls, linkage: Linkage, driven: Driven) -> ByLength | None:
        """That of a cylinder on link 2; None of any other, or of one that does not turn it."""
        cylinder, spec = driven.cylinder, driven.spec
        if cylinder is None:
            return None
        o2, point = np.asarray(linkage.o2, dtype=np.float64), np.asarray(cylinder.point)
        out = np.asarray(cylinder.base) - o2
        base, arm = float(np.hypot(*out)), float(np.hypot(*point))
        if cylinder.link != 2 or not (base > 0 and arm > 0):
            return None
        zero = float(np.arctan2(out[1], out[0]) - np.arctan2(point[1], point[0]))
        closed, ratio = (None, np.inf) if spec is None else (spec.closed, spec.ratio_max)
        return cls(base, arm, zero, closed or (0.0, np.inf), ratio, driven.lever)

    @property
    def limited(self) -> bool:
        return self.closed != (0.0, np.inf) or np.isfinite(self.ratio_max) or self.lever > 0

    def missed(self, starts: FloatArray, direction: int, task: Task) -> FloatArray:
        closed = self._length(self._opening(starts, direction))
        extended, (low, high) = closed + task.span[1], self.closed
        missed = [(low - closed) / task.size, (closed - high) / task.size]
        missed.append(extended / closed - self.ratio_max)
        if self.lever > 0:
            for length in (closed, extended):
                cosine = (self.arm**2 + length**2 - self.base**2) / (2 * self.arm * length)
                with np.errstate(invalid="ignore"):
                    missed.append(self.lever - np.arccos(np.abs(cosine)))
        return np.asarray(np.nan_to_num(np.max(missed, axis=0), nan=np.inf))

    def turned(self, starts: FloatArray, direction: int, inputs: FloatArray) -> FloatArray:
        first = self._opening(np.asarray(starts), direction)
        opened = self._at(self._length(first)[..., None] + inputs) - first[..., None]
        return np.where(inputs == 0, 0.0 * first[..., None], opened)

    def rate(self, starts: FloatArray, direction: int, inputs: FloatArray) -> FloatArray:
        length, opening = self._along(starts, direction, inputs)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(length / (self.base * self.arm * np.sin(opening)))

    def moved_by_start(self, start: float, direction: int, inputs: FloatArray) -> FloatArray:
        first = self._opening(np.array(start), direction)
        length, opening = self._along(np.array(start), direction, inputs)
        with np.errstate(divide="ignore", invalid="ignore"):
            moved: FloatArray = length * np.sin(first) / (self._length(first) * np.sin(opening))
        return moved

    def starts(self, reach: Limits, direction: int, span: Limits) -> Sequence[Limits]:
        found = list[Limits]()
        nearest = round((reach[0] + reach[1]) / 2 / TURN - self.zero / TURN)
        for zero in (self.zero + TURN * (nearest + k) for k in (-1, 0, 1)):
            low, high = (
                max(reach[0], min(zero, zero + direction * np.pi)),
                min(reach[1], max(zero, zero + direction * np.pi)),
            )
            if low >= high:
                continue
            least, most = sorted(self._length(np.array([low, high]) - zero).tolist())
            last = most - span[1]
            if last - least >= -_ROUNDING * most:
                ends = zero + direction * self._at(np.array([least, max(last, least)]))
                found.append((float(ends.min()), float(ends.max())))
        return found

    def starts_of_turn(self, turn: Limits, direction: int, span: Limits) -> Sequence[Limits]:
        ends = sorted((self.zero, self.zero + direction * np.pi))
        return self.starts((ends[0], ends[1]), direction, span)

    def _along(self, starts: FloatArray, direction: int, inputs: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lengths and openings at inputs, (..., N)."""
        length = self._length(self._opening(starts, direction))[..., None] + inputs
        return length, self._at(length)

    def _opening(self, theta2: FloatArray, direction: int) -> FloatArray:
        """Angle at O2 from base to pivot in a sense; NaN where the cylinder shortens in that sense."""
        opening = direction * (theta2 - self.zero)
        opening = opening - TURN * np.round(opening / TURN)
        inside = np.where(np.abs(opening) < _ROUNDING, 0.0, opening)
        return np.where(inside >= 0, inside, np.where(inside <= -np.pi + _ROUNDING, np.pi, np.nan))

    def _length(self, opening: FloatArray) -> FloatArray:
        length: FloatArray = np.hypot(self.base - self.arm * np.cos(opening), self.arm * np.sin(opening))
        return length

    def _at(self, length: FloatArray) -> FloatArray:
        """Opening at a length, rad; NaN where the cylinder is too short or too long."""
        cosine = (self.base**2 + self.arm**2 - length**2) / (2 * self.base * self.arm)
        within = np.abs(cosine) <= 1 + _ROUNDING
        return np.where(within, np.arccos(np.clip(cosine, -1.0, 1.0)), np.nan)


def input_of(linkage: Linkage, task: Task, driven: Driven) -> Input | None:
    """The input that turns link 2 in a task; None where a cylinder should turn it and none does."""
    return ByLength.of(linkage, driven) if task.lengthens else ByAngle()
