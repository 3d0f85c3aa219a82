"""Quantities of designs on a page: their names, units and digits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanisms import DIMENSIONS, NOISE
from grashof.problems.values.requirements.quantities import Needs, Quantity
from grashof.problems.values.units import Unit
from grashof.synth.designs.table import LISTED, NAMES, OWN, Row, known
from grashof.wording.problem import error_meaning

ROUNDING = "≈ 0"  # shown for an error that is rounding
_LENGTH_DIGITS, _ANGLE_DECIMALS = 5, 2
_GOAL_DIGITS = 4  # of goals that a table does not list otherwise


@dataclass(frozen=True, slots=True)
class Column:
    """A quantity of the designs on a page, by its name in candidates.csv.

    `decimals` is -1 for powers of ten; an error up to `noise` is rounding; more is `better` for +1, less for
    -1, neither for 0. `about` extends the label; a column that is not `listed` is only an axis.
    """

    key: str
    label: str
    unit: str
    decimals: int
    noise: float = 0.0
    better: int = 0
    about: str = ""
    listed: bool = True

    def text(self, value: Any) -> str:
        """A value as the table shows it."""
        number = float(value)
        if math.isinf(number):
            return "no limit"
        if math.isnan(number):
            return "–"
        if 0 < abs(number) <= self.noise:
            return ROUNDING
        return f"{number:z.{self.decimals}f}" if self.decimals >= 0 else f"{number:.3e}"


def columns_of(problem: Problem, rows: Sequence[Row]) -> list[Column]:
    """The quantities that are known of some of these designs, those of the table first, goals among them.

    The transmission angle over the task is left out where the task is a full turn; otherwise that over the
    turn where no driver turns fully.
    """
    closed, turns = problem.task.closed, any(row["full_rotation"] for row in rows)
    left_out = "transmission_min_task" if closed else "" if turns else "transmission_min_cycle"
    shown = [
        each
        for each in (*LISTED, OWN)
        if each.key != left_out and any(known(row.get(each.column)) for row in rows)
    ]
    # The table begins with quantities of any design, then those of masses or tolerances, then lengths.
    stated = Needs.DYNAMICS, Needs.MANUFACTURING
    weighed = {goal.key for goal, _ in problem.goals}
    digits = {each.key: each.digits or _GOAL_DIGITS * (each.key in weighed) for each in shown}
    shown.sort(key=lambda each: (not digits[each.key], not each.better, each.needs in stated))
    lengths, longest = length_decimals(rows), _longest(rows)
    return [
        Column(
            each.column,
            each.label.replace("mu ", "μ "),
            each.unit.of(problem.length_unit),
            lengths
            if _is_length(each) and lengths is not None
            else _decimals(
                _known_of(rows, each.column),
                digits[each.key],
                NOISE * longest if each.key in DIMENSIONS else noise_of(each, rows),
            ),
            noise_of(each, rows),
            each.better,
            error_meaning(problem) if each.key == "error" else each.about,
            listed=digits[each.key] > 0,
        )
        for each in shown
    ]


@dataclass(frozen=True, slots=True)
class Figure:
    """A column of candidates.csv in words, for the list of all values.

    Without `decimals` numbers are shown with significant digits; an error up to `noise` is rounding.
    """

    key: str
    name: str
    unit: str = ""
    about: str = ""
    decimals: int | None = None
    noise: float = 0.0


def figures_of(rows: Sequence[Row], length_unit: str) -> list[Figure]:
    """Every column of candidates.csv with values, in its order."""
    lengths = length_decimals(rows)
    figures = [Figure("family", NAMES["family"], about="the best of the designs that are alike")]
    for key, each in ((each.column, each) for each in (*LISTED, OWN)):
        angle = each.unit is Unit.ANGLE and not each.deviates
        decimals = lengths if _is_length(each) else _ANGLE_DECIMALS if angle else None
        noise = noise_of(each, rows)
        unit = each.unit.of(length_unit)
        figures.append(Figure(key, NAMES[key], unit, each.about, decimals, noise))
    by_key = {figure.key: figure for figure in figures}
    return [
        by_key.get(key) or Figure(key, NAMES[key]) for key in rows[0] if any(known(row[key]) for row in rows)
    ]


def length_decimals(rows: Sequence[Row]) -> int | None:
    """Decimals of all lengths of some designs; None where these are very large or small."""
    values = np.concatenate([_known_of(rows, each.column) for each in LISTED if _is_length(each)])
    if not np.any(values[np.isfinite(values)]):
        return None
    decimals = _decimals(values, _LENGTH_DIGITS, 0.0)
    return decimals if decimals >= 0 else None


def noise_of(quantity: Quantity, rows: Sequence[Row]) -> float:
    """Size up to which an error of some designs is rounding, in the unit of files; 0 for other quantities."""
    if not quantity.deviates:
        return 0.0
    if quantity.unit is Unit.ANGLE:
        return NOISE * Unit.ANGLE.shown
    return float((NOISE * _longest(rows)) ** quantity.unit.lengths)


def _is_length(quantity: Quantity) -> bool:
    """Whether it is a length or a coordinate, not an error."""
    return quantity.unit is Unit.LENGTH and not quantity.deviates


def _known_of(rows: Sequence[Row], column: str) -> FloatArray:
    return np.array([float(row[column]) for row in rows if known(row.get(column))])


def _longest(rows: Sequence[Row]) -> float:
    """The greatest size of some designs."""
    return float(_known_of(rows, "size").max(initial=0.0))


def _decimals(values: FloatArray, digits: int, noise: float) -> int:
    """Decimals with which the largest of some values has `digits`; -1 where powers of ten are better."""
    finite = np.abs(values[np.isfinite(values)])
    if not (finite > noise).any():
        return 0
    power = math.floor(math.log10(finite.max()))
    return max(digits - 1 - power, 0) if -3 <= power <= 6 else -1
