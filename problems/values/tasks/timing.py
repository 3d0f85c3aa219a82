"""Timing: the driver rotations at which targets are met, and whether the motion is a whole turn."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import TURN, FloatArray, frozen_array
from grashof.problems.values.checks import counted, finite_list
from grashof.problems.values.errors import ProblemError, wrong_value


def driver_timing(values: npt.ArrayLike | None, count: int, kind: str, target: str) -> FloatArray | None:
    """Driver rotations from the first of `count` targets, shape (count,), rad; `ProblemError` for others.

    Zero at the first target, then growing or falling throughout, over at most one turn. Messages name the
    table of problem files and what it calls a target, and are in degrees.
    """
    if values is None:
        return None
    timing, where = finite_angles(values, kind), f"{kind}.timing_deg"
    if len(timing) != count:
        raise ProblemError(f"{where} has {counted(len(timing), 'angle')} for {count} {target}s")
    if timing[0] != 0:
        raise ProblemError(f"{where}[0] is {_degrees(timing[0])}; it must be 0, at the first {target}")
    sense = np.sign(timing[1])
    for index in np.flatnonzero(sense * np.diff(timing) <= 0) + 1:
        raise ProblemError(
            f"{where}[{index}] is {_degrees(timing[index])} after {_degrees(timing[index - 1])}; "
            "the angles must only grow, or only fall"
        )
    if abs(timing[-1]) > TURN * (1 + 1e-12):
        last = f"{where}[{count - 1}] is {_degrees(timing[-1])}"
        raise ProblemError(f"{last}; it must be at most one turn, 360")
    return frozen_array(timing)


def finite_angles(values: npt.ArrayLike, kind: str) -> FloatArray:
    """A list of finite numbers, as an array."""
    return finite_list(values, f"{kind}.timing_deg", "angles")


def whole_turn(closed: bool, kind: str) -> bool:
    """Whether the motion is a whole turn of the driver, refused when it is not true or false."""
    if not isinstance(closed, (bool, np.bool_)):
        raise wrong_value(f"{kind}.closed", closed, "true or false")
    return bool(closed)


def _degrees(angle: float) -> str:
    return f"{np.degrees(angle):.6g}"
