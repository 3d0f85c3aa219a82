"""Zones: how far each target may be missed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.checks import GREATEST, counted, number_array
from grashof.problems.values.errors import ProblemError, shown

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
