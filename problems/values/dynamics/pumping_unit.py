"""A beam pumping unit, as the American Petroleum Institute counts its angles, loads and torques."""

from __future__ import annotations

from dataclasses import dataclass

from grashof.problems.values.checks import Rows, bounded, one_of, positive_bounded, rising_rows
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

CRANK, POSITION = "crank", "position"
_SENSES = ("clockwise", "counter-clockwise")
_SIDES = ("right", "left")
_ROWS = {CRANK: (2, "[crank angle, load]"), POSITION: (3, "[position, load up, load down]")}


@dataclass(frozen=True, slots=True)
class PumpingUnitSpec(TableValue):
    """A linkage whose link 4 is the beam of a pumping unit; its `output_arm` is that of the horsehead.

    Crank angles are those of the API: clockwise from 12 o'clock, seen with the well to the right.
    `ProblemError` for unknown words, numbers beyond 1e20, rows that do not rise or do not cover all.

    Parameters
    ----------
    well : {"right", "left"}
        Side of O4 on which horsehead and well are drawn.
    crank : {"clockwise", "counter-clockwise"}
        How the crank turns, seen with the well to the right.
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
    over : {"crank", "position"}
        Variable of the rows of `values`.
    """

    well: str = "right"
    crank: str = "clockwise"
    structural_unbalance: float = 0.0
    counterbalance: float = 0.0
    counterbalance_phase_deg: float = 0.0
    rating: float | None = None
    rod_load: float | None = None
    values: Rows | None = None
    over: str = CRANK

    def __post_init__(self) -> None:
        for name, words in (("well", _SIDES), ("crank", _SENSES), ("over", tuple(_ROWS))):
            one_of(getattr(self, name), name, words)
        names = ("structural_unbalance", "counterbalance", "counterbalance_phase_deg", "rod_load")
        check_fields(self, **dict.fromkeys(names, bounded), rating=positive_bounded)
        if self.values is None:
            if self.over != CRANK:
                raise ProblemError("over does not go with a constant load; it needs values")
            return
        if self.rod_load is not None:
            raise ProblemError("rod_load is given besides values; give one of them")
        set_fields(self, values=_loads(self.values, self.over))

    @property
    def side(self) -> int:
        """+1 where the well is drawn to the right, -1 to the left."""
        return 1 if self.well == "right" else -1

    @property
    def sense(self) -> int:
        """+1 where the crank turns clockwise, seen with the well to the right."""
        return 1 if self.crank == "clockwise" else -1


def _loads(values: object, over: str) -> Rows:
    columns, means = _ROWS[over]
    rows = rising_rows(values, columns, means, [over], turn=over == CRANK)
    first, last = rows[0][0], rows[-1][0]
    if over == POSITION and (first, last) != (0.0, 1.0):
        raise ProblemError(f"values cover positions {first:.15g} to {last:.15g}; they must cover 0 to 1")
    return rows
