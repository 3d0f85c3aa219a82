"""What function generators are searched for, in each sense, and how they become linkages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from grashof.problems import FourBar, FunctionTask, Problem, ProblemError, Rotatability, TransmissionOver
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.function_ground import FunctionGround
from grashof.problems.values.function_law import lobatto_with_weights
from grashof.synth.theory.function_fit import Wanted
from grashof.synth.theory.function_limits import ShapeLimits
from grashof.synth.theory.function_output import Generators

SAMPLES = 41  # Chebyshev-Lobatto points of the range, of the greatest error
DENSE = 1201  # places among which its extremes are looked for
INSIDE = 1e-7  # by so much limits are kept, so that rounding misses none


@dataclass(frozen=True, slots=True)
class FunctionAims:
    """The problem of a function as its search sees it: on the ground O2 = 0, O4 = 1.

    The driver turns counter-clockwise from the beginning of the range; designs that turn it clockwise are
    the mirror images.

    Parameters
    ----------
    task : FunctionTask
    problem : Problem
    ground : FunctionGround
    limits : ShapeLimits
    exact : bool
    """

    task: FunctionTask
    problem: Problem
    ground: FunctionGround
    limits: ShapeLimits
    exact: bool

    @classmethod
    def of(cls, problem: Problem) -> FunctionAims:
        """The aims of a problem whose task is a function."""
        task = problem.task
        if not isinstance(task, FunctionTask):
            raise ProblemError(f"problem.task is a {type(task).__name__}; it must be a FunctionTask")
        wanted = problem.requirements.resolved(task.size)
        ground, kind = FunctionGround.of(problem.requirements), wanted.rotatability
        lengths = [
            (
                max(wanted.link_lengths[0][0], ground.lengths[0]),
                min(wanted.link_lengths[0][1], ground.lengths[1]),
            )
        ]
        low, high = np.array([*lengths, *wanted.link_lengths[1:]], dtype=np.float64).T
        with np.errstate(divide="ignore"):
            caps = np.minimum(np.log(wanted.link_ratio_max), np.log(high)[:, None] - np.log(low))
        limits = ShapeLimits(
            span=task.span[1] - task.span[0],
            caps=caps - INSIDE,
            transmission=float(np.radians(wanted.transmission_min_deg)) + INSIDE,
            over_cycle=wanted.transmission_over is TransmissionOver.CYCLE,
            margin=None if kind is Rotatability.ANY else wanted.rotatability_margin + INSIDE,
            shortest={Rotatability.CRANK_ROCKER: 1, Rotatability.DOUBLE_CRANK: -1}.get(
                kind or Rotatability.ANY, 0
            ),
        )
        return cls(task, problem, ground, limits, problem.requirements.is_exact(task))

    @property
    def obstacle(self) -> str:
        """Why there can be no linkage; empty where there may be one."""
        low, high = self.ground.lengths
        if low > high:
            return "limits of o2, o4, r1 and the ground angle leave the ground link no length"
        pairs = zip(*np.nonzero(self.limits.caps + self.limits.caps.T < -3 * INSIDE), strict=True)
        names = [f"r{j + 1} and r{k + 1}" for j, k in pairs if j < k]
        return f"limits of {names[0]} contradict each other" if names else ""

    def ways(self) -> Iterator[tuple[int, int, float | None]]:
        """Senses of output and driver that are searched, and the driver angle at the beginning, if given."""
        wanted = self.problem.requirements
        senses = (1, -1) if self.task.sense == "either" else (1,)
        drivers = {"ccw": (1,), "cw": (-1,)}.get(wanted.driver_sense, (1, -1))
        start = wanted.theta2_start_deg
        for sense in senses:
            if start is None:
                yield sense, drivers[0], None
                continue
            for driver in drivers:
                first = driver * (float(np.radians(start)) - self.ground.theta1) + self.task.span[0]
                yield sense, driver, float(np.angle(np.exp(1j * first)))

    def pairs(self, sense: int) -> Wanted:
        """The pairs, from the beginning of the range."""
        return Wanted(self.task.inputs - self.task.span[0], sense * self.task.outputs, self.task.weights)

    def samples(self, sense: int, count: int = SAMPLES) -> Wanted:
        """Chebyshev-Lobatto points of the range."""
        places, weights = lobatto_with_weights(count)
        turned = self.limits.span * places
        return Wanted(turned, sense * self.task.output(turned + self.task.span[0]), weights)

    def dense(self, sense: int) -> tuple[FloatArray, FloatArray]:
        """Rotations from the beginning of the range, and the outputs there: extremes are found among them."""
        turned = np.linspace(0.0, self.limits.span, DENSE)
        return turned, sense * self.task.output(turned + self.task.span[0])

    def linkage(self, made: Generators, driver: int) -> FourBar:
        """The linkage of one generator, placed and scaled as limits have it."""
        wanted = self.problem.requirements.resolved(self.task.size)
        shares = made.lengths[0]
        low, high = np.array(wanted.link_lengths).T
        least = max(self.ground.lengths[0], float((low / shares).max()))
        most = min(self.ground.lengths[1], float((high / shares).min()))
        r1 = float(np.clip(self.ground.length, least, max(least, most)))
        o2, o4 = self.ground.placed(r1)
        r2, r3, r4 = (r1 * shares[1:]).tolist()
        return FourBar(o2=o2, o4=o4, r2=r2, r3=r3, r4=r4, assembly=driver * made.assembly[0])
