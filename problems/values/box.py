"""Boxes: where a joint may be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import Limits
from grashof.problems.values.checks import GREATEST, noted, refuse
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.value_bases import check_fields


@dataclass(frozen=True, slots=True)
class Box:
    """An upright rectangle x[0] <= x <= x[1], y[0] <= y <= y[1]; an infinite side is open.

    Parameters
    ----------
    x, y : pair of float, length
        Least and greatest coordinate; without it any will do.
    """

    x: Limits = (-np.inf, np.inf)
    y: Limits = (-np.inf, np.inf)

    def __post_init__(self) -> None:
        wrong: list[str] = []
        for axis in ("x", "y"):
            with noted(wrong):
                check_fields(self, **{axis: _side})
        refuse(wrong)

    def moved(self, origin: complex, scale: float) -> Box:
        """The same place in a frame with this origin and unit of length."""
        return Box(
            ((self.x[0] - origin.real) / scale, (self.x[1] - origin.real) / scale),
            ((self.y[0] - origin.imag) / scale, (self.y[1] - origin.imag) / scale),
        )


def _side(values: Limits, name: str) -> Limits:
    wanted = "[lo, hi] with lo <= hi"
    try:
        low, high = (float(value) for value in values)
    except (TypeError, ValueError):
        raise wrong_value(name, values, wanted) from None
    if not (low <= high and low < np.inf and high > -np.inf):
        raise ProblemError(f"{name} is [{low:.15g}, {high:.15g}]; it must be {wanted}")
    for side in (low, high):
        if GREATEST < abs(side) < np.inf:
            raise ProblemError(f"{name} is [{low:.15g}, {high:.15g}]; its sides must be at most {GREATEST:g}")
    return low, high


ANYWHERE = Box()  # limits nothing
