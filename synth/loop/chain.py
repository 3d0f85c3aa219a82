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
    nothing = 0.0 * driver.x
    start = Vector(nothing, nothing)
    frames = {1: Frame(start, Vector(nothing + 1.0, nothing)), 2: Frame(start, driver)}
    squares = []
    for number, (loop, assembly) in enumerate(zip(mechanism.loops, assemblies, strict=True)):
        c = frames[loop.dyad.hosts[0]].point(given[loop.c]) if number else given["r2"] * driver
        first, second, square = _closed(loop, given, c, frames, assembly, root)
        frames[loop.links[0]], frames[loop.links[1]] = first, second
        squares.append(square)
    return Chain(frames, squares)


def _closed(
    loop: LoopNames,
    given: Mapping[str, Any],
    c: Vector,
    frames: Mapping[int, Frame],
    assembly: Any,
    root: Root,
) -> tuple[Frame, Frame, Any]:
    """The two links of a dyad, and the square of its closure."""
    dyad = DYADS[loop.dyad.kind]
    if loop.pinned:
        ground = frames[loop.dyad.hosts[1]].point(given[loop.d])
    else:
        angle = given[loop.slide_angle]
        ground = Vector(-np.sin(angle), np.cos(angle))
    lengths = [given[name] for name in (*loop.bars, *filter(None, [loop.offset]))]
    r3, r4 = lengths if len(lengths) == 2 else (0.0, lengths[0])
    closed = dyad.closed(ground, c, r3, r4, assembly, root)
    along, across = dyad.directions(closed, r3, r4)
    if loop.dyad.kind is DyadKind.RRR:
        other = Frame(ground, across)
    else:
        other = Frame(ground if loop.pinned else c + closed.along, along if loop.pinned else -across.left)
    return Frame(c, along), other, closed.square
