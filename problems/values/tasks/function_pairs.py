"""The pairs of a function, checked: inputs that grow from zero, outputs that move, limits of rates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.problems.values import checks
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.tasks.generated_output import GeneratedOutput
from grashof.problems.values.tasks.target_checks import deg_text
from grashof.problems.values.text import counted

# Keys of files.
INPUT_DEG, INPUT, OUTPUT_DEG, OUTPUT, RATE = "input_deg", "input", "output_deg", "output", "rate"
_NOUNS = {INPUT_DEG: "angle", INPUT: "length", OUTPUT_DEG: "angle", OUTPUT: "travel"}
FEWEST, MOST = 3, 100_000
_LEAST_STEP = 1e-6  # rad, or share of the greatest lengthening, between two inputs
_LEAST_OUTPUT = 1e-6  # rad, between the least and the greatest output


def checked_pairs(
    inputs: npt.ArrayLike, outputs: npt.ArrayLike, *, travels: bool, lengthens: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Inputs (N,) that grow from 0, in rad or length of a cylinder, and outputs (N,), in rad or length."""
    keys = INPUT if lengthens else INPUT_DEG, OUTPUT if travels else OUTPUT_DEG
    given, output = finite_numbers(inputs, keys[0]), finite_numbers(outputs, keys[1])
    if len(given) != len(output):
        counts = (counted(len(each), _NOUNS[key]) for key, each in zip(keys, (given, output), strict=True))
        of_inputs, of_outputs = counts
        raise ProblemError(
            f"function.{keys[0]} has {of_inputs}, function.{keys[1]} {of_outputs}; it must be as many"
        )
    if len(given) < FEWEST:
        raise ProblemError(f"function has {counted(len(given), 'pair')}; it must have three or more")
    if len(given) > MOST:
        raise ProblemError(f"function has {len(given)} pairs; it must have at most {MOST}")
    for name, first in ((keys[0], given[0]), (keys[1], output[0])):
        if first != 0:
            raise ProblemError(f"function.{name}[0] is {_text(first, name)}; it must be 0, at the first pair")
    _refuse_falling(given, keys[0])
    if lengthens:
        _refuse_far(float(given[-1]), keys[0])
    else:
        _refuse_turns(given, keys[0])
    if travels:
        travel = float(np.ptp(output))
        if not travel > 0:
            raise ProblemError(f"function.{OUTPUT} does not move; the slide must travel")
        _refuse_far(travel, OUTPUT)
        return given, output
    _refuse_turns(output, OUTPUT_DEG)
    if np.ptp(output) < _LEAST_OUTPUT:
        raise ProblemError(f"function.{OUTPUT_DEG} does not move; the output must turn")
    return given, output


def checked_rates(rates: Any, inputs: FloatArray, unit: float, *, lengthens: bool) -> FloatArray:
    """Rows of input, least and greatest d(output)/d(input), (R, 3), times `unit` as in files."""
    rows, where = _rows(rates), f"function.{RATE}"
    last, key = float(inputs[-1]), INPUT if lengthens else INPUT_DEG
    for number, (at, low, high) in enumerate(rows.tolist()):
        if not 0 <= at <= last * (1 + 1e-12):
            within = f"0 to {_text(last, key)}"
            raise ProblemError(
                f"{where}[{number}] is at {_text(at, key)}; it must be within the inputs, {within}"
            )
        if low > high:
            text = f"[{low * unit:.6g}, {high * unit:.6g}]"
            raise ProblemError(f"{where}[{number}] allows {text}: lo exceeds hi; it must have lo <= hi")
    return np.minimum(rows, [last, np.inf, np.inf])


def rates_inside(rates: Any, *, travels: bool, lengthens: bool) -> FloatArray:
    """Rows [input, lo, hi] of a file, in degrees where inputs and outputs are, converted to radians."""
    at, *limits = _rows(rates).T
    at = at if lengthens else np.radians(at)
    if travels != lengthens:  # degrees for a length, or lengths for a degree
        limits = [np.degrees(each) if travels else np.radians(each) for each in limits]
    return np.column_stack([at, *limits])


def _rows(rates: Any) -> FloatArray:
    where = f"function.{RATE}"
    if isinstance(rates, (str, bytes)) or not isinstance(rates, (Sequence, np.ndarray)) or not len(rates):
        raise wrong_value(where, rates, "a list of rows [input, lo, hi]")
    return np.array(checks.each_checked(rates, where, _row), dtype=np.float64)


def _row(row: Any, where: str) -> list[float]:
    if isinstance(row, (str, bytes)) or not isinstance(row, (Sequence, np.ndarray)) or len(row) != 3:
        raise wrong_value(where, row, "[input, lo, hi]")
    return [checks.finite_number(each, f"{where}[{k}]") for k, each in enumerate(row)]


def finite_numbers(values: Any, key: str) -> FloatArray:
    """A list of finite numbers under a key, as an array."""
    return checks.finite_list(values, f"function.{key}", "angles" if key.endswith("_deg") else "lengths")


def _text(value: float, key: str) -> str:
    return deg_text(value) if key.endswith("_deg") else f"{value:.6g}"


def _refuse_falling(given: FloatArray, key: str) -> None:
    lengths = key == INPUT
    least = _LEAST_STEP * (float(np.ptp(given)) if lengths else 1.0)
    why = (
        "list the pairs from the shortest cylinder to the longest"
        if lengths
        else "inputs must grow (the driver may turn either way all the same)"
    )
    for index in np.flatnonzero(~(np.diff(given) >= max(least, np.finfo(float).tiny))) + 1:
        last, here = (_text(each, key) for each in given[index - 1 : index + 1])
        raise ProblemError(f"function.{key}[{index}] is {here} after {last}; {why}")


def _refuse_far(travel: float, key: str) -> None:
    if travel > checks.GREATEST:
        raise ProblemError(f"function.{key} covers {travel:.6g}; it must be at most {checks.GREATEST:g}")


def _refuse_turns(angles: FloatArray, key: str) -> None:
    if np.ptp(angles) > TURN * (1 + 1e-12):
        raise ProblemError(
            f"function.{key} covers {deg_text(np.ptp(angles))} deg; it must be at most one turn, 360"
        )


def either(key: str, angles: object, length: object, why: str) -> bool:
    """Whether a value is given as a length; `ProblemError` if it is given as an angle, too."""
    if angles is not None and length is not None:
        both = f"function.{key}_deg does not go with function.{key}"
        raise ProblemError(f"{both}; {why}, give one of them")
    return length is not None


def refuse_beside(values: Mapping[str, object], why: str) -> None:
    """Raise `ProblemError` for keys that are given and must not be."""
    for name in (name for name, value in values.items() if value is not None):
        raise ProblemError(f"function.{name} {why}")


def refuse_missing(values: Mapping[str, object], *unused: str) -> None:
    """Raise `ProblemError` for keys that are missing, but for those unused."""
    missing = [name for name, value in values.items() if value is None and name not in unused]
    if missing:
        raise ProblemError("\n".join(f"function.{name} is missing" for name in missing))


def checked_mirror(task: GeneratedOutput, turned: float) -> float:
    """The driver rotation of the mirrored position of a function, rad."""
    where = "function.mirror_deg"
    others = (
        (task.travels, "a travel of a slide"),
        (task.link != "output", f'function.link = "{task.link}"'),
        (task.lengthens, f"function.{INPUT}"),
    )
    for stated, what in others:
        if stated:
            raise ProblemError(f"{where} does not go with {what}; it is of links 2 and 4")
    given, last = float(np.degrees(checks.finite_number(turned, where))), float(np.degrees(np.ptp(task.span)))
    if not 0 < given < last:
        raise ProblemError(f"{where} is {given:.6g}; it must lie within the range, 0 to {last:.6g}")
    return float(turned)
