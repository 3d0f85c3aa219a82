"""Plots of what a function generator puts out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from grashof.analysis import function_curves
from grashof.figures.parts import COUPLER, OUTPUT, TARGET
from grashof.problems import FunctionTask
from grashof.synth import Candidate

_OVER = "driver rotation from the first pair (deg)"


def plot_function(task: FunctionTask, candidate: Candidate, *, ax: Sequence[Axes]) -> None:
    """Wanted and generated output of a design, and its structural error.

    Parameters
    ----------
    task : FunctionTask
    candidate : Candidate
    ax : two axes
        Of the output, and of the error.
    """
    output, error = ax
    curves = function_curves(candidate.linkage, task, candidate.verdict)
    if curves is not None:
        places = np.degrees(curves.turned)
        output.plot(places, np.degrees(curves.wanted), color=OUTPUT, linewidth=3, alpha=0.4, label="wanted")
        output.plot(places, np.degrees(curves.generated), color=COUPLER, label="generated")
        error.plot(places, np.degrees(curves.error), color=COUPLER)
        at = function_curves(candidate.linkage, task, candidate.verdict, at=task.inputs)
        if at is not None and not task.fits_range:
            pairs: dict[str, Any] = {"marker": "o", "markersize": 4, "color": TARGET}
            pairs |= {"linestyle": "none", "markerfacecolor": "none"}
            output.plot(np.degrees(task.inputs), np.degrees(at.wanted), label="pairs", **pairs)
            error.plot(np.degrees(task.inputs), np.degrees(at.error), **pairs)
    plot_labels(output, "output rotation (deg)")
    plot_labels(error, "structural error (deg)")
    if output.lines:
        output.legend(loc="best", fontsize="small")


def plot_wanted(axes: Axes, task: FunctionTask) -> None:
    """The function that is wanted, with its pairs."""
    turned = np.linspace(*task.span, 361)
    axes.plot(np.degrees(turned), np.degrees(task.output(turned)), color=OUTPUT, label="wanted")
    axes.plot(
        np.degrees(task.inputs), np.degrees(task.outputs), linestyle="none", marker="o", color=TARGET,
        markerfacecolor="none", label="pairs",
    )  # fmt: skip
    plot_labels(axes, "output rotation (deg)")
    axes.legend(loc="best", fontsize="small")


def plot_labels(axes: Axes, across: str) -> None:
    """Names of both axes."""
    axes.set_xlabel(_OVER)
    axes.set_ylabel(across)
