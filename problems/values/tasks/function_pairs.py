"""Pairs of a function: inputs and outputs as lists of numbers, checked."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.checks import GREATEST, counted, finite_list
from grashof.problems.values.errors import ProblemError

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
        counts = counted(len(turned), "angle"), counted(len(output), "travel" if travels else "angle")
        given = f"function.{INPUT} has {counts[0]}, function.{key} {counts[1]}"
        raise ProblemError(f"{given}; it must be as many")
    if len(turned) < FEWEST:
        raise ProblemError(f"function has {counted(len(turned), 'pair')}; it must have three or more")
    if len(turned) > MOST:
        raise ProblemError(f"function has {len(turned)} pairs; it must have at most {MOST}")
    for name, first in ((INPUT, turned[0]), (key, output[0])):
        if first != 0:
            given = _deg(first) if name.endswith("_deg") else f"{first:.6g}"
            raise ProblemError(f"function.{name}[0] is {given}; it must be 0, at the first pair")
    for index in np.flatnonzero(np.diff(turned) < _LEAST_STEP) + 1:
        raise ProblemError(
            f"function.{INPUT}[{index}] is {_deg(turned[index])} after {_deg(turned[index - 1])}; "
            "inputs must grow (the driver may turn either way all the same)"
        )
    _refuse_turns(turned, INPUT)
    if travels:
        _refuse_travel(float(np.ptp(output)))
        return turned, output
    _refuse_turns(output, OUTPUT_DEG)
    if np.ptp(output) < _LEAST_OUTPUT:
        raise ProblemError(f"function.{OUTPUT_DEG} does not move; the output must turn")
    return turned, output


def finite_numbers(values: Any, key: str) -> FloatArray:
    """A list of finite numbers under a key, as an array."""
    return finite_list(values, f"function.{key}", "lengths" if key == OUTPUT else "angles")


def _refuse_turns(angles: FloatArray, key: str) -> None:
    if np.ptp(angles) > TURN * (1 + 1e-12):
        raise ProblemError(
            f"function.{key} covers {_deg(np.ptp(angles))} deg; it must be at most one turn, 360"
        )


def _refuse_travel(travel: float) -> None:
    if not travel > 0:
        raise ProblemError(f"function.{OUTPUT} does not move; the slide must travel")
    if travel > GREATEST:
        raise ProblemError(f"function.{OUTPUT} covers {travel:.6g}; it must be at most {GREATEST:g}")


def _deg(angle: float) -> str:
    return f"{np.degrees(angle):.6g}"
