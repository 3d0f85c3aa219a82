"""Quantities of a design as the search computes them, written once with NumPy functions.

On arrays a formula screens many designs, on `Dual` numbers it is a residual of the batched search, on CasADi
symbols a row or a bound of the programme. The judge's measure of the same key shares nothing with it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial, reduce
from itertools import permutations
from operator import attrgetter
from typing import Any, TypeAlias

import numpy as np

from grashof.problems import Requirements
from grashof.problems.values.arrays import TURN, Limits
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.loop.dyad import PlacedLoop, stroke_of
from grashof.synth.loop.vector import Vector


class View(PlacedLoop):
    """A design, or many, at their targets; lengths in sizes, angles in rad.

    Scalars are arrays (n, 1), `Dual`, or symbols; what belongs to targets has N columns, or is a symbol of N
    rows. `offset` and `output_travel` are of slider kinds.
    """

    theta1: Any
    theta2_start: Any  # driver angle at the first target
    ap: Vector  # from A to P, in a frame that the body is turned against by `body_turn`
    bp: Vector  # from B to P in that frame
    body_turn: Any
    a: Vector  # at the targets
    b: Vector  # at the targets
    driver_turn: Any  # driver rotation from the first target to the last, positive in its sense
    direction: Any  # sense of the driver, +1 or -1
    output_turn: Any  # of the output link from the first target to the last, within half a turn
    turns: Any  # 1 where the driver turns fully, else 0
    output_travel: Any  # of the slide from the first target to the last

    @property
    def p(self) -> Vector:
        """P at the targets, where it is on a coupler with two pins."""
        coupler, bar = self.b - self.a, self.ap - self.bp
        along, across = bar.dot(self.ap), bar.cross(self.ap)
        place: Vector = self.a + (along * coupler + across * coupler.left) / bar.square
        return place


@dataclass(frozen=True, slots=True)
class Part:
    """One number of a quantity, or one at every target."""

    name: str  # such as "r3" or "o2.x"
    of: Callable[[Any], Any]  # from a `View`
    axis: str = ""  # of the box that limits it; empty for other limits
    # 2 or 4 where the dyad of the driver (O2, A) or the driven one (O4, B) alone decides it
    dyad: int | None = None
    squared: bool = False  # `of` gives the square, which has no kink at zero
    per: Callable[[Any], Any] | None = None  # what `of` is divided by, so that a limit can be a product
    fixed: bool = False  # the start decides it: no solve can change it


Formulas: TypeAlias = Mapping[str, tuple[Part, ...]]


def _place(name: str, dyad: int | None) -> tuple[Part, ...]:
    return tuple(Part(f"{name}.{axis}", attrgetter(f"{name}.{axis}"), axis, dyad) for axis in "xy")


def _apart(*pairs: str) -> tuple[Part, ...]:
    """Distances between two points at the targets."""

    def square(pair: str, d: View) -> Any:
        one, other = pair.split("-")
        return (getattr(d, one) - getattr(d, other)).square

    return tuple(Part(f"distances.{pair}", partial(square, pair), pair, squared=True) for pair in pairs)


def _bracket(name: str) -> tuple[Part, ...]:
    """A or B in the frame of the body."""

    def place(axis: str, d: View) -> Any:
        arm: Vector = -getattr(d, f"{name}p")
        return getattr(arm.turned(-d.body_turn), axis)

    return tuple(Part(f"{name}_on_body.{axis}", partial(place, axis), axis) for axis in "xy")


_LINKS = _R1, _R2, _R3, _R4 = (
    Part("r1", lambda d: d.r1),
    Part("r2", lambda d: d.r2, dyad=2),
    Part("r3", lambda d: d.r3),
    Part("r4", lambda d: d.r4, dyad=4),
)
_ARM = Part("A-P", lambda d: d.ap.square, dyad=2, squared=True)
_AP = replace(_ARM, name="distances.a-p", axis="a-p")
_BP = Part("distances.b-p", lambda d: d.bp.square, "b-p", squared=True)
_OFFSET = Part("offset", lambda d: d.offset)


def smooth_ratio(*links: Part) -> tuple[Part, ...]:
    """Ratios of any two links, in place of the extremes, which have a kink."""
    return tuple(
        Part(f"{long.name} to {short.name}", long.of, per=short.of) for short, long in permutations(links, 2)
    )


def _lengths(longest: Callable[[View], Any], shortest: Callable[[View], Any], *links: Part) -> Formulas:
    """The lengths of links, and ratios: of the longest to the shortest, and of any two."""
    ratio = Part("longest to shortest", longest, per=shortest)
    found = {"link_length": links, **{link.name: (link,) for link in links}, "link_ratio": (ratio,)}
    return found | {"link_ratios": tuple(_ratio(*both) for both in permutations(links, 2))}


def _ratio(one: Part, other: Part) -> Part:
    name = f"{one.name}/{other.name}"
    return Part(f"link_ratios.{name}", lambda d: one.of(d) / other.of(d), axis=name)


def _lengths_of_two(one: Part, other: Part) -> Formulas:
    return _lengths(
        lambda d: np.maximum(one.of(d), other.of(d)), lambda d: np.minimum(one.of(d), other.of(d)), one, other
    )


def _within(cosine: Any) -> Any:
    """A cosine kept between -1 and 1, where the loop does not close: arccos has no slope at the ends."""
    return np.minimum(np.maximum(cosine, -1 + 1e-15), 1 - 1e-15)


def _cosine(opposite: Any, one: Any, other: Any) -> Any:
    """Law of cosines."""
    return _within((one**2 + other**2 - opposite**2) / (2 * one * other))


def _ratio_of(angle: Any) -> Any:
    """Time ratio (pi + angle) / (pi - angle) of strokes that a crank at even speed makes."""
    return (np.pi + angle) / np.maximum(np.pi - angle, 1e-9)


def _swing(d: View, angle: Any) -> Any:
    """The angle, or a turn of a double-crank; between the end targets unless the driver turns fully."""
    full = (1 - d.double_crank) * angle + d.double_crank * TURN
    return d.turns * full + (1 - d.turns) * np.abs(d.output_turn)


def _output_swing(d: View) -> Any:
    """Between the triangles O2-B-O4 with links 2 and 3 stretched and folded."""
    far, close = (np.arccos(_cosine(d.r3 + sign * d.r2, d.r1, d.r4)) for sign in (1.0, -1.0))
    return _swing(d, far - close)


def _time_ratio(d: View) -> Any:
    """By the angle between the directions of O2B in its limit positions; zero for a double-crank."""
    far, close = (np.arccos(_cosine(d.r4, d.r1, d.r3 + sign * d.r2)) for sign in (1.0, -1.0))
    delta = (1 - d.double_crank) * np.abs(far - close)
    return (1 - d.double_crank) * _ratio_of(delta)


def _stroke(d: View) -> Any:
    """Between the limit positions; from the first target to the last unless the driver turns fully."""
    return d.turns * stroke_of(d) + (1 - d.turns) * np.abs(d.output_travel)


def _slide_time_ratio(d: View) -> Any:
    """By the angle between the directions of O2A in both limit positions."""
    far, near = (np.arccos(_within(d.offset / (d.r3 + sign * d.r2))) for sign in (1.0, -1.0))
    return _ratio_of(np.abs(far - near))


def _block_angle(d: View) -> Any:
    """Between the rod's two positions at right angles to the crank."""
    one, other = (np.arccos(_within((sign * d.r2 - d.offset) / d.r1)) for sign in (1.0, -1.0))
    return other - one


# By the key of the quantity.
FORMULAS: Formulas = {
    **_lengths(
        lambda d: np.maximum(np.maximum(d.r1, d.r2), np.maximum(d.r3, d.r4)),
        lambda d: np.minimum(np.minimum(d.r1, d.r2), np.minimum(d.r3, d.r4)),
        *_LINKS,
    ),
    "coupler_arms": (_ARM, Part("B-P", lambda d: d.bp.square, dyad=4, squared=True)),
    "o2": _place("o2", 2),
    "o4": _place("o4", 4),
    "a": _place("a", 2),
    "b": _place("b", 4),
    "distances": (*_apart("a-o4", "b-o2", "o2-p", "o4-p"), _AP, replace(_BP, dyad=4)),
    "a_on_body": _bracket("a"),
    "b_on_body": _bracket("b"),
    "ground_angle": (Part("theta1", lambda d: d.theta1),),
    "theta2_start": (Part("theta2", lambda d: d.theta2_start, dyad=2),),
    "driver_sense": (Part("driver sense", lambda d: d.direction, fixed=True),),
    "output_swing": (Part("output swing", _output_swing),),
    "time_ratio": (Part("time ratio", _time_ratio),),
    "driver_rotation": (Part("driver rotation", lambda d: d.driver_turn),),
}
_SHARED = {
    key: FORMULAS[key] for key in ("o2", "a", "a_on_body", "theta2_start", "driver_sense", "driver_rotation")
}
# Of slider kinds B, and O4, are decided by both dyads together.
SLIDER_CRANK: Formulas = {
    **_lengths_of_two(_R2, _R3),
    "coupler_arms": (_ARM, Part("B-P", lambda d: d.bp.square, squared=True)),
    **_SHARED,
    "b_on_body": FORMULAS["b_on_body"],
    "b": _place("b", None),
    "distances": (*_apart("b-o2", "o2-p"), _AP, _BP),
    "offset": (_OFFSET,),
    "slide_angle": (Part("slide angle", lambda d: d.theta1 - np.pi / 2),),
    "stroke": (Part("stroke", _stroke),),
    "time_ratio": (Part("time ratio", _slide_time_ratio),),
}
INVERTED: Formulas = {
    **_lengths_of_two(_R1, _R2),
    "coupler_arms": (_ARM,),
    **_SHARED,
    "ground_angle": FORMULAS["ground_angle"],
    "o4": _place("o4", None),
    "distances": (*_apart("a-o4"), _AP),
    "offset": (_OFFSET,),
    "output_swing": (Part("output swing", lambda d: _swing(d, _block_angle(d))),),
    "time_ratio": (Part("time ratio", lambda d: (1 - d.double_crank) * _ratio_of(_block_angle(d))),),
}


def of_six_bars(lengths: Sequence[str]) -> Formulas:
    """Formulas of six-bars with links of these lengths; `ap` and `bp` lead from both joints of P's link."""
    links = [Part(name, attrgetter(name)) for name in lengths]

    def extreme(of: Callable[[Any, Any], Any]) -> Callable[[View], Any]:
        return lambda d: reduce(of, (link.of(d) for link in links))

    return {
        **_lengths(extreme(np.maximum), extreme(np.minimum), *links),
        "coupler_arms": FORMULAS["coupler_arms"],
        "distances": _apart("a-o4", "b-o2"),
        **{
            key: FORMULAS[key]
            for key in (
                "o2",
                "o4",
                "a",
                "b",
                "ground_angle",
                "theta2_start",
                "driver_sense",
                "driver_rotation",
            )
        },
    }


LOGARITHMIC = {
    "link_length",
    "r1",
    "r2",
    "r3",
    "r4",
    "r5",
    "r6",
    "link_ratio",
    "link_ratios",
}  # ratios count, not differences


def parts_of(limited: Collection[str], *formulas: Formulas) -> Iterator[tuple[str, Part]]:
    """Parts of all limited quantities, each with its field of `Requirements`; the first mapping counts."""
    for name in limited:
        key = LIMITS[name].quantity.key
        for part in next((each[key] for each in formulas if key in each), ()):
            if key != "link_length" or part.name not in limited:  # a limit of its own overrides it
                yield name, part


def range_of(wanted: Requirements, name: str, part: Part) -> Limits:
    """The limits that a field of `wanted` sets for a part."""
    return wanted.ranges(name).get(part.axis, (-np.inf, np.inf))  # of a ratio without limits
