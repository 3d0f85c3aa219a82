"""The path task: points to trace, as a value."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.checks import GREATEST, finite_rows, number_within, task_size, true_or_false
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.tasks.target_checks import (
    LEAST_ZONE,
    driver_timing,
    finite_angles,
    some_columns,
    zone_sizes,
)
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.text import counted
from grashof.problems.values.value_bases import set_fields

RATIOS = 1.0, 1e6  # of the length of a curve to that of the spline


@dataclass(frozen=True, slots=True, init=False, eq=False)
class PathTask(Task):
    """Path generation: the coupler point P passes through points, in order.

    Parameters
    ----------
    points : array_like, shape (N, 2), length
        Where the coupler point P has to be, in order.
    timing : array_like, shape (N,), rad, optional
        Driver rotation from the first point, zero there, growing or falling throughout and over at
        most one turn. Its sense is free: a design may turn the driver either way.
    closed : bool
        One turn of the driver takes P round all points and back to the first.
    within : float or array_like, shape (N,), length, optional
        How far each point may be missed; the objective then decides.
    length_ratio_max : float, optional
        Of closed paths: greatest length of the coupler curve over that of the closed cubic spline through
        the points, so that no curve strays between them. By default 1.02 for six-bars, without limit for
        others.

    Raises
    ------
    ProblemError
        Fewer than three points, numbers that are not finite or beyond 1e20, a size below 1e-20, two
        consecutive equal points (the last may repeat the first), a timing that is not one, or a ratio below
        1 or of a path that is not closed.

    Examples
    --------
    >>> task = PathTask([[0, 0], [3, 0], [3, 4]])
    >>> task.size, task.exact_by_default
    (5.0, True)
    """

    kind: ClassVar[Literal["path"]] = "path"
    target: ClassVar[Literal["point"]] = "point"

    points: FloatArray
    timing: FloatArray | None
    closed: bool
    within: FloatArray | None
    length_ratio_max: float | None

    def __init__(
        self,
        points: npt.ArrayLike,
        *,
        timing: npt.ArrayLike | None = None,
        closed: bool = False,
        within: npt.ArrayLike | None = None,
        length_ratio_max: float | None = None,
    ) -> None:
        places = finite_rows(points, 2, "path.points", "a point [x, y]", GREATEST)
        if len(places) < 3:
            raise ProblemError(f"path.points has {counted(len(places), 'point')}; it must have three or more")
        for index in np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) == 0):
            raise ProblemError(
                f"path.points[{index}] and path.points[{index + 1}] are equal; consecutive points must differ"
            )
        size = task_size(places, "path.points")
        if length_ratio_max is not None:
            number_within(length_ratio_max, *RATIOS, "path.length_ratio_max")
            if not closed:
                raise ProblemError("path.length_ratio_max goes with path.closed = true; remove it")
        set_fields(
            self,
            closed=true_or_false(closed, "path.closed"),
            within=zone_sizes(within, len(places), "path.within", least=LEAST_ZONE * size),
            timing=driver_timing(timing, len(places), "path", "point"),
            points=places,
            length_ratio_max=None if length_ratio_max is None else float(length_ratio_max),
        )

    @classmethod
    def from_degrees(
        cls,
        points: npt.ArrayLike,
        *,
        timing_deg: npt.ArrayLike | None = None,
        closed: bool = False,
        within: npt.ArrayLike | None = None,
        length_ratio_max: float | None = None,
    ) -> PathTask:
        """Task with its timing in degrees, as problem files write it."""
        timing = None if timing_deg is None else np.radians(finite_angles(timing_deg, "path"))
        return cls(points, timing=timing, closed=closed, within=within, length_ratio_max=length_ratio_max)

    def some(self, index: IntArray, positions: FloatArray, angles: FloatArray) -> PathTask:  # noqa: ARG002
        """Some of the points, moved; they have no angles."""
        return replace(self, points=positions, **some_columns(self, index, "timing", "within"))

    @property
    def positions(self) -> FloatArray:
        """The points, by the name that they have in every task; shape (N, 2), length."""
        return self.points
