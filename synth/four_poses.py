"""Starts for motion generation through four exact poses: both dyad curves, all their pairs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems import Objective, ProblemError
from grashof.problems.checks import BoolArray, FloatArray, IntArray
from grashof.synth.burmester import Dyads, trace_four_pose_curves
from grashof.synth.distinct import pick_apart, signature
from grashof.synth.result import weigh
from grashof.synth.screen import GROUPS, Pairs, near_misses, screen
from grashof.synth.setup import Setup
from grashof.synth.start import Start

LINES, CELL = 800, 0.01  # of the traced curves, in sizes
PAIRS, NEAR_PAIRS = 1_000_000, 150_000  # judged
POOL = 6000  # feasible pairs among which starts are picked
PEAKS, PEAK_SPACING = 8, 0.25
SPACINGS = (0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.06, 0.04, 0.03, 0.02, 0.015)
MISSES, MISS_SPACING = 40, 0.05  # starts from pairs that lack something, the least first
NEARLY = 0.1  # pairs that lack no more are also spread over, for variety
UNSOLVED = frozenset({"order", "same_branch"})  # no smooth constraint can relax these


def degenerate(setup: Setup) -> str:
    """Why four poses have no dyad curves; empty when they have.

    Raises
    ------
    ProblemError
        Two of the poses are equal.
    """
    motion = setup.motion
    for i in range(4):
        for j in range(i + 1, 4):
            same = np.abs(motion.rotation[i] - motion.rotation[j]) + np.abs(motion.shift[i] - motion.shift[j])
            if same < 1e-12:
                raise ProblemError(
                    f"motion.poses[{i}] and motion.poses[{j}] are equal; "
                    "this version synthesises four distinct poses"
                )
    turn = motion.rotation[1:] - 1
    if np.abs(turn).max() < 1e-9:
        return (
            "the poses are pure translations of each other: only parallelogram linkages, "
            "which have a change point, could carry the body through them"
        )
    widest = 1 + int(np.argmax(np.abs(turn)))
    pole = motion.shift[widest] / (1 - motion.rotation[widest])
    if np.abs(motion.apply(np.array([pole]))[0] - pole).max() < 1e-9:
        x, y = setup.frame.outward(np.array(pole))
        return f"the poses are a pure rotation about ({x:.6g}, {y:.6g}): a single pivot there does the job"
    return ""


def starts(setup: Setup, most: int, enough: int, rng: np.random.Generator) -> tuple[list[Start], int]:
    """Starts for the solver, in the order in which to solve them, and the number of feasible pairs.

    The best well separated pairs first, free to climb to the best optima, then pairs spread over
    all feasible ones, each kept to its own neighbourhood so that the list offers a choice, then
    pairs that nearly do.

    Parameters
    ----------
    setup : Setup
    most : int
        Starts.
    enough : int
        Distinct designs wanted.
    rng : numpy.random.Generator
    """
    dyads = _dyads(setup, rng)
    feasible = screen(setup.motion, setup.body, dyads, setup.wanted, PAIRS)
    chosen = _peaks_and_spread(setup, feasible, enough)
    if len(chosen) < min(most, enough):
        near = near_misses(setup.motion, setup.body, dyads, setup.wanted, NEAR_PAIRS)
        near = near[~near.feasible]
        shortfall = near.lacks.sum(axis=1)
        chosen += _distinct_starts(setup, near, -shortfall, MISSES)
        near = near[shortfall < NEARLY]
        if len(near):
            spread = _peaks_and_spread(setup, near, enough)
            chosen += [replace(start, radius=np.inf, stay=True) for start in spread]
    return chosen[:most], len(feasible)


def relaxed_starts(setup: Setup, rng: np.random.Generator, groups: int = 3, each: int = 5) -> list[Start]:
    """Starts that may miss what stands in the way: one requirement where one is enough, else a few."""
    near = near_misses(setup.motion, setup.body, _dyads(setup, rng), setup.wanted, NEAR_PAIRS)
    if not len(near):
        return []
    missed = near.lacks > 0
    fewest = missed.sum(axis=1).min()
    if fewest == 0:  # feasible but not solved: nothing to relax
        return []
    chosen: list[Start] = []
    for combination, rows in _combinations(near, missed, int(fewest))[:groups]:
        part = near[rows]
        picked = _distinct_starts(setup, part, -part.lacks.sum(axis=1), each)
        chosen += [replace(start, relaxed=combination) for start in picked]
    return chosen


def _combinations(near: Pairs, missed: BoolArray, fewest: int) -> list[tuple[tuple[str, ...], IntArray]]:
    """Sets of `fewest` requirements that pairs miss, with those pairs; the least missed set first."""
    rows = np.flatnonzero(missed.sum(axis=1) == fewest)
    kinds, which = np.unique(missed[rows], axis=0, return_inverse=True)
    which = which.ravel()
    found = []
    for number, kind in enumerate(kinds):
        mine = rows[which == number]
        least = near.lacks[mine].sum(axis=1).min()
        found.append((least, tuple(np.array(GROUPS)[kind].tolist()), mine))
    found.sort(key=lambda item: (item[0], item[1]))
    return [(names, mine) for _, names, mine in found]


def _dyads(setup: Setup, rng: np.random.Generator) -> Dyads:
    longest = max(limits[1] for limits in setup.wanted.link_lengths)
    arms = setup.wanted.coupler_arms or (0.0, np.inf)
    reach = min(1.0 + 1.2 * (arms[1] + longest), 200.0)
    return trace_four_pose_curves(setup.motion, reach, LINES, CELL, phase=float(rng.uniform(0.1, 0.9)))


def _peaks_and_spread(setup: Setup, pairs: Pairs, enough: int) -> list[Start]:
    if not len(pairs):
        return []
    pairs = pairs[_pool(_merit(setup, pairs))]
    merit, signatures = _merit(setup, pairs), _signatures(setup, pairs)
    peaks = pick_apart(signatures, merit, PEAK_SPACING, PEAKS)
    free = [Start.of_pair(pairs, int(index), setup.problem.objective) for index in peaks]
    return free + _spread(setup, pairs, merit, signatures, enough)


def _spread(
    setup: Setup, pairs: Pairs, merit: FloatArray, signatures: FloatArray, enough: int
) -> list[Start]:
    """About 1.4 times `enough` pairs as far apart as can be, with neighbourhoods that do not overlap."""
    wanted = enough + (2 * enough + 4) // 5
    picked, spacing = np.zeros(0, dtype=np.int64), 0.0
    for spacing in SPACINGS:
        picked = pick_apart(signatures, merit, spacing, wanted)
        if len(picked) == wanted:
            break
    points = pairs.points[picked]
    coordinates = np.concatenate([points.real, points.imag], axis=1)
    gap = np.abs(coordinates[:, None] - coordinates).max(axis=2) + np.where(
        np.eye(len(picked)) > 0, np.inf, 0
    )
    nearest = gap.min(axis=1, initial=1.0)
    return [
        replace(Start.of_pair(pairs, int(index), setup.problem.objective), radius=float(0.4 * distance))
        for index, distance in zip(picked, nearest, strict=True)
    ]


def _distinct_starts(setup: Setup, pairs: Pairs, merit: FloatArray, most: int) -> list[Start]:
    best = _pool(merit)
    picked = best[pick_apart(_signatures(setup, pairs[best]), merit[best], MISS_SPACING, most)]
    return [Start.of_pair(pairs, int(index), setup.problem.objective) for index in picked]


def _pool(merit: FloatArray) -> IntArray:
    """At most `POOL` indices: the best half of them, and evenly many of the rest, best first."""
    order = np.argsort(-merit, kind="stable")
    if len(order) <= POOL:
        return order
    top, rest = order[: POOL // 2], order[POOL // 2 :]
    return np.concatenate([top, rest[:: -(-len(rest) // (POOL // 2))]])


def _signatures(setup: Setup, pairs: Pairs) -> FloatArray:
    return signature(setup.linkages(pairs.points, pairs.assembly))


def _merit(setup: Setup, pairs: Pairs) -> FloatArray:
    objective: Objective = setup.problem.objective
    size = np.zeros(len(pairs))
    if objective.compactness > 0:
        places = [setup.motion.apply(side.moving) for side in (pairs.driver, pairs.driven)]
        body = setup.motion.apply(np.full(len(pairs), setup.body))
        every = np.concatenate([*places, body, pairs.points[:, :2]], axis=1)
        size = np.hypot(np.ptp(every.real, axis=1), np.ptp(every.imag, axis=1))
    return weigh(objective, pairs.transmission, size)
