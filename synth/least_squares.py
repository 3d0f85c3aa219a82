"""Starts where the squared errors are made least: a batched search under every limit.

Linkages that are feasible by construction are placed best on the targets; then their places are
unknowns, too, and what oversteps a limit counts as an error, more so from stage to stage. So the
search ends where the programme does, whichever limits are active.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import TransmissionOver
from grashof.problems.checks import BoolArray, FloatArray, IntArray
from grashof.synth.finds import GROUPS, Finds
from grashof.synth.path_finds import entries_of, judged, path_target
from grashof.synth.path_loop import Batch, PathTarget
from grashof.synth.path_search import PLACES, Placed, draw, improve, standing, with_places, within_limits
from grashof.synth.path_thinning import refined, thinned
from grashof.synth.setup import Setup
from grashof.synth.start import Round, Start

DRAWS, TIMED_DRAWS = 2000, 600
# How many of the best distinct go on, for how many steps, at what weight of the limits (in sizes).
STAGES = ((400, 8, 0.3), (200, 10, 1.0), (80, 30, 5.0))
FEW_TARGETS = 48  # of a longer task decide which finds are worth the rest
LONG, LONG_STEPS = 24, 10  # how many of these are improved on all targets
COPY = 0.01  # sizes: two linkages closer at three targets are one
# Starts of a round: the best, some of the others, and some of before the limits bear fully.
BEST, OTHERS, EARLY = 12, 4, 8
UNLIMITED = ("order", "same_branch", "keep_out", "constraints")  # no residual of the search stands for them
FOUND = 1e-5  # sizes: so small an error is none


@dataclass(frozen=True, slots=True)
class _Stage:
    """Linkages of the search, best first, and their errors with what limits add (n,), sizes."""

    finds: Finds
    error: FloatArray


def starts(setup: Setup, rng: np.random.Generator, size: int = 1) -> Round:
    """One round of starts.

    Parameters
    ----------
    setup : Setup
    rng : numpy.random.Generator
    size : int
        How many times the usual number of linkages to draw, and of starts to take.

    Returns
    -------
    Round
    """
    early, late = _search(setup, rng, size)
    chosen = [_start(setup, late, k) for k in range(min(size * BEST, len(late.error)))]
    rest = np.arange(len(chosen), len(late.error))
    chosen += [_start(setup, late, k) for k in _some(rng, rest, size * OTHERS)]
    if _ends_bind(setup):  # the search may shift the ends of the motion, the programme may not
        some = _some(rng, np.arange(len(early.error)), size * EARLY)
        chosen += [replace(_start(setup, early, k), promise=0.0) for k in some]
    return Round(chosen, {"feasible finds": int(late.finds.feasible.sum())})


def _search(setup: Setup, rng: np.random.Generator, size: int) -> tuple[_Stage, _Stage]:
    """Linkages after the first stage, and after the last one."""
    target = path_target(setup)
    some, index = thinned(target, FEW_TARGETS)
    with np.errstate(all="ignore"):
        batch = with_places(some, draw(some, size * (DRAWS if target.timing is None else TIMED_DRAWS), rng))
        early = batch
        for number, (keep, steps, weight) in enumerate(STAGES):
            model = within_limits(some, weight)
            error, _, _ = model(batch)
            batch = _best_distinct(some, batch, error, size * keep, drawn=number == 0)
            batch, error = improve(model, batch, steps, 0.0)
            if number == 0:
                early = batch
        batch = _best_distinct(some, batch, error, len(batch), drawn=False)
        if len(index) < len(target.points):
            batch = _on_all_targets(target, index, batch[: size * LONG])
            batch, _ = improve(within_limits(target, STAGES[-1][2]), batch, LONG_STEPS, 0.0)
            early = _on_all_targets(target, index, early)
        return _ranked(setup, target, early), _ranked(setup, target, batch)


def _on_all_targets(target: PathTarget, index: IntArray, batch: Batch) -> Batch:
    """Linkages that know the targets `index` with driver angles at every one, where they stand."""
    places = batch.unknowns[:, -PLACES:]
    inner = refined(target, index, replace(batch, unknowns=batch.unknowns[:, :-PLACES]))
    return replace(inner, unknowns=np.concatenate([inner.unknowns, places], axis=1))


def _ranked(setup: Setup, target: PathTarget, batch: Batch) -> _Stage:
    placed = standing(target, batch)
    error, _, _ = within_limits(target, STAGES[-1][2])(batch)
    sound = np.flatnonzero(np.isfinite(error) & np.isfinite(placed.error))
    finds = judged(setup, target, entries_of(placed, sound), batch.direction[sound])
    unlimited = [GROUPS.index(name) for name in UNLIMITED]
    merit = np.sqrt(error[sound] / len(setup.targets)) + finds.lacks[:, unlimited].sum(axis=1)
    order = np.argsort(merit, kind="stable")
    return _Stage(finds[order], merit[order])


def _best_distinct(target: PathTarget, batch: Batch, error: FloatArray, keep: int, *, drawn: bool) -> Batch:
    """At most `keep` linkages, least error first; of copies the better one. Draws have no copies."""
    order = np.argsort(error, kind="stable")
    order = order[np.isfinite(error[order])]
    if not drawn:
        order = order[_distinct(standing(target, batch[order]))]
    return batch[order[:keep]]


def _distinct(placed: Placed) -> IntArray:
    """Which linkages, best first, no better one is a copy of; by A, B, P at three targets."""
    count = placed.a.shape[1]
    at = [0, count // 2, count - 1]
    marks = np.concatenate([placed.a[:, at], placed.b[:, at], placed.p[:, at]], axis=1)
    numbers = np.concatenate([marks.real, marks.imag], axis=1).astype(np.float32)
    left: BoolArray = np.ones(len(numbers), dtype=bool)
    picked = []
    for k in range(len(numbers)):
        if left[k]:
            picked.append(k)
            left[left] = np.abs(numbers[left] - numbers[k]).max(axis=1) > COPY
    return np.array(picked, dtype=np.int64)


def _start(setup: Setup, stage: _Stage, index: int) -> Start:
    start = Start.of_find(stage.finds, index, setup.problem.objective)
    met = bool(stage.finds.feasible[index]) and stage.finds.error[index] < FOUND
    return replace(start, promise=float(stage.error[index]), settled=met)


def _some(rng: np.random.Generator, every: IntArray, count: int) -> list[int]:
    """A few at random, in their order."""
    picked = rng.permutation(len(every))[:count]
    chosen: list[int] = every[np.sort(picked)].tolist()
    return chosen


def _ends_bind(setup: Setup) -> bool:
    """Whether a limit depends on where the driver is at single targets."""
    wanted = setup.wanted
    over_task = wanted.transmission_over is TransmissionOver.TASK and not setup.closed
    return bool(over_task and wanted.transmission_min_deg > 0)
