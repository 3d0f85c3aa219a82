"""What a search over paths has to meet, and its linkages as finds, judged by every requirement."""

from __future__ import annotations

import numpy as np

from grashof.problems.checks import BoolArray, FloatArray, IntArray
from grashof.synth.finds import (
    GROUPS,
    Configurations,
    Finds,
    as_they_come,
    dyad_lacks,
    judge,
    keep_out_lack,
)
from grashof.synth.own import screened
from grashof.synth.path_loop import TURN, PathTarget
from grashof.synth.path_search import Placed
from grashof.synth.setup import Setup


def path_target(setup: Setup) -> PathTarget:
    """What the search has to pass; a last point that repeats the first counts as its second half."""
    last = -1 if _repeats(setup) else None
    weights, turn_weights = setup.weights[:last].copy(), setup.turn_weights
    if last:
        weights[0] += setup.weights[-1]
    if turn_weights is not None:
        added = turn_weights[-1] if last else 0.0
        turn_weights = turn_weights[:last] + np.eye(1, len(weights))[0] * added
    return PathTarget(
        points=setup.targets[:last],
        weights=weights,
        timing=None if setup.timing is None else np.abs(setup.timing[:last]),
        wanted=setup.wanted,
        turns=None if setup.turns is None else setup.turns[:last],
        turn_weights=turn_weights,
        closed=setup.closed,
    )


def _repeats(setup: Setup) -> bool:
    """Whether the last target is the first one again."""
    given, apart = setup.weights[[0, -1]] > 0, abs(setup.targets[0] - setup.targets[-1])
    same = given[0] == given[1] and apart < 1e-12
    if setup.turns is not None and setup.turn_weights is not None:
        given = setup.turn_weights[[0, -1]] > 0
        apart = abs(np.exp(1j * setup.turns[0]) - np.exp(1j * setup.turns[-1]))
        same = same and given[0] == given[1] and apart < 1e-12
    return bool(same)


def entries_of(placed: Placed, rows: BoolArray | IntArray) -> Placed:
    """Some linkages of a batch."""
    return Placed(*(getattr(placed, name)[rows] for name in placed.__slots__))


def judged(setup: Setup, target: PathTarget, placed: Placed, direction: FloatArray) -> Finds:
    """Placed linkages with what each lacks."""
    a, b, theta2 = placed.a, placed.b, placed.theta2
    if _repeats(setup):
        a, b = (np.concatenate([points, points[:, :1]], axis=1) for points in (a, b))
        theta2 = np.concatenate([theta2, theta2[:, :1] + TURN * direction[:, None]], axis=1)
    visit = np.broadcast_to(np.arange(theta2.shape[1]), theta2.shape)
    if not target.wanted.order:
        visit, theta2, direction = as_they_come(theta2)
    p = placed.p[:, 0]
    lacks = dyad_lacks("o2", placed.o2, a, p, setup.wanted) + dyad_lacks("o4", placed.o4, b, p, setup.wanted)
    lacks[:, GROUPS.index("keep_out")] += keep_out_lack("p", placed.p, setup.wanted)
    found = Configurations(placed.o2, placed.o4, a, b, visit, theta2, direction)
    error = np.sqrt(placed.error / len(setup.targets))
    return screened(setup, judge(found, p, error, lacks, setup.wanted, placed.body_angle))
