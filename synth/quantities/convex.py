"""Convex pieces of the plane about a point: of a region, or of what areas leave free."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import shapely

from grashof.problems import Region
from grashof.problems.values.areas import shape
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.quantities.regions import hull_rows, nearest
from grashof.synth.quantities.screening import TOUCHING

EVERY_PLANE = np.array([0.0, 0.0, -1.0])  # 0 x + 0 y >= -1: no limit


def half_planes(area: shapely.Geometry, point: complex, count: int) -> FloatArray:
    """Half-planes about a point whose intersection is free of an area (see `solid`).

    Rows (nx, ny, c), (`count`, 3): nx x + ny y >= c in the free region, (nx, ny) a unit vector. For a point
    inside the area its nearest boundary point is taken. The side nearest to the point is extended to a
    straight line, and the area beyond it cut off; this is repeated until nothing is left, or all are
    used up and some of the area farther away is left. (Deits & Tedrake, "Computing large convex regions of
    obstacle-free space", 2015, take the same greedy cuts.)

    >>> from grashof.problems.values.areas import solid
    >>> stairs = solid([np.array([[0, -9], [0, 0], [5, 0], [5, 4], [9, 4], [9, -9]])])
    >>> half_planes(stairs, 3 + 1j, 3).tolist()
    [[0.0, 1.0, 0.0], [-1.0, 0.0, -5.0], [0.0, 0.0, -1.0]]
    """
    planes = np.tile(EVERY_PLANE, (count, 1))
    if shapely.contains_xy(area, point.real, point.imag):
        place = shapely.Point(point.real, point.imag)
        point = complex(*shapely.get_coordinates(shapely.shortest_line(shapely.boundary(area), place))[0])
    left = area
    for plane in planes:
        begin, end = _sides(left)
        if not len(begin):
            break
        outward = -1j * (end - begin) / np.abs(end - begin)
        plane[:] = _nearest_line(begin, end, outward, point)
        left = _part_in(left, plane)
    return planes


def piece_about(region: Region, point: complex, count: int) -> FloatArray:
    """Half-planes (`count`, 3) about a point whose intersection is a convex piece of a polygon.

    >>> piece_about(Region(inside=[[0, 0], [4, 0], [4, 1], [1, 1], [1, 4], [0, 4]]), 3 + 0.5j, 4).shape
    (4, 3)
    """
    if is_convex(region):
        planes = np.tile(EVERY_PLANE, (count, 1))
        rows = [(normal.real, normal.imag, limits[0]) for normal, limits in hull_rows(region)]
        planes[: len(rows)] = rows[:count]
        return planes
    return half_planes(_beyond(region), nearest(region, np.array(point)).item(), count)


@lru_cache(maxsize=64)
def is_convex(region: Region) -> bool:
    """Whether a polygon is its own convex hull."""
    made = shape(region.corners, is_line=region.on is not None)
    area, around = shapely.area(made), shapely.area(shapely.convex_hull(made))
    return bool(around - area <= 1e-12 * around)


@lru_cache(maxsize=64)
def _beyond(region: Region) -> shapely.Geometry:
    """The enlarged box around a region, less the region."""
    (left, right), (low, high) = region.x, region.y
    room = max(right - left, high - low)
    around = shapely.box(left - room, low - room, right + room, high + room)
    left_over = shapely.difference(around, shape(region.corners, is_line=region.on is not None))
    shapely.prepare(left_over)
    return left_over


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
