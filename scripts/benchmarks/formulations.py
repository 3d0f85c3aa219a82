"""Tasks as a user of a general solver writes them down: unknowns in a box, residuals, and limits.

Of points and poses the unknowns are O2, O4, r2, r3, r4, the coupler point, the body's angle and the driver
angle at every target; of a function r2, r3, r4 over the ground, and where driver and output begin. Choices,
such as the assembly, are drawn at random for every start. A limit is met where its value is not positive.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from independent_limits import elbow

from grashof.problems import Box, FourBar, Problem, Requirements, Task
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray

STEP = 1e-3  # rad, between two targets


class Choice(NamedTuple):
    """Choices of a start, each 1 or -1."""

    assembly: float
    way: float
    "Of the driver."
    turning: float
    "1 where link 2 is the shortest of a linkage that turns fully, -1 where the ground is."

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Choice:
        """Any."""
        return cls(*rng.choice([-1.0, 1.0], 3))


def formulated(problem: Problem) -> Formulation:
    """The formulation of a four-bar's task."""
    if problem.task.has_output.any():
        return FunctionFormulation.of(problem.task, problem.requirements)
    return CouplerFormulation.of(problem.task, problem.requirements)


@dataclass(frozen=True, slots=True)
class CouplerFormulation:
    """Points or poses: o2, o4, r2, r3, r4, u, v, body angle, and driver angles or, if timed, the first."""

    task: Task
    wanted: Requirements
    low: FloatArray
    high: FloatArray
    scale: float
    "Divisor of the residuals."
    minimax: bool = False
    "Whether the greatest residual is minimised instead of the sum of squares."

    @classmethod
    def of(cls, task: Task, wanted: Requirements) -> CouplerFormulation:
        """Pivots within three sizes of the task, links as the requirements have them."""
        size, middle = task.size, task.positions.mean(axis=0)
        least, most = wanted.link_length or (0.01 * size, 20 * size)
        arm = min((wanted.coupler_arms or (0, np.inf))[1], 20 * size)
        angles = 1 if task.timing is not None else len(task)
        beside = np.tile(middle, 2)
        low = np.array([*(beside - 3 * size), *[least] * 3, -arm, -arm, -np.pi, *[-TURN] * angles])
        most = min(most, 20 * size)
        high = np.array([*(beside + 3 * size), *[most] * 3, arm, arm, np.pi, *[TURN] * angles])
        boxes = (wanted.o2 or Box(), wanted.o4 or Box())
        for column, ends in enumerate(ends for box in boxes for ends in (box.x, box.y)):
            if np.isfinite(ends).all():
                low[column], high[column] = ends
        return cls(task, wanted, low, high, size)

    def start(self, rng: np.random.Generator, choice: Choice) -> FloatArray:
        """A random point of the box, the driver angles in order."""
        x = rng.uniform(self.low, self.high)
        way = choice.way * np.linspace(0, rng.uniform(0.3, TURN), len(x) - 10)
        x[10:] = np.clip(rng.uniform(-np.pi, np.pi) + way, self.low[10:], self.high[10:])
        return x

    def driver(self, x: FloatArray, choice: Choice) -> FloatArray:
        """The driver angle at each target, rad."""
        if self.task.timing is None:
            return x[10:]
        driver: FloatArray = x[10] + choice.way * self.task.timing
        return driver

    def a(self, x: FloatArray, choice: Choice) -> ComplexArray:
        """A at each target."""
        found: ComplexArray = complex(*x[:2]) + x[4] * np.exp(1j * self.driver(x, choice))
        return found

    def residuals(self, x: FloatArray, choice: Choice) -> FloatArray:
        """Of positions, and of angles times the task's length."""
        a = self.a(x, choice)
        theta3 = np.angle(elbow(complex(*x[2:4]) - a, x[5], x[6], choice.assembly))
        p = a + complex(*x[7:9]) * np.exp(1j * theta3)
        errors = [(p - self.task.positions @ np.array([1, 1j])).view(np.float64)]
        if self.task.has_angle.any():
            turn = theta3 + x[9] - self.task.angles
            errors.append(2 * self.task.angle_length * np.sin(turn / 2))
        return np.concatenate(errors)

    def limits(self, x: FloatArray, choice: Choice) -> FloatArray:
        """Assembly and transmission at the targets or over the cycle, full rotation, order, arms."""
        (r2, r3, r4), (u, v) = x[4:7], x[7:9]
        r1 = float(np.hypot(*(x[2:4] - x[:2])))
        square = np.abs(complex(*x[2:4]) - self.a(x, choice)) ** 2
        turns = self.wanted.rotatability != "any"
        if turns and self.wanted.transmission_over == "cycle":
            square = np.array([(r1 - r2) ** 2, (r1 + r2) ** 2])
        found = [_transmission(square, r3, r4, self.wanted)]
        if turns:
            crank = self.wanted.rotatability == "crank-rocker" or choice.turning > 0
            found.append(_turning(*((r2, r1) if crank else (r1, r2)), r3, r4) / self.scale)
        if self.task.timing is None:
            steps = choice.way * np.diff(x[10:])
            found += [STEP - steps, np.array([steps.sum() + STEP - TURN])]
        if self.wanted.coupler_arms is not None:
            arms = np.array([np.hypot(u, v), np.hypot(u - r3, v)])
            low, high = self.wanted.coupler_arms
            found += [(low - arms) / self.scale, (arms - high) / self.scale]
        return np.concatenate(found)

    def linkage(self, x: FloatArray, choice: Choice) -> FourBar:
        """The linkage of some unknowns."""
        return FourBar(
            o2=x[:2], o4=x[2:4], r2=x[4], r3=x[5], r4=x[6], coupler_point=x[7:9],
            assembly=choice.assembly, body_angle=x[9],
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class FunctionFormulation:
    """A function: r2, r3, r4 over a ground of 1, the first angles of driver and output."""

    task: Task
    wanted: Requirements
    low: FloatArray
    high: FloatArray
    minimax: bool
    scale: float = 1.0

    @classmethod
    def of(cls, task: Task, wanted: Requirements) -> FunctionFormulation:
        """Links up to the ratio that is allowed."""
        ratio = min(wanted.link_ratio_max, 20.0)
        low, high = [1 / ratio] * 3 + [-np.pi] * 2, [ratio] * 3 + [np.pi] * 2
        minimax = task.norm == "max" and not wanted.is_exact(task)
        return cls(task, wanted, np.array(low), np.array(high), minimax)

    def start(self, rng: np.random.Generator, choice: Choice) -> FloatArray:
        """A random point of the box, lengths alike on a logarithmic scale."""
        del choice
        x = rng.uniform(self.low, self.high)
        x[:3] = np.exp(rng.uniform(np.log(self.low[:3]), np.log(self.high[:3])))
        return x

    def residuals(self, x: FloatArray, choice: Choice) -> FloatArray:
        """Of the output angle at every pair, rad."""
        r2, r3, r4 = x[:3]
        a = r2 * np.exp(1j * (x[3] + choice.way * self.task.driver_turns))
        theta4 = np.angle(elbow(a - 1, r4, r3, -choice.assembly))
        sense = choice.turning if self.task.sense == "either" else 1.0
        found: FloatArray = 2 * np.sin((theta4 - x[4] - choice.way * sense * self.task.outputs) / 2)
        return found

    def limits(self, x: FloatArray, choice: Choice) -> FloatArray:
        """Assembly and transmission at the pairs, the ratio of the links."""
        r2, r3, r4 = x[:3]
        square = np.abs(r2 * np.exp(1j * (x[3] + choice.way * self.task.driver_turns)) - 1) ** 2
        links = np.array([1.0, r2, r3, r4])
        ratio = links.max() / links.min() / self.wanted.link_ratio_max - 1
        return np.append(_transmission(square, r3, r4, self.wanted), ratio)

    def linkage(self, x: FloatArray, choice: Choice) -> FourBar:
        """The linkage of some unknowns."""
        return FourBar(o2=(0, 0), o4=(1, 0), r2=x[0], r3=x[1], r4=x[2], assembly=choice.assembly)


Formulation = CouplerFormulation | FunctionFormulation


def _transmission(square: FloatArray, r3: float, r4: float, wanted: Requirements) -> FloatArray:
    """Shortfall of the transmission angle, or of assembly, at these squared distances from A to O4."""
    cosine = (r3**2 + r4**2 - square) / (2 * r3 * r4)
    most: float = np.cos(np.radians(wanted.transmission_min_deg))
    return np.concatenate([cosine - most, -cosine - most])


def _turning(shortest: float, *others: float) -> FloatArray:
    """Excess of the shortest link plus each other one over the two left (Grashof)."""
    total = sum(others)
    return np.array([shortest + 2 * each - total for each in others])
