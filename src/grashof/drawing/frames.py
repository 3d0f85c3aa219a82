"""Where the points of a link are in its own frame, as its drawings and bodies need them."""

from __future__ import annotations

import numpy as np

from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage_parts import Link


def points_on(linkage: Linkage, link: Link) -> dict[str, FloatArray]:
    """Points (2,) of a link of a single linkage, in their order, in its frame; the ground's is global.

    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80, coupler_point=(50, 20))
    >>> {name: at.tolist() for name, at in points_on(norton, norton.mechanism.links[2]).items()}
    {'a': [0.0, 0.0], 'b': [120.0, 0.0], 'p': [50.0, 20.0]}
    """
    return {name: _point(linkage, link, name) for name in link.points}


def _point(linkage: Linkage, link: Link, name: str) -> FloatArray:
    if link.number == 1:
        ground: FloatArray = getattr(linkage, name)
        return ground
    if name == link.points[0]:
        return np.zeros(2)
    if name in ("p", "c", "d"):
        arm: FloatArray = getattr(linkage, "coupler_point" if name == "p" else name)
        return arm
    length = f"r{link.number}"  # of a block none: B is as far from O4 as the rod is
    return np.array([float(getattr(linkage, length if hasattr(linkage, length) else "offset")), 0.0])
