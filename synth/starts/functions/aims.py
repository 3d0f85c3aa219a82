"""The aims of a search for function generators, in each sense, and generators as linkages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import (
    Linkage,
    Problem,
    ProblemError,
    Requirements,
    Rotatability,
    Task,
    TransmissionOver,
)
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.requirements.link_ratios import greatest_logs
from grashof.problems.values.tasks.function_law import lobatto_with_weights
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.functions.fit import DesiredOutput
from grashof.synth.theory.functions.limits import ShapeLimits, offset_rows
from grashof.synth.theory.functions.output import Generators

SAMPLES = 41  # Chebyshev-Lobatto points of the range, of the greatest error
DENSE = 1201  # places among which its extremes are looked for
INSIDE = 4e-8  # margin by which limits are kept, so that rounding misses none


@dataclass(frozen=True, slots=True)
class FunctionAims:
    """The problem of a function as its search sees it: on the ground O2 = 0, O4 = 1, or in units of travel.

    The driver turns counter-clockwise from the beginning of the range; designs that turn it clockwise are the
    mirror images.
    """

    task: Task
    problem: Problem  # of one kind of linkage
    kind: type[Generators]
    wanted: Requirements  # resolved
    limits: ShapeLimits  # of drivers that turn counter-clockwise
    sizes: dict[str, Limits]  # limits of lengths, by name
    unit: float  # of outputs: 1 rad, or the full travel
    exact: bool

    @classmethod
    def of(cls, scaled: ScaledProblem) -> FunctionAims:
        """The aims of a problem of one kind whose task is a function."""
        problem, task = scaled.problem, scaled.problem.task
        if not task.has_output.any():
            raise ProblemError(f"problem.task is a {type(task).__name__}; it must be a FunctionTask")
        wanted = problem.requirements.resolved(task.size)
        kind, unit = scaled.kind.generators[task.link], task.output_unit
        names, sizes = kind.sizes(wanted, unit)
        rotatability, offset = wanted.rotatability or Rotatability.ANY, wanted.offset
        lengths = [_over(each, unit) for each in sizes]
        limits = ShapeLimits(
            span=task.span[1] - task.span[0],
            caps=_caps(kind, dict(zip(names, sizes, strict=True)), wanted),
            transmission=float(np.radians(wanted.transmission_min_deg)) + INSIDE,
            over_cycle=wanted.transmission_over is TransmissionOver.CYCLE,
            margin=None if rotatability is Rotatability.ANY else wanted.rotatability_margin + INSIDE,
            shortest={Rotatability.CRANK_ROCKER: 1, Rotatability.DOUBLE_CRANK: -1}.get(rotatability, 0),
            offset=None if offset is None else offset_rows(lengths, _over(offset, unit)),
            stroke=(-np.inf, np.inf) if wanted.stroke is None else _over(wanted.stroke, unit),
        )
        exact = problem.requirements.is_exact(task)
        return cls(task, problem, kind, wanted, limits, dict(zip(names, sizes, strict=True)), unit, exact)

    def limits_of(self, driver: int) -> ShapeLimits:
        """Limits of the shapes whose linkages, or mirror images, turn their driver in a sense."""
        if driver > 0 or self.limits.offset is None:
            return self.limits
        return replace(self.limits, offset=self.limits.offset * np.append(np.ones(len(self.sizes)), -1.0))

    @property
    def kinds(self) -> str:
        """The name of linkages of its kind, in the plural."""
        return f"{self.problem.mechanism[0].replace('inverted-', 'inverted ')}s"

    @property
    def obstacle(self) -> str:
        """Why there can be no linkage; empty where there may be one."""
        caps, names = self.limits.caps, tuple(self.sizes)
        low, high = self.sizes[names[0]]
        if low > high:
            return "limits of o2, o4, r1 and the ground angle leave the ground link no length"
        pairs = zip(*np.nonzero(caps + caps.T < -3 * INSIDE), strict=True)
        found = [f"{names[j]} and {names[k]}" for j, k in pairs if j < k]
        return f"limits of {found[0]} contradict each other" if found else ""

    @property
    def greatest_error(self) -> float:
        """Structural error that is allowed, in units of the output."""
        stated = getattr(self.wanted, self.task.error_field)
        if stated is None:
            return np.inf
        return float(stated[1] if self.task.travels else np.radians(stated[1])) / self.unit

    def ways(self) -> Iterator[tuple[int, int, float | None]]:
        """Senses of output and driver that are searched, and the driver angle at the beginning, if given."""
        wanted = self.problem.requirements
        start = wanted.theta2_start_deg
        one = self.task.sense != "either" or (self.kind.ONE_SENSE and start is None)
        drivers = {"ccw": (1,), "cw": (-1,)}.get(wanted.driver_sense, (1, -1))
        for sense in (1,) if one else (1, -1):
            if start is None:
                for driver in drivers[:1] if self.mirrored else drivers:
                    yield sense, driver, None
                continue
            for driver in drivers:
                first = driver * (float(np.radians(start)) - self.kind.direction(wanted)) + self.task.span[0]
                yield sense, driver, float(np.angle(np.exp(1j * first)))

    @property
    def mirrored(self) -> bool:
        """Whether mirror images are equally suitable, so that one sense of the driver represents both."""
        return self.wanted.offset is None and self.problem.requirements.theta2_start_deg is None

    def pairs(self, sense: int) -> DesiredOutput:
        """The pairs, from the beginning of the range."""
        return DesiredOutput(
            self.task.driver_turns - self.task.span[0],
            sense * self.task.outputs / self.unit,
            self.task.weights,
        )

    def samples(self, sense: int, count: int = SAMPLES) -> DesiredOutput:
        """Chebyshev-Lobatto points of the range."""
        places, weights = lobatto_with_weights(count)
        turned = self.limits.span * places
        return DesiredOutput(
            turned, sense * self.task.output(turned + self.task.span[0]) / self.unit, weights
        )

    def dense(self, sense: int) -> tuple[FloatArray, FloatArray]:
        """Rotations from the beginning of the range, and the outputs there: extremes are found among them."""
        turned = np.linspace(0.0, self.limits.span, DENSE)
        return turned, sense * self.task.output(turned + self.task.span[0]) / self.unit

    def linkage(self, batch: Generators, driver: int) -> Linkage:
        """The linkage of one generator, placed and scaled as limits have it."""
        return batch.linkage(self.wanted, self.unit, driver)

    def generator(self, linkage: Linkage, driver: int, theta2: float) -> Generators:
        """The generator that a linkage is, its driver at `theta2`, rad, at the first pair."""
        return self.kind.of_linkage(linkage, self.unit, driver, theta2).begun(-self.task.span[0])


def _caps(kind: type[Generators], sizes: Mapping[str, Limits], wanted: Requirements) -> FloatArray:
    """Greatest logarithm of one length over another."""
    low, high = np.array(list(sizes.values()), dtype=np.float64).T
    most = greatest_logs(list(sizes), wanted.ratios, wanted.link_ratio_max)
    if not kind.FIRST_IS_LINK:
        most[0], most[:, 0] = np.inf, np.inf
    with np.errstate(divide="ignore", invalid="ignore"):
        caps: FloatArray = np.minimum(most, np.log(high)[:, None] - np.log(low))
    room = (caps + caps.T) / 2
    return caps - np.where(room > -INSIDE, np.clip(room, 0.0, INSIDE), INSIDE)  # none where a ratio is fixed


def _over(limits: Limits, unit: float) -> Limits:
    return limits[0] / unit, limits[1] / unit
