"""The wanted drive torque at places of the task motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import GREATEST, Rows, finite_rows, number_within, one_of
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.value_bases import TableValue, set_fields

ROW = "[place, torque in N m]"
_HEAVIEST = 1e6
_MOST_ROWS = 1000
# Greatest place of each variable, and its unit.
PLACES = {"driver": (360.0, " deg"), "share": (1.0, ""), "target": (1e4, "")}


@dataclass(frozen=True, slots=True)
class WantedTorque(TableValue):
    """Wanted drive torques over the task motion: the deviation from them is a quantity.

    Parameters
    ----------
    wanted : sequence of rows
        (place, torque in N m), places rising. A torque is positive where it drives link 2 in its sense from
        the first target to the last, and negative where it holds it back.
    over : {"driver", "share", "target"}
        The variable of the places: rotation of link 2 from the beginning of the motion, deg; the share of its
        rotation to the end, 0 to 1; or numbers of targets, from 1.
    weight : float
        In least squares, the position error in sizes of the task that counts as much as a deviation (root
        mean square) by the greatest wanted torque; with 0 the deviation is not part of the error.

    Raises
    ------
    ProblemError
        Rows that do not rise or lie outside the motion, or numbers outside their ranges.

    Examples
    --------
    >>> WantedTorque([(0, 12), (0.5, -8)], over="share").greatest
    12.0
    """

    wanted: Rows
    over: str = "driver"
    weight: float = 0.0

    def __post_init__(self) -> None:
        one_of(self.over, "over", PLACES)
        rows = finite_rows(self.wanted, 2, "wanted", ROW, GREATEST)
        if not 1 <= len(rows) <= _MOST_ROWS:
            raise ProblemError(f"wanted has {len(rows)} rows; it must have 1 to {_MOST_ROWS}")
        before, (most, unit) = -np.inf, PLACES[self.over]
        for number, place in enumerate(rows[:, 0].tolist()):
            given = f"wanted[{number}] has {self.over} {place:.15g}{unit}"
            if self.over == "target" and (place < 1 or place % 1):
                raise ProblemError(f"{given}; it must be a whole number from 1")
            if not 0 <= place <= most:
                raise ProblemError(f"{given}; it must be from 0 to {most:g}")
            if place <= before:
                raise ProblemError(f"{given}; it must rise from row to row")
            before = place
        weight = number_within(self.weight, 0.0, _HEAVIEST, "weight")
        if weight and not rows[:, 1].any():
            raise ProblemError(f"weight is {weight:g}; it must be 0 where every wanted torque is 0")
        set_fields(self, wanted=tuple(tuple(row) for row in rows.tolist()), weight=weight)

    @property
    def places(self) -> FloatArray:
        """The places, shape (K,): rad for the driver, shares, or numbers of targets from 0."""
        places = np.array(self.wanted)[:, 0]
        found: FloatArray = np.radians(places) if self.over == "driver" else places - (self.over == "target")
        return found

    @property
    def torques(self) -> FloatArray:
        """The torques, shape (K,), N m."""
        found: FloatArray = np.array(self.wanted)[:, 1]
        return found

    @property
    def greatest(self) -> float:
        """The greatest magnitude of the torques, N m."""
        return float(np.abs(self.torques).max())
