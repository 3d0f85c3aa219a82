"""The function that a design generates: wanted and generated output, and the structural error."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import FunctionCurves, Verdict, function_curves, verify
from grashof.problems import Task
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy

OVER = "driver rotation from the first pair (deg)"


def function_section(study: LinkageStudy) -> Section | None:
    """Output and structural error of a design that generates a function; None for all others."""
    problem = study.spec.problem
    if problem is None or not problem.task.has_output.any():
        return None
    task = problem.task
    verdict = verify(study.linkage, task, problem.requirements, problem=problem)
    curves = function_curves(study.linkage, task, verdict)
    if curves is None:
        return None
    at_pairs = function_curves(study.linkage, task, verdict, at=task.driver_turns)
    places, shown, unit = (
        np.degrees(curves.turned),
        task.counted_in.shown,
        task.counted_in.of(problem.length_unit),
    )
    output = {"wanted": shown * curves.wanted, "generated": shown * curves.generated}
    plots = (
        Plot("function-output", task.output_words, unit, output, places, OVER, bounded=True),
        Plot(
            "structural-error", "structural error", unit, {"error": shown * curves.error}, places, OVER,
            bounded=True,
        ),
    )  # fmt: skip
    tables = {} if at_pairs is None else {"function": _pairs(task, verdict, at_pairs)}
    way = "along the slide" if task.travels else "in the sense of the driver"
    between = "between pairs the wanted output is the cubic spline through them"
    notes = (
        f"error is output less what is wanted, {way}",
        between if task.law is None else f"wanted is the law {task.law.name}",
    )
    return Section("function", "Function", tuple(_facts(task, verdict, unit)), tables, plots, notes)


def _facts(task: Task, verdict: Verdict, unit: str) -> Iterator[Fact]:
    zero = "travel of the slide" if task.travels else "theta4"
    names = {
        "structural_error_max": "structural error, greatest",
        "structural_error_rms": "structural error, root mean square",
        "output_zero": f"{zero} at the wanted output zero",
    }
    ending = "" if task.travels else "_deg"
    for key, label in names.items():
        yield Fact(f"{key}{ending}", label, float(task.counted_in.shown * getattr(verdict, key)), unit)
        if key == "structural_error_max":
            where = f"{label}: driver rotation from the first pair"
            yield Fact(
                "structural_error_at_deg", where, float(np.degrees(verdict.structural_error_at)), "deg"
            )
    yield Fact("theta2_first_deg", "theta2 at the first pair", float(np.degrees(verdict.theta2[0])), "deg")
    yield Fact("driver_sense", "sense of the driver (1: counter-clockwise)", verdict.direction)


def _pairs(task: Task, verdict: Verdict, at_pairs: FunctionCurves) -> pd.DataFrame:
    """A row for each pair."""
    angles = {"input_deg": at_pairs.turned, "theta2_deg": verdict.theta2}
    outputs = {"wanted": at_pairs.wanted, "generated": at_pairs.generated, "error": at_pairs.error}
    ending = "" if task.travels else "_deg"
    columns = {name: np.degrees(values) for name, values in angles.items()}
    columns |= {f"{name}{ending}": task.counted_in.shown * values for name, values in outputs.items()}
    table = pd.DataFrame(columns)
    table.insert(0, "pair", np.arange(1, len(table) + 1))
    return table
