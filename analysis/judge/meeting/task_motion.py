"""Where a linkage meets its targets, and the motion of its driver between them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from grashof.analysis.mechanism.mobility import range_index, rotatability
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, IntArray, turned_from

STEADY = 1e-9  # rad: a driver step so small counts as none


@dataclass(frozen=True, slots=True)
class Targets:
    """The linkage as near to each target as it comes: driver angle (N,) in rad, assembly, and errors.

    NaN where no position or angle is given; inf where it cannot be assembled; `output_error` (rad) is empty
    but for functions.
    """

    theta2: FloatArray
    assembly: IntArray
    position_error: FloatArray
    angle_error: FloatArray
    output_error: FloatArray = field(default_factory=lambda: np.empty(0))

    @classmethod
    def of(cls, linkage: Linkage, task: Task, theta2: FloatArray, assembly: IntArray) -> Targets:
        """The errors at given driver angles and assemblies, each of shape (N,)."""
        state = solve_position(linkage, theta2, assembly)
        gap = state.p - task.positions
        distance = np.nan_to_num(np.hypot(gap[:, 0], gap[:, 1]), nan=np.inf)
        turned = np.abs(turned_from(state.theta3 + linkage.body_angle, task.angles))
        return cls(
            theta2,
            assembly,
            np.where(task.has_position, distance, np.nan),
            np.where(task.has_angle, np.nan_to_num(turned, nan=np.pi), np.nan),
        )


@dataclass(frozen=True, slots=True)
class TaskMotion:
    """The driver from the first target to the last.

    Angles at the targets (N,) in rad, unwrapped, the ends, and its sense, +1 counter-clockwise. `in_order` if
    it meets the targets in sequence, in one sense, within one turn.
    """

    theta2: FloatArray
    start: float
    end: float
    direction: int
    in_order: bool

    @classmethod
    def ordered(cls, theta2: FloatArray, direction: int) -> TaskMotion:
        """The motion through driver angles that are in order already."""
        return cls(theta2, float(theta2[0]), float(theta2[-1]), direction, True)

    def closed(self) -> TaskMotion:
        """The same, gone on to a whole turn."""
        return replace(self, end=self.start + self.direction * TURN)


def task_motion(linkage: Linkage, theta2: FloatArray, ordered: bool) -> TaskMotion:
    """The motion through driver angles (N,) in sequence, or the shortest that holds them all."""
    turns = bool((rotatability(linkage) >= 0).all())  # through a change point too, as circuits count it
    index, inside = range_index(linkage, theta2)
    if not turns and (index >= 0).all() and np.ptp(index) == 0:  # one range: no way around
        step = np.diff(inside)
        direction = 1 if inside[-1] >= inside[0] else -1
        in_order = bool((direction * step >= -STEADY).all())
        if ordered and in_order:
            return TaskMotion.ordered(inside, direction)
        return TaskMotion(inside, float(inside.min()), float(inside.max()), direction, in_order)
    motions = [_turning(theta2, direction) for direction in (1, -1)]
    best = min(motions, key=lambda motion: abs(motion.end - motion.start))
    return best if ordered else _shortest_arc(theta2, best)


def _turning(theta2: FloatArray, direction: int) -> TaskMotion:
    step = (direction * np.diff(theta2) + STEADY) % TURN - STEADY
    unwrapped = theta2[0] + direction * np.concatenate([[0.0], np.cumsum(step)])
    in_order = bool(step.sum() <= TURN + STEADY)
    return replace(TaskMotion.ordered(unwrapped, direction), in_order=in_order)


def _shortest_arc(theta2: FloatArray, ordered: TaskMotion) -> TaskMotion:
    around = np.sort(theta2 % TURN)
    gap = np.diff(around, append=around[0] + TURN)
    start = around[(np.argmax(gap) + 1) % len(around)]
    unwrapped = start + (theta2 - start + STEADY) % TURN - STEADY
    return TaskMotion(unwrapped, float(start), float(start + TURN - gap.max()), 1, ordered.in_order)
