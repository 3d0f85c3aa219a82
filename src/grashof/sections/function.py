"""The function that a design generates: wanted and generated output, and the structural error."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import FunctionCurves, Verdict, function_curves, verify
from grashof.problems import FunctionTask
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy

OVER = "driver rotation from the first pair (deg)"


def function_section(study: LinkageStudy) -> Section | None:
    """Output and structural error of a design that generates a function; None for all others."""
    problem = study.spec.problem
    if problem is None or not isinstance(problem.task, FunctionTask):
        return None
    task = problem.task
    verdict = verify(study.linkage, task, problem.requirements, problem=problem)
    curves = function_curves(study.linkage, task, verdict)
    if curves is None:
        return None
    at_pairs = function_curves(study.linkage, task, verdict, at=task.inputs)
    places = np.degrees(curves.turned)
    output = {"wanted": np.degrees(curves.wanted), "generated": np.degrees(curves.generated)}
    plots = (
        Plot("function-output", "output rotation", "deg", output, places, OVER, bounded=True),
        Plot(
            "structural-error", "structural error", "deg", {"error": np.degrees(curves.error)}, places, OVER,
            bounded=True,
        ),
    )  # fmt: skip
    tables = {} if at_pairs is None else {"function": _pairs(verdict, at_pairs)}
    between = "between pairs the wanted output is the cubic spline through them"
    notes = (
        "error is output less what is wanted, in the sense of the driver",
        between if task.law is None else f"wanted is the law {task.law.name}",
    )
    return Section("function", "Function", tuple(_facts(verdict)), tables, plots, notes)


def _facts(verdict: Verdict) -> Iterator[Fact]:
    names = {
        "structural_error_max": "structural error, greatest",
        "structural_error_at": "structural error, greatest: driver rotation from the first pair",
        "structural_error_rms": "structural error, root mean square",
        "output_zero": "theta4 at the wanted output zero",
    }
    for key, label in names.items():
        yield Fact(f"{key}_deg", label, float(np.degrees(getattr(verdict, key))), "deg")
    yield Fact("theta2_first_deg", "theta2 at the first pair", float(np.degrees(verdict.theta2[0])), "deg")
    yield Fact("driver_sense", "sense of the driver (1: counter-clockwise)", verdict.direction)


def _pairs(verdict: Verdict, at_pairs: FunctionCurves) -> pd.DataFrame:
    """A row for each pair."""
    columns = {
        "input_deg": at_pairs.turned,
        "theta2_deg": verdict.theta2,
        "wanted_deg": at_pairs.wanted,
        "generated_deg": at_pairs.generated,
        "error_deg": at_pairs.error,
    }
    table = pd.DataFrame({name: np.degrees(values) for name, values in columns.items()})
    table.insert(0, "pair", np.arange(1, len(table) + 1))
    return table
