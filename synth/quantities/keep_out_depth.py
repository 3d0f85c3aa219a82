"""Which points keep out of areas, and how deep they lie inside."""

from __future__ import annotations

import numpy as np
import shapely

from grashof.problems import FourBar, Requirements
from grashof.problems.values.areas import solid
from grashof.problems.values.arrays import ComplexArray, FloatArray

TOUCHING = 1e-10  # sizes: a point no deeper inside counts as on the boundary


def points_kept_out(wanted: Requirements) -> tuple[str, ...]:
    """Which of o2, o4, a, b, p must keep out of areas: those named, and the ends of links."""
    if not wanted.keep_out:
        return ()
    return tuple(name for name in FourBar.mechanism.points if {name, "links"} & set(wanted.keep_out_for))


def depth(wanted: Requirements, name: str, points: ComplexArray) -> FloatArray:
    """How deep points lie inside areas that `name` must keep out of; zero outside and where it need not.

    Requirements in the frame of the points; `name` is "o2", "o4", "a", "b" or "p".

    >>> square = Requirements(keep_out=[[[0, 0], [4, 0], [4, 4], [0, 4]]])
    >>> points = np.array([1 + 2j, 4 + 1j, 9])
    >>> depth(square, "o2", points).tolist(), depth(square, "a", points).tolist()
    ([1.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    """
    return inside(wanted, points) if name in points_kept_out(wanted) else np.zeros(points.shape)


def inside(wanted: Requirements, points: ComplexArray) -> FloatArray:
    """How deep points (...) lie inside the areas, whatever they are of; zero outside."""
    found = np.zeros(points.shape)
    area = solid(wanted.keep_out)
    within = shapely.contains_xy(area, points.real, points.imag)
    places = shapely.points(points.real[within], points.imag[within])
    found[within] = shapely.distance(shapely.boundary(area), places)
    return np.where(found > TOUCHING, found, 0.0)
