"""Searches for strokes, and their transmission angles."""

from typing import Any

import numpy as np

from grashof.problems.files.problem_schema import problem_from
from grashof.synth import Result, synthesize


def found(swing_deg: float = 80, time_ratio: float = 10 / 9, tables: Any = None, **wanted: Any) -> Result:
    stroke = {"swing_deg": swing_deg, "time_ratio": time_ratio}
    document = {"kind": "stroke", "stroke": stroke, "requirements": wanted, **(tables or {})}
    return synthesize(problem_from(document, "stroke"), enough=8)


def worst(result: Result) -> np.ndarray:
    return np.degrees([each.verdict.transmission_min_cycle for each in result.candidates])
