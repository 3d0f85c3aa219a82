"""Regions for joints in the search: distances outside, nearest places inside, half-planes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from grashof.problems import Box, Region, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.quantities.formulas import Formulas, Part


def pairs_of(wanted: Requirements, formulas: Formulas) -> Iterator[tuple[str, Region, Part, Part]]:
    """The regions of joints that have formulas: field, region and the parts x and y."""
    for name, region in wanted.regions.items():
        key = LIMITS[name].quantity.key
        if key in formulas:
            x, y = formulas[key]
            yield name, region, x, y


def outside(region: Region, x: FloatArray, y: FloatArray) -> FloatArray:
    """Distances of places from a region, zero inside; by the sides of the polygon, or by the segment.

    >>> outside(Region(on=[[0, 0], [2, 0]]), np.array([1.0, 3.0]), np.array([0.5, 0.0])).tolist()
    [0.5, 1.0]
    """
    places = np.asarray(x + 1j * y)
    away: FloatArray = np.abs(places - nearest(region, places))
    return np.where(np.isfinite(away), away, 0.0)


def nearest(region: Region, places: ComplexArray) -> ComplexArray:
    """The places in a region nearest to others (...), those inside themselves."""
    corner = region.places
    begin, end = (corner[:1], corner[1:]) if region.on is not None else (corner, np.roll(corner, -1))
    along, offset = end - begin, places[..., None] - begin
    share = np.clip((offset * along.conj()).real / np.abs(along) ** 2, 0, 1)
    foot = begin + share * along
    away = np.abs(places[..., None] - foot)
    best: ComplexArray = np.take_along_axis(foot, np.argmin(away, axis=-1)[..., None], axis=-1)[..., 0]
    if region.on is not None:
        return best
    return np.where(_winds(begin, end, places), places, best)


def _winds(begin: ComplexArray, end: ComplexArray, places: ComplexArray) -> Any:
    """Whether a closed polygon goes round places: a ray to the right crosses it an odd number of times."""
    at = places[..., None]
    crosses = (begin.imag > at.imag) != (end.imag > at.imag)
    with np.errstate(divide="ignore", invalid="ignore"):
        meets = begin.real + (at.imag - begin.imag) / (end.imag - begin.imag) * (end.real - begin.real)
    return np.count_nonzero(crosses & (at.real < meets), axis=-1) % 2 == 1


def into(box: Box | None, places: ComplexArray) -> ComplexArray:
    """The places in a box, or a region, nearest to others (...)."""
    if isinstance(box, Region):
        return nearest(box, places)
    x, y = (box or Box()).x, (box or Box()).y
    return np.clip(places.real, *x) + 1j * np.clip(places.imag, *y)


def hull_rows(region: Region) -> list[tuple[complex, Limits]]:
    """Unit normals n, with limits of Re(conj(n) z), of places z in the convex hull of a region.

    A segment has one row, whose limits are equal; one along an axis has none, as its box is the same.

    >>> hull_rows(Region(on=[[0, 0], [0, 3]]))
    []
    >>> len(hull_rows(Region(inside=[[0, 0], [4, 0], [1, 1], [0, 4]])))
    3
    """
    if region.is_upright:
        return []
    if region.on is not None:
        begin, end = region.places
        normal = complex(1j * (end - begin) / abs(end - begin))
        at = float((begin * np.conj(normal)).real)
        return [(normal, (at, at))]
    # Here, not above: shapely takes a while to import, and few problems have areas.
    import shapely

    hull = shapely.convex_hull(shapely.MultiPoint(region.corners))
    ring = shapely.get_exterior_ring(hull)
    corner = shapely.get_coordinates(ring)[:: 1 if shapely.is_ccw(ring) else -1] @ np.array([1, 1j])
    return [
        (complex(normal), (float((start * np.conj(normal)).real), np.inf))
        for start, normal in zip(corner[:-1], 1j * np.diff(corner) / np.abs(np.diff(corner)), strict=True)
    ]


def hull_parts(name: str, region: Region, x: Part, y: Part) -> Iterator[tuple[Part, Limits]]:
    """The same as parts of a quantity, which is a place with the parts x and y."""
    for number, (normal, limits) in enumerate(hull_rows(region), 1):
        yield Part(f"{name} side {number}", _across(x, y, normal), dyad=x.dyad), limits


def _across(x: Part, y: Part, normal: complex) -> Any:
    return lambda d: normal.real * x.of(d) + normal.imag * y.of(d)
