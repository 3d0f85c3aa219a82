"""A beam pumping unit, as the American Petroleum Institute counts its angles, loads and torques."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.checks import GREATEST, bounded, finite_rows, positive_number
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.stated import Stated

CRANK, POSITION = "crank", "position"
_SENSES = ("clockwise", "counter-clockwise")
_SIDES = ("right", "left")
_ROWS = {CRANK: (2, "[crank angle, load]"), POSITION: (3, "[position, load up, load down]")}


@dataclass(frozen=True, slots=True)
class PumpingUnitSpec(Stated):
    """A linkage whose link 4 is the beam of a pumping unit; its `output_arm` is that of the horsehead.

    Crank angles are those of the API: clockwise from 12 o'clock, seen with the well to the right.

    Parameters
    ----------
    well : str
        Side of O4 on which horsehead and well are drawn: "right" or "left".
    crank : str
        How the crank turns, seen with the well to the right: "clockwise" or "counter-clockwise".
    structural_unbalance : float, N
        Force at the polished rod, positive downwards, that holds the beam level without pitmans.
    counterbalance : float, N m
        Greatest moment of the counterbalance about the crankshaft.
    counterbalance_phase_deg : float, deg
        By which it lies beyond the crank, clockwise.
    rating : float, N m, optional
        Torque that the gear reducer is made for.
    rod_load : float, N, optional
        On the polished rod, where it is constant.
    values : sequence of rows, optional
        Instead: (crank angle in deg, N) over a turn; or (position, N on the up stroke, N on the down
        stroke) from 0 to 1. Between rows it follows a curve through them.
    over : str
        What the rows of `values` are over: "crank" or "position".

    Raises
    ------
    ProblemError
        Unknown words, numbers beyond 1e20, rows that do not rise or do not cover all.

    Examples
    --------
    >>> PumpingUnitSpec(counterbalance=9e4, rod_load=2e4).stated
    {'counterbalance': 90000.0, 'rod_load': 20000.0}
    """

    well: str = "right"
    crank: str = "clockwise"
    structural_unbalance: float = 0.0
    counterbalance: float = 0.0
    counterbalance_phase_deg: float = 0.0
    rating: float | None = None
    rod_load: float | None = None
    values: tuple[tuple[float, ...], ...] | None = None
    over: str = CRANK

    def __post_init__(self) -> None:
        for name, words in (("well", _SIDES), ("crank", _SENSES), ("over", tuple(_ROWS))):
            if (given := getattr(self, name)) not in words:
                raise wrong_value(name, given, " or ".join(words))
        for name in ("structural_unbalance", "counterbalance", "counterbalance_phase_deg"):
            object.__setattr__(self, name, bounded(getattr(self, name), name))
        if self.rating is not None:
            object.__setattr__(self, "rating", positive_number(bounded(self.rating, "rating"), "rating"))
        if self.rod_load is not None:
            object.__setattr__(self, "rod_load", bounded(self.rod_load, "rod_load"))
        if self.values is None:
            if self.over != CRANK:
                raise ProblemError("over does not go with a constant load; it needs values")
            return
        if self.rod_load is not None:
            raise ProblemError("rod_load is given besides values; give one of them")
        object.__setattr__(self, "values", _loads(self.values, self.over))

    @property
    def side(self) -> int:
        """+1 where the well is drawn to the right, -1 to the left."""
        return 1 if self.well == "right" else -1

    @property
    def sense(self) -> int:
        """+1 where the crank turns clockwise, seen with the well to the right."""
        return 1 if self.crank == "clockwise" else -1


def _loads(values: object, over: str) -> tuple[tuple[float, ...], ...]:
    columns, means = _ROWS[over]
    table = finite_rows(values, columns, "values", means, GREATEST)  # type: ignore[arg-type]
    if len(table) < 2:
        raise ProblemError(f"values has {len(table)} rows; it must have two or more")
    if not (steps := np.diff(table[:, 0]) > 0).all():
        row = int(np.flatnonzero(~steps)[0]) + 1
        raise ProblemError(f"values[{row}] has {over} {table[row, 0]:.15g}; it must rise from row to row")
    first, last = table[0, 0], table[-1, 0]
    if over == POSITION:
        if (first, last) != (0.0, 1.0):
            raise ProblemError(f"values cover positions {first:.15g} to {last:.15g}; they must cover 0 to 1")
    else:
        if abs(last - first - 360.0) > 1e-9:
            raise ProblemError(
                f"values cover crank {first:.15g} to {last:.15g} deg; they must cover a turn, as 0 to 360"
            )
        if table[0, 1] != table[-1, 1]:
            raise ProblemError("values end otherwise than they begin; a turn ends as it begins")
    return tuple(tuple(row) for row in table.tolist())
