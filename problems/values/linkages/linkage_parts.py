"""What a kind of linkage is stated by: the parameters that it is given by, and the points on its links."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import MOST_TURNS
from grashof.problems.values.errors import ProblemError, shown, wrong_value

_ENDINGS = {"place": ("_x", "_y"), "station": ("_u", "_v"), "arm": ("_u", "_v"), "angle": ("_deg",)}


@dataclass(frozen=True, slots=True)
class Parameter:
    """One of the parameters that a linkage is given by.

    A place is x and y; a station the same of a point on a link that is the ground, as u and v; an arm u and v
    in the frame of a link; a distance may be negative or zero; angles are in rad, in files and tables in deg.
    """

    name: str  # in Python and JSON
    kind: Literal["place", "station", "arm", "length", "distance", "sign", "angle"]
    column: str = ""  # what its columns in tables begin with, where that is not the name

    @property
    def paired(self) -> bool:
        """Whether it is two numbers, on a last axis."""
        return self.kind in ("place", "station", "arm")

    @property
    def in_length(self) -> bool:
        """Whether its numbers are in the unit of length."""
        return self.kind not in ("sign", "angle")

    @property
    def key(self) -> str:
        """Its key in linkage files."""
        return f"{self.name}_deg" if self.kind == "angle" else self.name

    @property
    def columns(self) -> tuple[str, ...]:
        """Its columns in tables, one a number."""
        return tuple((self.column or self.name) + ending for ending in _ENDINGS.get(self.kind, ("",)))

    def array(self, value: npt.ArrayLike) -> FloatArray:
        """A value of the parameter as an array.

        `ProblemError` where it is not a number, not finite, not a pair, not a length, not a sign, or over 100
        turns.
        """
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            raise wrong_value(self.name, value, "a number") from None
        if not np.isfinite(array).all():
            raise ProblemError(f"{self.name} is {shown(value)}; all numbers must be finite")
        if self.paired and array.shape[-1:] != (2,):
            raise ProblemError(f"{self.name} has shape {array.shape}; it must be (..., 2)")
        if self.kind == "length" and np.any(array <= 0):
            raise wrong_value(self.name, value, "greater than zero")
        if self.kind == "sign" and np.any(np.abs(array) != 1):
            raise wrong_value(self.name, value, "+1 or -1")
        if self.kind == "angle" and np.any(np.abs(array) > MOST_TURNS * 2 * np.pi):
            raise wrong_value(self.name, value, f"at most {MOST_TURNS} turns")
        return array


@dataclass(frozen=True, slots=True)
class Link:
    """A link and the points on it.

    1 is the ground, 2 the driver; their lengths are r1, r2, ..., their directions theta1, theta2, ... The
    first point is the origin of its frame, the second lies on its u-axis.
    """

    number: int
    name: str
    points: tuple[str, ...]

    @property
    def labels(self) -> tuple[str, ...]:
        """Its points as they are written in drawings: O2, A."""
        return tuple(point.upper() for point in self.points)

    @property
    def lines(self) -> tuple[tuple[str, str], ...]:
        """Its points, each joined with every other one."""
        return tuple(combinations(self.points, 2))


def points_of(links: Sequence[Link]) -> tuple[str, ...]:
    """All points on some links, each once."""
    return tuple(dict.fromkeys(point for link in links for point in link.points))
