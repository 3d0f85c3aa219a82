"""Regions: where a joint may be, other than an upright box."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.problems.values.box import ANYWHERE, Box
from grashof.problems.values.checks import GREATEST, finite_rows
from grashof.problems.values.errors import ProblemError, listing, wrong_value
from grashof.problems.values.text import counted
from grashof.problems.values.value_bases import set_fields

Corner: TypeAlias = tuple[float, float]
NARROWEST = 1e-9  # share of the extent of a region below which a polygon, or a slope, counts as straight


@dataclass(frozen=True, slots=True)
class Region(Box):
    """The inside of a polygon, or a straight line segment; `x` and `y` are the sides of the box around it.

    Parameters
    ----------
    inside : sequence of pair of float, length
        Corners of a simple polygon, whose boundary belongs to it.
    on : sequence of pair of float, length
        Both ends of a segment, in place of `inside`.

    Raises
    ------
    ProblemError
        Both or neither of them, a polygon without area or one that crosses itself, or a segment of no length.

    Examples
    --------
    >>> Region(inside=[[0, 0], [4, 0], [1, 2]]).y, Region(on=[[0, 0], [4, 2]]).x
    ((0.0, 2.0), (0.0, 4.0))
    """

    x: Limits = field(init=False, repr=False, compare=False)
    y: Limits = field(init=False, repr=False, compare=False)
    inside: Sequence[Corner] | None = None
    on: Sequence[Corner] | None = None

    def __post_init__(self) -> None:
        if (self.inside is None) == (self.on is None):
            given = "neither inside nor on" if self.inside is None else "inside and on"
            raise ProblemError(f"a region has {given}; it must have one of them")
        if self.on is not None:
            set_fields(self, on=_segment(self.on, "on"))
        else:
            set_fields(self, inside=_polygon(self.inside, "inside"))
        low, high = self.corners.min(axis=0).tolist(), self.corners.max(axis=0).tolist()
        set_fields(self, x=(low[0], high[0]), y=(low[1], high[1]))

    @property
    def corners(self) -> FloatArray:
        """Corners of the polygon, or the ends of the segment, (M, 2)."""
        return np.array(self.inside if self.on is None else self.on)

    @property
    def places(self) -> ComplexArray:
        """The same as complex numbers, (M,)."""
        found: ComplexArray = self.corners @ np.array([1, 1j])
        return found

    @property
    def is_upright(self) -> bool:
        """Whether it is a segment along an axis, which its box describes completely."""
        wide, tall = self.x[1] - self.x[0], self.y[1] - self.y[0]
        return self.on is not None and min(wide, tall) <= NARROWEST * max(wide, tall)

    @property
    def point(self) -> Box:
        """A place well inside it, or the middle of the segment, as a box of no width."""
        # Here, not above: shapely takes a while to import, and few problems have areas.
        import shapely

        from grashof.problems.values.areas import shape

        made = shape(self.corners, is_line=self.on is not None)
        (inside,) = shapely.get_coordinates(
            shapely.point_on_surface(made) if self.on is None else shapely.centroid(made)
        ).tolist()
        return Box(x=(inside[0], inside[0]), y=(inside[1], inside[1]))

    def moved(self, origin: complex, scale: float) -> Region:
        """The region in a frame with this origin and unit of length."""
        corners = [((x - origin.real) / scale, (y - origin.imag) / scale) for x, y in self.corners.tolist()]
        return Region(inside=corners) if self.on is None else Region(on=corners)


def place(**sides: Any) -> Box:
    """A box from `x` and `y`, or a region from `inside` or `on`, as files have them.

    `ProblemError` where keys of both are given.

    >>> place(x=(0, 1)), place(on=[[0, 0], [1, 1]])
    (Box(x=(0.0, 1.0), y=(-inf, inf)), Region(inside=None, on=((0.0, 0.0), (1.0, 1.0))))
    """
    given = [key for key in ("x", "y", "inside", "on") if sides.get(key) is not None]
    if len(given) > 1 and {"inside", "on"} & set(given):
        raise ProblemError(f"{given[-1]} does not go with {listing(given[:-1], 'and')}; give one of them")
    kept = {key: sides[key] for key in given}
    return Region(**kept) if {"inside", "on"} & set(given) else Box(**kept)


def standing(box: Box | None) -> Box:
    """The box for a pivot that is placed at once; for a region, a point in it."""
    return box.point if isinstance(box, Region) else box or ANYWHERE


def regions(places: dict[str, Any]) -> dict[str, Region]:
    """The values that are regions, by name."""
    return {name: each for name, each in places.items() if isinstance(each, Region)}


def _polygon(values: Any, where: str) -> tuple[Corner, ...]:
    # Here, not above: shapely takes a while to import, and few problems have areas.
    from grashof.problems.values.areas import polygon

    _refuse_words(values, where, "a list of corners [x, y]")
    return _pairs(polygon(values, where))


def _segment(values: Any, where: str) -> tuple[Corner, ...]:
    wanted = "[[x, y], [x, y]]"
    _refuse_words(values, where, wanted)
    ends = finite_rows(values, 2, where, "an end [x, y]", GREATEST)
    if len(ends) != 2:
        raise ProblemError(f"{where} has {counted(len(ends), 'end')}; it must be {wanted}")
    if np.hypot(*(ends[1] - ends[0])) <= NARROWEST * np.abs(ends).max():
        raise ProblemError(f"{where} has no length: both ends are the same point; it must be {wanted}")
    return _pairs(ends)


def _refuse_words(values: npt.ArrayLike, where: str, wanted: str) -> None:
    if isinstance(values, (str, bytes)) or not isinstance(values, (Sequence, np.ndarray)) or not len(values):
        raise wrong_value(where, values, wanted)


def _pairs(rows: FloatArray) -> tuple[Corner, ...]:
    return tuple((float(x), float(y)) for x, y in rows)
