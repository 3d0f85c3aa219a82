"""Distances of joints, and ends of struts, from the regions in which they have to lie."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from grashof.analysis.judge.verdict import Defect
from grashof.problems import Box, Problem, Region
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.requirements.limit_kinds import Limit
from grashof.problems.values.requirements.quantities import Scope

# Distances, in sizes, up to which a joint counts as inside a polygon, and as on a segment.
INSIDE, ON = 1e-9, 1e-6


def distances(region: Box, x: FloatArray, y: FloatArray) -> FloatArray:
    """Distances of places (n,) from a box or region, zero inside and on its boundary; NaN for a NaN place.

    >>> triangle = Region(inside=[[0, 0], [4, 0], [0, 4]])
    >>> distances(triangle, np.array([1.0, 2.0, 5.0]), np.array([1.0, 2.0, 0.0])).tolist()
    [0.0, 0.0, 1.0]
    """
    if not isinstance(region, Region):
        sides = zip((x, y), (region.x, region.y), strict=True)
        return np.hypot(*(np.maximum(0.0, np.maximum(low - at, at - high)) for at, (low, high) in sides))
    # Here, not above: shapely takes a while to import, and few problems have regions.
    import shapely

    from grashof.problems.values.areas import shape

    places = shapely.points(np.asarray(x), np.asarray(y))
    with np.errstate(invalid="ignore"):
        found = np.asarray(shapely.distance(shape(region.corners, is_line=region.on is not None), places))
    return np.where(np.isfinite(x) & np.isfinite(y), found, np.nan)


def slack_of(region: Box) -> float:
    """Distance, in sizes, that rounding may leave between a joint and its region."""
    return ON if isinstance(region, Region) and region.on is not None else INSIDE


def defects_outside(
    name: str, region: Region, limit: Limit, parts: Mapping[str, FloatArray], problem: Problem
) -> Iterator[Defect]:
    """A defect where a joint, with the places x and y at its targets, lies outside its region."""
    away = distances(region, parts["x"], parts["y"])
    # A target at which the linkage cannot be assembled is a defect by itself.
    nowhere = np.isnan(away).any() and limit.quantity.over is not Scope.TARGETS
    found = np.inf if nowhere else float(np.nan_to_num(away).max())
    miss = found / problem.scale(limit.quantity)
    if miss > slack_of(region):
        yield Defect(name, f"the distance of the {limit.quantity.words} from its region", found, "0", miss)
