"""The motion task: poses to carry a body through, as a value."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from grashof.problems.values import checks
from grashof.problems.values.arrays import FloatArray, IntArray, frozen_array
from grashof.problems.values.errors import ProblemError, shown, shown_key, wrong_value
from grashof.problems.values.tasks.target_checks import (
    LEAST_ZONE,
    driver_timing,
    finite_angles,
    some_columns,
    turn_sizes,
    zone_sizes,
)
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.text import counted, hint
from grashof.problems.values.value_bases import set_fields

# Where timed poses have no places.
ANGLES_ALONE = 'coupler angles by the driver angle alone need kind = "function", link = "coupler"'
_POSE = "a pose [x, y, angle in degrees]"
_SAME = 1e-12  # rad
_WEIGHTS = (1e-9, 1e9)
_MOST_TURNED = 2e4 * np.pi  # rad: ten thousand turns


@dataclass(frozen=True, slots=True, init=False, eq=False)
class MotionTask(Task):
    """Motion generation: the coupler carries a body through poses, in order.

    Parameters
    ----------
    positions : array_like, shape (N, 2), length
        Where the body's origin, the coupler point P, has to be; NaN where it is free.
    angles : array_like, shape (N,), rad
        Orientations of the body, counter-clockwise from +x; NaN where they are free.
    weights : array_like, shape (N,), optional
        Of the squared errors, 1e-9 to 1e9; 1 by default.
    angle_length : float, length, optional
        Length that one radian of orientation error counts as; the size of the task by default.
    body : array_like, shape (M, 2), length, optional
        Outline carried, in the body's frame (origin at the pose). Drawn, and kept
        out of areas where `keep_out_for` names it.
    within : float or array_like, shape (N,), length, optional
        How far each position may be missed; the objective then decides.
    angle_within : float or array_like, shape (N,), rad, optional
        The same of the angles, up to half a turn. Where only one of the two is given, the other one is
        the same through `angle_length`.
    timing : array_like, shape (N,), rad, optional
        Driver rotation from the first pose, zero there, growing or falling throughout and over at
        most one turn. Its sense is free: a design may turn the driver either way.
    closed : bool
        One turn of the driver takes the body through all poses and back to the first.

    Raises
    ------
    ProblemError
        Fewer than two poses, numbers that are infinite, lengths beyond 1e20, a size below 1e-20, a pose
        with nothing given, no position at all, two consecutive equal poses, weights out of range,
        or a timing that is not one.

    Examples
    --------
    >>> task = MotionTask.from_degrees([[0, 0, 0], [3, 4, 90], {"x": 1, "y": 1}])
    >>> task.size, task.has_angle.tolist()
    (5.0, [True, True, False])
    """

    kind: ClassVar[Literal["motion"]] = "motion"
    target: ClassVar[Literal["pose"]] = "pose"

    positions: FloatArray
    angles: FloatArray
    weights: FloatArray
    angle_length: float
    body: FloatArray | None
    within: FloatArray | None
    angle_within: FloatArray | None
    timing: FloatArray | None
    closed: bool

    def __init__(
        self,
        positions: npt.ArrayLike,
        angles: npt.ArrayLike,
        *,
        weights: npt.ArrayLike | None = None,
        angle_length: float | None = None,
        body: npt.ArrayLike | None = None,
        within: npt.ArrayLike | None = None,
        angle_within: npt.ArrayLike | None = None,
        timing: npt.ArrayLike | None = None,
        closed: bool = False,
    ) -> None:
        places = _numbers(positions, "positions")
        if places.ndim != 2 or places.shape[1] != 2:
            raise ProblemError(f"motion.poses has positions of shape {places.shape}; it must be (N, 2)")
        turned = _numbers(angles, "angles")
        if turned.shape != (len(places),):
            raise ProblemError(f"motion.poses has {len(places)} positions and angles of shape {turned.shape}")
        if (np.abs(turned) > _MOST_TURNED).any():
            pose = int(np.nanargmax(np.abs(turned)))
            raise ProblemError(
                f"motion.poses[{pose}] is turned by {np.degrees(turned[pose]):.6g} deg; "
                f"it must be at most {np.degrees(_MOST_TURNED):.0f} deg, beyond which digits are lost"
            )
        if len(places) < 2:
            raise ProblemError(f"motion.poses has {counted(len(places), 'pose')}; it must have two or more")
        _refuse_halves(places, turned, timed=timing is not None)
        _refuse_far(places)
        size = checks.task_size(places[~np.isnan(places[:, 0])], "motion.poses")
        _refuse_standing_still(places, turned)
        if angle_length is not None:
            checks.size_number(angle_length, "motion.angle_length")
        if size == 0 and angle_length is None:
            raise ProblemError(
                "motion.angle_length is missing: poses at a single place have no size to take it from"
            )
        set_fields(
            self,
            closed=checks.true_or_false(closed, "motion.closed"),
            within=zone_sizes(within, len(places), "motion.within", least=LEAST_ZONE * size),
            angle_within=turn_sizes(angle_within, len(places), in_degrees=False),
            timing=driver_timing(timing, len(places), "motion", "pose"),
            positions=frozen_array(places),
            angles=frozen_array(turned),
            weights=_weights(weights, len(places)),
            angle_length=size if angle_length is None else float(angle_length),
            body=None if body is None else checks.outline(body, "motion.body"),
        )

    def some(self, index: IntArray, positions: FloatArray, angles: FloatArray) -> MotionTask:
        """Some of the targets, moved."""
        return replace(
            self,
            positions=np.where(self.has_position[index, None], positions, np.nan),
            angles=np.where(self.has_angle[index], angles, np.nan),
            **some_columns(self, index, "weights", "timing", "within", "angle_within"),
        )

    @classmethod
    def from_degrees(
        cls,
        poses: Sequence[Sequence[float] | Mapping[str, float]] | FloatArray,
        *,
        weights: npt.ArrayLike | None = None,
        angle_length: float | None = None,
        body: npt.ArrayLike | None = None,
        within: npt.ArrayLike | None = None,
        angle_within_deg: npt.ArrayLike | None = None,
        timing_deg: npt.ArrayLike | None = None,
        closed: bool = False,
    ) -> MotionTask:
        """Task from rows [x, y, angle in degrees], or tables of x, y, angle, as problem files write them.

        Parameters
        ----------
        poses : sequence, length
            Where the coupler point P and the body carried with it have to be, in order; a table such as
            ``{ x = 2, y = 3 }`` or ``{ angle = 30 }`` leaves parts of a pose free.
        """
        if isinstance(poses, (str, bytes, Mapping)) or not isinstance(poses, Iterable):
            raise wrong_value("motion.poses", poses, "a list of poses")
        rows = np.array(checks.each_checked(poses, "motion.poses", _row)).reshape(-1, 3)
        return cls(
            rows[:, :2],
            np.radians(rows[:, 2]),
            weights=weights,
            angle_length=angle_length,
            body=body,
            within=within,
            angle_within=turn_sizes(angle_within_deg, len(rows), in_degrees=True),
            timing=None if timing_deg is None else np.radians(finite_angles(timing_deg, "motion")),
            closed=closed,
        )


def _row(pose: object, where: str) -> tuple[float, float, float]:
    if isinstance(pose, Mapping):
        for key in pose:
            if key not in ("x", "y", "angle"):
                keys = hint(str(key), ("x", "y", "angle"), "the keys are x, y, angle")
                raise ProblemError(f"{where}.{shown_key(key)} is unknown; {keys}")
        x, y, angle = (
            checks.finite_number(pose[key], f"{where}.{key}") if key in pose else np.nan
            for key in ("x", "y", "angle")
        )
        return x, y, angle
    if isinstance(pose, (str, bytes)) or not isinstance(pose, Iterable):
        raise wrong_value(where, pose, _POSE)
    values = list(pose)
    if len(values) != 3:
        raise ProblemError(
            f"{where} is {shown(values)}, {counted(len(values), 'number')}; it must be {_POSE}"
        )
    for value in values:
        if isinstance(value, float) and not np.isfinite(value):
            raise ProblemError(f"{where} is {shown(values)}; all numbers must be finite")
    x, y, angle = (checks.finite_number(value, f"{where}[{k}]") for k, value in enumerate(values))
    return x, y, angle


def _numbers(values: npt.ArrayLike, what: str) -> FloatArray:
    numbers = checks.number_array(values, f"motion.poses has {what} {shown(values)}; they must be numbers")
    if np.isinf(numbers).any():
        raise ProblemError(
            f"motion.poses has {what} that are infinite; they must be finite, or NaN where free"
        )
    return numbers.astype(np.float64)


def _weights(values: npt.ArrayLike | None, count: int) -> FloatArray:
    if values is None:
        return frozen_array(np.ones(count))
    weights = checks.number_array(
        values, f"motion.weights is {shown(values)}; it must be a list of numbers", (1,)
    )
    if len(weights) != count:
        raise ProblemError(f"motion.weights has {counted(len(weights), 'number')} for {count} poses")
    least, most = _WEIGHTS
    for index in np.flatnonzero(~((weights >= least) & (weights <= most))):
        raise ProblemError(
            f"motion.weights[{index}] is {weights[index]}; it must be a number from {least:g} to {most:g}"
        )
    return frozen_array(weights)


def _refuse_far(positions: FloatArray) -> None:
    for index in np.flatnonzero((np.abs(positions) > checks.GREATEST).any(axis=1)):
        x, y = positions[index]
        raise ProblemError(
            f"motion.poses[{index}] is at {x:g}, {y:g}; x and y must be at most {checks.GREATEST:g}"
        )


def _refuse_halves(positions: FloatArray, angles: FloatArray, *, timed: bool) -> None:
    missing = np.isnan(positions)
    for index in np.flatnonzero(missing.any(axis=1) != missing.all(axis=1)):
        raise ProblemError(f"motion.poses[{index}] has one of x and y; it must have both or neither")
    for index in np.flatnonzero(missing.all(axis=1) & np.isnan(angles)):
        raise ProblemError(f"motion.poses[{index}] has neither position nor angle")
    if missing.all():
        why = f": {ANGLES_ALONE}" if timed else ""
        raise ProblemError(f"motion.poses has no position; one pose or more must have x and y{why}")


def _refuse_standing_still(positions: FloatArray, angles: FloatArray) -> None:
    moved = ~(np.abs(np.diff(positions, axis=0)).max(axis=1) <= 0)  # where either is free, too
    turned = ~(np.abs(np.exp(1j * angles[1:]) - np.exp(1j * angles[:-1])) <= _SAME)
    for index in np.flatnonzero(~(moved | turned)):
        raise ProblemError(
            f"motion.poses[{index}] and motion.poses[{index + 1}] are equal; consecutive poses must differ"
        )
