"""Requirements on a design. Every field is spelled as its key in a problem file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np

from grashof.problems.values.arrays import TURN, FloatArray, Limits
from grashof.problems.values.box import ANYWHERE, Box
from grashof.problems.values.checks import GREATEST, some_of, true_or_false, within
from grashof.problems.values.linkages.mechanisms import having
from grashof.problems.values.region import Region, regions
from grashof.problems.values.requirements import requirement_checks as check
from grashof.problems.values.requirements.limit_kinds import Kind, Limit
from grashof.problems.values.requirements.limiting import (
    between,
    coupler,
    limit,
    on_body,
    place_of,
    structural_error,
)
from grashof.problems.values.requirements.link_ratios import LinkRatios
from grashof.problems.values.requirements.modes import Rotatability, TransmissionOver
from grashof.problems.values.requirements.named_limits import NamedLimits
from grashof.problems.values.requirements.quantities import (
    MEASURED,
    OUTPUTS,
    SINGLE,
    SLIDING,
    TRAVEL_ERRORS,
    Quantity,
    Scope,
)
from grashof.problems.values.requirements.target_limits import TargetLimits
from grashof.problems.values.tasks.task import USUAL_MARGIN, Task
from grashof.problems.values.units import Unit
from grashof.problems.values.value_bases import ReadOnly, check_fields

_SWING = "of link 4 between its limit positions, over the task where the driver cannot turn"
_STROKES = "time of the slow stroke of link 4 over that of the quick one"
_TRAVEL = "of the slide between its limit positions, over the task where the driver cannot turn"
_TARGETS = "from the first target to the last"


@dataclass(frozen=True, slots=True, kw_only=True)
class Requirements(ReadOnly):
    """The conditions that a design must satisfy besides performing the task.

    Lengths are in the problem's unit; None means the default, which excludes only absurd designs
    and is taken from the size of the task (see `resolved`).

    Parameters
    ----------
    exact : bool, optional
        Whether every target is met, or the squared errors are made least. By default exact wherever
        linkages that meet every target can be expected (see `is_exact`).
    tolerance : float
        A design is exact when its largest error is at most ``tolerance * size``.
    error_factor : float, optional
        Least squares: the objective decides among designs with up to this multiple of the least error.
    rotatability : Rotatability, optional
        full-crank (the driver turns fully), crank-rocker, double-crank, or any (the driver
        covers the task). By default full-crank, of functions any.
    rotatability_margin : float
        r3+r4-r1-r2 and |r1-r2|-|r3-r4| are at least this share of r1+r2+r3+r4; by default 0.001, for the
        stroke of a slide 0, as its transmission angle says the same. Unless it is 0, the second loop of a
        six-bar has no change point, either.
    order : bool
        The driver meets the targets in sequence, in one sense, within one turn.
    same_branch : bool
        One assembly and no dead position over the task motion.
    transmission_min_deg : float, deg
        Least min(mu, pi - mu) over `transmission_over`.
    transmission_over : TransmissionOver
        task (the motion from first to last target) or cycle (the full turn).
    link_length : tuple of float, optional
        (lo, hi) for all links; r1, r2, r3, r4 and r5, r6 of a six-bar override it for single ones.
    link_ratio_max : float
        Longest to shortest of r1..r4, of a six-bar r1..r6.
    link_ratios : mapping of str to float or tuple of float, optional
        Ratios of two links, such as ``{"r4/r2": 1, "r3/r2": (2, 2.5)}``: a number, or (lo, hi).
    coupler_arms : tuple of float, optional
        (lo, hi) for the distances of P from the joints of its link: A-P and B-P, of a six-bar C-P and E-P.
    o2, o4, d : Box or Region, optional
        Where this ground pivot may lie; D is that of link 6, of a Watt II or Stephenson III.
    a, b : Box or Region, optional
        Where this moving pivot may be at every target.
    distances : mapping of str to float or tuple of float, optional
        Distances at every target, such as ``{"a-o4": (2, 3)}``: a number, or (lo, hi), of a-o4, b-o2, a-p,
        b-p, o2-p or o4-p.
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
        (lo, hi) for the same where the output is the travel of a slide.
    time_ratio : tuple of float, optional
        (lo, hi) for the time of the slow stroke of link 4 over that of the quick one, the driver turning
        steadily; undefined for a driver that does not turn fully.
    mechanical_advantage_min : float, optional
        Least ``|omega2 / omega4|`` over the task motion.
    cylinder_angle_min_deg : float, deg, optional
        Least angle between the cylinder that drives and its arm, over the task motion.
    cylinder_force_max : tuple of float, N, optional
        (lo, hi) for its greatest force.
    cylinder_rate : tuple of float, length, optional
        (lo, hi) for the moment arm of its force on link 4, the change of its length for a radian.
    coupler_angle_deg : tuple of float, deg, optional
        (lo, hi) for the direction A->B over the task motion; 360 deg more is the same.
    coupler_rate : tuple of float, optional
        (lo, hi) for the derivative of this direction with respect to the driver angle, over the task motion.
    a_on_body, b_on_body : Box or Region, optional
        Where this pivot may sit on the body that is guided, in its frame: origin at P, turned with it.
    keep_out : sequence of array_like, shape (M, 2), length
        Polygons; their boundary may be touched. Where two overlap or share a side they are one.
    keep_out_for : sequence of {"o2", "o4", "a", "b", "p", "links", "body"}
        Parts that keep out of them: pivots, coupler point, all links as straight lines (O2A, AB, O4B,
        AP, BP), or the outline of the body; all but o2 and o4 over the motion from first to last target.
    at : sequence of TargetLimits
        Limits at single targets.
    """

    exact: bool | None = None
    tolerance: float = 1e-6
    error_factor: float | None = None
    rotatability: Rotatability = None  # type: ignore[assignment]  # the task's own, in a problem
    rotatability_margin: float = None  # type: ignore[assignment]  # the task's own, in a problem
    order: bool = True
    same_branch: bool = True
    transmission_min_deg: float = limit(
        Quantity("transmission", "mu", Unit.ANGLE, Scope.TASK, +1, listed=False),
        Kind.AT_LEAST,
        default=0.0,
        allowed=(0.0, 90.0),
    )
    transmission_over: TransmissionOver = TransmissionOver.TASK
    link_length: Limits | None = between(
        Quantity("link_length", "link length", Unit.LENGTH, listed=False), usual=(0.01, 20.0)
    )
    r1: Limits | None = between("r1")
    r2: Limits | None = between("r2")
    r3: Limits | None = between("r3")
    r4: Limits | None = between("r4")
    r5: Limits | None = between("r5")
    r6: Limits | None = between("r6")
    offset: Limits | None = between("offset", -GREATEST)
    slide_angle_deg: float | Limits | None = limit("slide_angle", Kind.DIRECTION)
    coupler_arms: Limits | None = between(
        Quantity("coupler_arms", "coupler arm", Unit.LENGTH, listed=False), usual=(0.0, 30.0)
    )
    link_ratio_max: float = limit(
        Quantity("link_ratio", "ratio of longest to shortest link", Unit.RATIO, better=-1, listed=False),
        Kind.AT_MOST,
        default=20.0,
        allowed=(1.0, 1e6),
    )
    link_ratios: Mapping[str, float | Limits] | None = limit(
        Quantity("link_ratios", "ratio of two links", Unit.RATIO, listed=False), Kind.NAMED
    )
    o2: Box | None = limit(place_of("o2", Scope.DESIGN), Kind.INSIDE)
    o4: Box | None = limit(place_of("o4", Scope.DESIGN), Kind.INSIDE)
    d: Box | None = limit(place_of("d", Scope.DESIGN), Kind.INSIDE)
    a: Box | None = limit(place_of("a", Scope.TARGETS), Kind.INSIDE)
    b: Box | None = limit(place_of("b", Scope.TARGETS), Kind.INSIDE)
    distances: Mapping[str, float | Limits] | None = limit(
        Quantity("distances", "distance of two points", Unit.LENGTH, Scope.TARGETS, listed=False), Kind.NAMED
    )
    ground_angle_deg: float | Limits | None = limit(
        Quantity("ground_angle", "direction of O2O4", Unit.ANGLE, listed=False, kinds=having("o4")),
        Kind.DIRECTION,
    )
    theta2_start_deg: float | None = limit("theta2_start", Kind.EQUAL)
    size: Limits | None = between("size")
    omega4_max: Limits | None = between("omega4_max")
    point_speed_max: Limits | None = between("point_speed_max")
    point_acceleration_max: Limits | None = between("point_acceleration_max")
    synchrony_error: Limits | None = between("synchrony_error", 0.0, 1.0)
    output_acceleration_max: Limits | None = between("output_acceleration_max")
    torque_peak: Limits | None = between("torque_peak")
    torque_rms: Limits | None = between("torque_rms")
    torque_deviation: Limits | None = between("torque_deviation")
    torque_deviation_max: Limits | None = between("torque_deviation_max")
    joint_force_peak: Limits | None = between("joint_force_peak")
    coupler_fit_r2: Limits | None = between("coupler_fit_r2", -GREATEST, 1.0)
    hausdorff: Limits | None = between("hausdorff")
    frechet: Limits | None = between("frechet")
    worst_move: Limits | None = between("worst_move")
    share_within_made: Limits | None = between("share_within_made", 0.0, 1.0)
    driver_rotation_deg: Limits | None = between(
        Quantity("driver_rotation", "driver rotation", Unit.ANGLE, Scope.TARGETS, about=_TARGETS),
        high=360.0,
    )
    driver_sense: str = limit(
        Quantity("driver_sense", "sense of the driver", Unit.RATIO, listed=False),
        Kind.WORD,
        default="either",
        words={"either": (-1.0, 1.0), "ccw": (1.0, 1.0), "cw": (-1.0, -1.0)},
    )
    output_swing_deg: Limits | None = between(
        Quantity("output_swing", "output swing", Unit.ANGLE, Scope.CYCLE, +1, about=_SWING, kinds=OUTPUTS),
        high=360.0,
    )
    stroke: Limits | None = between(
        Quantity("stroke", "stroke", Unit.LENGTH, Scope.CYCLE, +1, about=_TRAVEL, kinds=SLIDING)
    )
    time_ratio: Limits | None = between(
        Quantity("time_ratio", "time ratio", Unit.RATIO, Scope.CYCLE, +1, about=_STROKES, kinds=SINGLE),
        1.0,
        1e6,
    )
    mechanical_advantage_min: float | None = limit(
        Quantity(
            "mechanical_advantage",
            "mechanical advantage",
            Unit.RATIO,
            Scope.TASK,
            +1,
            listed=False,
            kinds=OUTPUTS,
        ),
        Kind.AT_LEAST,
        allowed=(0.0, 1e6),
    )
    cylinder_angle_min_deg: float | None = limit("cylinder_angle_min", Kind.AT_LEAST, allowed=(0.0, 90.0))
    cylinder_force_max: Limits | None = between("cylinder_force_max")
    cylinder_rate: Limits | None = between("cylinder_rate")
    structural_error_max_deg: Limits | None = between(structural_error("max"), 0.0, 360.0)
    structural_error_rms_deg: Limits | None = between(structural_error("rms"), 0.0, 360.0)
    structural_error_max: Limits | None = between(structural_error("max", TRAVEL_ERRORS))
    structural_error_rms: Limits | None = between(structural_error("rms", TRAVEL_ERRORS))
    coupler_angle_deg: Limits | None = coupler("angle")
    coupler_rate: Limits | None = coupler("rate")
    a_on_body: Box | None = limit(on_body("a"), Kind.ON_BODY)
    b_on_body: Box | None = limit(on_body("b"), Kind.ON_BODY)
    keep_out: tuple[FloatArray, ...] = ()
    keep_out_for: tuple[str, ...] = ("o2", "o4")
    at: tuple[TargetLimits, ...] = ()

    def __post_init__(self) -> None:
        check_fields(self, "requirements.", **_CHECKS)

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
        """The limits that are stated, by field."""
        return {name: each for name, each in LIMITS.items() if getattr(self, name) not in (None, ANYWHERE)}

    @property
    def named(self) -> dict[str, NamedLimits]:
        """The limits by name, such as ratios of links, by field."""
        every = {name: getattr(self, name) for name in LIMITS}
        return {name: each for name, each in every.items() if isinstance(each, NamedLimits)}

    @property
    def ratios(self) -> LinkRatios:
        """Limits of ratios of links; empty without any."""
        return LinkRatios(tuple(self.ranges("link_ratios").items()))

    @property
    def regions(self) -> dict[str, Region]:
        """The places that are regions, not boxes, by field."""
        return regions({name: getattr(self, name) for name in LIMITS})

    def as_required(self, quantity: Quantity) -> Quantity:
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
        """The ranges that a field allows (see `Limit.ranges`); empty where it limits nothing."""
        value = getattr(self, name) if name in LIMITS else None
        return {} if value in (None, ANYWHERE) else LIMITS[name].ranges(value)


# The limits, by field.
LIMITS: dict[str, Limit] = {
    field.name: field.metadata["limit"] for field in fields(Requirements) if "limit" in field.metadata
}
_RANGES = {"tolerance": (1e-12, 1.0), "error_factor": (1.0, 1e6), "rotatability_margin": (0.0, 0.25)}
_CHECKS: dict[str, Callable[[Any, str], Any]] = {
    **dict.fromkeys(("exact", "order", "same_branch"), true_or_false),
    "rotatability": partial(check.word, Rotatability),
    "transmission_over": partial(check.word, TransmissionOver),
    **{name: within(*limits) for name, limits in _RANGES.items()},
    **{name: partial(check.limits, limited) for name, limited in LIMITS.items()},
    "keep_out": check.areas,
    "at": check.at_targets,
    "keep_out_for": partial(some_of, words=check.MAY_KEEP_OUT, wanted=check.KEPT_OUT),
}
