"""The search for function generators whose input is the lengthening of a cylinder on the driver.

With a triangle of O2 and the pivots of the cylinder, the task becomes one in driver angles: through few pairs
the linkages are known; for more pairs, the best fits under some triangles are fitted together with these.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.pairs import NEAR, Pairs, expected_score, through_pairs
from grashof.synth.theory.functions.by_cylinder import ByCylinder
from grashof.synth.theory.functions.fit import DesiredOutput, best_apart, fitted
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.optima import Aim, refined
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.starts import few_starts
from grashof.synth.theory.functions.triangle import turned_by
from grashof.synth.theory.stopping import StopRequested, stop_requested

TRIANGLES = 240  # from which least squares begins
ENDS, LONG = 12, 120  # of the best fits that are refined where pairs are met, and the steps of each
HALVINGS, RAISED = 6, 3  # of the transmission angle where freedom is left, and fits that are refined
EACH = 6  # starts that continue under each triangle
APART = 0.3  # distance between them, as in `best_apart`
# Triangles that are tried for pairs that are met, by their number, and the effort of each.
TRIED = {3: (48, 0.02), 4: (36, 0.03), 5: (400, 1.0)}
KEPT = 12  # of the most promising linkages under each triangle
ZOOMED, ZOOMS = 8, 2  # best triangles around which others are tried, and number of such rounds


def through_by_cylinder(
    aims: FunctionAims, sense: int, driver: int, rng: np.random.Generator, effort: float
) -> Generators:
    """All that are found through the pairs and keep the limits."""
    kind, pairs = _kind(aims), Pairs.of(aims, sense, driver)
    if len(aims.task) <= kind.by_angle.EXACT:
        pool = _by_triangles(aims, sense, driver, rng, effort)
        if len(pool) or stop_requested():
            return pool
    starts = driven_starts(aims, pairs.desired, rng, effort)
    found = _met(pairs, starts, pairs.limits, ENDS)
    return found if len(aims.task) == kind.EXACT else _raised(pairs, found, effort)


def _met(pairs: Pairs, starts: Generators, limits: ShapeLimits, most: int) -> Generators:
    """Those that meet all pairs within limits: the best of many starts, refined where too few do."""
    within = replace(pairs, limits=limits)
    near, _ = fitted(pairs.desired, starts, limits.of)
    found = within.kept(near)
    if len(found) < most:
        with suppress(StopRequested):
            ends = refined(Aim(pairs.desired, limits), near[:most], LONG)
            found = found.joined([found, ends.generators])
    return within.kept(found)


def _raised(pairs: Pairs, found: Generators, effort: float) -> Generators:
    """Some designs, and others with ever greater transmission angles, by halving."""
    span = pairs.limits.span
    pool, low, high = found, -1.0, float(np.pi / 2)
    for _ in range(round(HALVINGS * min(effort, 1.0))):
        if not len(pool) or stop_requested():
            break
        worst = np.arccos(np.minimum(pool.worst_cosine(span), 1.0))
        low, best = max(low, float(worst.max())), pool[np.argsort(-worst, kind="stable")[:ZOOMED]]
        level = (low + high) / 2
        more = _met(pairs, best, replace(pairs.limits, transmission=level), RAISED)
        high = high if len(more) else level
        pool = pool.joined([pool, more])
    return pool


def _by_triangles(
    aims: FunctionAims, sense: int, driver: int, rng: np.random.Generator, effort: float
) -> Generators:
    """Through few pairs: under random triangles, then under those near the best ones."""
    limits, kind = aims.triangle, _kind(aims)
    pool = kind.joined([])
    if limits is None:
        return pool
    count, share = TRIED[len(aims.task)]
    about: FloatArray | None = None
    for _ in range(1 + ZOOMS):
        found = [pool]
        for triangle in limits.drawn(rng, max(1, round(count * effort)), about):
            if stop_requested():
                break
            by_angle = aims.under(triangle)
            made = through_pairs(by_angle, sense, driver, None, rng, share)
            promising = best_apart(made, -expected_score(by_angle, made, sense), NEAR)[:KEPT]
            found.append(kind.of(made[promising], triangle))
        pool = kind.joined(found)
        if not len(pool):
            break
        best = pool[best_apart(pool, -expected_score(aims, pool, sense), NEAR)[:ZOOMED]]
        about = best.shape[:, -4:-1]
    return pool


def driven_starts(
    aims: FunctionAims, desired: DesiredOutput, rng: np.random.Generator, effort: float
) -> Generators:
    """Generators near the desired output under random triangles, from which least squares begins."""
    limits, kind = aims.triangle, _kind(aims)
    found = [kind.joined([])]
    count = max(1, round(TRIANGLES * effort))
    for triangle in np.empty((0, 3)) if limits is None else limits.drawn(rng, count):
        if stop_requested() and len(found) > 1:
            break
        there = turned_by(triangle, desired.turned)
        by_angle = DesiredOutput(there, desired.output, desired.weights)
        batch = few_starts(kind.by_angle, by_angle, rng)
        square = np.nan_to_num(by_angle.square(by_angle.errors(batch)), nan=np.inf)
        found.append(kind.of(batch[best_apart(batch, square, APART)[:EACH]], triangle))
    return kind.joined(found)


def _kind(aims: FunctionAims) -> type[ByCylinder]:
    if not issubclass(aims.kind, ByCylinder):
        raise TypeError("the inputs are angles")
    return aims.kind
