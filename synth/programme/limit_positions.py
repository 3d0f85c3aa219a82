"""The rows of a stroke: the output turns back at both targets, its swing or stroke lies between them."""

from __future__ import annotations

import numpy as np

from grashof.synth.loop.dyad import Closed
from grashof.synth.programme.builder import Builder
from grashof.synth.programme.constraints import Positions, Symbols
from grashof.synth.programme.plane import unit, vector
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.unknowns import Unknowns
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.limit_positions import lag_of


def stand_at_limits(build: Builder, form: Form, x: Unknowns, places: Positions) -> None:
    """The output stands still at both targets, as far apart as the task states; P is A.

    Which of its positions is which, and its sense, stay those of the start.
    """
    if not form.at_limits:
        return
    dyad, design = form.kind.dyad, Symbols(form, x, places)
    for k in range(form.targets):
        loop = Closed(vector(unit(x.theta3[k])), places.across(k), None, None)
        build.zero(dyad.driven_by(loop, vector(unit(x.theta2[k])).left))
    moved = design.output_turn if dyad.pinned else design.output_travel
    build.zero((moved / build.parameter(_output)) ** 2 - 1)
    if dyad.bars:  # the swing of a block decides its time ratio
        slow = build.parameter(lambda scaled, _: np.pi + lag_of(scaled.problem.task.time_ratio))
        build.zero(x.theta2[1] - x.theta2[0] - x.direction * slow)
    build.zero(x.arm)


def _output(scaled: ScaledProblem, _: Start) -> float:
    """The stroke in sizes, or the swing."""
    task = scaled.problem.task
    return float(task.swing or np.nan) if task.stroke is None else task.stroke / scaled.frame.scale
