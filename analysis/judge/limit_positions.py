"""Strokes: where a linkage has its limit positions, and what its swing or stroke and time ratio miss."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion
from grashof.analysis.judge.verdict import Defect
from grashof.analysis.mechanism.stroke import output_stroke
from grashof.problems import Linkage, Requirements, Task
from grashof.problems.values.arrays import TURN

_EVEN = 1e-12  # rad: strokes that differ by less take as long


def at_limits(linkage: Linkage, task: Task, wanted: Requirements) -> tuple[Targets, TaskMotion]:
    """The limit positions of a linkage on its own assembly, and the slow stroke between them.

    A whole turn apart where there are none. Clockwise where the driver's sense has to be; either has the same
    swing and time ratio.
    """
    sense = -1 if wanted.driver_sense == "cw" else 1
    stretched, folded = np.nan_to_num(output_stroke(linkage).theta2, nan=0.0).tolist()
    there = sense * (folded - stretched) % TURN
    first, way = (stretched, there) if there > np.pi - _EVEN else (folded, TURN - there)
    first -= TURN * np.ceil((first - np.pi) / TURN)
    theta2 = np.array([first, first + sense * way])
    assembly = np.full(2, int(linkage.assembly))
    return Targets.of(linkage, task, theta2, assembly), TaskMotion.ordered(theta2, sense)


def stroke_defects(linkage: Linkage, task: Task, wanted: Requirements) -> Iterator[Defect]:
    """What swing (by `tolerance` in rad), stroke and time ratio (by that share of them) miss."""
    found = output_stroke(linkage)
    ratio = float(found.time_ratio)
    if task.stroke is None:
        swing = float(found.swing)
        if np.isnan(swing):  # link 4 does not turn back
            swing, ratio = TURN, task.time_ratio
        first = ("the swing in deg", swing, task.swing or 0.0, float(np.degrees(1.0)), 1.0)
    elif lacking := int(np.isnan(found.theta2).sum()):
        yield Defect("exact", "the number of limit positions", 2 - lacking, "2", 1.0)
        return
    else:
        first = ("the stroke", float(found.chord), task.stroke, 1.0, task.stroke)
    for what, value, wish, unit, scale in (
        first,
        ("the time ratio", ratio, task.time_ratio, 1.0, task.time_ratio),
    ):
        miss = abs(value - wish) / scale if np.isfinite(value) else np.inf
        if not miss <= wanted.tolerance:
            within = f"{wish * unit:.6g} within {wanted.tolerance * scale * unit:.2g}"
            yield Defect("exact", what, value * unit, within, miss - wanted.tolerance)
