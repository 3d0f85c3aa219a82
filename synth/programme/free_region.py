"""A convex region about a point, outside the areas kept out."""

from __future__ import annotations

import numpy as np
import shapely

from grashof.problems import Requirements
from grashof.problems.values.areas import solid
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import PLANES
from grashof.synth.quantities.screening import TOUCHING

EVERY_PLANE = np.array([0.0, 0.0, -1.0])  # 0 x + 0 y >= -1: no limit


def half_planes(area: shapely.Geometry, point: complex, count: int = PLANES) -> FloatArray:
    """Half-planes about a point whose intersection is free of an area (see `solid`).

    Rows (nx, ny, c), (`count`, 3): nx x + ny y >= c in the free region, (nx, ny) a unit vector. For a point
    inside the area its nearest boundary point is taken. The side nearest to the point is extended to a
    straight line, and the area beyond it cut off; this is repeated until nothing is left, or all are
    used up and some of the area farther away is left. (Deits & Tedrake, "Computing large convex regions of
    obstacle-free space", 2015, take the same greedy cuts.)

    >>> stairs = solid([np.array([[0, -9], [0, 0], [5, 0], [5, 4], [9, 4], [9, -9]])])
    >>> half_planes(stairs, 3 + 1j)[:3].tolist()
    [[0.0, 1.0, 0.0], [-1.0, 0.0, -5.0], [0.0, 0.0, -1.0]]
    """
    planes = np.tile(EVERY_PLANE, (count, 1))
    if shapely.contains_xy(area, point.real, point.imag):
        place = shapely.Point(point.real, point.imag)
        nearest = shapely.get_coordinates(shapely.shortest_line(shapely.boundary(area), place))[0]
        point = complex(*nearest)
    left = area
    for plane in planes:
        begin, end = _sides(left)
        if not len(begin):
            break
        outward = -1j * (end - begin) / np.abs(end - begin)
        plane[:] = _nearest_line(begin, end, outward, point)
        left = _part_in(left, plane)
    return planes


def free_regions(wanted: Requirements, start: Start, names: tuple[str, ...]) -> FloatArray:
    """Half-planes (K, PLANES, 3) about points of a start, name by name, moving ones in the order of visit."""
    track = dict(zip(("a", "b", "p"), start.track, strict=True))
    places = [track.get(name, np.array([getattr(start, name)])) for name in names]
    area = solid(wanted.keep_out)
    return np.array([half_planes(area, complex(point)) for point in np.concatenate(places)])


def _sides(area: shapely.Geometry) -> tuple[ComplexArray, ComplexArray]:
    """Sides of the boundary, the area on their left."""
    begins, ends = [np.zeros(0, dtype=np.complex128)], [np.zeros(0, dtype=np.complex128)]
    for part in shapely.get_parts(area):
        if shapely.get_type_id(part) != shapely.GeometryType.POLYGON:
            continue
        for number, ring in enumerate(shapely.get_rings(part)):
            corner = shapely.get_coordinates(ring) @ np.array([1, 1j])
            # Counter-clockwise around the area, clockwise around a hole.
            if bool(shapely.is_ccw(ring)) != (number == 0):
                corner = corner[::-1]
            begins.append(corner[:-1])
            ends.append(corner[1:])
    return np.concatenate(begins), np.concatenate(ends)


def _nearest_line(
    begin: ComplexArray, end: ComplexArray, outward: ComplexArray, point: complex
) -> FloatArray:
    """The line through the side nearest to a point; at a corner the side it is farther outside of."""
    along, offset = end - begin, point - begin
    share = np.clip((offset * along.conj()).real / np.abs(along) ** 2, 0, 1)
    away = np.abs(offset - share * along)
    outside = (outward.conj() * offset).real
    side = np.argmax(np.where(away <= away.min() + TOUCHING, outside, -np.inf))
    normal = outward[side]
    return np.array([normal.real, normal.imag, (normal.conj() * begin[side]).real])


def _part_in(area: shapely.Geometry, plane: FloatArray) -> shapely.Geometry:
    """The part of an area in a half-plane, without slivers."""
    normal = complex(plane[0], plane[1])
    foot = normal * (plane[2] + TOUCHING)
    far = 4 * (np.abs(shapely.bounds(area)).max() + abs(foot))
    corners = foot + far * np.array([-1j, 1 - 1j, 1 + 1j, 1j]) * normal
    return shapely.intersection(area, shapely.Polygon(np.stack([corners.real, corners.imag], axis=-1)))
