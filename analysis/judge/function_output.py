"""How a linkage generates a function: the structural error over the range."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from grashof.analysis.judge.at_targets import SLACK, rate_misses, start_limits
from grashof.analysis.judge.meeting.function_start import (
    Beginning,
    begins,
    begins_mirrored,
    generated_rates,
    moved_output,
    senses_of,
    way_of,
)
from grashof.analysis.judge.meeting.inputs import ByAngle, ByLength, Driven, input_of
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import Linkage, Requirements, Task, TransmissionOver
from grashof.problems.values.arrays import TURN, FloatArray

_DENSE = 721
_GAUSS = 12  # points between two samples of the quadrature


def output_error(
    linkage: Linkage, task: Task, begun: Beginning, inputs: FloatArray, sense: int
) -> FloatArray:
    """Generated less wanted output, up to a constant, at growing inputs (K,), rad or length.

    Positive where the output is ahead in the sense of the driver; NaN where the linkage cannot be assembled.
    """
    state = solve_position(linkage, begun.driver_angles(inputs))
    found: FloatArray = moved_output(task, state, begun.direction) - sense * task.output(inputs)
    return found


def structural_error(
    linkage: Linkage, task: Task, begun: Beginning, exact: bool
) -> tuple[FloatArray, dict[str, Any]] | None:
    """Generated less wanted output at the pairs (N,), rad or length, and the figures of a verdict.

    None where the linkage cannot be assembled over the entire range. Extremes are refined, the mean square is
    a Gauss-Legendre sum between samples and pairs. The output's zero is the mean of the errors at the pairs,
    or the middle of the extremes where the greatest error counts and pairs need not be met; for a mirrored
    linkage it lies in the mirrored position.
    """
    share = task.weights / task.weights.sum()
    dense = np.unique(np.concatenate([task.inputs, np.linspace(*task.span, _DENSE)]))
    found = []
    for sense in senses_of(task):
        off = output_error(linkage, task, begun, dense, sense)
        if np.isnan(off).any():
            return None
        at_pairs = off[np.searchsorted(dense, task.inputs)]
        found.append((float(np.ptp(off)), sense, off, at_pairs))
    _, sense, off, at_pairs = min(found, key=lambda each: each[:2])
    zero = float(share @ at_pairs)

    def curves(inputs: FloatArray) -> FloatArray:
        order = np.argsort(inputs, kind="stable")
        errors = np.empty(len(inputs))
        found = output_error(linkage, task, begun, inputs[order], sense)
        if not task.travels:  # without the full turns by which they may differ from the dense samples
            found = found - TURN * np.round((found - np.interp(inputs[order], dense, off)) / TURN)
        errors[order] = found
        return np.stack([errors, -errors])

    (high, low), (high_at, low_at) = (each.tolist() for each in peaks(curves, [dense]))
    if task.mirror is not None:
        zero = float(curves(np.array([task.mirror_turn]))[0, 0])
    elif task.norm == "max" and not exact:
        zero = (high - low) / 2
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    coarse = np.unique(np.concatenate([task.inputs, np.linspace(*task.span, 25)]))
    middle, half = (coarse[1:] + coarse[:-1]) / 2, np.diff(coarse) / 2
    inner = (middle[:, None] + half[:, None] * nodes).ravel()
    square = float((half[:, None] * weights).ravel() @ (curves(inner)[0] - zero) ** 2) / float(np.ptp(coarse))
    above, below = high - zero, low + zero
    worst, at = (above, high_at) if above >= below else (below, low_at)
    return at_pairs - zero, {
        "structural_error_max": worst,
        "structural_error_rms": float(np.sqrt(square)),
        "structural_error_at": float(begun.driver_turns(np.array([at]))[0]),
        "output_zero": way_of(task, begun.direction) * zero,
        "output_sense": sense,
    }


def met_as_function(
    linkage: Linkage, task: Task, wanted: Requirements, driven: Driven
) -> tuple[Targets, TaskMotion, dict[str, Any] | None, tuple[Defect, ...]]:
    """Driver angle and error at each pair, the motion, and the figures of the error, or None without one.

    Last, the defects of rates beyond their limits. Where the inputs are lengths of a cylinder, the
    cylinder drives; without one there is no motion.
    """
    exact = wanted.is_exact(task)
    start = None if wanted.theta2_start_deg is None else float(np.radians(wanted.theta2_start_deg))
    senses = {"ccw": (1,), "cw": (-1,)}.get(wanted.driver_sense, (1, -1))
    limited = start is None and wanted.transmission_over is TransmissionOver.TASK
    least = float(np.radians(wanted.transmission_min_deg)) if limited else 0.0
    by = input_of(linkage, task, driven)
    begun = None
    if by is not None:
        if task.mirror is not None:
            begun = begins_mirrored(linkage, task, by, senses) or begins_mirrored(linkage, task, by, (1, -1))
        misses = start_limits(linkage, task, wanted, by)
        begun = begun or begins(linkage, task, by, exact, start, senses, least, misses)
        if misses is not None:
            begun = begun or begins(linkage, task, by, exact, start, senses, least)
        # A linkage that misses a requirement from every start is reported where its error is least.
        begun = begun or begins(linkage, task, by, exact, start, senses)
        begun = begun or begins(linkage, task, by, exact, start)
    met = begun or _nowhere(task, start)
    first = met.theta2 if start is not None else met.theta2 - TURN * np.round(met.theta2 / TURN)
    met = replace(met, theta2=float(first))
    theta2 = met.driver_angles(task.inputs)
    found = structural_error(linkage, task, met, exact) if begun else None
    errors, figures = (np.full(len(task), np.inf), None) if found is None else found
    free, own = np.full(len(task), np.nan), np.full(len(task), int(linkage.assembly))
    first, last = met.driver_angles(np.array(task.span)).tolist()
    motion = replace(TaskMotion.ordered(theta2, met.direction), start=first, end=last)
    targets = Targets(theta2, own, free, free, np.abs(errors))
    return targets, motion, figures, tuple(_rate_defects(linkage, task, met, figures))


def _rate_defects(
    linkage: Linkage, task: Task, begun: Beginning, figures: dict[str, Any] | None
) -> Iterator[Defect]:
    """Rates beyond their limits, with the miss as a share of the greatest limit."""
    if task.rates is None or figures is None:
        return
    start, limited = np.array(begun.theta2), task.rates
    rates = generated_rates(linkage, task, begun.by, start, begun.direction, limited[:, 0])
    rates = figures["output_sense"] * rates
    for (at, *limits), rate, miss in zip(limited, rates, rate_misses(limited, rates), strict=True):
        if miss > SLACK:
            what = f"the leverage ratio d(output)/d(input) at input {task.counted_from.shown * at:.6g}"
            low, high = (f"{task.rate_unit * limit:.6g}" for limit in limits)
            found = float(task.rate_unit * rate)
            yield Defect("function.rate", what, found, f"{low} to {high}", float(miss))


def _nowhere(task: Task, start: float | None) -> Beginning:
    """Beginning of a linkage that does not cover the range, with an arbitrary cylinder where it has none."""
    if not task.lengthens:
        return Beginning(start or 0.0, 1, ByAngle())
    stroke = float(task.inputs[-1])
    return Beginning(np.pi / 4, 1, ByLength(base=stroke, arm=stroke, zero=0.0))


@dataclass(frozen=True, slots=True)
class FunctionCurves:
    """Wanted and generated output of a design over the range, each of shape (K,).

    Parameters
    ----------
    inputs : ndarray, rad or length
        Driver rotation, or lengthening of the cylinder, from the first pair.
    wanted, generated, error : ndarray, rad or length
        Output rotation, positive as the driver turns, or travel along the slide, from the wanted zero on.
    """

    inputs: FloatArray
    wanted: FloatArray
    generated: FloatArray
    error: FloatArray


def function_curves(
    linkage: Linkage, task: Task, verdict: Verdict, count: int = 361, at: FloatArray | None = None
) -> FunctionCurves | None:
    """Output of a judged linkage over the range of its function, or at given inputs.

    Parameters
    ----------
    linkage : Linkage
    task : Task
        A function.
    verdict : Verdict
        Of `verify` for this linkage and task.
    count : int
        Number of inputs, evenly spaced over the range.
    at : ndarray, shape (K,), rad or length, optional
        Inputs from the first pair, instead.

    Returns
    -------
    FunctionCurves or None
        None where the linkage does not cover the range.

    Examples
    --------
    >>> from grashof.problems import FourBar, FunctionTask
    >>> from grashof.analysis.judge.verify import verify
    >>> linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> task = FunctionTask([0, 0.5, 1.0], [0, 0.1, 0.3])
    >>> curves = function_curves(linkage, task, verify(linkage, task, Requirements(exact=False)))
    >>> bool(np.abs(curves.generated - curves.wanted - curves.error).max() < 1e-12)
    True
    """
    if not np.isfinite(verdict.structural_error_max):
        return None
    dense = np.linspace(*task.span, max(count, _DENSE))
    inputs = np.linspace(*task.span, count) if at is None else at
    every = np.unique(np.concatenate([dense, inputs]))
    by = input_of(linkage, task, Driven(verdict.cylinder))
    if by is None:
        return None
    begun = Beginning(float(verdict.theta2[0]), verdict.direction, by)
    way = way_of(task, verdict.direction)
    off = output_error(linkage, task, begun, every, verdict.output_sense) - way * verdict.output_zero
    middle = 0.0 if task.travels else TURN * np.round(np.median(off) / TURN)
    error = off[np.searchsorted(every, inputs)] - middle
    wanted = verdict.output_sense * task.output(inputs)
    return FunctionCurves(inputs, wanted, wanted + error, error)
