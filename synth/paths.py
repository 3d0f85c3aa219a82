"""Starts for path generation: rounds of a search over linkages that are feasible by construction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from grashof.problems.checks import BoolArray
from grashof.synth.choose import feasible_starts, mended_starts
from grashof.synth.choose import relaxed_starts as relaxed
from grashof.synth.finds import Configurations, Finds, as_they_come, dyad_lacks, judge
from grashof.synth.path_search import Batch, PathTarget, Placed, draw, improve, place
from grashof.synth.setup import Setup
from grashof.synth.start import Start

TURN = 2 * np.pi
# Draws, and how many of the best go on for how many steps: few solutions, or a whole family of them.
ISOLATED = (4000, ((300, 8), (80, 12), (20, 50)))
FAMILY = (6000, ((1500, 10), (800, 10)))
TIMED = (600, ((60, 6), (20, 60)))
BARREN = 12  # so many rounds on end without a start end the search
EXACT = 1e-16  # sizes squared: such an error is left to the solver
FOUND = 1e-5  # sizes: rms error of a start for an exact task


def rounds(setup: Setup, enough: int, rng: np.random.Generator) -> Iterator[tuple[list[Start], int]]:
    """Rounds of starts, each with the number of feasible finds; later ones only when more are needed.

    Parameters
    ----------
    setup : Setup
    enough : int
        Distinct designs wanted.
    rng : numpy.random.Generator

    Yields
    ------
    list of Start, int
    """
    barren = 0
    while barren < BARREN:
        finds, family = search(setup, enough, rng), _family(setup, path_target(setup))
        feasible = finds[finds.feasible]
        starts = feasible_starts(setup, feasible, enough)
        if len(starts) < enough:
            starts += mended_starts(setup, finds, enough)
        # Without freedom, or with no error left to reduce, a find is the design already.
        settled = not family and (setup.exact or finds.error.min(initial=1.0) < FOUND)
        barren = 0 if starts else barren + 1
        yield [replace(start, settled=settled) for start in starts], len(feasible)


def relaxed_starts(setup: Setup, rng: np.random.Generator) -> list[Start]:
    """Starts that may miss what stands in the way."""
    drawn, free = search(setup, 1, rng), search(setup, 1, rng, to_boxes=False)
    return relaxed(setup, drawn) or relaxed(setup, free)


def search(setup: Setup, enough: int, rng: np.random.Generator, *, to_boxes: bool = True) -> Finds:
    """One round of the search, drawn towards the pivots' boxes or not, its finds judged."""
    target = path_target(setup)
    if not to_boxes:
        target = replace(target, wanted=replace(target.wanted, o2=None, o4=None))
    draws, stages = _effort(setup, target)
    batch = draw(target, draws, rng)
    with np.errstate(all="ignore"):
        error = place(target, batch).error
        for keep, steps in stages:
            best = np.argsort(error, kind="stable")[:keep]
            batch, error = improve(target, batch[best], steps, EXACT, until=min(enough, keep))
        placed = place(target, batch)
    sound = np.isfinite(placed.error)
    if setup.exact:
        sound &= placed.error <= len(target.points) * FOUND**2
    return _judged(setup, target, batch[sound], _at(placed, sound))


def path_target(setup: Setup) -> PathTarget:
    """What the search has to pass; a last point that repeats the first counts as its second half."""
    points, timing = setup.targets, setup.timing
    weights = np.ones(len(points))
    if _repeats(setup):
        points, weights = points[:-1], weights[:-1]
        weights[0] = 2.0
        timing = None if timing is None else timing[:-1]
    return PathTarget(
        points=points,
        weights=weights,
        timing=None if timing is None else np.abs(timing),
        wanted=setup.wanted,
    )


def _repeats(setup: Setup) -> bool:
    return bool(abs(setup.targets[0] - setup.targets[-1]) < 1e-12)


def _effort(setup: Setup, target: PathTarget) -> tuple[int, tuple[tuple[int, int], ...]]:
    if _family(setup, target):
        return FAMILY
    return ISOLATED if target.timing is None else TIMED


def _family(setup: Setup, target: PathTarget) -> bool:
    """Whether exact designs have freedom left: more unknowns than equations."""
    unknowns = target.unknowns + 6 - (target.wanted.order and target.timing is None)
    return setup.exact and unknowns > 2 * len(target.points)


def _at(placed: Placed, rows: BoolArray) -> Placed:
    return Placed(*(getattr(placed, name)[rows] for name in placed.__slots__))


def _judged(setup: Setup, target: PathTarget, batch: Batch, placed: Placed) -> Finds:
    a, b, theta2 = placed.a, placed.b, placed.theta2
    if _repeats(setup):
        a, b = (np.concatenate([points, points[:, :1]], axis=1) for points in (a, b))
        theta2 = np.concatenate([theta2, theta2[:, :1] + TURN * batch.direction[:, None]], axis=1)
    visit = np.broadcast_to(np.arange(theta2.shape[1]), theta2.shape)
    direction = batch.direction
    if not target.wanted.order:
        visit, theta2, direction = as_they_come(theta2)
    p = placed.p[:, 0]
    lacks = dyad_lacks("o2", placed.o2, a, p, setup.wanted) + dyad_lacks("o4", placed.o4, b, p, setup.wanted)
    found = Configurations(placed.o2, placed.o4, a, b, visit, theta2, direction)
    error = np.sqrt(placed.error / max(len(setup.targets), 1))
    return judge(found, p, error, lacks, setup.wanted)
