"""The output that a linkage generates: what counts of it, in which sense, and its rate."""

from __future__ import annotations

import numpy as np

from grashof.analysis.judge.meeting.inputs import Input
from grashof.analysis.mechanism.closing import STEADY, close, move, operands_of
from grashof.analysis.mechanism.position import Position
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import FloatArray, IntArray


def moved_output(
    task: Task, state: Position, direction: int | IntArray, *, unwrapped: bool = True
) -> FloatArray:
    """Output of a linkage in its positions: rotation in the sense of the driver, or travel of the slide."""
    if task.travels:
        return state.travel
    turned = state.angles[task.turning_link(state.linkage.mechanism)]
    moved: FloatArray = direction * (np.unwrap(turned) if unwrapped else turned)
    return moved


def output_rate(linkage: Linkage, task: Task, theta2: FloatArray) -> FloatArray:
    """Derivative of the output, an angle or a travel, by the driver angle; not finite in dead positions."""
    loops, _ = close(linkage.mechanism, operands_of(linkage), theta2)
    moving, turns = move(loops, STEADY, dead_below=0.0, last_too=True)
    link = turns[task.turning_link(linkage.mechanism)]
    rate: FloatArray = moving[-1].orders[0].travel if task.travels else link.tangential[0]
    return rate


def generated_rates(
    linkage: Linkage, task: Task, by: Input, starts: FloatArray, direction: int, inputs: FloatArray
) -> FloatArray:
    """Leverage ratios d(output)/d(input) by starts (...) at inputs (R,), with the sign of the output."""
    theta2 = starts[..., None] + direction * by.turned(starts, direction, inputs)
    rates = output_rate(linkage, task, theta2) * by.rate(starts, direction, inputs)
    # Rotations of the output and of link 2 count in the sense of the driver.
    return (direction if task.travels else 1) * rates


def senses_of(task: Task) -> tuple[int, ...]:
    """The senses in which the output may follow the function."""
    return (1, -1) if task.sense == "either" else (1,)


def way_of(task: Task, direction: int) -> int:
    """Sense in which an output counts: a rotation in that of the driver, a travel along the slide."""
    return 1 if task.travels else direction
