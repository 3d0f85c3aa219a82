"""Checks of a function as files and users state it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.problems.values import checks
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.tasks.target_checks import deg_text

INPUT, OUTPUT_DEG, OUTPUT = "input_deg", "output_deg", "output"  # keys of files
FEWEST, MOST = 3, 100_000
_LEAST_STEP = 1e-6  # rad, between two inputs
_LEAST_OUTPUT = 1e-6  # rad, between the least and the greatest output


def checked_pairs(
    inputs: npt.ArrayLike, outputs: npt.ArrayLike, *, travels: bool
) -> tuple[FloatArray, FloatArray]:
    """Inputs (N,) in rad that grow from 0, and outputs (N,) in rad, or length of a slide that travels."""
    key = OUTPUT if travels else OUTPUT_DEG
    turned, output = finite_numbers(inputs, INPUT), finite_numbers(outputs, key)
    if len(turned) != len(output):
        angles = checks.counted(len(turned), "angle")
        others = checks.counted(len(output), "travel" if travels else "angle")
        raise ProblemError(f"function.{INPUT} has {angles}, function.{key} {others}; it must be as many")
    if len(turned) < FEWEST:
        raise ProblemError(f"function has {checks.counted(len(turned), 'pair')}; it must have three or more")
    if len(turned) > MOST:
        raise ProblemError(f"function has {len(turned)} pairs; it must have at most {MOST}")
    for name, first in ((INPUT, turned[0]), (key, output[0])):
        if first != 0:
            given = deg_text(first) if name.endswith("_deg") else f"{first:.6g}"
            raise ProblemError(f"function.{name}[0] is {given}; it must be 0, at the first pair")
    for index in np.flatnonzero(np.diff(turned) < _LEAST_STEP) + 1:
        raise ProblemError(
            f"function.{INPUT}[{index}] is {deg_text(turned[index])} after {deg_text(turned[index - 1])}; "
            "inputs must grow (the driver may turn either way all the same)"
        )
    _refuse_turns(turned, INPUT)
    if travels:
        travel = float(np.ptp(output))
        if not travel > 0:
            raise ProblemError(f"function.{OUTPUT} does not move; the slide must travel")
        if travel > checks.GREATEST:
            raise ProblemError(
                f"function.{OUTPUT} covers {travel:.6g}; it must be at most {checks.GREATEST:g}"
            )
        return turned, output
    _refuse_turns(output, OUTPUT_DEG)
    if np.ptp(output) < _LEAST_OUTPUT:
        raise ProblemError(f"function.{OUTPUT_DEG} does not move; the output must turn")
    return turned, output


def finite_numbers(values: Any, key: str) -> FloatArray:
    """A list of finite numbers under a key, as an array."""
    return checks.finite_list(values, f"function.{key}", "lengths" if key == OUTPUT else "angles")


def _refuse_turns(angles: FloatArray, key: str) -> None:
    if np.ptp(angles) > TURN * (1 + 1e-12):
        raise ProblemError(
            f"function.{key} covers {deg_text(np.ptp(angles))} deg; it must be at most one turn, 360"
        )


def either(key: str, angles: object, travel: object) -> bool:
    """Whether the output is given as travel; `ProblemError` if it is given as rotation, too."""
    if angles is not None and travel is not None:
        both = f"function.{key}_deg does not go with function.{key}"
        raise ProblemError(f"{both}; an output turns or slides, give one of them")
    return travel is not None


def refuse_beside(values: Mapping[str, object], why: str) -> None:
    """Refuse keys that are stated beside others with which they do not go."""
    for name in (name for name, value in values.items() if value is not None):
        raise ProblemError(f"function.{name} {why}")


def refuse_missing(values: Mapping[str, object], output: str, travels: bool) -> None:
    """Refuse a table that lacks a key; of an output that of its kind."""
    other = f"{output}_deg" if travels else output
    missing = [name for name, value in values.items() if value is None and name != other]
    if missing:
        raise ProblemError("\n".join(f"function.{name} is missing" for name in missing))
