"""A convex region about a point, outside the areas kept out."""

from __future__ import annotations

import numpy as np

from grashof.problems import Requirements
from grashof.problems.values.areas import solid
from grashof.problems.values.arrays import FloatArray
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import PLANES
from grashof.synth.quantities.convex import half_planes


def free_regions(wanted: Requirements, start: Start, names: tuple[str, ...]) -> FloatArray:
    """Half-planes (K, PLANES, 3) about points of a start, name by name, moving ones in the order of visit."""
    track = dict(zip(("a", "b", "p"), start.track, strict=True))
    places = [track.get(name, np.array([getattr(start, name)])) for name in names]
    area = solid(wanted.keep_out)
    return np.array([half_planes(area, complex(point), PLANES) for point in np.concatenate(places)])
