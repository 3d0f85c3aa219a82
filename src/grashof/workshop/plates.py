"""Shapes of the parts: a point, a line or a polygon round holes, widened all round by half a width."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

import numpy as np
import numpy.typing as npt
import shapely

from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.checks import number_within, positive_number

_STRAIGHT = 1e-9  # share of a plate's length by which holes in line may be off it


@dataclass(frozen=True, slots=True)
class PlateSizes:
    """Dimensions of the plates of a linkage.

    Parameters
    ----------
    width : float, mm
        Of the links; their ends are semicircles about the holes. The base is twice as wide.
    hole : float, mm
        Diameter of the holes, and of the pins.
    thickness : float, mm
        Of the material, the same for all parts.
    clearance : float, mm
        Least gap between parts that pass each other on one layer; a twentieth of the width by default.

    Raises
    ------
    ProblemError
        A number that is not positive, a hole as wide as the plate, or a clearance outside a
        hundredth of the width to the width.

    Examples
    --------
    >>> PlateSizes(width=20, hole=6).least_spacing
    13.0
    """

    width: float = 20.0
    hole: float = 6.0
    thickness: float = 5.0
    clearance: float | None = None

    def __post_init__(self) -> None:
        for name in ("width", "hole", "thickness"):
            object.__setattr__(self, name, positive_number(getattr(self, name), f"{name} in mm"))
        if self.hole >= self.width:
            raise ProblemError(f"hole is {self.hole:g} mm; it must be less than the width, {self.width:g} mm")
        gap = self.width / 20 if self.clearance is None else self.clearance
        low, high = self.width / 100, self.width
        object.__setattr__(self, "clearance", number_within(gap, low, high, "clearance in mm"))

    @property
    def gap(self) -> float:
        """The clearance, mm."""
        return float(self.clearance or 0.0)

    @property
    def least_spacing(self) -> float:
        """Least distance of two holes, mm: then as much is left between them as beside each."""
        return (self.width + self.hole) / 2


@dataclass(frozen=True, slots=True, eq=False)
class Plate:
    """A part cut from the sheet, in a frame of its own: O2, A or O4 at the origin, the next joint along +x.

    Parameters
    ----------
    name : str
    joints : tuple of str
        Purpose of each hole.
    holes : ndarray, shape (n, 2), mm
        Centres.
    corners : ndarray, shape (n, 2), mm
        Point, line or convex polygon (counter-clockwise) that the plate surrounds.
    width : float, mm
    hole : float, mm
        Diameter, and the width of slots.
    slots : tuple of (str, ndarray of shape (2, 2)), mm
        Purpose of each slot, and the centres of its ends.
    """

    name: str
    joints: tuple[str, ...]
    holes: FloatArray
    corners: FloatArray
    width: float
    hole: float
    slots: tuple[tuple[str, FloatArray], ...] = ()

    @property
    def outline(self) -> FloatArray:
        """The closed outline, counter-clockwise: x, y in mm and the bulge to the next row; shape (k, 3).

        The bulge, as in a DXF polyline, is the tangent of a quarter of the arc's angle; 0 for a line.
        """
        return outline(self.corners, self.width / 2)

    @property
    def distances(self) -> tuple[tuple[str, float], ...]:
        """Distances between holes (mm) by the names of their joints, in a row of four to the next; slots."""
        holes = list(zip(self.joints, self.holes, strict=True))
        row = len(holes) > 3 and len(self.corners) == 2
        pairs = pairwise(holes) if row else combinations(holes, 2)
        apart = [(f"{one}-{other}", float(np.hypot(*(b - a)))) for (one, a), (other, b) in pairs]
        return (*apart, *((f"slot {name}", float(np.hypot(*(b - a)))) for name, (a, b) in self.slots))


def outline(corners: npt.ArrayLike, radius: float) -> FloatArray:
    """Everything within `radius` of a point, a line or a convex polygon (n, 2), counter-clockwise.

    As x, y and bulge (tangent of a quarter of the arc's angle) of each vertex, (2 max(n, 1) or 2, 3).

    >>> outline([(0, 0), (50, 0)], 10).round(6).tolist()
    [[0.0, 10.0, 1.0], [0.0, -10.0, 0.0], [50.0, -10.0, 1.0], [50.0, 10.0, 0.0]]
    """
    points = np.asarray(corners, dtype=np.float64)
    if len(points) == 1:
        (x, y), r = points[0], radius
        return np.array([[x - r, y, 1.0], [x + r, y, 1.0]])
    sides = np.roll(points, -1, axis=0) - points
    normals = np.stack([sides[:, 1], -sides[:, 0]], axis=1) * radius / np.hypot(*sides.T)[:, None]
    before = np.roll(normals, 1, axis=0)
    cross = before[:, 0] * normals[:, 1] - before[:, 1] * normals[:, 0]
    turn = np.abs(np.arctan2(cross, (before * normals).sum(axis=1)))
    arcs = np.column_stack([points + before, np.tan(turn / 4)])
    lines = np.column_stack([points + normals, np.zeros(len(points))])
    return np.stack([arcs, lines], axis=1).reshape(-1, 3)


def bar(name: str, joints: tuple[str, ...], along: tuple[float, ...], sizes: PlateSizes) -> Plate:
    """A straight plate with holes at positions along x (mm), rounded about the outermost ones."""
    holes = np.array([(x, 0.0) for x in along])
    ends = np.array([(min(along), 0.0), (max(along), 0.0)])
    return _plate(name, joints, holes, ends, sizes)


def plate_of(
    name: str,
    holes: Mapping[str, FloatArray],
    sizes: PlateSizes,
    slots: Mapping[str, FloatArray] | None = None,
) -> Plate:
    """A plate round holes (x, y) and slots, each from one centre to another, shape (2, 2), mm.

    A bar where all its holes lie on the x-axis and it has no slot.
    """
    centres, slots = np.array(list(holes.values())), slots or {}
    if not slots and np.abs(centres[:, 1]).max() <= _STRAIGHT * np.abs(centres).max():
        return bar(name, tuple(holes), tuple(centres[:, 0].tolist()), sizes)
    corners = _hull(np.concatenate([centres, *slots.values()]))
    if not slots:  # they begin at the first hole that is one
        _, corner = np.nonzero((centres[:, None] == corners).all(axis=-1))
        corners = np.roll(corners, -corner[0], axis=0)
    plate = _plate(name, tuple(holes), centres, corners, sizes)
    return replace(plate, slots=tuple((pin, frozen_array(ends)) for pin, ends in slots.items()))


def _hull(points: FloatArray) -> FloatArray:
    """Corners of the convex hull of points, counter-clockwise, shape (1, 2 or more, 2)."""
    hull = shapely.convex_hull(shapely.multipoints(points))
    corners: FloatArray = shapely.get_coordinates(shapely.orient_polygons(hull))
    return corners[:-1] if shapely.get_dimensions(hull) == 2 else corners


def spacer(sizes: PlateSizes) -> Plate:
    """The ring about a pin where it passes a layer without a plate of its own: as wide as a link's end."""
    centre = np.zeros((1, 2))
    return _plate("spacer", ("pin",), centre, centre, sizes)


def _plate(
    name: str, joints: tuple[str, ...], holes: FloatArray, corners: FloatArray, sizes: PlateSizes
) -> Plate:
    return Plate(name, joints, frozen_array(holes), frozen_array(corners), sizes.width, sizes.hole)
