"""Which quantities of a design the page lists, and in which unit each of them is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from grashof.problems import Problem
from grashof.problems.values.mechanisms import DIMENSIONS, NOISE
from grashof.problems.values.quantities import Needs
from grashof.synth.designs.table import LISTED, OWN
from grashof.wording.problem import error_meaning


@dataclass(frozen=True, slots=True)
class Column:
    """A quantity of the designs on a page.

    Parameters
    ----------
    key : str
        Its name in candidates.csv.
    label : str
    unit : str
    decimals : int
        Of its numbers, -1 for powers of ten.
    better : int
        +1 where more is better, -1 where less is, 0 for neither.
    about : str
        What it is, where its label does not show it.
    listed : bool
        Whether the table has it; the others are axes that designs may be compared by.
    """

    key: str
    label: str
    unit: str
    decimals: int
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
        return f"{number:z.{self.decimals}f}" if self.decimals >= 0 else f"{number:.3e}"


def columns_of(problem: Problem, frame: pd.DataFrame) -> list[Column]:
    """Every quantity that is known of some of these designs, those of the table first.

    Without the transmission angle over the task where that is a whole turn, or else the one over the turn
    where no driver turns fully.
    """
    whole, turns = problem.task.closed, frame["full_rotation"].any()
    left_out = "transmission_min_task" if whole else "" if turns else "transmission_min_cycle"
    known = [
        each
        for each in (*LISTED, OWN)
        if each.key != left_out and each.column in frame and not frame[each.column].isna().all()
    ]
    # In the table first what any design has, then what takes masses or tolerances, then the lengths.
    longest = float(frame["size"].max())
    stated = Needs.DYNAMICS, Needs.MANUFACTURING
    known.sort(key=lambda each: (not each.digits, not each.better, each.needs in stated))
    return [
        Column(
            each.column,
            each.label.replace("mu ", "μ "),
            each.unit.of(problem.length_unit),
            _decimals(frame[each.column], each.digits, NOISE * longest if each.key in DIMENSIONS else 0.0),
            each.better,
            error_meaning(problem) if each.key == "error" else each.about,
            listed=each.digits > 0,
        )
        for each in known
    ]


def figure_units(frame: pd.DataFrame, length_unit: str) -> list[tuple[str, str, str]]:
    """Name, unit and meaning of every column of candidates.csv that is filled, in its order."""
    known = {each.column: (each.unit.of(length_unit), each.about) for each in (*LISTED, OWN)}
    known["family"] = "", "the best of the designs that are alike"
    return [(str(key), *known.get(str(key), ("", ""))) for key in frame if not frame[key].isna().all()]


def _decimals(values: pd.Series[Any], digits: int, noise: float) -> int:
    """How many decimals show so many digits of the largest of some values; -1 where that is no help."""
    known = values[np.isfinite(values)].abs()
    if not (known > noise).any():
        return 0
    power = math.floor(math.log10(known.max()))
    return max(digits - 1 - power, 0) if -3 <= power <= 6 else -1
