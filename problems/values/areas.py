"""Areas for parts of a linkage to avoid: polygons checked, and joined.

Regions for joints are shapes here, too. Only this module gives polygons to shapely; it is imported only where
there are areas.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt
import shapely

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import GREATEST, each_checked, finite_rows
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.text import counted

_STEPS = 400  # least number of steps along a line at which its depth is measured
_FLAT = 1e-12  # share of the square of its extent below which a polygon has no area


def polygons(values: Iterable[npt.ArrayLike], where: str) -> tuple[FloatArray, ...]:
    """Corners of polygons, read-only arrays of shape (M, 2); a polygon may repeat its first corner last.

    `ProblemError` for fewer than three corners, no area, numbers that are not finite, or a crossing.
    """
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise wrong_value(where, values, "a list of polygons")
    return tuple(each_checked(values, where, polygon))


def solid(areas: Sequence[FloatArray]) -> shapely.Geometry:
    """All areas, corners (M, 2), as one, prepared for many queries: no gap is left where two share a side."""
    joined = shapely.union_all(np.array([shapely.Polygon(corners) for corners in areas]))
    shapely.prepare(joined)
    return joined


def depth_of_line(areas: Sequence[FloatArray], corners: FloatArray) -> float:
    """Greatest depth of a closed line through corners (M, 2), or a single point, inside areas; 0 outside.

    >>> square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    >>> depth_of_line([square], np.array([[1.0, 2.0]])), depth_of_line([square], square + [3.0, 0.0])
    (1.0, 1.0)
    """
    area = solid(areas)
    line = shapely.Point(corners[0]) if len(corners) == 1 else shapely.LinearRing(corners)
    inside = shapely.segmentize(shapely.intersection(area, line), line.length / _STEPS or 1.0)
    points = shapely.points(shapely.get_coordinates(inside))
    return float(np.max(shapely.distance(shapely.boundary(area), points), initial=0.0))


def shape(corners: FloatArray, *, is_line: bool) -> shapely.Geometry:
    """Corners (M, 2) as a polygon or a line, prepared for many queries."""
    return _shape(corners.tobytes(), is_line)


@lru_cache(maxsize=64)
def _shape(corners: bytes, is_line: bool) -> shapely.Geometry:
    rows = np.frombuffer(corners).reshape(-1, 2)
    made = shapely.LineString(rows) if is_line else shapely.Polygon(rows)
    shapely.prepare(made)
    return made


def polygon(values: npt.ArrayLike, where: str) -> FloatArray:
    """Corners of a simple polygon, read-only (M, 2); see `polygons`."""
    corners = finite_rows(values, 2, where, "a corner [x, y]", GREATEST)
    distinct = len(np.unique(corners, axis=0))
    if distinct < 3:
        raise ProblemError(f"{where} has {counted(distinct, 'distinct corner')}; it must have three or more")
    extent = float(np.hypot(*np.ptp(corners, axis=0)))
    if shapely.MultiPoint(corners).convex_hull.area <= _FLAT * extent**2:
        raise ProblemError(f"{where} has no area: its corners lie on a straight line")
    found = re.search(r"\[(\S+) (\S+)\]", reason := shapely.is_valid_reason(shapely.Polygon(corners)))
    if found:
        x, y = (float(number) for number in found.groups())
        raise ProblemError(
            f"{where} crosses or touches itself at ({x:.6g}, {y:.6g}); it must be a simple polygon"
        )
    if reason != "Valid Geometry":
        raise ProblemError(f"{where} is not a simple polygon: {reason.lower()}")
    return corners
