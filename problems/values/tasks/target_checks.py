"""Columns of targets: how far each may be missed, the driver rotations at which they are met, some rows."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import TURN, FloatArray, IntArray, frozen_array
from grashof.problems.values.checks import GREATEST, finite_list, number_array
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.text import counted

LEAST_ZONE = 1e-12  # below, digits are lost
ANGLES_DEG = (1e-10, 180.0)  # least and greatest zone of an angle


def zone_sizes(
    values: npt.ArrayLike | None, count: int, where: str, *, least: float, most: float = GREATEST
) -> FloatArray | None:
    """How far each of `count` targets may be missed, shape (count,), from one number or one for each.

    `ProblemError` where they are not numbers, not as many as targets, or out of range.
    """
    if values is None:
        return None
    wanted = "it must be a number greater than zero, or a list of one for each target"
    numbers = number_array(values, f"{where} is {shown(values)}; {wanted}", (0, 1))
    if numbers.ndim == 1 and len(numbers) != count:
        raise ProblemError(f"{where} has {counted(len(numbers), 'number')} for {count} targets; {wanted}")
    for index, number in enumerate(np.atleast_1d(numbers)):
        if not least <= number <= most:
            name = f"{where}[{index}]" if numbers.ndim else where
            raise ProblemError(f"{name} is {number:g}; it must be from {least:g} to {most:g}")
    return frozen_array(np.broadcast_to(numbers, (count,)))


def turn_sizes(values: npt.ArrayLike | None, count: int, *, in_degrees: bool) -> FloatArray | None:
    """The same of angles, rad; from radians, or from degrees, as problem files write them."""
    low, high = ANGLES_DEG if in_degrees else np.radians(ANGLES_DEG)
    name = "motion.angle_within_deg" if in_degrees else "angle_within"
    turns = zone_sizes(values, count, name, least=low, most=high)
    return frozen_array(np.radians(turns)) if in_degrees and turns is not None else turns


def driver_timing(values: npt.ArrayLike | None, count: int, kind: str, target: str) -> FloatArray | None:
    """Driver rotations from the first of `count` targets, shape (count,), rad; `ProblemError` for others.

    Zero at the first target, then growing or falling throughout, over at most one turn. Messages name the
    table of problem files and its word for a target, and are in degrees.
    """
    if values is None:
        return None
    timing, where = finite_angles(values, kind), f"{kind}.timing_deg"
    if len(timing) != count:
        raise ProblemError(f"{where} has {counted(len(timing), 'angle')} for {count} {target}s")
    if timing[0] != 0:
        raise ProblemError(f"{where}[0] is {deg_text(timing[0])}; it must be 0, at the first {target}")
    sense = np.sign(timing[1])
    for index in np.flatnonzero(sense * np.diff(timing) <= 0) + 1:
        raise ProblemError(
            f"{where}[{index}] is {deg_text(timing[index])} after {deg_text(timing[index - 1])}; "
            "the angles must only grow, or only fall"
        )
    if abs(timing[-1]) > TURN * (1 + 1e-12):
        last = f"{where}[{count - 1}] is {deg_text(timing[-1])}"
        raise ProblemError(f"{last}; it must be at most one turn, 360")
    return frozen_array(timing)


def finite_angles(values: npt.ArrayLike, kind: str) -> FloatArray:
    """A list of finite numbers, as an array."""
    return finite_list(values, f"{kind}.timing_deg", "angles")


def deg_text(angle: float) -> str:
    """An angle (rad) in degrees, as messages show it."""
    return f"{np.degrees(angle):.6g}"


def some_columns(task: object, index: IntArray, *names: str) -> dict[str, Any]:
    """Columns of some of the targets, by name; None where the task has no such column."""
    columns = {name: getattr(task, name) for name in names}
    return {name: None if column is None else column[index] for name, column in columns.items()}
