"""Which finds of a search become starts: the best, and the most different of the rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.problems.values.requirements import QUANTITIES
from grashof.synth.programme.along_motion import ALONG, SCREENED, magnitudes
from grashof.synth.programme.formulas import FORMULAS
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import GROUPS, Many, Screened
from grashof.synth.programme.start import Start
from grashof.synth.theory.distinct import pick_apart, signature

POOL = 6000  # finds among which starts are picked
PEAKS, PEAK_SPACING = 8, 0.25
SPACINGS = (0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.06, 0.04, 0.03, 0.02, 0.015)
MISSES, MISS_SPACING = 40, 0.05  # starts from near misses, the nearest first
OTHERS = 10.0  # weight of what else is missed, where one requirement may be
NEARLY = 0.1  # finds that lack no more are also spread over, for variety


def feasible_starts(scaled: ScaledProblem, finds: Screened, enough: int) -> list[Start]:
    """Starts from feasible linkages.

    The best well separated ones first, free to climb to the best optima, then about 1.4 times
    `enough` spread over all, each kept to its own neighbourhood so that the list offers a choice.
    """
    if not len(finds):
        return []
    every = merits(scaled, finds)
    pool = _pool(every)
    finds, merit = finds[pool], every[pool]
    signatures = _signatures(scaled, finds)
    spacing = PEAK_SPACING if scaled.exact else MISS_SPACING
    peaks = pick_apart(signatures, merit, spacing, PEAKS)
    free = [Start.of_find(finds, int(index), scaled.problem.objective) for index in peaks]
    if not scaled.exact:  # what counts is the error, and a neighbourhood would only keep it large
        return free
    return free + _spread(scaled, finds, merit, signatures, enough)


def mended_starts(scaled: ScaledProblem, finds: Screened, enough: int) -> list[Start]:
    """Starts from near misses: the nearest first, then spread ones to be mended in place."""
    short = finds[~finds.feasible]
    shortfall = short.violations.sum(axis=1)
    merit = -shortfall - short.error
    if not scaled.exact:
        return _distinct_starts(scaled, short, merit, PEAKS)
    chosen = _distinct_starts(scaled, short, merit, MISSES)
    nearly = feasible_starts(scaled, short[shortfall < NEARLY], enough)
    return chosen + [replace(start, radius=np.inf, stay=True) for start in nearly]


def relaxed_starts(scaled: ScaledProblem, finds: Screened, groups: int = 3, each: int = 5) -> list[Start]:
    """Starts that may miss what stands in the way: one requirement where one is enough, else a few."""
    if not len(finds):
        return []
    missed = finds.violations > 0
    fewest = missed.sum(axis=1).min()
    if fewest == 0:  # feasible but not solved: nothing to relax
        return []
    chosen: list[Start] = []
    for combination, rows in _combinations(finds, missed, int(fewest))[:groups]:
        part = finds[rows]
        picked = _distinct_starts(scaled, part, -part.violations.sum(axis=1), each)
        chosen += [replace(start, relaxed=combination) for start in picked]
    return chosen


def _combinations(finds: Screened, missed: BoolArray, fewest: int) -> list[tuple[tuple[str, ...], IntArray]]:
    """Sets of `fewest` requirements that finds miss, with those finds; the least missed set first."""
    rows = np.flatnonzero(missed.sum(axis=1) == fewest)
    kinds, which = np.unique(missed[rows], axis=0, return_inverse=True)
    which = which.ravel()
    found = []
    for number, kind in enumerate(kinds):
        mine = rows[which == number]
        least = finds.violations[mine].sum(axis=1).min()
        found.append((least, tuple(np.array(GROUPS)[kind].tolist()), mine))
    found.sort(key=lambda item: (item[0], item[1]))
    return [(names, mine) for _, names, mine in found]


def _spread(
    scaled: ScaledProblem, finds: Screened, merit: FloatArray, signatures: FloatArray, enough: int
) -> list[Start]:
    """Screened as far apart as can be, with neighbourhoods that do not overlap."""
    wanted = enough + (2 * enough + 4) // 5
    picked, spacing = np.zeros(0, dtype=np.int64), 0.0
    for spacing in SPACINGS:
        picked = pick_apart(signatures, merit, spacing, wanted)
        if len(picked) == wanted:
            break
    points = finds.points[picked]
    coordinates = np.concatenate([points.real, points.imag], axis=1)
    gap = np.abs(coordinates[:, None] - coordinates).max(axis=2) + np.where(
        np.eye(len(picked)) > 0, np.inf, 0
    )
    nearest = gap.min(axis=1, initial=1.0)
    return [
        replace(Start.of_find(finds, int(index), scaled.problem.objective), radius=float(0.4 * distance))
        for index, distance in zip(picked, nearest, strict=True)
    ]


def _distinct_starts(scaled: ScaledProblem, finds: Screened, merit: FloatArray, most: int) -> list[Start]:
    best = _pool(merit)
    picked = best[pick_apart(_signatures(scaled, finds[best]), merit[best], MISS_SPACING, most)]
    return [Start.of_find(finds, int(index), scaled.problem.objective) for index in picked]


def _pool(merit: FloatArray) -> IntArray:
    """At most `POOL` indices: the best half of them, and evenly many of the rest, best first."""
    order = np.argsort(-merit, kind="stable")
    if len(order) <= POOL:
        return order
    top, rest = order[: POOL // 2], order[POOL // 2 :]
    return np.concatenate([top, rest[:: -(-len(rest) // (POOL // 2))]])


def _signatures(scaled: ScaledProblem, finds: Screened) -> FloatArray:
    origin = np.array([scaled.frame.origin.real, scaled.frame.origin.imag])
    return signature(scaled.linkages(finds.points, finds.assembly), origin)


def merits(scaled: ScaledProblem, finds: Screened) -> FloatArray:
    """Score of each find; its size is that of a box around what is known of it at the first target."""
    if not scaled.exact:
        return -finds.error
    score = np.zeros(len(finds))
    for key, weight in scaled.problem.objective.weights:
        score += weight * _worth(scaled, finds, key)
    return score


def _worth(scaled: ScaledProblem, finds: Screened, key: str) -> FloatArray:
    """What the objective counts a quantity as, greater is better; nothing where the search has no formula."""
    if key == "transmission":
        return finds.transmission / (np.pi / 2)
    if key == "size":
        return -np.hypot(np.ptp(finds.points.real, axis=1), np.ptp(finds.points.imag, axis=1))
    if key in ALONG:
        ways = finds.theta2, finds.direction, finds.assembly
        return -magnitudes(scaled.problem, key, finds.points, *ways, SCREENED).max(axis=1)
    if key in FORMULAS:
        (part,) = FORMULAS[key]
        o2, o4, a, b, p = finds.points.T
        value: FloatArray = part.of(Many(p, o2, a[:, None], o4, b[:, None]))[:, 0]
        return QUANTITIES[key].better * value / scaled.scale(QUANTITIES[key])
    return np.zeros(len(finds))


def closest_starts(scaled: ScaledProblem, finds: Screened, group: str, most: int) -> list[Start]:
    """Starts from finds that lack little of one requirement, and nothing of the others if that can be."""
    violations = finds.violations[:, GROUPS.index(group)]
    others = finds.violations.sum(axis=1) - violations
    return _distinct_starts(scaled, finds, -violations - OTHERS * others - finds.error, most)
