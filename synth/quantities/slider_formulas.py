"""Formulas of the search for slider-cranks and inverted ones; see `grashof.synth.quantities.formulas`."""

from __future__ import annotations

from itertools import permutations
from typing import Any

import numpy as np

from grashof.problems.values.arrays import TURN
from grashof.synth.loop.dyad import stroke_of
from grashof.synth.quantities.formulas import FORMULAS, Part, View

_R1, _R2, _R3 = (
    Part("r1", lambda d: d.r1),
    Part("r2", lambda d: d.r2, dyad=2),
    Part("r3", lambda d: d.r3),
)
_ARM = Part("A-P", lambda d: d.ap.square, dyad=2, squared=True)
_OTHER_ARM = Part("B-P", lambda d: d.bp.square, squared=True)


def _both(*links: Part) -> dict[str, tuple[Part, ...]]:
    """Lengths of two links, and their ratio."""
    longest = Part("longest to shortest", lambda d: np.maximum(*(link.of(d) for link in links)),
                   per=lambda d: np.minimum(*(link.of(d) for link in links)))  # fmt: skip
    return {"link_length": links, **{link.name: (link,) for link in links}, "link_ratio": (longest,)}


def smooth_ratio(*links: Part) -> tuple[Part, ...]:
    """The ratio either way: what stands for the extremes where no kink is wanted."""
    return tuple(
        Part(f"{long.name} to {short.name}", long.of, per=short.of) for short, long in permutations(links, 2)
    )


def _apart(names: tuple[str, ...]) -> dict[str, tuple[Part, ...]]:
    """Formulas that are those of a four-bar, each decided by both dyads together where B has a part in it."""
    return {name: FORMULAS[name] for name in names}


def _stroke(d: View) -> Any:
    """Between the limit positions; from the first target to the last unless the driver turns fully."""
    return d.turns * stroke_of(d) + (1 - d.turns) * np.abs(d.output_travel)


def _within(cosine: Any) -> Any:
    return np.minimum(np.maximum(cosine, -1 + 1e-15), 1 - 1e-15)


def _slide_time_ratio(d: View) -> Any:
    """(pi + delta) / (pi - delta) with delta between the directions of O2A in both limit positions."""
    far, near = (np.arccos(_within(d.offset / (d.r3 + sign * d.r2))) for sign in (1.0, -1.0))
    delta = np.abs(far - near)
    return (np.pi + delta) / np.maximum(np.pi - delta, 1e-9)


def _block_swing(d: View) -> Any:
    """Between the rod's two positions at right angles to the crank; of a block that turns a turn."""
    one, other = (np.arccos(_within((sign * d.r2 - d.offset) / d.r1)) for sign in (1.0, -1.0))
    whole = (1 - d.double_crank) * (other - one) + d.double_crank * TURN
    return d.turns * whole + (1 - d.turns) * np.abs(d.output_turn)


def _block_time_ratio(d: View) -> Any:
    """(pi + swing) / (pi - swing); zero where the block turns."""
    one, other = (np.arccos(_within((sign * d.r2 - d.offset) / d.r1)) for sign in (1.0, -1.0))
    swing = other - one
    return (1 - d.double_crank) * (np.pi + swing) / np.maximum(np.pi - swing, 1e-9)


_ANY = ("o2", "a", "a_on_body", "theta2_start", "driver_sense", "driver_rotation")
_OFFSET = {"offset": (Part("offset", lambda d: d.offset),)}
# By the key of the quantity.
SLIDER_CRANK: dict[str, tuple[Part, ...]] = {
    **_both(_R2, _R3),
    "coupler_arms": (_ARM, _OTHER_ARM),
    **_apart((*_ANY, "b_on_body")),
    "b": tuple(Part(part.name, part.of, part.axis) for part in FORMULAS["b"]),
    **_OFFSET,
    "slide_angle": (Part("slide angle", lambda d: d.theta1 - np.pi / 2),),
    "stroke": (Part("stroke", _stroke),),
    "time_ratio": (Part("time ratio", _slide_time_ratio),),
}
INVERTED: dict[str, tuple[Part, ...]] = {
    **_both(_R1, _R2),
    "coupler_arms": (_ARM,),
    **_apart((*_ANY, "ground_angle")),
    "o4": tuple(Part(part.name, part.of, part.axis) for part in FORMULAS["o4"]),
    **_OFFSET,
    "output_swing": (Part("output swing", _block_swing),),
    "time_ratio": (Part("time ratio", _block_time_ratio),),
}
SMOOTH_SLIDER_CRANK = {"link_ratio": smooth_ratio(_R2, _R3)}
SMOOTH_INVERTED = {"link_ratio": smooth_ratio(_R1, _R2)}
