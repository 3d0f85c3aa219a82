"""A problem: the task, the requirements, the objective, and the effort of the search."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, get_type_hints

import numpy as np

from grashof.problems.values import checks
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec, metres, reference_torque
from grashof.problems.values.dynamics.manufacturing import Manufacturing
from grashof.problems.values.dynamics.wanted_torque import WantedTorque
from grashof.problems.values.efforts import EFFORTS
from grashof.problems.values.errors import ProblemError, shown, wrong_value
from grashof.problems.values.linkages.cylinder import CylinderSpec
from grashof.problems.values.linkages.mechanisms import (
    ROWS,
    freedoms,
    mechanisms,
    spelt_out,
)
from grashof.problems.values.requirements import task_limits
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.function_ground import grounded
from grashof.problems.values.requirements.modes import Rotatability
from grashof.problems.values.requirements.objective import GOALS, Objective
from grashof.problems.values.requirements.quantities import (
    BLOCKS,
    OF_SLIDES,
    ROCKERS,
    Needs,
    Quantity,
)
from grashof.problems.values.requirements.requirements import LIMITS, Requirements
from grashof.problems.values.requirements.task_limits import stated_size, strokes_wrong
from grashof.problems.values.specs import torque_limits
from grashof.problems.values.specs.dynamics_of_kind import misplaced
from grashof.problems.values.specs.needs import NEEDED, NO_OUTPUT, OF_OUTPUTS
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.text import counted, plain_text
from grashof.problems.values.units import Unit
from grashof.problems.values.value_bases import ReadOnly, check_fields, set_fields

LEAST_TOLERANCE = 1e-4  # sizes: from here on a tolerance is a zone about each target
NO_OBJECTIVE = (
    "objective is of no effect in least squares; it needs within (zones about the targets) or "
    "requirements.error_factor"
)
MOST_TARGETS = 10_000
# Of inverted slider-cranks: with offset 0 the transmission angle is 90 deg, and size decides.
SMALLEST = Objective(transmission=1.0, compactness=0.05)
ROCKING = (Rotatability.CRANK_ROCKER, Rotatability.DOUBLE_CRANK)  # defined by link 4, which has to turn


@dataclass(frozen=True, slots=True)
class Search:
    """How hard to search.

    Parameters
    ----------
    starts : int
        Most Ipopt solves.
    enough : int
        Exact tasks: stop between batches once this many distinct designs are verified. Least squares: with 1
        only the design of least error is found, without a list to choose from.
    seed : int
        Random seed.
    effort : float
        How long to look for better designs before stopping, 0.2 to 10 000: the rounds of a search with
        1 come first and unchanged.
    """

    starts: int = 200
    enough: int = 50
    seed: int = 0
    effort: float = 1.0

    def __post_init__(self) -> None:
        for name, least in (("starts", 1), ("enough", 1), ("seed", 0)):
            set_fields(self, **{name: checks.whole_number(getattr(self, name), least, f"search.{name}")})
        check_fields(self, "search.", effort=checks.within(*EFFORTS))


def _named(kind: Any) -> str:
    if kind is Task:
        return "MotionTask or PathTask or StrokeTask or TandemTask or FunctionTask"
    return " or ".join(each.__name__ for each in getattr(kind, "__args__", (kind,))).replace("Type", "")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Problem(ReadOnly):
    """A complete problem, as a problem file states it.

    Parameters
    ----------
    task : MotionTask, PathTask, StrokeTask, TandemTask, FunctionTask or DwellTask
    requirements : Requirements
    objective : Objective
    search : Search
    name, title, source, length_unit : str
        For people: file names, headings, axis labels.
    outlines : sequence of array_like, shape (M, 2), length
        The scene: drawn, no constraint.
    manufacturing : Manufacturing, optional
        How exactly linkages are made; without it there are no columns of made ones.
    dynamics : DynamicsSpec, optional
        Masses, speed and gravity; without it there are no torques and forces.
    mechanism : str or sequence of str
        The kinds of linkages that may do it, such as ("four-bar", "slider-crank"); one list of all.
    driver : CylinderSpec, optional
        The cylinder that drives the linkage, in place of a crank on link 2.
    torque : WantedTorque, optional
        The wanted drive torque; the deviation from it is then the default objective.
    """

    task: Task
    requirements: Requirements = field(default_factory=Requirements)
    objective: Objective = None  # type: ignore[assignment]  # the usual one of the task, once it is checked
    search: Search = field(default_factory=Search)
    name: str = "problem"
    title: str = ""
    source: str = ""
    length_unit: str = ""
    outlines: tuple[FloatArray, ...] = ()
    manufacturing: Manufacturing | None = None
    dynamics: DynamicsSpec | None = None
    mechanism: Sequence[str] = ()  # by default the usual one of the task
    driver: CylinderSpec | None = None
    torque: WantedTorque | None = None

    def __post_init__(self) -> None:
        usual = self.objective is None
        if usual:
            set_fields(self, objective=Objective())
        for name, kind in _KINDS.items():
            if not isinstance(value := getattr(self, name), kind):
                raise ProblemError(f"problem.{name} is {shown(value)}; it must be {_named(kind)}")
        if len(self.task) > MOST_TARGETS:
            raise ProblemError(f"the task has {len(self.task)} targets; it must have at most {MOST_TARGETS}")
        set_fields(self, requirements=self.requirements.for_task(self.task))
        set_fields(self, task=grounded(self.task, self.requirements))
        check_fields(self, **dict.fromkeys(("name", "title", "source", "length_unit"), plain_text))
        given = mechanisms(self.mechanism or self.task.usual_mechanism)
        set_fields(self, mechanism=spelt_out(given, self._unsuited))
        checks.refuse([line for word in self.mechanism if (line := Task.impossible(self.task, word))])
        set_fields(self, requirements=self._met_by_all_kinds())
        if usual:
            set_fields(self, objective=self.usual_objective)
        if isinstance(self.outlines, str) or not isinstance(self.outlines, Iterable):
            raise wrong_value("scene.outlines", self.outlines, "a list of outlines")
        wrong: list[str] = []
        if self.dynamics is not None:
            with checks.noted(wrong):
                metres(self.length_unit)  # refuses one that is not known
            with checks.noted(wrong):
                checks.positive_number(self.dynamics.speed_rpm, "dynamics.speed_rpm")
            for row in (row for word in self.mechanism for row in ROWS[word]):
                wrong += misplaced(self.dynamics, row)
            wrong += self.dynamics.beside_task
            wrong += self.dynamics.too_short(self.dynamics.turn_time, "a turn of the driver")
            if not self.dynamics.acts:
                wrong.append(
                    "dynamics has no mass; mass_per_length is needed, masses and inertias, density or "
                    "payload, or else loads, springs or friction"
                )
        wrong += self._not_of_these_kinds()
        wrong += self._without_value()
        wrong += task_limits.requirements_wrong(self.task, self.requirements, self.mechanism)
        if self.objective != self.usual_objective and not self.by_objective:
            wrong.append(NO_OBJECTIVE)
        if self.torque is not None:
            stated = self.task, self.requirements, self.dynamics, self.mechanism
            wrong += torque_limits.wrong(self.torque, *stated)
        if self.driver is not None:
            wrong += task_limits.cylinders_wrong(self.task, self.requirements)
        wrong += task_limits.lengths_wrong(self.task, self.requirements, self.driver)
        wrong += task_limits.functions_wrong(self.task, self.requirements, self.mechanism)
        wrong += task_limits.dwells_wrong(self.task, self.requirements)
        wrong += task_limits.tandems_wrong(self.task, self.requirements)
        wrong += [line for kind in self.mechanism if (line := self.task.impossible(kind))]
        if self.task.at_limits:
            wrong += strokes_wrong(self.task, self.requirements, self.mechanism)
        set_fields(self, task=self.task.sized(stated_size(self.requirements)))
        checks.refuse(wrong)
        set_fields(self, outlines=tuple(checks.each_checked(self.outlines, "scene.outlines", checks.outline)))

    def _unsuited(self, word: str) -> str:
        """Why "six-bar" does not stand for a kind; empty where it does."""
        return self.task.impossible(word) or self.task.needless(word)

    def _met_by_all_kinds(self) -> Requirements:
        """The requirements, exact by default only if all the kinds can be expected to meet every target."""
        fewest = min(freedoms(self.task.rows(kind) or ROWS[kind]) for kind in self.mechanism)
        exact = self.task.exact_for(fewest)
        if self.requirements.exact is not None or exact == self.task.exact_by_default:
            return self.requirements
        return replace(self.requirements, exact=exact)

    def _without_value(self) -> list[str]:
        """Quantities weighed or limited without the parts of the problem that they need, a line each."""
        used = self._weighed_or_limited
        given = {"driver.cylinder": self.driver, "dynamics": self.dynamics}
        absent = [name for name, value in given.items() if value is None]
        both = f"{' and '.join(absent)} {'are' if len(absent) > 1 else 'is'} missing"
        wrong = []
        for where, quantity in used.items():
            if not self.states(quantity.needs):
                without = quantity.needs in OF_OUTPUTS and not self.task.has_output.any()
                line = NO_OUTPUT if without else NEEDED[quantity.needs][1]
                wrong.append(f"{line.format(kind=self.task.kind, both=both)}; {where} needs it")
        wrong += task_limits.without_meaning(self.task, self.requirements, used)
        if not self.requirements.same_branch:
            wrong += [
                f"requirements.same_branch is false; it must be true when {where} is given"
                for where, quantity in used.items()
                if quantity.needs in (Needs.DYNAMICS, Needs.LOADED_CYLINDER)
            ]
        return wrong

    @property
    def _weighed_or_limited(self) -> dict[str, Quantity]:
        """Quantities that are weighed or limited, by key path."""
        stated = self.objective.stated.items()
        goals = {f"objective.maximise.{name}": self.as_required(GOALS[name]) for name, w in stated if w}
        limited = self.requirements.limited.items()
        return goals | {f"requirements.{name}": limit.quantity for name, limit in limited}

    def as_required(self, quantity: Quantity) -> Quantity:
        """The quantity by `Requirements.as_required`; errors and bands of a slide are lengths."""
        found, task = self.requirements.as_required(quantity), self.task
        slides = task.travels or (task.dwell is not None and task.stroke is not None)
        return QUANTITIES[OF_SLIDES.get(found.key, found.key)] if slides else found

    def _not_of_these_kinds(self) -> list[str]:
        """Quantities weighed or limited that none of the kinds of linkage has, a line each."""
        having: dict[str, Sequence[str]] = {
            where: quantity.kinds for where, quantity in self._weighed_or_limited.items()
        }
        if self.requirements.rotatability in ROCKING:
            having[f'requirements.rotatability = "{self.requirements.rotatability}"'] = ROCKERS
        having |= task_limits.kinds_of_names(self.requirements)
        return task_limits.not_of_kinds(self.task, self.mechanism, having)

    def for_kind(self, kind: str) -> Problem:
        """The same for one kind of linkage alone, without limits and goals that do not apply to it.

        By default inverted slider-cranks are searched for a small size, too.

        Examples
        --------
        >>> from grashof.problems import PathTask
        >>> task, wanted = PathTask([[0, 0], [1, 0], [2, 0]]), Requirements(r2=(1, 2), r4=(3, 4))
        >>> alone = Problem(task=task, requirements=wanted, mechanism=["four-bar", "slider-crank"])
        >>> alone.for_kind("slider-crank").requirements == Requirements(r2=(1, 2))
        True
        """
        plain = Requirements()
        others = {name for name, limit in LIMITS.items() if kind not in limit.quantity.kinds}
        wanted = replace(self.requirements, **{name: getattr(plain, name) for name in others})
        named: dict[str, Any] = {name: each.for_kind(kind) for name, each in wanted.named.items()}
        wanted = replace(wanted, **named)
        if wanted.at:
            wanted = replace(wanted, at=tuple(filter(None, (each.for_kind(kind) for each in wanted.at))))
        if kind not in ROCKERS and wanted.rotatability in ROCKING:
            wanted = replace(wanted, rotatability=Rotatability.FULL_CRANK)
        weights = {name: w for name, w in self.objective.stated.items() if kind in GOALS[name].kinds}
        given = any(weights.values())
        objective = Objective(**{"transmission": 0.0} | weights) if given else self.usual_objective
        if kind in BLOCKS and objective == Objective() and self.by_objective:
            objective = SMALLEST
        return replace(self, mechanism=(kind,), requirements=wanted, objective=objective)

    def period(self, key: str) -> float:
        """See `Requirements.period`; functions and strokes give a slide its sense."""
        return self.requirements.period(key) if self.task.has_position.any() else TURN

    def states(self, needs: Needs) -> bool:
        """Whether it states the parts that a quantity needs to have a value."""
        return needs not in NEEDED or NEEDED[needs][0](self)

    @property
    def goals(self) -> tuple[tuple[Quantity, float], ...]:
        """Quantities of the objective and their weights; the transmission angle over the motion required."""
        goals = self.objective.goals.items()
        return tuple((self.as_required(QUANTITIES[key]), weight) for key, weight in goals)

    @property
    def usual_objective(self) -> Objective:
        """The objective where none is stated."""
        if self.torque is not None and self.by_objective:
            return Objective(0.0, torque_deviation=1.0)
        return Objective(**self.task.usual_objective)

    @property
    def by_objective(self) -> bool:
        """Whether the objective decides which design is better; otherwise the error does."""
        wanted = self.requirements
        bounded = self.task.zones is not None or wanted.error_factor is not None
        return bounded or wanted.is_exact(self.task)

    @property
    def zones(self) -> FloatArray | None:
        """How far positions (length) and angles (rad) may be missed, shape (2, N), where that is given.

        Each target's own zone, or a tolerance of `LEAST_TOLERANCE` and more where every target has
        to be met.
        """
        return zones_of(self.task, self.requirements)

    def without_zones(self, *, exact: bool | None = False) -> Problem:
        """The same problem without zones, by least squares unless `exact` states otherwise."""
        task = self.task.without_zones() if self.task.zones is not None else self.task
        tight = min(self.requirements.tolerance, Requirements().tolerance)
        wanted = replace(self.requirements, exact=exact, error_factor=None, tolerance=tight)
        objective = self.objective if wanted.is_exact(task) else Objective()
        return replace(self, task=task, requirements=wanted, objective=objective)

    def __repr__(self) -> str:
        return f"<Problem {self.name}: {type(self.task).__name__} of {counted(len(self.task), 'target')}>"

    def scale(self, quantity: Quantity) -> float:
        """The unit in which the objective counts a quantity, so that weights are pure numbers.

        Lengths and areas in sizes of the task, angles in 90 deg, velocities by a point one size from O2 on
        a driver at the problem's speed (1 rad/s without dynamics), torques and forces in `reference_torque`,
        forces at an arm of one size.
        """
        size, omega2 = self.task.size, 1.0 if self.dynamics is None else self.dynamics.omega2
        by_unit = {
            Unit.LENGTH: size,
            Unit.AREA: size**2,
            Unit.ANGLE: math.pi / 2,
            Unit.ANGULAR_VELOCITY: omega2,
            Unit.ANGULAR_ACCELERATION: omega2**2,
            Unit.VELOCITY: omega2 * size,
            Unit.ACCELERATION: omega2**2 * size,
        }
        if quantity.unit is Unit.TORQUE:
            return self.reference_torque
        if quantity.unit is Unit.FORCE:
            return self.reference_torque / (size * metres(self.length_unit))
        return by_unit.get(quantity.unit, 1.0)

    @property
    def reference_torque(self) -> float:
        """The torque that the objective counts torques in, N m; it depends on the problem alone.

        M S (g + omega2^2 S): the mass of links, payload and counterweights, held and turned at a radius
        of the task's size S. `mass_per_length` and `density` count as one bar of length S. Added are the
        greatest moments, the greatest forces at a radius of S, springs and dampers stretched by S (and
        omega2 S), or turned by 1 rad (and at omega2), and friction. 1 where nothing acts.

        Raises
        ------
        ProblemError
            The problem has no dynamics.
        """
        spec = self.dynamics
        if spec is None:
            raise ProblemError("dynamics is missing; without masses there is no torque")
        return reference_torque(spec, self.task.size, metres(self.length_unit))


_LISTED = ("outlines", "mechanism")  # with checks of their own
_KINDS = {name: kind for name, kind in get_type_hints(Problem).items() if name not in _LISTED}


def zones_of(task: Task, wanted: Requirements) -> FloatArray | None:
    """The zones of `Problem.zones`."""
    if task.zones is not None or not task.in_plane:
        return task.zones
    if wanted.tolerance < LEAST_TOLERANCE or not wanted.is_exact(task):
        return None
    radii = np.full((2, len(task)), wanted.tolerance * task.size)
    radii[1] /= task.angle_length
    return np.where([task.has_position, task.has_angle], radii, np.inf)
