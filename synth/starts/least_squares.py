"""Starts of least squares: linkages feasible by construction, placed best on the targets.

Where the best of them break a limit, places become unknowns, and oversteps of limits count as errors that
grow from stage to stage: so the search ends where the programme does, for any active limits.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems import TransmissionOver
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.programme.start import Round, Start
from grashof.synth.quantities.formulas import FORMULAS
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Screened
from grashof.synth.starts.closed_loop import Batch, SearchTargets, joined
from grashof.synth.starts.coupler_search import FOUND, CouplerSearch
from grashof.synth.starts.every_target import costs_of_all, fitted_to_all
from grashof.synth.starts.loop_search import (
    PLACES,
    Placed,
    WithinLimits,
    draw,
    fitting,
    improve,
    judged,
    place,
    standing,
    with_places,
)
from grashof.synth.starts.thinning import refined, thinned
from grashof.synth.theory.stopping import raise_if_overdue

DRAWS, TIMED_DRAWS = 2000, 600  # of a round; twice as many where limits bind, whose minima are narrower
ASTRAY = 0.3  # share of them on which P makes a detour between two targets
MANY_TARGETS, FEW_TARGETS = 40, 16  # of a longer task a few decide which linkages are worth the rest
# Where no limit binds: numbers of the best that continue, and their steps.
FREE_STAGES, TIMED_STAGES = ((200, 6), (60, 10), (20, 50)), ((60, 6), (20, 60))
MOST_CURVES = 6  # starts of such a round
# Times the least error: starts with a greater expected error are not solved; where the search may shift the
# ends of the motion, it is a little off.
NEAR_BEST, NEAR_BEST_SHIFTED = 1.6, 2.0
SAME_ERROR = 1e-3  # share: a feasible linkage nearer to the best one shows that no limit binds
SAME_CURVE = 0.1  # of the rms error: two linkages closer at every target are one
# Where limits bind: numbers of the best distinct ones that continue, their steps, and the weight of the
# limits (in sizes). All but the first follow the valleys along limits, which are narrow, by bent steps.
STAGES = ((600, 6, 1.0), (200, 60, 5.0))
LONG, LONG_STEPS = 24, 20  # linkages of a thinned task that are improved on all targets, and their steps
LAST_STEPS = 200  # and the best of them until little is gained
LAST_WEIGHT = 300.0  # of limits, which then are kept but for rounding
COPY = 0.01  # sizes: two linkages closer at three targets are one
# Starts of a round: the best, some of the others, and some from before the limits apply fully; fewer on
# tasks of more targets than `AMPLE`, whose solves take longer.
BEST, OTHERS, EARLY = 12, 4, 8
AMPLE, FEWEST = 24, 0.25
# No residual of the search represents these.
UNLIMITED = (
    *("order", "same_branch", "keep_out", "constraints"),
    *(
        name
        for name, limit in LIMITS.items()
        if all(part.fixed for part in FORMULAS.get(limit.quantity.key, ()))
        and limit.quantity.key != "transmission"
    ),
)


class LeastSquares(CouplerSearch):
    """Targets that may be missed."""

    def round(self, _number: int, _enough: int, rng: np.random.Generator, size: int, /) -> Round:
        """A round of `size` times the usual number of draws and starts; there is always another one."""
        scaled, target = self.scaled, SearchTargets.of(self.scaled)
        some, index = _thinned(target)
        drawn = draw(some, size * (TIMED_DRAWS if target.timed else DRAWS), rng, ASTRAY)
        best = _best_fitting(some, drawn, size)
        # the deviation from a wanted torque depends on the place
        unbound = target.torque is None
        free = _free_round(scaled, _on_all_targets(target, index, best, size), size) if unbound else None
        return free or _limited_round(scaled, rng, drawn, best, size)


def _thinned(target: SearchTargets) -> tuple[SearchTargets, IntArray]:
    """The targets that the search begins with, and their indices."""
    long = len(target.points) > MANY_TARGETS
    return thinned(target, FEW_TARGETS if long else MANY_TARGETS)


def _best_fitting(some: SearchTargets, drawn: Batch, size: int) -> Batch:
    """Of some linkages those that fit best, improved, whether they keep the limits or not."""
    batch = drawn
    with np.errstate(all="ignore"):
        error = place(some, batch).error
        for keep, steps in TIMED_STAGES if some.timed else FREE_STAGES:
            best = np.argsort(error, kind="stable")[: size * keep]
            batch, error = improve(fitting(some), batch[best], steps, 0.0)
        return batch[np.argsort(error, kind="stable")]


def _on_all_targets(target: SearchTargets, index: IntArray, batch: Batch, size: int) -> Batch:
    """Linkages that know the targets `index` with driver angles at every one, improved there."""
    if len(index) == len(target.points):
        return batch
    batch = refined(target, index, batch)
    with np.errstate(all="ignore"):
        if target.timed:
            return improve(fitting(target), batch, LONG_STEPS, 0.0)[0]
        batch = fitted_to_all(target, batch)
        best = np.argsort(place(target, batch).error, kind="stable")
        few, rest = np.split(best, [size * MOST_CURVES])
        return joined(fitted_to_all(target, batch[few], LAST_STEPS), batch[rest])


def _free_round(scaled: ScaledProblem, batch: Batch, size: int) -> Round | None:
    """Starts from linkages that fit best; None where the best of them break a limit."""
    target = SearchTargets.of(scaled)
    with np.errstate(all="ignore"):
        placed = place(target, batch)
    sound = np.isfinite(placed.error)
    linkages = judged(scaled, target, placed[sound], batch.direction[sound])
    least = linkages.error.min(initial=np.inf)
    useful = max(NEAR_BEST * least, scaled.of_use)
    feasible = linkages[linkages.feasible & (linkages.error <= useful)]
    if not len(feasible) or feasible.error.min() > max(least * (1 + SAME_ERROR), FOUND):
        return None
    order = np.argsort(feasible.error, kind="stable")
    starts = [_start(scaled, feasible, feasible.error, int(k)) for k in order]
    if target.timed and len(target.points) > MANY_TARGETS and not scaled.every_constraint:
        starts = [start.under(settled=True) for start in starts]  # as `_start` has it of the untimed
    counts, reached = {"feasible finds": len(feasible)}, _as_good(placed.error)
    most = size * MOST_CURVES * (2 if scaled.of_use else 1)
    return Round(_other_curves(starts, most), counts, size, NEAR_BEST, free=True, reached=reached)


def _as_good(square: FloatArray) -> int:
    """The number of linkages whose squared error is the least."""
    return int(np.count_nonzero(square <= np.nanmin(square, initial=np.inf) * (1 + SAME_ERROR) ** 2))


def _other_curves(starts: list[Start], most: int) -> list[Start]:
    """Starts that pass the targets along another curve than all before; cognates are added afterwards."""
    chosen, curves = list[Start](), list[ComplexArray]()
    for start in starts:
        order = np.argsort(start.visit)
        p = start.track[2][order]
        near = SAME_CURVE * max(start.expected_error, FOUND)
        if len(chosen) < most and all(np.abs(p - other).max() > near for other in curves):
            chosen.append(start)
            curves.append(p)
    return chosen


def _limited_round(
    scaled: ScaledProblem, rng: np.random.Generator, drawn: Batch, best: Batch, size: int
) -> Round:
    """Starts of the search under every limit, from drawn linkages and those that fit best."""
    more = draw(_thinned(SearchTargets.of(scaled))[0], len(drawn), rng, ASTRAY)
    before_limits, found, reached = _search(scaled, joined(drawn, more), best, size)
    linkages, error = _ranked(scaled, found)
    share = size * min(1.0, max(AMPLE / len(scaled.targets), FEWEST))
    first, others, before = (round(share * count) for count in (BEST, OTHERS, EARLY))
    chosen = [_start(scaled, linkages, error, k) for k in range(min(first, len(error)))]
    rest = np.arange(len(chosen), len(error))
    chosen += [_start(scaled, linkages, error, k) for k in _some(rng, rest, others)]
    prune = NEAR_BEST
    if _ends_bind(scaled):  # the search may shift the ends of the motion, the programme may not
        early, error = _ranked(scaled, before_limits)
        some = _some(rng, np.arange(len(error)), before)
        chosen += [
            replace(_start(scaled, early, error, k), expected_error=0.0).under(settled=False) for k in some
        ]
        prune = NEAR_BEST_SHIFTED
    counts = {"feasible finds": int(linkages.feasible.sum())}
    return Round(chosen, counts, size, prune, reached=reached)


def _search(scaled: ScaledProblem, drawn: Batch, best: Batch, size: int) -> tuple[Batch, Batch, int]:
    """Linkages after the first stage and after the last one, and how many of these led to the best."""
    target = SearchTargets.of(scaled)
    some, index = _thinned(target)
    with np.errstate(all="ignore"):
        batch = early = with_places(some, joined(drawn, best))
        for number, (keep, steps, weight) in enumerate(STAGES):
            model, first = WithinLimits(some, weight), number == 0
            raise_if_overdue()
            batch = _best_distinct(some, batch, model.errors(batch), size * keep, drawn=first)
            batch, error = improve(model, batch, steps, 0.0, missed=None if first else model.missed)
            if first:
                early = batch
        reached = _as_good(error)
        batch = _best_distinct(some, batch, error, len(batch), drawn=False)
        if len(index) < len(target.points):
            batch = _with_places_refined(target, index, batch[: size * LONG])
            weight = STAGES[-1][2]
            if target.timed:
                batch, _ = improve(WithinLimits(target, weight), batch, LONG_STEPS, 0.0)
            else:
                batch = fitted_to_all(target, batch, weight=weight, placed=True)
                order = np.argsort(costs_of_all(target, batch, weight), kind="stable")
                few = batch[order[: size * MOST_CURVES]]
                batch = fitted_to_all(target, few, LAST_STEPS, weight=LAST_WEIGHT, placed=True)
            early = _with_places_refined(target, index, early[:: -(-len(early) // LONG) or 1])
        return early, batch, reached


def _with_places_refined(target: SearchTargets, index: IntArray, batch: Batch) -> Batch:
    """Linkages that know the targets `index` with driver angles at every one, where they stand."""
    places = batch.unknowns[:, -PLACES:]
    z = places.reshape(-1, PLACES // 2, 2) @ np.array([1, 1j])
    inner = refined(target, index, replace(batch, unknowns=batch.unknowns[:, :-PLACES]), z)
    return replace(inner, unknowns=np.concatenate([inner.unknowns, places], axis=1))


def _ranked(scaled: ScaledProblem, batch: Batch) -> tuple[Screened, FloatArray]:
    """Linkages of the search, best first, and their errors with what limits add (n,), sizes."""
    target = SearchTargets.of(scaled)
    placed = standing(target, batch)
    if _all_fitted(target):
        with np.errstate(all="ignore"):
            error = costs_of_all(target, batch, STAGES[-1][2])
    else:
        error = WithinLimits(target, STAGES[-1][2]).errors(batch)
    sound = np.flatnonzero(np.isfinite(error) & np.isfinite(placed.error))
    linkages = judged(scaled, target, placed[sound], batch.direction[sound])
    unlimited = [GROUPS.index(name) for name in UNLIMITED]
    score = np.sqrt(error[sound] / len(scaled.targets)) + linkages.violations[:, unlimited].sum(axis=1)
    order = np.argsort(score, kind="stable")
    return linkages[order], score[order]


def _best_distinct(
    target: SearchTargets, batch: Batch, error: FloatArray, keep: int, *, drawn: bool
) -> Batch:
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


def _start(scaled: ScaledProblem, linkages: Screened, error: FloatArray, index: int) -> Start:
    start = Start.of_screened(linkages, index, scaled.objective)
    fitted = _all_fitted(SearchTargets.of(scaled)) and not scaled.every_constraint
    met = bool(linkages.feasible[index]) and max(linkages.error[index], error[index]) < FOUND
    return replace(start, expected_error=float(error[index])).under(settled=met or fitted)


def _all_fitted(target: SearchTargets) -> bool:
    """Whether the search itself fits linkages to all of many targets, so that a programme gains nothing."""
    return len(target.points) > MANY_TARGETS and not target.timed


def _some(rng: np.random.Generator, every: IntArray, count: int) -> list[int]:
    """A few at random, in their order."""
    picked = rng.permutation(len(every))[:count]
    chosen: list[int] = every[np.sort(picked)].tolist()
    return chosen


def _ends_bind(scaled: ScaledProblem) -> bool:
    """Whether a limit depends on the driver angle at single targets."""
    wanted = scaled.wanted
    over_task = wanted.transmission_over is TransmissionOver.TASK and not scaled.closed
    return bool(over_task and wanted.transmission_min_deg > 0)
