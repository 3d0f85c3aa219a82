"""Formulas of the search: what designs are worth, written once with NumPy functions.

On the arrays of many designs a formula is the screen, on numbers with derivatives (`Dual`) a residual of the
batched search, on CasADi symbols a row or a limit of the nonlinear programme. The judge has a measure of the
same key, which shares nothing with it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import permutations
from operator import attrgetter
from typing import Any

import numpy as np

from grashof.problems import Requirements
from grashof.problems.values.arrays import TURN, Limits
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.loop.dyad import Standing
from grashof.synth.loop.vector import Vector


class View(Standing):
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


@dataclass(frozen=True, slots=True)
class Part:
    """One number of a quantity, or one at every target."""

    name: str  # such as "r3" or "o2.x"
    of: Callable[[Any], Any]  # from a `View`
    axis: str = ""  # of the box that limits it; empty for other limits
    # 2 or 4 for what the dyad of the driver (O2, A) or the driven one (O4, B) decides by itself
    dyad: int | None = None
    squared: bool = False  # `of` gives the square, which has no kink at zero
    per: Callable[[Any], Any] | None = None  # what `of` is divided by, so that a limit can be a product
    fixed: bool = False  # the start decides it: no solve can change it


def _place(name: str, dyad: int) -> tuple[Part, ...]:
    return tuple(Part(f"{name}.{axis}", attrgetter(f"{name}.{axis}"), axis, dyad) for axis in "xy")


def _bracket(name: str) -> tuple[Part, ...]:
    """A or B in the frame of the body."""

    def place(axis: str, d: View) -> Any:
        arm: Vector = -getattr(d, f"{name}p")
        return getattr(arm.turned(-d.body_turn), axis)

    return tuple(Part(f"{name}_on_body.{axis}", partial(place, axis), axis) for axis in "xy")


_LINKS = (
    Part("r1", lambda d: d.r1),
    Part("r2", lambda d: d.r2, dyad=2),
    Part("r3", lambda d: d.r3),
    Part("r4", lambda d: d.r4, dyad=4),
)
_EXTREMES = Part(
    "longest to shortest",
    lambda d: np.maximum(np.maximum(d.r1, d.r2), np.maximum(d.r3, d.r4)),
    per=lambda d: np.minimum(np.minimum(d.r1, d.r2), np.minimum(d.r3, d.r4)),
)
# Between any two links: what stands for the extremes where no kink is wanted.
_PAIRS = tuple(
    Part(f"{long.name} to {short.name}", long.of, per=short.of) for short, long in permutations(_LINKS, 2)
)


_FLAT = 1 - 1e-15


def _cosine(opposite: Any, one: Any, other: Any) -> Any:
    """Law of cosines, kept between -1 and 1 where there is no triangle: arccos has no slope at the ends."""
    cosine = (one**2 + other**2 - opposite**2) / (2 * one * other)
    return np.minimum(np.maximum(cosine, -_FLAT), _FLAT)


def _output_swing(d: View) -> Any:
    """Between the triangles O2-B-O4 with links 2 and 3 stretched and folded; of a double-crank a turn."""
    far, close = (np.arccos(_cosine(d.r3 + sign * d.r2, d.r1, d.r4)) for sign in (1.0, -1.0))
    whole = (1 - d.double_crank) * (far - close) + d.double_crank * TURN
    # from the first target to the last where it does not turn fully
    return d.turns * whole + (1 - d.turns) * np.abs(d.output_turn)


def _time_ratio(d: View) -> Any:
    """(pi + delta) / (pi - delta) with delta between the directions of O2B in its limit positions."""
    far, close = (np.arccos(_cosine(d.r4, d.r1, d.r3 + sign * d.r2)) for sign in (1.0, -1.0))
    delta = (1 - d.double_crank) * np.abs(far - close)
    # zero for a double-crank, whose output has no strokes
    return (1 - d.double_crank) * (np.pi + delta) / np.maximum(np.pi - delta, 1e-9)


# By the key of the quantity.
FORMULAS: dict[str, tuple[Part, ...]] = {
    "link_length": _LINKS,
    **{link.name: (link,) for link in _LINKS},
    "link_ratio": (_EXTREMES,),
    "coupler_arms": (
        Part("A-P", lambda d: d.ap.square, dyad=2, squared=True),
        Part("B-P", lambda d: d.bp.square, dyad=4, squared=True),
    ),
    "o2": _place("o2", 2),
    "o4": _place("o4", 4),
    "a": _place("a", 2),
    "b": _place("b", 4),
    "a_on_body": _bracket("a"),
    "b_on_body": _bracket("b"),
    "ground_angle": (Part("theta1", lambda d: d.theta1),),
    "theta2_start": (Part("theta2", lambda d: d.theta2_start, dyad=2),),
    "driver_sense": (Part("driver sense", lambda d: d.direction, fixed=True),),
    "output_swing": (Part("output swing", _output_swing),),
    "time_ratio": (Part("time ratio", _time_ratio),),
    "driver_rotation": (Part("driver rotation", lambda d: d.driver_turn),),
}
SMOOTH = {"link_ratio": _PAIRS}
LOGARITHMIC = {"link_length", "r1", "r2", "r3", "r4", "link_ratio"}  # ratios count, not differences


def parts_of(
    limited: Collection[str], *formulas: Mapping[str, tuple[Part, ...]]
) -> Iterator[tuple[str, Part]]:
    """Parts of all that is limited, each with its field of `Requirements`."""
    for name in limited:
        key = LIMITS[name].quantity.key
        # the first mapping that has it, by the key of the quantity
        for part in next((each[key] for each in formulas if key in each), ()):
            if key != "link_length" or part.name not in limited:  # a limit of its own overrides it
                yield name, part


def range_of(wanted: Requirements, name: str, part: Part) -> Limits:
    """What a field of `wanted` allows for a part."""
    low, high = wanted.ranges(name)[part.axis]
    return low, high
