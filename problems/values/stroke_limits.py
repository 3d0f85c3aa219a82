"""What requirements mean for a stroke: contradictions, and the length that its scale is taken from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import astuple

from grashof.problems.values.arrays import Limits
from grashof.problems.values.checks import GREATEST, LEAST
from grashof.problems.values.requirements import Requirements, Rotatability
from grashof.problems.values.stroke_task import StrokeTask


def strokes_wrong(task: StrokeTask, wanted: Requirements, kinds: Sequence[str]) -> list[str]:
    """What a stroke, the kinds of linkages and the requirements do not agree on, a line each."""
    wrong = [line for kind in kinds if (line := task.impossible(kind))]
    if wanted.exact is False:
        wrong.append("requirements.exact is false; with stroke it must be true: the time ratio is always met")
    if wanted.rotatability is Rotatability.DOUBLE_CRANK:
        wrong.append(
            'requirements.rotatability is "double-crank", whose output does not swing; '
            "with stroke it must be full-crank or crank-rocker"
        )
    return wrong


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
