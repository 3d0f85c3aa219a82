"""Where a linkage meets its targets, how far it misses them, and the motion of its driver between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace

import numpy as np

from grashof.analysis.curves.coupler_curve import coupler_motion
from grashof.analysis.mechanism.mobility import closes_everywhere, range_index
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.minimisation import Model
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, turned_from

STEADY = 1e-9  # rad: a smaller driver step counts as none
_ROUNDING = 1e-13  # share of the size: sums of squares that differ by less than its square are equal


@dataclass(frozen=True, slots=True)
class Targets:
    """The closest approach of a linkage to each target: driver angle (N,) in rad, assembly, and errors.

    NaN where no position or angle is given; inf where it cannot be assembled; `output_error` (rad) is empty
    but for functions. Those of a batch, (B, N), are indexed as arrays are.
    """

    theta2: FloatArray
    assembly: IntArray
    position_error: FloatArray
    angle_error: FloatArray
    output_error: FloatArray = field(default_factory=lambda: np.empty(0))

    @classmethod
    def of(cls, linkage: Linkage, task: Task, theta2: FloatArray, assembly: IntArray) -> Targets:
        """The errors at given driver angles and assemblies, each of shape (N,), or (B, N) of a batch (B,)."""
        linkage = linkage[..., None]
        state = solve_position(linkage, theta2, assembly)
        gap = state.p - task.positions
        distance = np.nan_to_num(np.hypot(gap[..., 0], gap[..., 1]), nan=np.inf)
        turned = np.abs(turned_from(state.carrying + linkage.body_angle, task.angles))
        return cls(
            theta2,
            assembly,
            np.where(task.has_position, distance, np.nan),
            np.where(task.has_angle, np.nan_to_num(turned, nan=np.pi), np.nan),
        )

    def shares(self, zones: FloatArray) -> FloatArray:
        """Misses as shares of zones (2, N), the greater one of position and angle."""
        most: FloatArray = np.fmax(self.position_error / zones[0], self.angle_error / zones[1])
        return most

    def __getitem__(self, index: int) -> Targets:
        return Targets(*(getattr(self, each.name)[index] for each in fields(self)[:-1]))


def misses(linkage: Linkage, task: Task, theta2: FloatArray, assembly: IntArray) -> FloatArray:
    """|dp|^2 + (length * dangle)^2 of the given parts, shape (..., N); inf where it cannot close."""
    state = solve_position(linkage, theta2, assembly)
    gap = state.p - task.positions
    miss: FloatArray = np.where(task.has_position, gap[..., 0] ** 2 + gap[..., 1] ** 2, 0.0)
    if task.has_angle.any():
        off = turned_from(state.carrying, task.angles - linkage.body_angle)
        miss = miss + np.where(task.has_angle, task.meeting_lengths * off, 0.0) ** 2
    return np.nan_to_num(miss, nan=np.inf, posinf=np.inf)


def squares(
    linkage: Linkage,
    task: Task,
    assembly: IntArray,
    order: slice | IntArray = slice(None),
    *,
    weighted: bool = True,
) -> Callable[[FloatArray], Model]:
    """The misses as functions of driver angles (..., N), on given assemblies (..., N)."""
    weights = task.meeting_weights if weighted else np.ones(len(task))
    point = np.nan_to_num(task.positions[order] @ np.array([1, 1j]))
    angle = np.nan_to_num(task.angles[order] - linkage.body_angle)
    by_point = (weights * task.has_position)[order]
    by_angle = (weights * task.has_angle * task.meeting_lengths**2)[order]

    def model(theta2: FloatArray) -> Model:
        p, rate, bend, theta, omega, alpha = coupler_motion(linkage, theta2, assembly)
        with np.errstate(invalid="ignore", over="ignore"):
            gap = p - point
            value = by_point * (gap.real**2 + gap.imag**2)
            slope = by_point * (rate.conj() * gap).real
            positive = by_point * (rate.real**2 + rate.imag**2)
            curved = by_point * (bend.conj() * gap).real
            if by_angle.any():
                off = turned_from(theta, angle)
                value, slope = value + by_angle * off**2, slope + by_angle * omega * off
                positive, curved = positive + by_angle * omega**2, curved + by_angle * alpha * off
            return np.nan_to_num(value, nan=np.inf), 2 * slope, 2 * positive + 2 * curved, 2 * positive

    return model


def as_good(task: Task, totals: FloatArray) -> BoolArray:
    """Which sums of weighted misses are the least but for rounding."""
    good: BoolArray = totals <= totals.min() * (1 + 1e-9) + len(task) * (_ROUNDING * task.size) ** 2
    return good


def valleys(values: FloatArray) -> IntArray:
    """Indices of the finite values, of shape (S,), that exceed neither neighbour."""
    padded = np.pad(values, 1, constant_values=np.inf)
    return np.flatnonzero((values <= padded[:-2]) & (values <= padded[2:]) & np.isfinite(values))


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
        """The same, continued to a full turn."""
        return replace(self, end=self.start + self.direction * TURN)


def task_motion(linkage: Linkage, theta2: FloatArray, ordered: bool) -> TaskMotion:
    """The motion through driver angles (N,) in sequence, or the shortest that holds them all."""
    return task_motions(linkage[None], theta2[None], ordered)[0]


def task_motions(linkage: Linkage, theta2: FloatArray, ordered: bool) -> list[TaskMotion]:
    """The motions of a batch (B,) through driver angles (B, N), each as of `task_motion`."""
    index, inside = range_index(linkage[:, None], theta2)
    # One range: no way around. A linkage turns through a change point too, as circuits count it.
    swings = ~closes_everywhere(linkage) & np.all((index >= 0) & (index == index[:, :1]), axis=1)
    direction = np.where(inside[:, -1] >= inside[:, 0], 1, -1)
    in_order = np.all(direction[:, None] * np.diff(inside) >= -STEADY, axis=1)
    around = [_turning(theta2, sense) for sense in (1, -1)]
    found = list[TaskMotion]()
    for row, angles in enumerate(inside):
        if not swings[row]:
            best = min((each[row] for each in around), key=lambda motion: abs(motion.end - motion.start))
            found.append(best if ordered else _shortest_arc(theta2[row], best))
        elif ordered and in_order[row]:
            found.append(TaskMotion.ordered(angles, int(direction[row])))
        else:
            ends = float(angles.min()), float(angles.max())
            found.append(TaskMotion(angles, *ends, int(direction[row]), bool(in_order[row])))
    return found


def _turning(theta2: FloatArray, direction: int) -> list[TaskMotion]:
    step = (direction * np.diff(theta2) + STEADY) % TURN - STEADY
    turned = np.concatenate([np.zeros((len(theta2), 1)), np.cumsum(step, axis=1)], axis=1)
    unwrapped, within = theta2[:, :1] + direction * turned, step.sum(axis=1) <= TURN + STEADY
    return [
        replace(TaskMotion.ordered(angles, direction), in_order=bool(once))
        for angles, once in zip(unwrapped, within, strict=True)
    ]


def _shortest_arc(theta2: FloatArray, ordered: TaskMotion) -> TaskMotion:
    around = np.sort(theta2 % TURN)
    gap = np.diff(around, append=around[0] + TURN)
    start = around[(np.argmax(gap) + 1) % len(around)]
    unwrapped = start + (theta2 - start + STEADY) % TURN - STEADY
    return TaskMotion(unwrapped, float(start), float(start + TURN - gap.max()), 1, ordered.in_order)
