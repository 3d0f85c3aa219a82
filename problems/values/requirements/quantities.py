"""Quantities of a design. Each is declared here, once, without its formula.

Limited, a quantity is a requirement; weighed, an objective; listed, a column; missed, a defect. The judge
has a measure of each by its key (`grashof.analysis.judge.measures`), the search a formula of those that it
can steer (`grashof.synth.quantities.formulas`); the two share nothing but the key.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum, StrEnum
from typing import Any

from grashof.problems.values.linkages.cylinder import Cylinder
from grashof.problems.values.linkages.mechanism import MECHANISMS, ONE_LOOP, WORDS, Mechanism, Parameter
from grashof.problems.values.linkages.mechanisms import DIMENSIONS, having
from grashof.problems.values.linkages.one_loop import FourBar
from grashof.problems.values.units import Unit
from grashof.problems.values.value_bases import set_fields


class Scope(StrEnum):
    """Where a quantity is taken."""

    DESIGN = "the design"
    TARGETS = "the targets"
    TASK = "the task motion, from the first target to the last"
    CYCLE = "the full turn"


class Needs(Enum):
    """The part of the problem on which a quantity depends."""

    NOTHING = "nothing"
    DYNAMICS = "dynamics"
    WANTED_TORQUE = "torque.wanted"
    MANUFACTURING = "manufacturing"
    CLOSED = "a closed path"
    LEAST_SQUARES = "exact = false"
    ANGLES = "targets with angles"
    CYLINDER = "driver.cylinder"
    LOADED_CYLINDER = "driver.cylinder and dynamics"
    OUTPUTS = "a function"
    ROTATION = "a function whose output turns"
    TRAVEL = "a function whose output slides"
    DWELL = "a dwell"
    DWELL_OF_LINK = "a dwell of a link that swings"
    DWELL_OF_SLIDE = "a dwell of a slide"
    TWO_OUTPUTS = "two strokes"
    EFFORT = "effort"


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity of a design."""

    key: str
    label: str  # heading in tables
    unit: Unit
    over: Scope = Scope.DESIGN
    better: int = 0  # +1 where more is better, -1 where less is, 0 for neither
    needs: Needs = Needs.NOTHING
    digits: int = 0  # significant ones of the largest value in a table; 0 where it is listed in files only
    about: str = ""  # a description, where the label is not enough
    listed: bool = True  # whether it is a column; a place, which has several parts, is not
    words: str = ""  # its name in a sentence, where that is not its label
    short: str = ""  # heading where there is little room, where that is not its label
    kinds: tuple[str, ...] = WORDS  # of linkages that have it
    named: str = ""  # its name in candidates.csv, where that is not its key
    full: str = ""  # its name in words in a list of all values, where that is not `words`

    def __post_init__(self) -> None:
        set_fields(self, words=self.words or self.label, short=self.short or self.label)
        set_fields(self, full=self.full or self.words)

    @property
    def column(self) -> str:
        """Its name in candidates.csv."""
        return self.named or (f"{self.key}_deg" if self.unit is Unit.ANGLE else self.key)

    @property
    def deviates(self) -> bool:
        """Whether it is a deviation, a length or an angle whose best value is zero."""
        return self.better < 0 and self.key != "size" and self.unit in (Unit.LENGTH, Unit.AREA, Unit.ANGLE)


_FIRST, _SIX_BARS = FourBar.mechanism, [row for row in MECHANISMS if row.word not in ONE_LOOP]
# Names of the lengths and places that state a linkage, by column.
_STATED = {
    "o2_x": "O2, x",
    "o2_y": "O2, y",
    "o4_x": "O4, x",
    "o4_y": "O4, y",
    "r1": "r1, ground link O2-O4",
    "r2": "r2, driver O2-A",
    "r3": "r3, coupler A-B",
    "r4": "r4, output link O4-B",
    "p_u": "P along its link",
    "p_v": "P perpendicular to its link",
    "r5": "r5, link 5, C-E",
    "r6": "r6, link 6, D-E",
    "c_u": "C along its link",
    "c_v": "C perpendicular to its link",
    "d_u": "D along its link",
    "d_v": "D perpendicular to its link",
    "offset": "offset of the slide",
    "offset_2": "offset of the second slide",
    "cylinder_base_x": "cylinder, fixed pivot, x",
    "cylinder_base_y": "cylinder, fixed pivot, y",
    "cylinder_u": "cylinder, moving pivot, along its link",
    "cylinder_v": "cylinder, moving pivot, perpendicular to its link",
}


def _length(key: str, label: str = "", **others: Any) -> Quantity:
    return Quantity(key, label or key, Unit.LENGTH, **{"full": _STATED.get(key, ""), **others})


def _stated(
    of: Iterable[Mechanism], *kinds: str, digits: int = 0, listed: Sequence[Parameter] = ()
) -> list[Quantity]:
    """Quantities of the columns of parameters of some kinds; of six-bars those that four-bars lack."""
    rows = (row for mechanism in of for row in mechanism.parameters if row.kind in kinds)
    names = dict.fromkeys(name for row in rows if row not in listed for name in row.columns)
    return [_length(name, kinds=having(name), digits=digits) for name in names]


def _move(name: str) -> Quantity:
    about = f"how far the worst target moves per unit of change of {name}"
    return Quantity(
        f"move_{name}", f"move by {name}", Unit.RATIO, Scope.TARGETS, -1, Needs.MANUFACTURING, about=about,
        kinds=having(name), full=f"sensitivity to {name.replace('_', ' ')}",
    )  # fmt: skip


def _rate(name: str = "", where: str = "", better: int = 0, *, listed: bool = True) -> Quantity:
    """The rate of a cylinder somewhere in the motion."""
    return _length(
        f"cylinder_rate{name}", f"cylinder rate{name.replace('_', ' ')}", over=Scope.TASK, better=better,
        needs=Needs.CYLINDER, about=_RATE, listed=listed, words=f"rate of the cylinder{where}",
        full=f"cylinder, rate{where}", kinds=OUTPUTS,
    )  # fmt: skip


def _of_dwell(key: str, words: str) -> tuple[Quantity, Quantity]:
    """A band, of a link that swings and of a slide."""
    given: dict[str, Any] = {"over": Scope.CYCLE, "better": -1, "digits": 3, "words": words}
    label = key.replace("_", ", ")
    return (
        Quantity(key, label, Unit.ANGLE, needs=Needs.DWELL_OF_LINK, **given),
        Quantity(f"slide_{key}", label, Unit.LENGTH, needs=Needs.DWELL_OF_SLIDE, named=key, **given),
    )


def _of_outputs(*links: int) -> list[Quantity]:
    """Swing and time ratio of each of two outputs."""
    given: dict[str, Any] = {"over": Scope.CYCLE, "needs": Needs.TWO_OUTPUTS}
    each = (("swing", "swing", Unit.ANGLE), ("time_ratio", "time ratio", Unit.RATIO))
    return [
        Quantity(f"{key}_{link}", f"{words} {link}", unit, full=f"{words} of link {link}", **given)
        for key, words, unit in each
        for link in links
    ]


_BAND = "output band in the dwell"
_SYNCHRONY = (
    "greatest difference over the turn between the shares of their swings that two outputs have done, in the "
    "same sense or in opposite ones, whichever is less"
)
_BOX = (
    "diagonal of the box around the pivots and all that joints and P reach from the first target to the last"
)
_FITTED = "minimised by least squares: root mean square of positions and angles together, weighted"
RMS = " (root mean square)"
_ALL = f"error of positions and angles{RMS}"
_WORST = "worst transmission angle over the"
_EFFORT = "with its struts and springs, at every temperature; 0 where the effort is within its limits"
_LEVER = (
    "between cylinder and arm; on coupler and slider 90 deg less that between cylinder and path of its pivot"
)
_RATE = "change of its length for a radian of link 4: the moment arm of its force on link 4"
_TASK = "from the first target to the last"
_MISSED: dict[str, Any] = {"over": Scope.TARGETS, "better": -1}
_OVERALL: dict[str, Any] = {"over": Scope.TASK, "about": _TASK}
# Kinds of which some have D on the ground.
GROUNDED = tuple(dict.fromkeys(
    row.word for row in MECHANISMS for each in row.parameters if (each.name, each.kind) == ("d", "station")
))  # fmt: skip
TURNING = having("o4")  # kinds whose link 4 turns
ROCKERS = having("r4")  # those where it is a bar
TRAVELLING = having("slide_angle")  # kinds whose link 4 slides on the ground
BLOCKS = tuple(kind for kind in TURNING if kind not in ROCKERS)  # kinds whose link 4 is a block on a rod
SINGLE = tuple(ONE_LOOP)  # kinds of one loop, and those whose output turns
OUTPUTS = tuple(kind for kind in TURNING if kind in SINGLE)
SLIDING = (*having("slide_angle"), *having("slide_angle_2"))  # kinds with a slide on the ground
# The quantities for structural errors of a slide, in the unit of length.
TRAVEL_ERRORS = {f"structural_error_{key}": f"travel_error_{key}" for key in ("max", "rms")}
# All quantities of an output that turns, with those of a slide in their place.
OF_SLIDES = TRAVEL_ERRORS | {key: f"slide_{key}" for key in ("band", "band_made")}
_DRIVEN: dict[str, Any] = {**_OVERALL, "better": -1, "needs": Needs.DYNAMICS}

# In the order of the columns of candidates.csv; those that a field of `Requirements` declares follow.
MEASURED: dict[str, Quantity] = {
    quantity.key: quantity
    for quantity in (
        *_stated([_FIRST], "place"),
        *(_length(name, digits=4, kinds=having(name)) for name in _FIRST.lengths),
        *_stated([_FIRST], "arm"),
        Quantity("body_angle", "body angle", Unit.ANGLE, about="orientation of the body minus theta3"),
        Quantity("theta2_start", "driver angle at the first target", Unit.ANGLE, Scope.TARGETS),
        Quantity("theta2_end", "driver angle at the last target", Unit.ANGLE, Scope.TARGETS),
        _length(
            "error", "error rms", digits=3, needs=Needs.LEAST_SQUARES, about=_FITTED, full=_ALL, **_MISSED
        ),
        _length("error_max", "largest position error", over=Scope.TARGETS, better=-1),
        _length("error_rms", "position error rms", full=f"position error{RMS}", **_MISSED),
        Quantity("error_sse", "sum of squared position errors", Unit.AREA, Scope.TARGETS, -1),
        Quantity("angle_error_max", "largest angle error", Unit.ANGLE, Scope.TARGETS, -1),
        Quantity(
            "angle_error_rms", "angle error rms", Unit.ANGLE, full=f"angle error{RMS}", **_MISSED,
        ),
        Quantity(
            "transmission_min_task", "mu task", Unit.ANGLE, Scope.TASK, +1, digits=3, words=f"{_WORST} task"
        ),
        Quantity(
            "transmission_min_cycle", "mu turn", Unit.ANGLE, Scope.CYCLE, +1, digits=3, words=f"{_WORST} turn"
        ),
        Quantity(
            "omega4_max", "omega4", Unit.ANGULAR_VELOCITY, better=-1, kinds=TURNING,
            full="largest angular velocity of link 4", **_OVERALL,
        ),
        Quantity(
            "point_speed_max", "speed of P", Unit.VELOCITY, better=-1, full="largest speed of P", **_OVERALL
        ),
        Quantity(
            "point_acceleration_max", "acceleration of P", Unit.ACCELERATION, better=-1,
            full="largest acceleration of P", **_OVERALL,
        ),
        Quantity(
            "torque_peak", "peak torque, task", Unit.TORQUE, digits=4, words="peak torque", short="torque",
            full="peak drive torque", **_DRIVEN,
        ),
        Quantity(
            "torque_rms", "rms torque, task", Unit.TORQUE, words="rms torque",
            full=f"drive torque{RMS}", **_DRIVEN,
        ),
        Quantity(
            "joint_force_peak", "peak force, task", Unit.FORCE, digits=4, words="peak joint force",
            short="force", **_DRIVEN,
        ),
        Quantity(
            "coupler_fit_r2", "fit of P", Unit.RATIO, better=+1,
            full="R2 of a polynomial through the path of P", **_OVERALL,
        ),
        _length("size", over=Scope.TASK, better=-1, digits=4, about=_BOX, full="size of the linkage"),
        _length("hausdorff", "Hausdorff distance", over=Scope.CYCLE, better=-1, needs=Needs.CLOSED),
        _length("frechet", "Fréchet distance", over=Scope.CYCLE, better=-1, needs=Needs.CLOSED),
        *(_move(name) for name in _FIRST.dimensions),
        _length(
            "worst_move", "worst move", needs=Needs.MANUFACTURING,
            full="largest move of a target within the tolerances", **_MISSED,
        ),
        Quantity(
            "share_within_linear", "within, linear", Unit.SHARE, Scope.TARGETS, +1, Needs.MANUFACTURING,
            full="share made within the allowed error, linearised",
        ),
        Quantity(
            "share_within_made", "made within", Unit.SHARE, Scope.TARGETS, +1, Needs.MANUFACTURING, digits=3,
            full="share made within the allowed error",
        ),
        *_stated(ONE_LOOP.values(), "distance", digits=4),
        Quantity("slide_angle", "direction of the slide", Unit.ANGLE, kinds=having("slide_angle")),
        *_stated(_SIX_BARS, "length", digits=4, listed=_FIRST.parameters),
        *_stated(_SIX_BARS, "arm", "station", listed=_FIRST.parameters),
        *_stated(_SIX_BARS, "distance", digits=4, listed=_FIRST.parameters),
        Quantity(
            "slide_angle_2", "direction of the second slide", Unit.ANGLE, kinds=having("slide_angle_2")
        ),
        *(
            Quantity(
                f"dwell_{name}", f"dwell {name}", Unit.ANGLE, Scope.CYCLE, needs=Needs.DWELL,
                full=f"driver angle at the {end} of the dwell",
            )
            for name, end in (("from", "beginning"), ("to", "end"))
        ),
        *_of_dwell("band", _BAND),
        *_of_dwell("band_made", f"{_BAND}, with tolerances"),
        Quantity(
            "swing", "swing", Unit.ANGLE, Scope.CYCLE, needs=Needs.DWELL_OF_LINK, digits=4,
            full="swing of the last link over the turn",
        ),
        Quantity(
            "length_ratio", "length ratio", Unit.RATIO, Scope.CYCLE, -1, Needs.CLOSED,
            about="length of the curve of P over that of the closed spline through the points, where limited",
        ),
        Quantity(
            "output_acceleration_max", "output acceleration", Unit.ANGULAR_ACCELERATION, better=-1,
            kinds=TURNING, full="largest angular acceleration of the output", **_OVERALL,
        ),
        *_of_outputs(4, 6),
        Quantity(
            "synchrony_error", "synchrony error", Unit.SHARE, Scope.CYCLE, -1, Needs.TWO_OUTPUTS, digits=3,
            about=_SYNCHRONY, full="synchrony error of the outputs",
        ),
        *(_move(name) for name in DIMENSIONS if name not in _FIRST.dimensions),
        *(
            Quantity(
                f"torque_deviation{key}", f"torque deviation{end}", Unit.TORQUE, Scope.TASK, -1,
                Needs.WANTED_TORQUE, digits=3, about="at the rows of torque.wanted",
                words=f"deviation from the wanted torque{words}",
            )
            for key, end, words in (("", "", RMS), ("_max", ", max", " where it is greatest"))
        ),
        *(_length(name, name.replace("_", " "), needs=Needs.CYLINDER) for name in Cylinder.COLUMNS),
        _length(
            "cylinder_closed", "closed cylinder", over=Scope.TASK, needs=Needs.CYLINDER, digits=4,
            full="cylinder, closed length",
        ),
        _length(
            "cylinder_stroke", "cylinder stroke", over=Scope.TASK, needs=Needs.CYLINDER, digits=4,
            full="cylinder, stroke",
        ),
        Quantity(
            "cylinder_angle_min", "lever angle", Unit.ANGLE, Scope.TASK, +1, Needs.CYLINDER, digits=3,
            about=_LEVER, words="worst lever angle of the cylinder", full="cylinder, worst lever angle",
        ),
        Quantity(
            "cylinder_force_max", "cylinder force", Unit.FORCE, Scope.TASK, -1, Needs.LOADED_CYLINDER,
            digits=4, words="peak force of the cylinder", full="cylinder, peak force",
        ),
        _rate(listed=False),
        _rate("_start", " at the first target"),
        _rate("_end", " at the last target"),
        _rate("_min", " where it is least", +1),
        _rate("_max", " where it is greatest"),
        *(
            Quantity(
                f"coupler_{name}_{end}", f"coupler {name} {end}", unit, Scope.TASK, about=_TASK,
                full=f"{words} of the coupler where it is {extreme}",
            )
            for name, unit, words in (("angle", Unit.ANGLE, "direction"), ("rate", Unit.RATIO, "rate"))
            for end, extreme in (("min", "least"), ("max", "greatest"))
        ),
        Quantity(
            "effort_deviation", "effort deviation", Unit.FORCE, Scope.TASK, needs=Needs.EFFORT, digits=3,
            about=_EFFORT, full="greatest deviation from the wanted effort",
        ),
    )
}  # fmt: skip
