"""What the search has to pass, and its linkages judged by every requirement."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import TURN, FloatArray
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.quantities.driver_motion import as_they_come
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import (
    Configurations,
    Screened,
    judge,
    violations_apart,
)
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.loop_search import Placed


def search_targets(scaled: ScaledProblem) -> SearchTargets:
    """What the search has to pass; a last point that repeats the first counts as its second half."""
    last = -1 if scaled.problem.task.returns else None
    weights, turn_weights = scaled.weights[:last].copy(), scaled.turn_weights[:last].copy()
    if last:
        weights[0] += scaled.weights[-1]
        turn_weights[0] += scaled.turn_weights[-1]
    return SearchTargets(
        points=scaled.targets[:last],
        weights=weights,
        turns=scaled.turns[:last],
        turn_weights=turn_weights,
        timing=scaled.timing[:last],
        wanted=scaled.wanted,
        closed=scaled.closed,
        kind=scaled.kind,
    )


def judged(scaled: ScaledProblem, target: SearchTargets, placed: Placed, direction: FloatArray) -> Screened:
    """Placed linkages and how far each violates the requirements."""
    a, b, theta2 = placed.a, placed.b, placed.theta2
    if scaled.problem.task.returns:
        a, b = (np.concatenate([points, points[:, :1]], axis=1) for points in (a, b))
        theta2 = np.concatenate([theta2, theta2[:, :1] + TURN * direction[:, None]], axis=1)
    visit = np.broadcast_to(np.arange(theta2.shape[1]), theta2.shape)
    if not target.wanted.order:
        visit, theta2, direction = as_they_come(theta2)
    p = placed.p[:, 0]
    found = Configurations(placed.o2, placed.o4, a, b, visit, theta2, direction, scaled.kind)
    violations = violations_apart(found, p, placed.p, scaled.wanted)
    error = np.sqrt(placed.error / len(scaled.targets))
    return fully_screened(scaled, judge(found, p, error, violations, scaled.wanted, placed.body_angle))
