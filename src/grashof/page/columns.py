"""Which figures of a design the page lists, and in which unit each of them is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from grashof.problems import Problem
from grashof.synth.results.table import DYNAMICS, MOTION
from grashof.wording.problem import error_meaning


@dataclass(frozen=True, slots=True)
class Column:
    """A column of the page's table.

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
        What it is, where its label does not say so.
    """

    key: str
    label: str
    unit: str
    decimals: int
    better: int = 0
    about: str = ""

    def text(self, value: Any) -> str:
        """A value as the table shows it."""
        number = float(value)
        if math.isinf(number):
            return "no limit"
        if math.isnan(number):
            return "–"
        return f"{number:z.{self.decimals}f}" if self.decimals >= 0 else f"{number:.3e}"


# Key, label, unit (of length: "length"), significant digits of the largest, which way is better.
_LISTED = (
    ("error", "error rms", "length", 3, -1),
    ("transmission_min_task_deg", "μ task", "deg", 3, 1),
    ("transmission_min_cycle_deg", "μ turn", "deg", 3, 1),
    ("size", "size", "length", 4, -1),
    ("torque_peak", "peak torque, task", "N m", 4, -1),
    ("joint_force_peak", "peak force, task", "N", 4, -1),
    ("share_within_made", "made within", "share", 3, 1),
    *((name, name, "length", 4, 0) for name in ("r1", "r2", "r3", "r4")),
)
_UNITS = {
    "omega4_max": "rad/s", "point_speed_max": "length/s", "point_acceleration_max": "length/s²",
    "torque_peak": "N m", "torque_rms": "N m", "joint_force_peak": "N", "error_sse": "length²",
    "move_u": "", "move_v": "",
}  # fmt: skip
_SIZE = "diagonal of the box around O2, O4 and all that A, B and P reach from the first target to the last"
_FITTED = "what least squares makes small: root mean square of positions and angles together, weighted"
# What figures are, where their names do not tell.
_ABOUT = {
    "size": _SIZE,
    "error": _FITTED,
    "family": "the best of the designs that are alike",
} | dict.fromkeys((*MOTION, *DYNAMICS), "from the first target to the last")
_LENGTHS = (
    "o2_x", "o2_y", "o4_x", "o4_y", "r1", "r2", "r3", "r4", "p_u", "p_v", "error", "error_max", "error_rms",
    "size", "hausdorff", "frechet", "worst_move",
)  # fmt: skip


def listed(problem: Problem, frame: pd.DataFrame) -> list[Column]:
    """Columns of the table that say something of these designs.

    The error is left out where every target is met, and the transmission angle over the task where
    the task is a whole turn.
    """
    exact = problem.requirements.is_exact(problem.task)
    left_out = {"error"} if exact else set()
    if problem.task.closed:
        left_out.add("transmission_min_task_deg")
    elif not frame["full_rotation"].any():
        left_out.add("transmission_min_cycle_deg")
    return [
        Column(
            key,
            label,
            in_length(unit, problem.length_unit),
            _decimals(frame[key], digits),
            better,
            error_meaning(problem) if key == "error" else _ABOUT.get(key, ""),
        )
        for key, label, unit, digits, better in _LISTED
        if key not in left_out and (unit == "deg" or not frame[key].isna().all())
    ]


def figure_units(frame: pd.DataFrame, length_unit: str) -> list[tuple[str, str, str]]:
    """Name, unit and meaning of every column of candidates.csv that is filled, in its order."""
    filled = [str(key) for key in frame if not frame[key].isna().all()]
    return [(key, in_length(_unit(key), length_unit), _ABOUT.get(key, "")) for key in filled]


def in_length(unit: str, length_unit: str) -> str:
    """A unit with the problem's own unit of length in it."""
    return unit.replace("length", length_unit) if length_unit else unit


def _decimals(values: pd.Series[Any], digits: int) -> int:
    """How many decimals show so many digits of the largest of some values; -1 where that is no help."""
    known = values[np.isfinite(values)].abs()
    if not known.any():
        return 0
    power = math.floor(math.log10(known.max()))
    return max(digits - 1 - power, 0) if -3 <= power <= 6 else -1


def _unit(key: str) -> str:
    if key in _LENGTHS:
        return "length"
    return "deg" if key.endswith("_deg") else _UNITS.get(key, "")
