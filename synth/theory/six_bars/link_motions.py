"""Links that move through five poses, and what may join two of them: chains, and bars by the quartic.

A point of a link is given where it is at the first pose, as a complex number; the ground is a link, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.loop.dyad import Bars, as_complex
from grashof.synth.loop.vector import Vector
from grashof.synth.theory.five_poses import five_pose_dyads_of_sets

POSES = 5
TRIVIAL = 1e-5  # share of their distance from the origin within which a bar is one that is known


@dataclass(frozen=True, slots=True)
class LinkMotions:
    """Displacements z -> rotation * z + shift of links from the first pose to all five, (n, 5)."""

    rotation: ComplexArray
    shift: ComplexArray

    @classmethod
    def at_rest(cls, count: int) -> LinkMotions:
        """Those of the ground."""
        return cls(np.ones((count, POSES), np.complex128), np.zeros((count, POSES), np.complex128))

    @classmethod
    def between(cls, start: ComplexArray, end: ComplexArray) -> LinkMotions:
        """Those of links with two points at given places (n, 5); of the same length at all of them."""
        way = end - start
        rotation = way / way[:, :1]
        rotation = rotation / np.abs(rotation)
        return cls(rotation, start - rotation * start[:, :1])

    def __len__(self) -> int:
        return len(self.rotation)

    def __getitem__(self, index: IntArray | BoolArray) -> LinkMotions:
        return LinkMotions(self.rotation[index], self.shift[index])

    def apply(self, points: ComplexArray) -> ComplexArray:
        """Places (n, 5) of a point of each link, (n,)."""
        return points[:, None] * self.rotation + self.shift

    def seen_from(self, other: LinkMotions) -> LinkMotions:
        """The same relative to other links."""
        back = other.rotation.conj()
        return LinkMotions(back * self.rotation, back * (self.shift - other.shift))


def chain(
    base: LinkMotions,
    body: LinkMotions,
    ends: tuple[ComplexArray, ComplexArray],
    lengths: tuple[FloatArray, FloatArray],
    side: FloatArray,
) -> tuple[ComplexArray, LinkMotions, LinkMotions]:
    """The joint (n,) of two bars between two links, and the motions of the bars; NaN where they do not reach.

    `ends` (n,) are the joints on both links; `side`, (n, 1) or (n, 5), is +1 where the joint of the bars lies
    left of the line from the first end to the second.
    """
    start, end = base.apply(ends[0]), body.apply(ends[1])
    first, second = (length[:, None] for length in lengths)
    closed = Bars().closed(_vector(end), _vector(start), first, second, side)
    joint = start + as_complex(closed.along)
    return joint[:, 0], LinkMotions.between(start, joint), LinkMotions.between(joint, end)


def bars(
    one: LinkMotions, other: LinkMotions, known: tuple[ComplexArray, ComplexArray], reach: float
) -> tuple[IntArray, ComplexArray, ComplexArray]:
    """All bars between pairs of links that keep their length through the poses, besides one that is known.

    The number of the pair, and the joints on one link and on the other, (k,); `known` are those of the known
    bar, (n,). Joints farther than `reach` from the origin are left out.
    """
    relative = other.seen_from(one)
    if not len(relative):
        return np.zeros(0, np.int64), np.zeros(0, np.complex128), np.zeros(0, np.complex128)
    dyads = five_pose_dyads_of_sets(relative.rotation, relative.shift, reach)
    new = np.isfinite(dyads.moving)
    apart = [
        np.abs(found - each[:, None]) > TRIVIAL * (1 + np.abs(each[:, None]))
        for found, each in zip((dyads.ground, dyads.moving), known, strict=True)
    ]
    pair, root = np.nonzero(new & (apart[0] | apart[1]))
    return pair, dyads.ground[pair, root], dyads.moving[pair, root]


def _vector(places: ComplexArray) -> Vector:
    return Vector(places.real, places.imag)
