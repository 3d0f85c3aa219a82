"""Differences between kinds of linkages in an analysis: joints with forces, links that turn, their words."""

from __future__ import annotations

import numpy as np

from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind, Mechanism

# Words for the two shares of `rotatability` of the first dyad; empty where a share has no meaning.
SHARES = {
    DyadKind.RRR: ("(r3 + r4 - r1 - r2) / sum", "(|r1 - r2| - |r3 - r4|) / sum"),
    DyadKind.RRP: ("(r3 - r2 - offset) / sum", "(r3 - r2 + offset) / sum"),
    DyadKind.RPR: ("", "(|r1 - r2| - |offset|) / sum"),
}
_IN_LINE = {"stretched": "2 and 3 stretched", "folded": "2 and 3 folded"}
# The two positions in which link 4 turns back, by key.
LIMIT_POSITIONS = {
    DyadKind.RRR: _IN_LINE,
    DyadKind.RRP: _IN_LINE,
    DyadKind.RPR: {
        "left": "2 perpendicular to the rod, to its left",
        "right": "2 perpendicular to the rod, to its right",
    },
}


def forces_of(kind: Mechanism) -> dict[str, str]:
    """Keys of the joint forces (f32: on link 2 by link 3) and the joints in which they act, slides last.

    >>> from grashof.problems import FourBar, SliderCrank
    >>> forces_of(FourBar.mechanism)
    {'f12': 'O2', 'f32': 'A', 'f43': 'B', 'f14': 'O4'}
    >>> forces_of(SliderCrank.mechanism)
    {'f12': 'O2', 'f32': 'A', 'f43': 'B', 'f14': 'slide'}
    """
    every = sorted(kind.every_joint, key=lambda joint: joint.slides)
    return {force_key(joint.links): "slide" if joint.slides else joint.name for joint in every}


def force_key(links: tuple[int, int]) -> str:
    """Key of a joint force: on the first link by the second, or on the second by the ground."""
    one, other = links
    return f"f1{other}" if one == 1 else f"f{other}{one}"


def plain(kind: Mechanism) -> bool:
    """Whether it is a four-bar: one loop with pins only."""
    return len(kind.dyads) == 1 and not kind.slides


def output_turns(kind: Mechanism) -> bool:
    """Whether the last link turns."""
    return kind.links[-1].number in turning(kind)


def turning(kind: Mechanism) -> dict[int, str]:
    """Names of the links after the driver that turn, by link number."""
    still = {number for pair in kind.slides if 1 in pair for number in pair}
    return {link.number: link.name for link in kind.links[2:] if link.number not in still}


def halfway(linkage: Linkage, link: int) -> FloatArray:
    """The point (u, v) halfway between the joints of a link; of a rod halfway to P, of a block its joint."""
    length = getattr(linkage, f"r{link}", None)
    if length is None:
        length = linkage.coupler_point[0] if link == 3 else 0.0
    return np.array([float(length) / 2, 0.0])
