"""Tasks: what a linkage is asked to do, as values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from grashof.problems.checks import FloatArray, counted, finite_number, finite_rows, frozen_array, outline
from grashof.problems.errors import ProblemError

_TURN = 2 * np.pi


@dataclass(frozen=True, slots=True, init=False, eq=False)
class MotionTask:
    """Motion generation: the coupler carries a body through poses, in order.

    Parameters
    ----------
    positions : array_like, shape (N, 2), length
        Where the body's origin, the coupler point P, has to be.
    angles : array_like, shape (N,), rad
        Orientations of the body, counter-clockwise from +x.
    angle_length : float, length, optional
        Length that one radian of orientation error counts as; the size of the task by default.
    body : array_like, shape (M, 2), length, optional
        Outline carried, in the body's frame (origin at the pose). Drawn only.

    Raises
    ------
    ProblemError
        Fewer than two poses, numbers that are not finite, or two consecutive equal poses.

    Examples
    --------
    >>> task = MotionTask.from_degrees([[0, 0, 0], [3, 4, 90]])
    >>> task.size
    5.0
    """

    kind: ClassVar[Literal["motion"]] = "motion"

    positions: FloatArray
    angles: FloatArray
    angle_length: float
    body: FloatArray | None

    def __init__(
        self,
        positions: npt.ArrayLike,
        angles: npt.ArrayLike,
        *,
        angle_length: float | None = None,
        body: npt.ArrayLike | None = None,
    ) -> None:
        places = finite_rows(positions, 2, "motion.poses", "a position [x, y]")
        try:
            turned = np.asarray(angles, dtype=np.float64)
        except (TypeError, ValueError):
            raise ProblemError(f"motion.poses has angles {angles!r}; allowed are numbers") from None
        if turned.shape != (len(places),):
            raise ProblemError(f"motion.poses has {len(places)} positions and angles of shape {turned.shape}")
        if not np.isfinite(turned).all():
            raise ProblemError("motion.poses has an angle that is not finite")
        if len(places) < 2:
            raise ProblemError(f"motion.poses has {counted(len(places), 'pose')}; allowed are two or more")
        span = _span(places)
        if not np.isfinite(span):
            raise ProblemError("motion.poses are farther apart than the largest number")
        _refuse_standing_still(places, turned)
        if angle_length is not None and finite_number(angle_length, "motion.angle_length") <= 0:
            raise ProblemError(
                f"motion.angle_length is {angle_length:g}; allowed is a length greater than zero"
            )
        if span == 0 and angle_length is None:
            raise ProblemError("motion.angle_length is missing: a pure rotation has no size to take it from")
        object.__setattr__(self, "positions", places)
        object.__setattr__(self, "angles", frozen_array(turned))
        object.__setattr__(self, "angle_length", span if angle_length is None else float(angle_length))
        object.__setattr__(self, "body", None if body is None else outline(body, "motion.body"))

    @classmethod
    def from_degrees(
        cls,
        poses: Sequence[Sequence[float]] | FloatArray,
        *,
        angle_length: float | None = None,
        body: npt.ArrayLike | None = None,
    ) -> MotionTask:
        """Task from rows [x, y, angle in degrees], as problem files write them."""
        rows = finite_rows(poses, 3, "motion.poses", "a pose [x, y, angle in degrees]")
        return cls(rows[:, :2], np.radians(rows[:, 2]), angle_length=angle_length, body=body)

    @property
    def size(self) -> float:
        """Greatest distance between two target positions; `angle_length` for a pure rotation."""
        return _span(self.positions) or self.angle_length

    @property
    def exact_by_default(self) -> bool:
        """Whether linkages that meet every pose can be expected: up to five poses (Burmester)."""
        return len(self) <= 5

    def __len__(self) -> int:
        return len(self.positions)


@dataclass(frozen=True, slots=True, init=False, eq=False)
class PathTask:
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

    Raises
    ------
    ProblemError
        Fewer than three points, numbers that are not finite, two consecutive equal points (the last
        may repeat the first), or a timing that is none.

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

    def __init__(
        self, points: npt.ArrayLike, *, timing: npt.ArrayLike | None = None, closed: bool = False
    ) -> None:
        places = finite_rows(points, 2, "path.points", "a point [x, y]")
        if len(places) < 3:
            raise ProblemError(f"path.points has {counted(len(places), 'point')}; allowed are three or more")
        if not np.isfinite(_span(places)):
            raise ProblemError("path.points are farther apart than the largest number")
        for index in np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) == 0):
            raise ProblemError(
                f"path.points[{index}] and path.points[{index + 1}] are equal; consecutive points must differ"
            )
        if not isinstance(closed, (bool, np.bool_)):
            raise ProblemError(f"path.closed is {closed!r}; allowed is true or false")
        rotation = None if timing is None else _timing(timing, len(places))
        object.__setattr__(self, "points", places)
        object.__setattr__(self, "timing", rotation)
        object.__setattr__(self, "closed", bool(closed))

    @classmethod
    def from_degrees(
        cls, points: npt.ArrayLike, *, timing_deg: npt.ArrayLike | None = None, closed: bool = False
    ) -> PathTask:
        """Task with its timing in degrees, as problem files write it."""
        timing = None if timing_deg is None else np.radians(_numbers(timing_deg))
        return cls(points, timing=timing, closed=closed)

    @property
    def positions(self) -> FloatArray:
        """The points, by the name that both kinds of task share; shape (N, 2), length."""
        return self.points

    @property
    def size(self) -> float:
        """Greatest distance between two points."""
        return _span(self.points)

    @property
    def exact_by_default(self) -> bool:
        """Whether linkages through every point can be expected: up to nine points, five timed ones."""
        return len(self) <= (9 if self.timing is None else 5)

    def __len__(self) -> int:
        return len(self.points)


Task: TypeAlias = MotionTask | PathTask


def _span(points: FloatArray) -> float:
    with np.errstate(over="ignore"):
        separation = points[:, None] - points[None]
        return float(np.hypot(separation[..., 0], separation[..., 1]).max())


def _refuse_standing_still(positions: FloatArray, angles: FloatArray) -> None:
    moved = np.abs(np.diff(positions, axis=0)).max(axis=1) > 0
    turned = np.abs(np.exp(1j * angles[1:]) - np.exp(1j * angles[:-1])) > 1e-12
    for index in np.flatnonzero(~(moved | turned)):
        raise ProblemError(
            f"motion.poses[{index}] and motion.poses[{index + 1}] are equal; consecutive poses must differ"
        )


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
    if abs(timing[-1]) > _TURN * (1 + 1e-12):
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
