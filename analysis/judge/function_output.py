"""How a linkage generates a function: the structural error over the range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from grashof.analysis.judge.at_targets import SLACK, rate_misses, start_limits
from grashof.analysis.judge.meeting.function_start import Beginning, begins, begins_mirrored
from grashof.analysis.judge.meeting.generated import generated_rates, way_of
from grashof.analysis.judge.meeting.inputs import ByAngle, ByLength, Driven, input_of
from grashof.analysis.judge.meeting.structural_error import DENSE, outputs_of, structural_errors
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.problems import Linkage, Requirements, Task, TransmissionOver
from grashof.problems.values.arrays import TURN, FloatArray

MetAsFunction: TypeAlias = tuple[Targets, TaskMotion, dict[str, Any] | None, tuple[Defect, ...]]


def met_as_function(
    members: Sequence[Linkage], batch: Linkage, task: Task, wanted: Requirements, driven: Sequence[Driven]
) -> Iterator[MetAsFunction]:
    """Of each linkage, driver angles and errors at the pairs, the motion, and figures, or None without any.

    Last, the defects of rates beyond their limits. Where the inputs are lengths of a cylinder, the
    cylinder drives; without one there is no motion.
    """
    begun = [_begun(linkage, task, wanted, by) for linkage, by in zip(members, driven, strict=True)]
    moving = [row for row, each in enumerate(begun) if each is not None]
    start = _start_of(wanted)
    met = [each or _nowhere(task, start) for each in begun]
    exact = wanted.is_exact(task)
    found = dict(
        zip(moving, structural_errors(batch[moving], task, [met[row] for row in moving], exact), strict=True)
    )
    for row, (linkage, at) in enumerate(zip(members, met, strict=True)):
        errors, figures = found.get(row) or (np.full(len(task), np.inf), None)
        theta2 = at.driver_angles(task.inputs)
        free, own = np.full(len(task), np.nan), np.full(len(task), int(linkage.assembly))
        first, last = at.driver_angles(np.array(task.span)).tolist()
        motion = replace(TaskMotion.ordered(theta2, at.direction), start=first, end=last)
        targets = Targets(theta2, own, free, free, np.abs(errors))
        yield targets, motion, figures, tuple(_rate_defects(linkage, task, at, figures))


def _start_of(wanted: Requirements) -> float | None:
    return None if wanted.theta2_start_deg is None else float(np.radians(wanted.theta2_start_deg))


def _begun(linkage: Linkage, task: Task, wanted: Requirements, driven: Driven) -> Beginning | None:
    """Where the driver of a linkage begins; None where it does not cover the range."""
    exact, start = wanted.is_exact(task), _start_of(wanted)
    senses = {"ccw": (1,), "cw": (-1,)}.get(wanted.driver_sense, (1, -1))
    limited = start is None and wanted.transmission_over is TransmissionOver.TASK
    least = float(np.radians(wanted.transmission_min_deg)) if limited else 0.0
    if (by := input_of(linkage, task, driven)) is None:
        return None
    begun = None
    if task.mirror is not None:
        begun = begins_mirrored(linkage, task, by, senses) or begins_mirrored(linkage, task, by, (1, -1))
    misses = start_limits(linkage, task, wanted, by)
    begun = begun or begins(linkage, task, by, exact, start, senses, least, misses)
    if misses is not None:
        begun = begun or begins(linkage, task, by, exact, start, senses, least)
    # A linkage that misses a requirement from every start is reported where its error is least.
    begun = begun or begins(linkage, task, by, exact, start, senses)
    begun = begun or begins(linkage, task, by, exact, start)
    if begun is None or start is not None:
        return begun
    return replace(begun, theta2=float(begun.theta2 - TURN * np.round(begun.theta2 / TURN)))


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
    dense = np.linspace(*task.span, max(count, DENSE))
    inputs = np.linspace(*task.span, count) if at is None else at
    every = np.unique(np.concatenate([dense, inputs]))
    by = input_of(linkage, task, Driven(verdict.cylinder))
    if by is None:
        return None
    begun = Beginning(float(verdict.theta2[0]), verdict.direction, by)
    way = way_of(task, verdict.direction)
    outputs = outputs_of(linkage[None], task, [begun], every)[0]
    off = outputs - verdict.output_sense * task.output(every) - way * verdict.output_zero
    middle = 0.0 if task.travels else TURN * np.round(np.median(off) / TURN)
    error = off[np.searchsorted(every, inputs)] - middle
    wanted = verdict.output_sense * task.output(inputs)
    return FunctionCurves(inputs, wanted, wanted + error, error)
