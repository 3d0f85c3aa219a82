"""Which screened linkages become starts: the best, and the most different of the rest."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.synth.programme.start import Start
from grashof.synth.programme.user_functions import own_score
from grashof.synth.quantities.along_motion import ALONG, along_motion
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Many, Screened
from grashof.synth.quantities.wanted_torque import DEVIATIONS
from grashof.synth.theory.distinct import best_first, pick_apart, task_signature
from grashof.synth.theory.stopping import raise_if_overdue

POOL = 6000  # linkages among which starts are picked
PEAKS, PEAK_SPACING = 8, 0.25
VALLEYS = 24  # of deviations, which have more local optima than other goals
SPACINGS = (0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.06, 0.04, 0.03, 0.02, 0.015)
MISSES, MISS_SPACING = 40, 0.05  # starts from near misses, the nearest first
SETS, EACH = 3, 5  # sets of requirements that are missed by least, and starts of each
FEW = 512  # points up to which all pairs are compared
OTHERS = 10.0  # weight of other misses, where one requirement may be missed
NEARLY = 0.1  # linkages that violate no more are also spread over, for variety


def feasible_starts(
    scaled: ScaledProblem, linkages: Screened, enough: int, peaks: int | None = None, closer: float = 1.0
) -> list[Start]:
    """Starts from feasible linkages: the best well separated ones first (`peaks`), free to climb.

    Then about 1.4 times `enough` spread over all, each kept to its own neighbourhood so that the list offers
    a choice; by `closer`, below 1, they are nearer to each other than they could be, and better.
    """
    if not len(linkages):
        return []
    if peaks is None:
        peaks = PEAKS if DEVIATIONS.keys().isdisjoint(scaled.problem.objective.goals) else VALLEYS
    every = scores(scaled, linkages)
    pool = _pool(every)
    linkages, score = linkages[pool], every[pool]
    signatures = _signatures(scaled, linkages)
    spacing = PEAK_SPACING if scaled.exact else MISS_SPACING
    free = starts_of(scaled, linkages, pick_apart(signatures, score, spacing, peaks, raise_if_overdue))
    if not scaled.exact:  # what counts is the error, and a neighbourhood would only keep it large
        return free
    return free + _spread(scaled, linkages, score, signatures, enough, closer)


def mended_starts(scaled: ScaledProblem, linkages: Screened, enough: int) -> list[Start]:
    """Starts from near misses: the nearest first, then spread ones to be mended in place."""
    short = linkages[~linkages.feasible]
    shortfall = short.violations.sum(axis=1)
    score = -shortfall - short.error
    if not scaled.exact:
        return _distinct_starts(scaled, short, score, PEAKS)
    chosen = _distinct_starts(scaled, short, score, MISSES)
    nearly = feasible_starts(scaled, short[shortfall < NEARLY], enough)
    return chosen + [start.under(radius=np.inf, stay=True) for start in nearly]


def relaxed_starts(scaled: ScaledProblem, linkages: Screened) -> list[Start]:
    """Starts that may miss what no linkage meets: one requirement where one is enough, else a few."""
    missed = linkages.violations > 0
    fewest = missed.sum(axis=1).min(initial=len(GROUPS))
    if not len(linkages) or fewest == 0:  # feasible but not solved: nothing to relax
        return []
    rows = np.flatnonzero(missed.sum(axis=1) == fewest)
    sets, which = np.unique(missed[rows], axis=0, return_inverse=True)
    found = []
    for number, together in enumerate(sets):
        mine = linkages[rows[which.ravel() == number]]
        lacking = mine.violations.sum(axis=1)
        found.append((lacking.min(), tuple(np.array(GROUPS)[together].tolist()), mine, lacking))
    found.sort(key=lambda item: item[:2])  # the set that is missed least first
    return [
        start.under(relaxed=names)
        for _, names, mine, lacking in found[:SETS]
        for start in _distinct_starts(scaled, mine, -lacking, EACH)
    ]


def closest_starts(scaled: ScaledProblem, linkages: Screened, group: str, most: int) -> list[Start]:
    """Starts from linkages that miss one requirement by little, and no other one if possible."""
    violations = linkages.violations[:, GROUPS.index(group)]
    others = linkages.violations.sum(axis=1) - violations
    return _distinct_starts(scaled, linkages, -violations - OTHERS * others - linkages.error, most)


def starts_of(scaled: ScaledProblem, linkages: Screened, picked: IntArray) -> list[Start]:
    """Starts at some of the linkages."""
    return [Start.of_screened(linkages, int(index), scaled.objective) for index in picked]


def _spread(
    scaled: ScaledProblem, linkages: Screened, score: FloatArray, signatures: FloatArray, enough: int,
    closer: float,
) -> list[Start]:  # fmt: skip
    """Linkages as far apart as possible, or closer, with neighbourhoods that do not overlap."""
    wanted = enough + (2 * enough + 4) // 5
    picked = np.zeros(0, dtype=np.int64)
    for spacing in SPACINGS:
        picked = pick_apart(signatures, score, spacing, wanted, raise_if_overdue)
        if len(picked) == wanted:
            if closer < 1:
                picked = pick_apart(signatures, score, closer * spacing, wanted, raise_if_overdue)
            break
    points = linkages.points[picked]
    coordinates = np.concatenate([points.real, points.imag], axis=1)
    nearest = to_nearest(coordinates)
    starts = starts_of(scaled, linkages, picked)
    return [one.under(radius=float(0.4 * gap)) for one, gap in zip(starts, nearest, strict=True)]


def to_nearest(coordinates: FloatArray) -> FloatArray:
    """Distance of points (n, C) from the nearest others, by the coordinate that differs most; up to 1."""
    if len(coordinates) <= FEW:
        pairs = np.abs(coordinates[:, None] - coordinates).max(axis=-1, initial=0.0)
        np.fill_diagonal(pairs, np.inf)
        apart = pairs.min(axis=-1, initial=np.inf)
    else:
        from scipy.spatial import cKDTree  # takes longer to import than many a search

        # a tree in place of all pairs, where there are many
        apart = np.asarray(cKDTree(coordinates).query(coordinates, k=2, p=np.inf)[0])[:, 1]
    nearest: FloatArray = np.minimum(apart, 1.0)
    return nearest


def _distinct_starts(scaled: ScaledProblem, linkages: Screened, score: FloatArray, most: int) -> list[Start]:
    best = _pool(score)
    apart = pick_apart(_signatures(scaled, linkages[best]), score[best], MISS_SPACING, most, raise_if_overdue)
    return starts_of(scaled, linkages, best[apart])


def _pool(score: FloatArray) -> IntArray:
    """At most `POOL` indices: the best half of them, and evenly many of the rest, best first."""
    order = best_first(score)
    if len(order) <= POOL:
        return order
    top, rest = order[: POOL // 2], order[POOL // 2 :]
    return np.concatenate([top, rest[:: -(-len(rest) // (POOL // 2))]])


def _signatures(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    return task_signature(scaled.problem.task, scaled.linkages(linkages.points, linkages.assembly))


def scores(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    """Score of each linkage; its size is that of a box around its known points at the first target."""
    if not scaled.exact:
        return -linkages.error
    if scaled.own_objective is not None:
        return own_score(scaled, linkages, scaled.own_objective)
    score = np.zeros(len(linkages))
    for key, weight in scaled.problem.objective.weights:
        score += weight * _worth(scaled, linkages, key)
    return score


def _worth(scaled: ScaledProblem, linkages: Screened, key: str) -> FloatArray:
    """The value of a quantity to the objective, greater is better."""
    worth: FloatArray = np.zeros(len(linkages))
    if key == "transmission":
        worth = linkages.transmission / (np.pi / 2)
    elif key == "size":
        known = [0, 1, 2, 3, 4] if "o4" in scaled.kind.linkage.mechanism.ground else [0, 2, 3, 4]
        points = linkages.points[:, known]
        worth = -np.hypot(np.ptp(points.real, axis=1), np.ptp(points.imag, axis=1))
    elif key in (*ALONG, *DEVIATIONS):
        ways = linkages.theta2, linkages.direction, linkages.assembly
        worth = QUANTITIES[key].better * along_motion(scaled, key, linkages.points, *ways)
    elif key in scaled.kind.formulas:
        (part,) = scaled.kind.formulas[key]
        o2, o4, a, b, p = linkages.points.T
        pairs = Many(p, o2, a[:, None], o4, b[:, None], linkages.theta2, kind=scaled.kind)
        value = part.of(pairs)[:, 0]
        worth = QUANTITIES[key].better * value / scaled.scale(QUANTITIES[key])
    return worth
