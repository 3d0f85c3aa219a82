"""How each kind of task is met, and what is asked of it besides: a row for a kind that needs one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from grashof.analysis.judge.function_output import met_as_function
from grashof.analysis.judge.limit_positions import at_limits, stroke_defects
from grashof.analysis.judge.meet import meet
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion
from grashof.analysis.judge.verdict import Defect
from grashof.problems import FunctionTask, Linkage, Requirements, StrokeTask, Task
from grashof.problems.values.arrays import FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class Met:
    """A linkage at the targets of a task, and its motion.

    It has to stand on one circuit, and branch, at `theta2` (K,), rad, with `assembly` (K,); `covered` if it
    can be assembled all over what is asked for. `figures` are what a verdict has besides, by its fields.
    """

    targets: Targets
    motion: TaskMotion
    theta2: FloatArray
    assembly: IntArray
    covered: bool = True
    figures: Mapping[str, Any] = field(default_factory=dict)


def _nothing_else(_linkage: Linkage, _task: Task, _wanted: Requirements) -> Iterable[Defect]:
    return ()


@dataclass(frozen=True, slots=True)
class HowMet:
    """How a kind of task is met, and what it asks for that no requirement states."""

    met: Callable[[Linkage, Any, Requirements], Met]
    defects: Callable[[Linkage, Any, Requirements], Iterable[Defect]] = _nothing_else


def _in_plane(linkage: Linkage, task: Task, wanted: Requirements) -> Met:
    targets, motion = meet(linkage, task, wanted)
    return Met(targets, motion, targets.theta2, targets.assembly)


def _as_function(linkage: Linkage, task: Task, wanted: Requirements) -> Met:
    """The whole range counts, not only its pairs."""
    targets, motion, error = met_as_function(linkage, task, wanted)
    theta2 = np.array([motion.start, *targets.theta2, motion.end])
    assembly = np.full(len(theta2), int(linkage.assembly))
    figures = {} if error is None else error.figures
    return Met(targets, motion, theta2, assembly, covered=error is not None, figures=figures)


def _between_limits(linkage: Linkage, task: Task, wanted: Requirements) -> Met:
    targets, motion = at_limits(linkage, task, wanted)
    return Met(targets, motion.closed(), targets.theta2, targets.assembly)


HOW_MET: Mapping[type, HowMet] = {
    Task: HowMet(_in_plane),
    FunctionTask: HowMet(_as_function),
    StrokeTask: HowMet(_between_limits, stroke_defects),
}
