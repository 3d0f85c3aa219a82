"""Limits that depend on where the driver of a function begins: how far each start misses them."""

from __future__ import annotations

from typing import Any

import numpy as np

from grashof.analysis.judge.at_targets import SLACK, excess, figures_at
from grashof.analysis.judge.meeting.function_start import Misses
from grashof.analysis.judge.meeting.inputs import Input
from grashof.problems import Linkage, Requirements, TargetLimits, Task
from grashof.problems.values.arrays import FloatArray

MOTION = 97  # inputs of the range, at which what is limited over the motion is compared
_AT_PAIRS = ("a", "b", "distances")
_OVER_MOTION = ("coupler_angle_deg", "coupler_rate", "mechanical_advantage_min")


def start_limits(linkage: Linkage, task: Task, wanted: Requirements, by: Input) -> Misses | None:
    """Excess over these limits (S,) by starts (S,) and a sense, in sizes, rad or ratios; None without any.

    Zero where they are kept; infinite where the linkage does not close.
    """
    at_pairs = _some(wanted, _AT_PAIRS, len(task))
    over_motion = _some(wanted, _OVER_MOTION, MOTION)
    if not (wanted.at or at_pairs or over_motion):
        return None
    inputs = np.linspace(*task.span, MOTION)

    def misses(starts: FloatArray, direction: int) -> FloatArray:
        worst = np.zeros(len(starts))
        for limits, places in (
            *((limits, task.inputs) for limits in (*wanted.at, *at_pairs)),
            *((limits, inputs) for limits in over_motion),
        ):
            theta2 = starts[:, None] + direction * by.turned(starts, direction, places)
            own = np.full(len(places), int(linkage.assembly))
            for _, values, allowed, unit in figures_at(linkage, limits, theta2, own, task.size):
                over = excess(values, allowed) / task.size**unit.lengths
                greatest = _crest(over) if limits in over_motion else over.max(axis=-1)
                worst = np.maximum(worst, np.nan_to_num(greatest, nan=np.inf))
        return np.where(worst > SLACK, worst, 0.0)

    return misses


def _some(wanted: Requirements, names: tuple[str, ...], count: int) -> tuple[TargetLimits, ...]:
    """Limits of requirements as limits at all of some targets."""
    stated: dict[str, Any] = {name: getattr(wanted, name) for name in names if name in wanted.limited}
    return (TargetLimits(targets=range(1, count + 1), **stated),) if stated else ()


def _crest(values: FloatArray) -> FloatArray:
    """The greatest of even samples (..., K), or of the parabola through it and its neighbours."""
    before, here, after = values[..., :-2], values[..., 1:-1], values[..., 2:]
    bend = 2 * here - before - after
    with np.errstate(divide="ignore", invalid="ignore"):
        rise = np.where((here >= before) & (here >= after) & (bend > 0), (after - before) ** 2 / (8 * bend), 0.0)
    greatest: FloatArray = np.maximum(values.max(axis=-1), (here + rise).max(axis=-1))
    return greatest
