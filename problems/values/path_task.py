"""The path task: points to trace, as a value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import TURN, FloatArray, frozen_array
from grashof.problems.values.checks import GREATEST, counted, finite_rows, span, task_size
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.read_only import ReadOnly
from grashof.problems.values.zones import LEAST_ZONE, zone_sizes


@dataclass(frozen=True, slots=True, init=False, eq=False)
class PathTask(ReadOnly):
    """Path generation: the coupler point P passes through points, in order.

    Parameters
    ----------
    points : array_like, shape (N, 2), length
        Where P has to be.
    timing : array_like, shape (N,), rad, optional
        Driver rotation from the first point, zero there, growing or falling throughout and over at
        most one turn. Its sense is free: a design may turn the driver either way.
    closed : bool
        One turn of the driver takes P round all points and back to the first.
    within : float or array_like, shape (N,), length, optional
        How far each point may be missed; the objective then decides.

    Raises
    ------
    ProblemError
        Fewer than three points, numbers that are not finite or beyond 1e20, a size below 1e-20, two
        consecutive equal points (the last may repeat the first), or a timing that is none.

    Examples
    --------
    >>> task = PathTask([[0, 0], [3, 0], [3, 4]])
    >>> task.size, task.exact_by_default
    (5.0, True)
    """

    kind: ClassVar[Literal["path"]] = "path"

    points: FloatArray
    timing: FloatArray | None
    closed: bool
    within: FloatArray | None

    def __init__(
        self,
        points: npt.ArrayLike,
        *,
        timing: npt.ArrayLike | None = None,
        closed: bool = False,
        within: npt.ArrayLike | None = None,
    ) -> None:
        places = finite_rows(points, 2, "path.points", "a point [x, y]", GREATEST)
        if len(places) < 3:
            raise ProblemError(f"path.points has {counted(len(places), 'point')}; allowed are three or more")
        for index in np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) == 0):
            raise ProblemError(
                f"path.points[{index}] and path.points[{index + 1}] are equal; consecutive points must differ"
            )
        size = task_size(places, "path.points")
        if not isinstance(closed, (bool, np.bool_)):
            raise ProblemError(f"path.closed is {closed!r}; allowed is true or false")
        zone = zone_sizes(within, len(places), "path.within", least=LEAST_ZONE * size)
        object.__setattr__(self, "within", zone)
        rotation = None if timing is None else _timing(timing, len(places))
        object.__setattr__(self, "points", places)
        object.__setattr__(self, "timing", rotation)
        object.__setattr__(self, "closed", bool(closed))

    @classmethod
    def from_degrees(
        cls,
        points: npt.ArrayLike,
        *,
        timing_deg: npt.ArrayLike | None = None,
        closed: bool = False,
        within: npt.ArrayLike | None = None,
    ) -> PathTask:
        """Task with its timing in degrees, as problem files write it."""
        timing = None if timing_deg is None else np.radians(_numbers(timing_deg))
        return cls(points, timing=timing, closed=closed, within=within)

    @property
    def positions(self) -> FloatArray:
        """The points, by the name that both kinds of task share; shape (N, 2), length."""
        return self.points

    @property
    def size(self) -> float:
        """Greatest distance between two points."""
        return span(self.points)

    @property
    def zones(self) -> FloatArray | None:
        """How far points (length) and angles (infinite: there are none) may be missed, shape (2, N)."""
        return None if self.within is None else np.stack([self.within, np.full(len(self), np.inf)])

    def without_zones(self) -> PathTask:
        """The same targets, none of them to be missed."""
        return PathTask(self.points, timing=self.timing, closed=self.closed)

    @property
    def exact_by_default(self) -> bool:
        """Whether linkages through every point can be expected: up to nine points, five timed ones."""
        return len(self) <= (9 if self.timing is None else 5)

    def __len__(self) -> int:
        return len(self.points)


def _timing(values: npt.ArrayLike, count: int) -> FloatArray:
    """Driver rotations of `count` points, checked; messages in degrees, as files write them."""
    timing = _numbers(values)
    if len(timing) != count:
        raise ProblemError(f"path.timing_deg has {counted(len(timing), 'angle')} for {count} points")
    if timing[0] != 0:
        raise ProblemError(f"path.timing_deg[0] is {_degrees(timing[0])}; allowed is 0, at the first point")
    sense = np.sign(timing[1])
    for index in np.flatnonzero(sense * np.diff(timing) <= 0) + 1:
        raise ProblemError(
            f"path.timing_deg[{index}] is {_degrees(timing[index])} after {_degrees(timing[index - 1])}; "
            "allowed are angles that only grow, or only fall"
        )
    if abs(timing[-1]) > TURN * (1 + 1e-12):
        raise ProblemError(
            f"path.timing_deg[{count - 1}] is {_degrees(timing[-1])}; allowed is up to one turn, 360"
        )
    return frozen_array(timing)


def _numbers(values: npt.ArrayLike) -> FloatArray:
    try:
        numbers = np.asarray(values)
    except ValueError:  # lists of unequal length inside
        raise ProblemError(f"path.timing_deg is {values!r}; allowed is a list of angles") from None
    if numbers.ndim != 1 or numbers.dtype.kind not in "iuf":
        raise ProblemError(f"path.timing_deg is {values!r}; allowed is a list of angles")
    for index in np.flatnonzero(~np.isfinite(numbers)):
        raise ProblemError(f"path.timing_deg[{index}] is {numbers[index]}; all numbers must be finite")
    return numbers.astype(np.float64)


def _degrees(angle: float) -> str:
    return f"{np.degrees(angle):.6g}"
