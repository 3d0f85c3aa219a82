"""What requirements mean for a stroke: contradictions, and the length that its scale is taken from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import astuple

from grashof.problems.values.arrays import Limits
from grashof.problems.values.checks import GREATEST, LEAST
from grashof.problems.values.requirements.quantities import ROCKERS
from grashof.problems.values.requirements.requirements import Requirements, Rotatability
from grashof.problems.values.tasks.task import Task


def strokes_wrong(task: Task, wanted: Requirements, kinds: Sequence[str]) -> list[str]:
    """What a stroke, the kinds of linkages and the requirements do not agree on, a line each."""
    wrong = [line for kind in kinds if (line := task.impossible(kind))]
    if task.stroke is not None and task.time_ratio > 1 + wanted.tolerance and wanted.offset == (0, 0):
        wrong.append(
            f"stroke.time_ratio is {task.time_ratio:.6g}; it must be 1 where requirements.offset is [0, 0]"
        )
    wrong += _too_small(task, wanted)
    if wanted.exact is False:
        wrong.append("requirements.exact is false; with stroke it must be true: the time ratio is always met")
    if wanted.rotatability is Rotatability.DOUBLE_CRANK and not {*kinds}.isdisjoint(ROCKERS):
        wrong.append(
            'requirements.rotatability is "double-crank", whose output does not swing; '
            "with stroke it must be full-crank or crank-rocker"
        )
    return wrong


def _too_small(task: Task, wanted: Requirements) -> list[str]:
    """That B has no room for its stroke, where a slide is asked for."""
    if task.stroke is None or wanted.b is None:
        return []
    wide, tall = wanted.b.x[1] - wanted.b.x[0], wanted.b.y[1] - wanted.b.y[0]
    if math.hypot(wide, tall) >= task.stroke * (1 - wanted.tolerance):
        return []
    return [f"requirements.b is {wide:g} by {tall:g}; it must hold the stroke, {task.stroke:g}"]


def stated_size(wanted: Requirements) -> float:
    """A length that limits state, for a task without a size of its own; 1 where there is none."""
    for name in ("r1", "r4", "r3", "link_length", "r2"):
        lengths: Limits | None = getattr(wanted, name)
        if lengths is not None and 0 < lengths[1] < GREATEST:
            return lengths[1]
    if wanted.o2 is not None and wanted.o4 is not None:
        apart = [
            (sum(four) - sum(two)) / 2  # no number where a box is open
            for two, four in zip(*map(astuple, (wanted.o2, wanted.o4)), strict=True)
        ]
        if LEAST < (distance := math.hypot(*apart)) < GREATEST:
            return distance
    return 1.0
