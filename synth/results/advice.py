"""What to know of a list besides its designs: that a task leaves none of them good, and what would."""

from __future__ import annotations

import numpy as np

from grashof.problems import Problem, Task
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.strokes.limit_positions import stroke_kind_of
from grashof.synth.theory.limit_positions import best_transmission

GOOD = float(np.radians(40))  # transmission angle that textbooks ask for (Norton, sec. 3.3)
LITTLE = float(np.radians(1))  # of which tenths of a degree say nothing
_HALVINGS = 12


def advice(problem: Problem) -> str:
    """For a stroke that no linkage transmits well: how well the best does and what does better; else empty.

    >>> from grashof.problems import StrokeTask
    >>> advice(Problem(task=StrokeTask.from_degrees(swing_deg=80, time_ratio=1.05)))
    ''
    >>> print(advice(Problem(task=StrokeTask.from_degrees(swing_deg=40, time_ratio=1.5))))
    crank-rockers with this swing and time ratio transmit at 31.8 deg at best, less than the usual 40 deg; \
time ratios up to 1.30 allow 40 deg, and a six-bar may do it as asked
    """
    task = problem.task
    if not task.at_limits:
        return ""
    stroke_kind = stroke_kind_of(ScaledProblem.of(problem).kind)
    if not stroke_kind.advised or (best := best_transmission(task.swing, task.time_ratio)) >= GOOD:
        return ""
    kinds, what = stroke_kind.what, stroke_kind.advised
    usual = f"{np.degrees(GOOD):.0f} deg"
    ratio = _ratio_that_allows(task)
    smaller = (
        f"time ratios up to {ratio:.2f} allow {usual}" if ratio > 1 else f"{usual} takes a smaller {what}"
    )
    angle = f"{np.degrees(best):.{1 if best > LITTLE else 4}f}"
    return (
        f"{kinds} with this {what} and time ratio transmit at {angle} deg at best, less than "
        f"the usual {usual}; {smaller}, and a six-bar may do it as asked"
    )


def _ratio_that_allows(task: Task) -> float:
    """The greatest time ratio, in hundredths, that allows a good transmission angle; 1 where none does."""
    low, high = 1.0, task.time_ratio
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        good = best_transmission(task.swing, middle) >= GOOD
        low, high = (middle, high) if good else (low, middle)
    return float(np.floor(100 * low) / 100)
