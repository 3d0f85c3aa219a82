"""A driver and dyads, of any number and kind: where each link lies, for arrays, `Dual` numbers or symbols."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from grashof.problems.values.linkages.mechanism import DyadKind, LoopNames, Mechanism
from grashof.synth.loop.dyad import Bars, Block, ClosingDyad, Root, Slider
from grashof.synth.loop.vector import Vector

DYADS: dict[DyadKind, ClosingDyad] = {
    DyadKind.RRR: Bars(),
    DyadKind.RRP: Slider(),
    DyadKind.RPR: Block(),
}


class Frame(NamedTuple):
    """The frame of a link: its origin and the unit vector of its u axis, as `SixBar` has them."""

    origin: Vector
    along: Vector

    def point(self, arm: Vector) -> Vector:
        """A point of the link."""
        placed: Vector = self.origin + arm.x * self.along + arm.y * self.along.left
        return placed


class Chain(NamedTuple):
    """A mechanism in one or many positions."""

    frames: Mapping[int, Frame]  # by the number of the link
    squares: Sequence[Any]  # of each dyad, under the root of its closure; positive where it is closed


def chained(
    mechanism: Mechanism,
    given: Mapping[str, Any],
    driver: Vector,
    assemblies: Sequence[Any],
    root: Root = np.sqrt,
) -> Chain:
    """Every link, dyad after dyad.

    `given` has lengths, offsets and angles by the names of the parameters, and points of links as vectors;
    `driver` is the unit vector along O2A, with O2 in the origin.
    """
    frames, squares = _grounded(driver), []
    for loop, assembly in zip(mechanism.loops, assemblies, strict=True):
        first, second, square = _closed(loop, given, frames, assembly, root)
        frames[loop.links[0]], frames[loop.links[1]] = first, second
        squares.append(square)
    return Chain(frames, squares)


def gap_of(mechanism: Mechanism, given: Mapping[str, Any], driver: Vector, assemblies: Sequence[Any]) -> Any:
    """The distance C-D that the last dyad closes; of a slide that of C from its line through O2, to its left.

    Arguments as of `chained`; the lengths of the last dyad may be missing.
    """
    frames = _grounded(driver)
    *earlier, last = mechanism.loops
    for loop, assembly in zip(earlier, assemblies, strict=False):
        frames[loop.links[0]], frames[loop.links[1]], _ = _closed(loop, given, frames, assembly, np.sqrt)
    c, ground = _hosted(last, given, frames)
    return np.sqrt((c - ground).square) if last.pinned else c.dot(ground)


def _grounded(driver: Vector) -> dict[int, Frame]:
    """The frames of links 1 and 2."""
    nothing = 0.0 * driver.x
    start = Vector(nothing, nothing)
    return {1: Frame(start, Vector(nothing + 1.0, nothing)), 2: Frame(start, driver)}


def _hosted(loop: LoopNames, given: Mapping[str, Any], frames: Mapping[int, Frame]) -> tuple[Vector, Vector]:
    """C, and D or the unit vector across a slide, to its left."""
    on_c, on_d = loop.dyad.hosts
    c = frames[on_c].point(given[loop.c]) if loop.c != "a" else given["r2"] * frames[2].along
    if loop.pinned:
        return c, frames[on_d].point(given[loop.d])
    angle = given[loop.slide_angle]
    return c, Vector(-np.sin(angle), np.cos(angle))


def _closed(
    loop: LoopNames, given: Mapping[str, Any], frames: Mapping[int, Frame], assembly: Any, root: Root
) -> tuple[Frame, Frame, Any]:
    """The two links of a dyad, and the square of its closure."""
    dyad = DYADS[loop.dyad.kind]
    c, ground = _hosted(loop, given, frames)
    lengths = [given[name] for name in (*loop.bars, *filter(None, [loop.offset]))]
    r3, r4 = lengths if len(lengths) == 2 else (0.0, lengths[0])
    closed = dyad.closed(ground, c, r3, r4, assembly, root)
    along, across = dyad.directions(closed, r3, r4)
    if loop.dyad.kind is DyadKind.RRR:
        other = Frame(ground, across)
    else:
        other = Frame(ground if loop.pinned else c + closed.along, along if loop.pinned else -across.left)
    return Frame(c, along), other, closed.square
