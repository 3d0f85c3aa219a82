"""The aims of a search for function generators, in each sense, and generators as linkages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import (
    CylinderSpec,
    Linkage,
    Problem,
    ProblemError,
    Requirements,
    Rotatability,
    Task,
    TransmissionOver,
)
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.box import ANYWHERE, Box
from grashof.problems.values.requirements.function_ground import FunctionGround
from grashof.problems.values.requirements.link_ratios import greatest_logs
from grashof.problems.values.tasks.function_law import lobatto_with_weights
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import DrivenLinkage
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.functions.places import PlaceLimits
from grashof.synth.starts.functions.placing import distances, placed_cylinder, triangle_of
from grashof.synth.theory.functions.by_cylinder import BY_CYLINDER, ByCylinder
from grashof.synth.theory.functions.fit import DesiredOutput
from grashof.synth.theory.functions.limits import ShapeLimits, offset_rows
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.placed import PLACED
from grashof.synth.theory.functions.triangle import TriangleLimits, opening_slopes, turned_by

SAMPLES = 41  # Chebyshev-Lobatto points of the range, of the greatest error
DENSE = 1201  # places among which its extremes are looked for
RATED = 9  # number of inputs at which the rate of a cylinder is limited
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
        if task.lengthens:
            kind, wanted = BY_CYLINDER[kind], _with_scale(problem.requirements, wanted, task.usual_ground)
        places = PlaceLimits.of(problem, scaled.kind, wanted, unit if task.travels else None)
        anywhere = wanted
        if places is not None:
            wanted = places.settled(wanted)
            anywhere = replace(wanted, o2=None, o4=None) if places.free.any() else wanted
        names, sizes = kind.sizes(anywhere, unit)
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
            rates=_rates(task, wanted, unit),
            places=None if places is None else places.with_sizes(sizes),
            triangle=_triangle(problem, wanted, unit if task.travels else None) if task.lengthens else None,
        )
        exact = problem.requirements.is_exact(task)
        return cls(task, problem, kind, wanted, limits, dict(zip(names, sizes, strict=True)), unit, exact)

    def limits_of(self, driver: int, sense: int) -> ShapeLimits:
        """Limits of the shapes whose linkages, or mirror images, turn driver and output in their senses."""
        limits = self.limits
        if driver < 0 and limits.offset is not None:
            limits = replace(limits, offset=limits.offset * np.append(np.ones(len(self.sizes)), -1.0))
        if driver < 0 and isinstance(limits.places, PlaceLimits):
            limits = replace(limits, places=replace(limits.places, driver=driver))
        if sense < 0 and limits.rates is not None:
            limits = replace(limits, rates=limits.rates[:, [0, 2, 1]] * [1.0, -1.0, -1.0])
        return limits

    @property
    def kinds(self) -> str:
        """The name of linkages of its kind, in the plural."""
        return f"{self.problem.mechanism[0].replace('inverted-', 'inverted ')}s"

    @property
    def obstacle(self) -> str:
        """Why there can be no linkage; empty where there may be one."""
        if self.triangle is not None and self.triangle.empty:
            return "limits of the cylinder leave it no length"
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
        same = self.kind.ONE_SENSE and start is None and not self.directed
        one = self.task.sense != "either" or same
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
        start = self.problem.requirements.theta2_start_deg
        return self.wanted.offset is None and start is None and not self.directed

    @property
    def places(self) -> PlaceLimits | None:
        """Limits of joints and links in their places, of drivers that turn counter-clockwise."""
        limits = self.limits.places
        return limits if isinstance(limits, PlaceLimits) else None

    @property
    def anywhere(self) -> FunctionAims:
        """The same without these limits."""
        return replace(self, limits=replace(self.limits, places=None))

    @property
    def directed(self) -> bool:
        """Whether limits depend on the directions of links, so that mirror images differ."""
        return self.places is not None and self.places.directed

    @property
    def made(self) -> type[Generators]:
        """The kind, with places where these are searched for."""
        return self.kind if self.places is None or not self.places.free.any() else PLACED[self.kind]

    def pairs(self, sense: int) -> DesiredOutput:
        """The pairs, from the beginning of the range."""
        return DesiredOutput(
            self.task.inputs - self.task.span[0],
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
        wanted = self.wanted if self.places is None else self.places.standing(batch, self.wanted)
        return batch.linkage(wanted, self.unit, driver)

    def design(self, batch: Generators, driver: int) -> Linkage | DrivenLinkage | None:
        """The linkage of one generator, with its cylinder; None where that has no base within its limits."""
        if not isinstance(batch, ByCylinder):
            return self.linkage(batch, driver)
        found = list[DrivenLinkage]()
        either = self.mirrored and self.problem.requirements.driver_sense == "either"
        for sense in (driver, -driver) if either else (driver,):
            linkage = self.linkage(batch, sense)
            cylinder = placed_cylinder(batch, sense, linkage, self.kind.direction(self.wanted), self._base)
            found += [] if cylinder is None else [DrivenLinkage(linkage, cylinder)]
        # Of mirror images the one whose arm lies closer to O2A.
        return min(found, key=lambda each: abs(np.arctan2(*each.cylinder.point[::-1])), default=None)

    def generator(self, design: Candidate) -> Generators | None:
        """The generator that a design is; None without the cylinder that should drive it."""
        linkage, verdict = design.linkage, design.verdict
        driver, theta2 = verdict.direction, float(verdict.theta2[0])
        if not issubclass(self.kind, ByCylinder):
            made = self.kind.of_linkage(linkage, self.unit, driver, theta2).begun(-self.task.span[0])
            return made if self.places is None else self.places.of_linkage(made, linkage)
        logs = None if verdict.cylinder is None else triangle_of(verdict.cylinder, linkage, theta2)
        if logs is None:
            return None
        return self.kind.of(self.kind.by_angle.of_linkage(linkage, self.unit, driver, theta2), logs)

    def under(self, triangle: FloatArray) -> FunctionAims:
        """The same for a given triangle of the cylinder, logarithms (3,): a task in driver angles."""
        kind, task = self.kind, self.task
        if not issubclass(kind, ByCylinder):
            raise TypeError("the inputs are angles")
        rates = self.limits.rates
        if rates is not None:
            base, arm, length = np.exp(triangle)
            slope = opening_slopes(base, arm, length + rates[:, 0])[2]
            rates = np.column_stack([turned_by(triangle, rates[:, 0]), rates[:, 1:] / slope[:, None]])
        by_angle = task.by_turns(turned_by(triangle, task.inputs))
        caps = self.limits.caps.copy()
        if self.triangle is not None:
            caps[0, 1] = min(caps[0, 1], self.triangle.reach(triangle))
        places = self.places
        if places is not None:
            places = replace(places, inputs=turned_by(triangle, places.inputs))
        limits = replace(
            self.limits, caps=caps, span=by_angle.span[1], rates=rates, triangle=None, places=places
        )
        return replace(self, task=by_angle, kind=kind.by_angle, limits=limits)

    @property
    def triangle(self) -> TriangleLimits | None:
        """Limits of the triangle of the cylinder; None where the inputs are angles."""
        limits = self.limits.triangle
        return limits if isinstance(limits, TriangleLimits) else None

    @property
    def _base(self) -> Box:
        """Where the base of the cylinder may be."""
        spec = self.problem.driver
        return ANYWHERE if spec is None or spec.base is None else spec.base


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


def _rates(task: Task, wanted: Requirements, unit: float) -> FloatArray | None:
    """Limits of rates from the beginning of the range, in units of the output, kept by a margin.

    Limits of the cylinder's rate dL/dtheta4, the inverse of such a rate, are included at some inputs.
    """
    rows = [] if task.rates is None else [task.rates - [task.span[0], 0.0, 0.0]]
    if wanted.cylinder_rate is not None and task.lengthens and not task.travels and task.link == "output":
        slow, quick = (1 / edge if edge else np.inf for edge in wanted.cylinder_rate)
        least, most = (quick, slow) if quick > 0 else (-slow, slow)
        backwards = task.outputs[-1] < task.outputs[0]
        low, high = (-most, -least) if backwards else (least, most)
        at = np.linspace(0.0, task.span[1], RATED)
        rows.append(np.column_stack([at, np.full(RATED, low), np.full(RATED, high)]))
    if not rows:
        return None
    at, low, high = np.concatenate(rows).T
    inside = np.minimum(INSIDE * unit / (task.span[1] - task.span[0]), (high - low) / 2)
    return np.column_stack([at, (low + inside) / unit, (high - inside) / unit])


def _triangle(problem: Problem, wanted: Requirements, travel: float | None) -> TriangleLimits:
    """Limits of the triangle of a problem's cylinder."""
    spec, stroke = problem.driver or CylinderSpec(), float(problem.task.inputs[-1])
    ground = FunctionGround.of(wanted)
    closed = spec.closed or (0.0, np.inf)
    least = stroke / (spec.ratio_max - 1)
    return TriangleLimits(
        stroke=stroke,
        base=distances(ground.placed(ground.length)[0], spec.base or ANYWHERE),
        closed=(max(closed[0], least * (1 + INSIDE)), closed[1]),
        lever=float(np.radians(wanted.cylinder_angle_min_deg or 0.0)) + INSIDE,
        ratio=wanted.link_ratio_max,
        unit=ground.length if travel is None else travel,
    )


def _with_scale(stated: Requirements, wanted: Requirements, usual: float) -> Requirements:
    """The requirements; where none of those stated limits r1 it has its usual length."""
    free = FunctionGround.of(stated).lengths == (0.0, np.inf)
    return replace(wanted, r1=(usual, usual)) if free else wanted


def _over(limits: Limits, unit: float) -> Limits:
    return limits[0] / unit, limits[1] / unit
