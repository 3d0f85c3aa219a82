"""Plots of what a function generator puts out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from grashof.analysis import function_curves
from grashof.figures.parts import COUPLER, OUTPUT, TARGET
from grashof.problems import Task
from grashof.synth import Candidate

_OVER = "driver rotation from the first pair (deg)"


def plot_function(task: Task, candidate: Candidate, *, ax: Sequence[Axes]) -> None:
    """Wanted and generated output of a design on the first axes, its structural error on the second."""
    output, error = ax
    curves = function_curves(candidate.linkage, task, candidate.verdict)
    if curves is not None:
        places, shown = np.degrees(curves.turned), task.counted_in.shown
        output.plot(places, shown * curves.wanted, color=OUTPUT, linewidth=3, alpha=0.4, label="wanted")
        output.plot(places, shown * curves.generated, color=COUPLER, label="generated")
        error.plot(places, shown * curves.error, color=COUPLER)
        at = function_curves(candidate.linkage, task, candidate.verdict, at=task.driver_turns)
        if at is not None and not task.fits_range:
            pairs: dict[str, Any] = {"marker": "o", "markersize": 4, "color": TARGET}
            pairs |= {"linestyle": "none", "markerfacecolor": "none"}
            output.plot(np.degrees(task.driver_turns), shown * at.wanted, label="pairs", **pairs)
            error.plot(np.degrees(task.driver_turns), shown * at.error, **pairs)
    unit = candidate.problem.length_unit
    _label(output, task.output_words, task, unit)
    _label(error, "structural error", task, unit)
    if output.lines:
        output.legend(loc="best", fontsize="small")


def plot_wanted(axes: Axes, task: Task, length_unit: str) -> None:
    """The function that is wanted, with its pairs."""
    turned, shown = np.linspace(*task.span, 361), task.counted_in.shown
    axes.plot(np.degrees(turned), shown * task.output(turned), color=OUTPUT, label="wanted")
    axes.plot(
        np.degrees(task.driver_turns), shown * task.outputs, linestyle="none", marker="o", color=TARGET,
        markerfacecolor="none", label="pairs",
    )  # fmt: skip
    _label(axes, task.output_words, task, length_unit)
    axes.legend(loc="best", fontsize="small")


def _label(axes: Axes, words: str, task: Task, length_unit: str) -> None:
    """Name both axes, the upright one by words with the unit of the output."""
    axes.set_xlabel(_OVER)
    axes.set_ylabel(f"{words} ({task.counted_in.of(length_unit)})")
