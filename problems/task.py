"""Tasks: what a linkage is asked to do, as values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.problems.checks import FloatArray, counted, finite_number, finite_rows, frozen_array, outline
from grashof.problems.errors import ProblemError


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

    def __len__(self) -> int:
        return len(self.positions)


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
