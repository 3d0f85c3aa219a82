"""The value of every quantity of a judged linkage, by the judge's own means."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import fields
from functools import cached_property, partial
from itertools import permutations
from operator import attrgetter

import numpy as np

from grashof.analysis.cylinder.lengths import CylinderFigures
from grashof.analysis.judge.coupler_motion import CouplerMotion, coupler_motions, curve_distances_of_each
from grashof.analysis.judge.cylinder_drive import cylinder_force_peak, figures_of
from grashof.analysis.judge.effort_travel import effort_deviation
from grashof.analysis.judge.meeting.dwell_output import made_band
from grashof.analysis.judge.over_task import (
    TORQUE,
    OverTask,
    each_over_task,
    motion_ends,
    over_task,
    task_peaks,
)
from grashof.analysis.judge.tolerance import robustness
from grashof.analysis.judge.verdict import Enclosure, Verdict
from grashof.analysis.judge.wanted_torque import torque_misses
from grashof.analysis.mechanism.position import Position, solve_position
from grashof.analysis.mechanism.stroke import OutputStroke, link_stroke, output_stroke
from grashof.problems import Cylinder, Linkage, Problem
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.linkages.mechanisms import LENGTHS, PARAMETERS
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.distances import PAIRS, ends_of
from grashof.problems.values.requirements.quantities import TRAVEL_ERRORS, Needs
from grashof.problems.values.tasks.tandem_task import LINKS

_RATES = tuple(f"rate_{name}" for name in ("start", "end", "min", "max"))  # of cylinders


class Values(Mapping[str, float]):
    """The values of a design by the keys of their quantities, each measured on first use.

    In rad, N, N m and the problem's unit of length. NaN where the problem lacks the data for one, or the
    linkage has no such value.
    """

    def __init__(self, linkage: Linkage, verdict: Verdict, problem: Problem) -> None:
        self.linkage, self.verdict, self.problem = linkage, verdict, problem
        self._known: dict[str, float] = {}
        self.enclosure: Enclosure | None = None  # once `find_enclosures` has made it

    def __getitem__(self, key: str) -> float:
        if key not in self._known:
            quantity = QUANTITIES[key]
            has = self.linkage.mechanism.word in quantity.kinds and self.problem.states(quantity.needs)
            self._known[key] = float(MEASURES[key](self)) if has else np.nan
        return self._known[key]

    def __iter__(self) -> Iterator[str]:
        return iter(MEASURES)

    def __len__(self) -> int:
        return len(MEASURES)

    def are_of(self, linkage: Linkage, verdict: Verdict, problem: Problem) -> bool:
        """Whether they are those of this very design, by a problem that states the same."""
        stated = attrgetter("requirements", "dynamics", "torque", "driver", "manufacturing", "length_unit")
        alike = self.problem is problem or stated(self.problem) == stated(problem)
        return self.linkage is linkage and self.verdict is verdict and alike

    def parts(self, key: str) -> Mapping[str, FloatArray]:
        """A quantity by its parts, such as the axes of a place; by "" where it is a number."""
        return PARTS[key](self) if key in PARTS else {"": np.array([self[key]])}

    @cached_property
    def columns(self) -> Mapping[str, float | str]:
        """Columns of the linkage."""
        return self.linkage.columns

    @cached_property
    def at_targets(self) -> Position:
        """The linkage at the targets."""
        return solve_position(self.linkage, self.verdict.theta2, self.verdict.assembly)

    @cached_property
    def theta2_ends(self) -> FloatArray:
        """Driver angles at the first target, above -pi to pi, and at the last."""
        first, last = self.verdict.theta2[[0, -1]].tolist()
        ends: FloatArray = np.array([first, last]) - TURN * np.ceil((first - np.pi) / TURN)
        return ends

    @cached_property
    def stroke(self) -> OutputStroke:
        """Where link 4 turns back, and how fast its strokes are."""
        return output_stroke(self.linkage)

    @cached_property
    def over_task(self) -> OverTask:
        """Figures of the motion from the first target to the last."""
        return over_task(self.linkage, self.problem, self.verdict)

    @cached_property
    def made(self) -> Mapping[str, float]:
        """How the design takes inexact dimensions."""
        if self.problem.manufacturing is None or "worst_move" in self.problem.task.without:
            return {}  # it has no meaning where no point is carried
        found = robustness(self.linkage, self.problem.task, self.verdict, self.problem.manufacturing)
        moves = zip(
            (f"move_{name}" for name in self.linkage.mechanism.dimensions), found.moves.tolist(), strict=True
        )
        shares = {"share_within_linear": found.share_linear, "share_within_made": found.share_made}
        return {**dict(moves), "worst_move": found.worst_move, **shares}

    @cached_property
    def cylinder(self) -> CylinderFigures | None:
        """Figures of the cylinder that drives it; None without one."""
        return figures_of(self.linkage, self.problem.task, self.verdict)

    @cached_property
    def coupler(self) -> CouplerMotion:
        """Extremes of the direction and the rate of the coupler over the task motion."""
        return coupler_motions([self.linkage], self.problem, [self.verdict])[0]

    @cached_property
    def torque_misses(self) -> FloatArray:
        """Drive torques minus the wanted ones."""
        return torque_misses(self.linkage, self.problem, self.verdict)

    @cached_property
    def curve_distances(self) -> list[float]:
        """Hausdorff and Fréchet distance of the coupler curve from the polygon of the targets."""
        return curve_distances_of_each([self.linkage], self.problem, [self.verdict])[0]


_COUPLER = {f"coupler_{field.name}": field.name for field in fields(CouplerMotion)}
# Figures that are found faster for several designs: the properties that keep them, and their quantities.
_TOGETHER: tuple[tuple[str, Callable[..., Sequence[object]], Set[str]], ...] = (
    ("over_task", each_over_task, {field.name for field in fields(OverTask)}),
    ("coupler", coupler_motions, _COUPLER.keys()),
    ("curve_distances", curve_distances_of_each, {"hausdorff", "frechet"}),
)


def find_together(designs: Sequence[Values], keys: Set[str]) -> None:
    """Find the figures behind quantities of designs of a problem at once, before they are needed."""
    if not designs:
        return
    problem = designs[0].problem
    stated = {key for key in keys if problem.states(QUANTITIES[key].needs)}
    for name, measure, quantities in _TOGETHER:
        wanted = [] if stated.isdisjoint(quantities) else [each for each in designs if name not in vars(each)]
        if wanted:
            found = measure([each.linkage for each in wanted], problem, [each.verdict for each in wanted])
            for each, figures in zip(wanted, found, strict=True):
                vars(each)[name] = figures  # as the cached property keeps it


def _angle_error(number: Callable[[FloatArray], float], values: Values) -> float:
    """A number of the angle errors; NaN where the task has no angle."""
    errors = values.verdict.angle_error
    return np.nan if np.isnan(errors).all() else number(errors)


def _column(name: str, values: Values) -> float:
    return float(values.columns.get(name, np.nan))


def _of_linkage(name: str, values: Values) -> float:
    """A field of the linkage; NaN where its kind has none."""
    return float(getattr(values.linkage, name, np.nan))


def _link_ratio(values: Values) -> float:
    lengths = values.linkage.lengths
    return lengths.max() / lengths.min() if lengths.min() > 0 else np.inf


def _made(key: str, values: Values) -> float:
    return values.made.get(key, np.nan)


def _output_swing(values: Values) -> float:
    """Between limit positions; over the task motion where the driver does not turn fully."""
    linkage = values.linkage
    if values.verdict.full_rotation:
        swing = float(values.stroke.swing)
        return TURN if np.isnan(swing) else swing
    limits = values.stroke.theta2
    theta4 = solve_position(linkage, _with(limits, values), values.verdict.assembly[0]).theta4
    return float(np.ptp(np.unwrap(theta4)))


def _stroke(values: Values) -> float:
    """Of the slider, likewise."""
    if len(values.linkage.mechanism.loops) > 1:
        return float(link_stroke(values.linkage).stroke) if values.linkage.mechanism.slides else np.nan
    limits = values.stroke
    if values.verdict.full_rotation:
        return float(limits.chord)
    b = solve_position(values.linkage, _with(limits.theta2, values), values.verdict.assembly[0]).b
    first = np.argmax(np.hypot(*(b - b[0]).T))  # an end of the way, as B goes to and fro on a line
    return float(np.hypot(*(b - b[first]).T).max())


def _with(theta2: FloatArray, values: Values) -> FloatArray:
    """Driver angles over the task motion, among them those of the given ones that lie in it."""
    start, end = motion_ends(values.problem.task, values.verdict)
    turned = theta2 + TURN * np.arange(-3, 4)[:, None]
    inside = turned[(turned > min(start, end)) & (turned < max(start, end))]
    return np.sort(np.concatenate([np.linspace(start, end, 181), inside]))


def _cylinder(name: str, values: Values) -> float:
    return np.nan if values.cylinder is None else getattr(values.cylinder, name)


def _cylinder_column(name: str, values: Values) -> float:
    return np.nan if (driven := values.verdict.cylinder) is None else driven.columns[name]


def _of_dwell(name: str, values: Values) -> float:
    return np.nan if (dwell := values.verdict.dwell) is None else getattr(dwell, name)


def _band_made(values: Values) -> float:
    dwell, made = values.verdict.dwell, values.problem.manufacturing
    if dwell is None:
        return np.nan
    return made_band(values.linkage, dwell, None if made is None else made.length_tolerance)


def _of_output(name: str, place: int, values: Values) -> float:
    """A figure of one of two outputs."""
    outputs = values.verdict.outputs
    return np.nan if outputs is None else getattr(outputs, name)[place]


def _torque_peak(values: Values) -> float:
    """That of `over_task`, without the rest of it."""
    if "over_task" in vars(values):
        return values.over_task.torque_peak
    return float(task_peaks([values.linkage], values.problem, [values.verdict], torque_alone=True)[0, TORQUE])


def _omega2(values: Values) -> float:
    return 1.0 if values.problem.dynamics is None else values.problem.dynamics.omega2


# Of every quantity that is one number.
MEASURES: dict[str, Callable[[Values], float]] = {
    **{name: partial(_column, name) for row in PARAMETERS if row.paired for name in row.columns},
    **{
        name: partial(_of_linkage, name)
        for name in (*LENGTHS, "offset", "offset_2", "slide_angle", "slide_angle_2")
    },
    "body_angle": lambda values: _angle_error(lambda _: float(values.linkage.body_angle), values),
    "ground_angle": attrgetter("linkage.theta1"),
    "link_ratio": _link_ratio,
    "theta2_start": lambda values: values.theta2_ends[0],
    "theta2_end": lambda values: values.theta2_ends[1],
    "error": lambda values: (
        np.nan
        if values.problem.task.has_output.any()
        else float(np.sqrt(values.verdict.square / len(values.problem.task)))
    ),
    **{(key := f"structural_error_{name}"): attrgetter(f"verdict.{key}") for name in ("max", "rms", "at")},
    **{key: attrgetter(f"verdict.{name}") for name, key in TRAVEL_ERRORS.items()},
    **{name: attrgetter(f"verdict.{name}") for name in ("error_max", "error_rms", "error_sse")},
    "angle_error_max": partial(_angle_error, np.nanmax),
    "angle_error_rms": partial(_angle_error, lambda errors: np.sqrt(np.nanmean(errors**2))),
    "transmission": lambda values: values[
        values.problem.requirements.as_required(QUANTITIES["transmission"]).key
    ],
    **{(key := f"transmission_min_{over}"): attrgetter(f"verdict.{key}") for over in ("task", "cycle")},
    "size": attrgetter("verdict.size"),
    **{field.name: attrgetter(f"over_task.{field.name}") for field in fields(OverTask)},
    "torque_peak": _torque_peak,
    "torque_deviation": lambda values: np.sqrt(np.mean(values.torque_misses**2)),
    "torque_deviation_max": lambda values: np.abs(values.torque_misses).max(),
    "dwell_from": partial(_of_dwell, "start"),
    "dwell_to": partial(_of_dwell, "end"),
    **dict.fromkeys(("band", "slide_band"), partial(_of_dwell, "band")),
    **dict.fromkeys(("band_made", "slide_band_made"), _band_made),
    "swing": partial(_of_dwell, "swing"),
    "length_ratio": attrgetter("verdict.length_ratio"),
    **{
        f"{name}_{link}": partial(_of_output, f"{name}s", place)
        for place, link in enumerate(LINKS)
        for name in ("swing", "time_ratio")
    },
    "synchrony_error": lambda values: (
        np.nan if values.verdict.outputs is None else values.verdict.outputs.synchrony_error
    ),
    "driver_rotation": lambda values: float(np.ptp(values.verdict.theta2)),
    "driver_sense": attrgetter("verdict.direction"),
    "output_swing": _output_swing,
    "stroke": _stroke,
    "time_ratio": lambda values: float(values.stroke.time_ratio),
    "mechanical_advantage": lambda values: _omega2(values) / values["omega4_max"],
    "mechanical_advantage_min": lambda values: values["mechanical_advantage"],
    **{key: attrgetter(f"coupler.{name}") for key, name in _COUPLER.items()},
    "hausdorff": lambda values: values.curve_distances[0],
    "frechet": lambda values: values.curve_distances[1],
    **{name: partial(_cylinder_column, name) for name in Cylinder.COLUMNS},
    **{f"cylinder_{name}": partial(_cylinder, name) for name in ("closed", "stroke", "angle_min", *_RATES)},
    "effort_deviation": lambda values: effort_deviation(values.linkage, values.problem, values.verdict),
    "cylinder_force_max": lambda values: cylinder_force_peak(values.linkage, values.problem, values.verdict),
    **{
        quantity.key: partial(_made, quantity.key)
        for quantity in QUANTITIES.values()
        if quantity.needs is Needs.MANUFACTURING
    },
}


def _place(point: str, values: Values) -> dict[str, FloatArray]:
    x, y = np.atleast_2d(attrgetter(point)(values)).T
    return {"x": x, "y": y}


def _lengths(values: Values) -> dict[str, FloatArray]:
    return dict(zip(values.linkage.mechanism.lengths, values.linkage.lengths[:, None], strict=True))


def _ratios(values: Values) -> dict[str, FloatArray]:
    """Of any two links."""
    every = permutations(_lengths(values).items(), 2)
    return {f"{one}/{other}": length / under for (one, length), (other, under) in every}


def _distances(values: Values) -> dict[str, FloatArray]:
    """Distances between points of the first loop, and of P from them, at every target."""
    state, ground = values.at_targets, values.linkage.mechanism.ground
    places = {name: getattr(state, name) for name in ("a", "b", "p")}
    places |= {name: np.asarray(getattr(values.linkage, name)) for name in ("o2", "o4") if name in ground}
    pairs = ((name, ends_of(name)) for name in PAIRS)
    return {
        name: np.linalg.norm(places[one] - places[other], axis=-1)
        for name, (one, other) in pairs
        if {one, other} <= set(places)
    }


def _arms(values: Values) -> dict[str, FloatArray]:
    """From P to the joints of the link that carries it."""
    arm, kind = complex(*values.linkage.coupler_point), values.linkage.mechanism
    origin, end, *_ = kind.links[kind.carries - 1].labels
    arms = {f"{origin}-P": np.abs([arm])}
    if (bar := f"r{kind.carries}") in kind.lengths:
        arms[f"{end}-P"] = np.abs([arm - float(getattr(values.linkage, bar))])
    return arms


def _has_b(linkage: Linkage) -> bool:
    """Whether the coupler has a point B, at r3 from A."""
    return "r3" in linkage.mechanism.lengths


def _on_body(of_a: bool, values: Values) -> dict[str, FloatArray]:
    """A or B in the frame of the body, whose origin is P."""
    linkage = values.linkage
    length = linkage.r3 if not of_a and _has_b(linkage) else 0.0
    arm = length - complex(*linkage.coupler_point)
    place = arm * np.exp(-1j * linkage.body_angle)
    return {"x": np.array([place.real]), "y": np.array([place.imag])}


def _extremes(key: str, values: Values) -> dict[str, FloatArray]:
    """The least and the greatest value of a quantity over the task motion."""
    return {"": np.array([values[f"{key}_{end}"] for end in ("min", "max")])}


def _grounds_d(linkage: Linkage) -> bool:
    """Whether D is a pivot of the ground."""
    return "d" in linkage.mechanism.ground


_NOWHERE = {axis: np.array([np.nan]) for axis in "xy"}
# Of those that have several parts.
PARTS: Mapping[str, Callable[[Values], Mapping[str, FloatArray]]] = {
    "link_length": _lengths,
    "link_ratios": _ratios,
    "coupler_arms": _arms,
    "o2": partial(_place, "linkage.o2"),
    "o4": partial(_place, "linkage.o4"),
    "d": lambda values: _place("linkage.d", values) if _grounds_d(values.linkage) else dict(_NOWHERE),
    "a": partial(_place, "at_targets.a"),
    "b": partial(_place, "at_targets.b"),
    "distances": _distances,
    "a_on_body": partial(_on_body, True),
    "b_on_body": partial(_on_body, False),
    "cylinder_rate": partial(_extremes, "cylinder_rate"),
    "coupler_angle": partial(_extremes, "coupler_angle"),
    "coupler_rate": partial(_extremes, "coupler_rate"),
}
