"""The search for function generators whose input is the lengthening of a cylinder on the driver.

With a triangle of O2 and the pivots of the cylinder, the task becomes one in driver angles: through few pairs
the linkages are known; for more pairs, the best fits under some triangles are fitted together with these.
"""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.met import ZOOMED, met, nearest, raised
from grashof.synth.starts.functions.pairs import NEAR, Pairs, expected_score, through_pairs
from grashof.synth.theory.functions.by_cylinder import ByCylinder
from grashof.synth.theory.functions.fit import DesiredOutput, best_apart
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.starts import few_starts
from grashof.synth.theory.functions.triangle import turned_by
from grashof.synth.theory.stopping import stop_requested

TRIANGLES = 240  # from which least squares begins
ENDS = 12  # of the best fits that are refined where pairs are met
EACH = 6  # starts that continue under each triangle
APART = 0.3  # distance between them, as in `best_apart`
# Triangles that are tried for pairs that are met, by their number, and the effort of each.
TRIED = {3: (48, 0.02), 4: (36, 0.03), 5: (400, 1.0)}
KEPT = 12  # of the most promising linkages under each triangle
ZOOMS = 2  # rounds in which triangles near the best ones are tried


def through_by_cylinder(
    aims: FunctionAims, sense: int, driver: int, rng: np.random.Generator, effort: float
) -> Generators:
    """All that are found through the pairs and keep the limits."""
    kind, pairs = _kind(aims), Pairs.of(aims, sense, driver)
    if len(aims.task) <= kind.by_angle.EXACT:
        pool = nearest(pairs, _by_triangles(aims.anywhere, sense, driver, rng, effort))
        if len(pool) or stop_requested():
            return pool
    starts = driven_starts(aims, pairs.desired, rng, effort)
    found = met(pairs, starts, pairs.limits, ENDS)
    return found if len(aims.task) == kind.EXACT else raised(pairs, found, effort=effort)


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
