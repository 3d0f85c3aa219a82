"""The motion of a judged linkage from the first target to the last, and samples of it."""

from __future__ import annotations

import numpy as np

from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.driver_law import DriverLaw
from grashof.analysis.mechanism.even_motion import close_samples
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage, Problem, Task
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics.motor import MotorSpec

_SAMPLES = 361


def as_used(linkage: Linkage, verdict: Verdict) -> Linkage:
    """The linkage on the assembly on which it meets the first target."""
    used = np.asarray(verdict.assembly[0], dtype=np.float64)
    return linkage if used == linkage.assembly else linkage.changed(assembly=used)


def joins(linkage: Linkage, verdict: Verdict, theta2: FloatArray) -> bool:
    """Whether a motion joins the targets; at its very ends rounding may open the loop."""
    return verdict.branch_ok and not np.isnan(solve_position(linkage, theta2[1:-1]).theta3).any()


def motion_ends(task: Task, verdict: Verdict) -> tuple[float, float]:
    """Driver angles at which the motion from the first target to the last begins and ends, rad."""
    low, high = float(verdict.theta2.min()), float(verdict.theta2.max())
    before, after = task.beyond
    start, end = (low, high) if verdict.direction > 0 else (high, low)
    start, end = start - verdict.direction * before, end + verdict.direction * after
    if task.closed:
        end = start + verdict.direction * TURN
    return start, end


def driver_law(problem: Problem, start: float, end: float) -> DriverLaw:
    """How the driver of a design goes from one angle to the other: as the problem's dynamics have it."""
    spec, rotation = problem.dynamics, end - start
    omega2 = np.copysign(1.0 if spec is None else spec.omega2, rotation)
    motor = spec.motor if spec is not None and rotation else None
    return DriverLaw(start, rotation, float(omega2), motor or MotorSpec())


def sampled(linkage: Linkage, start: float, end: float) -> FloatArray:
    """Driver angles from the lower end to the upper, close where a dead position is near."""
    return close_samples(linkage, start, end, _SAMPLES, second=False)
