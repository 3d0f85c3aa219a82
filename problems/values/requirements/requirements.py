"""Requirements on a design. Every field is spelled as its key in a problem file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from typing import Any, cast

import numpy as np

from grashof.problems.values.arrays import TURN, FloatArray, Limits
from grashof.problems.values.box import ANYWHERE, Box
from grashof.problems.values.checks import GREATEST, finite_number, limits, number_within
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.linkages.four_bar import FourBar
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.linkages.mechanisms import SLIDER_CRANK, having
from grashof.problems.values.read_only import ReadOnly
from grashof.problems.values.requirements.quantities import (
    MEASURED,
    TURNING,
    Kind,
    Limit,
    Needs,
    Over,
    Quantity,
    limit,
)
from grashof.problems.values.tasks.task import USUAL_MARGIN, Task
from grashof.problems.values.units import Unit


class Rotatability(StrEnum):
    """What the driver must be able to do."""

    FULL_CRANK = "full-crank"
    CRANK_ROCKER = "crank-rocker"
    DOUBLE_CRANK = "double-crank"
    ANY = "any"


class TransmissionOver(StrEnum):
    """The motion over which the transmission angle is judged."""

    TASK = "task"
    CYCLE = "cycle"


_SWING = "of link 4 between its limit positions, over the task where the driver cannot turn"
_STROKES = "time of the slow stroke of link 4 over that of the quick one"
_TRAVEL = "of the slide between its limit positions, over the task where the driver cannot turn"
_FIRST_TO_LAST = "from the first target to the last"
_FROM_ZERO = (0.0, GREATEST)
# What structural errors of a slide, in the unit of length, are as quantities.
TRAVEL_ERRORS = {f"structural_error_{key}": f"travel_error_{key}" for key in ("max", "rms")}


def _place(name: str, over: Over) -> Quantity:
    kinds = having(name) if over is Over.DESIGN else tuple(ONE_LOOP)
    return Quantity(name, f"place of {name.upper()}", Unit.LENGTH, over, listed=False, kinds=kinds)


def _structural(key: str, label: str, *, travels: bool = False) -> Quantity:
    about, name = "output less what is wanted, over the whole range", f"structural_error_{key}"
    words = "greatest structural error" if key == "max" else "structural error (root mean square)"
    if not travels:
        return Quantity(name, label, Unit.ANGLE, Over.TASK, -1, Needs.ROTATION, 3, about, words=words)
    return Quantity(
        TRAVEL_ERRORS[name], label, Unit.LENGTH, Over.TASK, -1, Needs.TRAVEL, 3, about, named=name,
        kinds=(SLIDER_CRANK,), words=words,
    )  # fmt: skip


def _bracket(name: str) -> Quantity:
    words = f"place of {name.upper()} on the body"
    kinds = tuple(word for word, kind in ONE_LOOP.items() if name in kind.links[2].points)
    return Quantity(f"{name}_on_body", words, Unit.LENGTH, needs=Needs.ANGLES, listed=False, kinds=kinds)


@dataclass(frozen=True, slots=True, kw_only=True)
class Requirements(ReadOnly):
    """What a design must satisfy besides doing the task.

    Lengths are in the problem's unit; None means the default, which excludes only the absurd
    and is taken from the size of the task (see `resolved`).

    Parameters
    ----------
    exact : bool, optional
        Whether every target is met, or the squared errors are made least. By default exact wherever
        linkages that meet every target can be expected (see `is_exact`).
    tolerance : float
        A design is exact when its largest error is at most ``tolerance * size``.
    error_factor : float, optional
        Least squares: the objective decides among designs of up to so many times the least error found.
    rotatability : Rotatability, optional
        full-crank (the driver turns fully), crank-rocker, double-crank, or any (the driver
        covers the task). By default full-crank, of functions any.
    rotatability_margin : float
        r3+r4-r1-r2 and |r1-r2|-|r3-r4| are at least this share of r1+r2+r3+r4; by default 0.001, for the
        stroke of a slide 0, as its transmission angle says the same.
    order : bool
        The driver meets the targets in sequence, in one sense, within one turn.
    same_branch : bool
        One assembly and no dead position over the task motion.
    transmission_min_deg : float, deg
        Least min(mu, pi - mu) over `transmission_over`.
    transmission_over : TransmissionOver
        task (the motion from first to last target) or cycle (the whole turn).
    link_length : tuple of float, optional
        (lo, hi) for all four links; r1, r2, r3, r4 override it for single ones.
    link_ratio_max : float
        Longest to shortest of r1..r4.
    coupler_arms : tuple of float, optional
        (lo, hi) for the distances A-P and B-P.
    o2, o4 : Box, optional
        Where this ground pivot may lie.
    a, b : Box, optional
        Where this moving pivot may be at every target.
    offset : tuple of float, optional
        (lo, hi) for the signed offset of a slide: of its line from O2, of an inverted one from O4.
    slide_angle_deg : float or tuple of float, deg, optional
        Direction of the slide of a slider-crank, or (lo, hi) for it. For poses and paths 180 deg more is
        the same line, unless `offset` is limited; the offset of a listed design counts from the direction
        that is listed.
    ground_angle_deg : float or tuple of float, deg, optional
        Direction O2->O4, or (lo, hi) for it.
    theta2_start_deg : float, deg, optional
        Driver angle at the first target.
    size, torque_peak, worst_move, ... : tuple of float, optional
        (lo, hi) for whatever candidates.csv lists; see `grashof.problems.values.requirements.quantities`.
    driver_rotation_deg : tuple of float, deg, optional
        (lo, hi) for the driver rotation from the first target to the last.
    driver_sense : {"either", "ccw", "cw"}
        Sense of the driver from the first target to the last: counter-clockwise or clockwise.
    output_swing_deg : tuple of float, deg, optional
        (lo, hi) for the swing of link 4 between its limit positions, O2, A, B in line; over the task motion
        where the driver does not turn fully, and 360 where link 4 does.
    stroke : tuple of float, optional
        (lo, hi) for the travel of a slider-crank's slide between its limit positions; over the task motion
        where the driver does not turn fully.
    structural_error_max_deg : tuple of float, deg, optional
        (lo, hi) for the greatest structural error of a function over its range.
    structural_error_rms_deg : tuple of float, deg, optional
        (lo, hi) for its root mean square.
    structural_error_max, structural_error_rms : tuple of float, optional
        (lo, hi) for the same of a function whose output is the travel of a slide.
    time_ratio : tuple of float, optional
        (lo, hi) for the time of the slow stroke of link 4 over that of the quick one, the driver turning
        steadily; of a driver that does not turn fully there is none.
    mechanical_advantage_min : float, optional
        Least ``|omega2 / omega4|`` over the task motion.
    cylinder_angle_min_deg : float, deg, optional
        Least angle between the cylinder that drives and its arm, over the task motion.
    cylinder_force_max : tuple of float, N, optional
        (lo, hi) for its greatest force.
    a_on_body, b_on_body : Box, optional
        Where this pivot may sit on the body that is guided, in its frame: origin at P, turned with it.
    keep_out : sequence of array_like, shape (M, 2), length
        Polygons; their boundary may be touched. Where two overlap or share a side they are one.
    keep_out_for : sequence of {"o2", "o4", "a", "b", "p", "links", "body"}
        What keeps out of them: pivots, coupler point, all links as straight lines (O2A, AB, O4B,
        AP, BP), or the outline of the body; all but o2 and o4 over the motion from first to last target.
    """

    exact: bool | None = None
    tolerance: float = 1e-6
    error_factor: float | None = None
    rotatability: Rotatability = None  # type: ignore[assignment]  # the task's own, in a problem
    rotatability_margin: float = None  # type: ignore[assignment]  # the task's own, in a problem
    order: bool = True
    same_branch: bool = True
    transmission_min_deg: float = limit(
        Quantity("transmission", "mu", Unit.ANGLE, Over.TASK, +1, listed=False),
        Kind.AT_LEAST,
        default=0.0,
        allowed=(0.0, 90.0),
    )
    transmission_over: TransmissionOver = TransmissionOver.TASK
    link_length: Limits | None = limit(
        Quantity("link_length", "link length", Unit.LENGTH, listed=False),
        Kind.BETWEEN,
        allowed=_FROM_ZERO,
        usual=(0.01, 20.0),
    )
    r1: Limits | None = limit("r1", Kind.BETWEEN, allowed=_FROM_ZERO)
    r2: Limits | None = limit("r2", Kind.BETWEEN, allowed=_FROM_ZERO)
    r3: Limits | None = limit("r3", Kind.BETWEEN, allowed=_FROM_ZERO)
    r4: Limits | None = limit("r4", Kind.BETWEEN, allowed=_FROM_ZERO)
    offset: Limits | None = limit("offset", Kind.BETWEEN, allowed=(-GREATEST, GREATEST))
    slide_angle_deg: float | Limits | None = limit("slide_angle", Kind.DIRECTION)
    coupler_arms: Limits | None = limit(
        Quantity("coupler_arms", "coupler arm", Unit.LENGTH, listed=False),
        Kind.BETWEEN,
        allowed=_FROM_ZERO,
        usual=(0.0, 30.0),
    )
    link_ratio_max: float = limit(
        Quantity("link_ratio", "ratio of longest to shortest link", Unit.RATIO, better=-1, listed=False),
        Kind.AT_MOST,
        default=20.0,
        allowed=(1.0, 1e6),
    )
    o2: Box | None = limit(_place("o2", Over.DESIGN), Kind.INSIDE)
    o4: Box | None = limit(_place("o4", Over.DESIGN), Kind.INSIDE)
    a: Box | None = limit(_place("a", Over.TARGETS), Kind.INSIDE)
    b: Box | None = limit(_place("b", Over.TARGETS), Kind.INSIDE)
    ground_angle_deg: float | Limits | None = limit(
        Quantity("ground_angle", "direction of O2O4", Unit.ANGLE, listed=False, kinds=having("o4")),
        Kind.DIRECTION,
    )
    theta2_start_deg: float | None = limit("theta2_start", Kind.EQUAL)
    size: Limits | None = limit("size", Kind.BETWEEN, allowed=_FROM_ZERO)
    omega4_max: Limits | None = limit("omega4_max", Kind.BETWEEN, allowed=_FROM_ZERO)
    point_speed_max: Limits | None = limit("point_speed_max", Kind.BETWEEN, allowed=_FROM_ZERO)
    point_acceleration_max: Limits | None = limit("point_acceleration_max", Kind.BETWEEN, allowed=_FROM_ZERO)
    torque_peak: Limits | None = limit("torque_peak", Kind.BETWEEN, allowed=_FROM_ZERO)
    torque_rms: Limits | None = limit("torque_rms", Kind.BETWEEN, allowed=_FROM_ZERO)
    joint_force_peak: Limits | None = limit("joint_force_peak", Kind.BETWEEN, allowed=_FROM_ZERO)
    coupler_fit_r2: Limits | None = limit("coupler_fit_r2", Kind.BETWEEN, allowed=(-GREATEST, 1.0))
    hausdorff: Limits | None = limit("hausdorff", Kind.BETWEEN, allowed=_FROM_ZERO)
    frechet: Limits | None = limit("frechet", Kind.BETWEEN, allowed=_FROM_ZERO)
    worst_move: Limits | None = limit("worst_move", Kind.BETWEEN, allowed=_FROM_ZERO)
    share_within_made: Limits | None = limit("share_within_made", Kind.BETWEEN, allowed=(0.0, 1.0))
    driver_rotation_deg: Limits | None = limit(
        Quantity("driver_rotation", "driver rotation", Unit.ANGLE, Over.TARGETS, about=_FIRST_TO_LAST),
        Kind.BETWEEN,
        allowed=(0.0, 360.0),
    )
    driver_sense: str = limit(
        Quantity("driver_sense", "sense of the driver", Unit.RATIO, listed=False),
        Kind.WORD,
        default="either",
        words={"either": (-1.0, 1.0), "ccw": (1.0, 1.0), "cw": (-1.0, -1.0)},
    )
    output_swing_deg: Limits | None = limit(
        Quantity("output_swing", "output swing", Unit.ANGLE, Over.CYCLE, +1, about=_SWING, kinds=TURNING),
        Kind.BETWEEN,
        allowed=(0.0, 360.0),
    )
    stroke: Limits | None = limit(
        Quantity("stroke", "stroke", Unit.LENGTH, Over.CYCLE, +1, about=_TRAVEL, kinds=(SLIDER_CRANK,)),
        Kind.BETWEEN,
        allowed=_FROM_ZERO,
    )
    time_ratio: Limits | None = limit(
        Quantity("time_ratio", "time ratio", Unit.RATIO, Over.CYCLE, +1, about=_STROKES),
        Kind.BETWEEN,
        allowed=(1.0, 1e6),
    )
    mechanical_advantage_min: float | None = limit(
        Quantity(
            "mechanical_advantage",
            "mechanical advantage",
            Unit.RATIO,
            Over.TASK,
            +1,
            listed=False,
            kinds=TURNING,
        ),
        Kind.AT_LEAST,
        allowed=(0.0, 1e6),
    )
    cylinder_angle_min_deg: float | None = limit("cylinder_angle_min", Kind.AT_LEAST, allowed=(0.0, 90.0))
    cylinder_force_max: Limits | None = limit("cylinder_force_max", Kind.BETWEEN, allowed=_FROM_ZERO)
    structural_error_max_deg: Limits | None = limit(
        _structural("max", "max error"), Kind.BETWEEN, allowed=(0.0, 360.0)
    )
    structural_error_rms_deg: Limits | None = limit(
        _structural("rms", "rms error"), Kind.BETWEEN, allowed=(0.0, 360.0)
    )
    structural_error_max: Limits | None = limit(
        _structural("max", "max error", travels=True), Kind.BETWEEN, allowed=_FROM_ZERO
    )
    structural_error_rms: Limits | None = limit(
        _structural("rms", "rms error", travels=True), Kind.BETWEEN, allowed=_FROM_ZERO
    )
    a_on_body: Box | None = limit(_bracket("a"), Kind.ON_BODY)
    b_on_body: Box | None = limit(_bracket("b"), Kind.ON_BODY)
    keep_out: tuple[FloatArray, ...] = ()
    keep_out_for: tuple[str, ...] = ("o2", "o4")

    def __post_init__(self) -> None:
        if not isinstance(self.exact, bool | None):
            raise wrong_value("requirements.exact", self.exact, "true or false")
        for name in ("order", "same_branch"):
            if not isinstance(getattr(self, name), bool):
                raise wrong_value(f"requirements.{name}", getattr(self, name), "true or false")
        for name, kind in (("rotatability", Rotatability), ("transmission_over", TransmissionOver)):
            if getattr(self, name) is None and name == "rotatability":  # the task's own
                continue
            object.__setattr__(self, name, _member(kind, getattr(self, name), f"requirements.{name}"))
        for name, (low, high) in _RANGES.items():
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, number_within(value, low, high, f"requirements.{name}"))
        for name, limited in LIMITS.items():
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, _limits(value, limited, f"requirements.{name}"))
        object.__setattr__(self, "keep_out", _areas(self.keep_out))
        object.__setattr__(self, "keep_out_for", _kept_out(self.keep_out_for))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Requirements):
            return NotImplemented
        return self._comparable() == other._comparable()

    def __hash__(self) -> int:
        return hash(self._comparable())

    def _comparable(self) -> tuple[object, ...]:
        """Every field, the arrays among them as tuples."""
        areas = tuple(tuple(map(tuple, corners.tolist())) for corners in self.keep_out)
        named = ("keep_out", "rotatability", "rotatability_margin")
        turns = self.rotatability or Rotatability.FULL_CRANK  # where no task says otherwise
        margin = USUAL_MARGIN if self.rotatability_margin is None else self.rotatability_margin
        others = (field.name for field in fields(self) if field.name not in named)
        return areas, turns, margin, *(getattr(self, name) for name in others)

    @property
    def link_lengths(self) -> tuple[Limits, Limits, Limits, Limits]:
        """Limits of r1, r2, r3, r4 (of resolved requirements)."""
        every = self.link_length or (0.0, np.inf)
        return self.r1 or every, self.r2 or every, self.r3 or every, self.r4 or every

    def contradictions(self, task: Task) -> list[str]:
        """What these requirements and a task do not agree on, a line each."""
        wrong = []
        if task.zones is not None and self.exact:
            wrong.append(f"{task.kind}.within does not go with requirements.exact = true; it takes its place")
        if task.zones is not None and self.error_factor is not None:
            wrong.append(f"requirements.error_factor does not go with {task.kind}.within; give one of them")
        if self.error_factor is not None and self.is_exact(task):
            wrong.append("requirements.error_factor needs least squares, exact = false")
        directions = (name for name, limited in LIMITS.items() if limited.kind is Kind.DIRECTION)
        wrong += [
            f"requirements.{name} is a range; of a {task.kind} it must be a single angle"
            for name in directions
            if isinstance(getattr(self, name), tuple) and not task.has_position.any()
        ]
        if self.keep_out and "body" in self.keep_out_for and task.body is None:
            wrong.append(f"{task.kind}.body is missing; requirements.keep_out_for has body")
        return wrong

    def is_exact(self, task: Task) -> bool:
        """Whether a design has to meet every target of the task.

        Examples
        --------
        >>> from grashof.problems import PathTask
        >>> line = PathTask([[0, 0], [1, 0], [2, 0]])
        >>> Requirements().is_exact(line), Requirements(exact=False).is_exact(line)
        (True, False)
        """
        if task.zones is not None:
            return False
        return task.exact_by_default if self.exact is None else self.exact

    def for_task(self, task: Task) -> Requirements:
        """These requirements with the rotatability and margin usual for a task, where they state none."""
        usual: dict[str, Any] = {}
        if self.rotatability not in tuple(Rotatability):
            usual["rotatability"] = Rotatability(task.usual_rotatability)
        if self.rotatability_margin is None:
            usual["rotatability_margin"] = task.usual_margin
        return replace(self, **usual) if usual else self

    def resolved(self, size: float, *, scale_free: bool = False) -> Requirements:
        """These requirements with every default that depends on the size of the task filled in.

        Where the scale is free, no length has a default.

        Examples
        --------
        >>> Requirements().resolved(2.0).link_length
        (0.02, 40.0)
        """
        usual: dict[str, Any] = {
            name: (limited.usual[0] * size, min(limited.usual[1] * size, GREATEST))
            for name, limited in LIMITS.items()
            if limited.usual is not None and getattr(self, name) is None and not scale_free
        }
        anywhere: dict[str, Any] = {
            name: ANYWHERE
            for name, limited in LIMITS.items()
            if limited.kind is Kind.INSIDE and getattr(self, name) is None
        }
        return replace(self, **usual, **anywhere)

    @property
    def limited(self) -> dict[str, Limit]:
        """What is limited, by field: the fields that are stated."""
        return {
            name: limited for name, limited in LIMITS.items() if getattr(self, name) not in (None, ANYWHERE)
        }

    def meant(self, quantity: Quantity) -> Quantity:
        """The quantity itself; of the transmission angle, the one over the motion that is required."""
        over = quantity.key == "transmission"
        return MEASURED[f"transmission_min_{self.transmission_over}"] if over else quantity

    def angle_of(self, name: str) -> float | None:
        """The angle that a field fixes, rad; None where it fixes none, as a range does not."""
        value = getattr(self, name)
        return float(np.radians(value)) if isinstance(value, float) else None

    def period(self, key: str) -> float:
        """By how much the angles of a quantity differ that count as one, rad.

        A slide without a limit of its offset is a line, which has no sense.

        Examples
        --------
        >>> np.degrees([Requirements(offset=offset).period("slide_angle") for offset in (None, (0, 5))])
        array([180., 360.])
        """
        return np.pi if key == "slide_angle" and self.offset is None else TURN

    def ranges(self, name: str) -> dict[str, Limits]:
        """What a field allows (see `Limit.ranges`); empty where it limits nothing."""
        value = getattr(self, name) if name in LIMITS else None
        return {} if value in (None, ANYWHERE) else LIMITS[name].ranges(value)


_RANGES = {"tolerance": (1e-12, 1.0), "error_factor": (1.0, 1e6), "rotatability_margin": (0.0, 0.25)}

# What the fields limit, by field.
LIMITS: dict[str, Limit] = {
    field.name: field.metadata["limit"] for field in fields(Requirements) if "limit" in field.metadata
}

_ADVANTAGE = Quantity(
    "mechanical_advantage_min",
    "mechanical advantage",
    Unit.RATIO,
    Over.TASK,
    about="|omega2 / omega4| where it is least over the task motion",
    full="least mechanical advantage",
    kinds=TURNING,
)
# All quantities of a design, by key; those that are listed in the order of the columns.
QUANTITIES = MEASURED | {limited.quantity.key: limited.quantity for limited in LIMITS.values()}
QUANTITIES[_ADVANTAGE.key] = _ADVANTAGE
_ERROR_AT = Quantity(
    "structural_error_at",
    "worst at",
    Unit.ANGLE,
    Over.TASK,
    needs=Needs.OUTPUTS,
    about="driver rotation from the first pair to the greatest structural error",
    full="driver rotation to the greatest structural error",
)
QUANTITIES[_ERROR_AT.key] = _ERROR_AT


def _limits(value: Any, limited: Limit, where: str) -> Box | Limits | float | str:
    if limited.kind in (Kind.INSIDE, Kind.ON_BODY):
        if not isinstance(value, Box):
            raise wrong_value(where, value, "a Box")
        return value
    low, high = limited.allowed
    if limited.kind is Kind.BETWEEN:
        return limits(value, where, least=low, most=high)
    if limited.kind is Kind.WORD:
        if value not in limited.words:
            raise wrong_value(where, value, f"one of {', '.join(limited.words)}")
        return str(value)
    if limited.kind is Kind.DIRECTION and isinstance(value, tuple | list):
        low, high = limits(cast(Limits, value), where, least=-GREATEST)
        return low if low == high else (low, high)
    if limited.kind.is_angle:
        return finite_number(value, where)
    return number_within(value, low, high, where)


MAY_KEEP_OUT = (*FourBar.mechanism.points, "links", "body")


def _areas(values: Sequence[FloatArray]) -> tuple[FloatArray, ...]:
    if isinstance(values, Sequence) and not len(values):
        return ()
    # Here, not above: shapely takes a while to import, and few problems have areas.
    from grashof.problems.values.areas import polygons

    return polygons(values, "requirements.keep_out")


def _kept_out(names: Sequence[str]) -> tuple[str, ...]:
    wanted = f"a list of {', '.join(MAY_KEEP_OUT[:-1])} and {MAY_KEEP_OUT[-1]}"
    if isinstance(names, str) or not isinstance(names, Sequence) or not len(names):
        raise wrong_value("requirements.keep_out_for", names, wanted)
    for index, name in enumerate(names):
        if name not in MAY_KEEP_OUT:
            where = f"requirements.keep_out_for[{index}]"
            raise wrong_value(where, name, f"one of {', '.join(MAY_KEEP_OUT)}")
    return tuple(dict.fromkeys(names))


def _member(kind: type[StrEnum], value: str, where: str) -> StrEnum:
    try:
        return kind(value)
    except ValueError:
        raise wrong_value(where, value, f"one of {', '.join(kind)}") from None
