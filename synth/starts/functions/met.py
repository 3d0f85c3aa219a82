"""Function generators through all pairs under limits that few of those through the pairs keep."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from grashof.synth.starts.functions.pairs import NEAR, Pairs
from grashof.synth.starts.functions.places import PlaceLimits
from grashof.synth.theory.functions.fit import best_apart, fitted
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.optima import Aim, refined
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.stopping import StopRequested, stop_requested

LONG = 120  # steps of those that are refined
HALVINGS, RAISED = 6, 3  # of the transmission angle where freedom is left, and fits that are refined
ZOOMED = 8  # best designs that others with a greater transmission angle begin at
STARTS, ENDS = 200, 30  # of those that miss limits by least, and of those that are refined


def met(
    pairs: Pairs, starts: Generators, limits: ShapeLimits, most: int, *, held: bool = False
) -> Generators:
    """Those that meet all pairs within limits: the best of many starts, refined where too few do."""
    within = replace(pairs, limits=limits)
    near, _ = fitted(pairs.desired, starts, limits.of, held=held)
    found = within.kept(near)
    if len(found) < most:
        with suppress(StopRequested):
            ends = refined(Aim(pairs.desired, limits, held=held), near[:most], LONG)
            found = found.joined([found, ends.generators])
    return within.kept(found)


def raised(pairs: Pairs, found: Generators, *, held: bool = False, effort: float = 1.0) -> Generators:
    """Some designs, and others with ever greater transmission angles, by halving."""
    span = pairs.limits.span
    pool, low, high = found, -1.0, float(np.pi / 2)
    for _ in range(round(HALVINGS * min(effort, 1.0))):
        if not len(pool) or stop_requested():
            break
        worst = np.arccos(np.minimum(pool.worst_cosine(span), 1.0))
        low, best = max(low, float(worst.max())), pool[np.argsort(-worst, kind="stable")[:ZOOMED]]
        level = (low + high) / 2
        more = met(pairs, best, replace(pairs.limits, transmission=level), RAISED, held=held)
        high = high if len(more) else level
        pool = pool.joined([pool, more])
    return pool


def nearest(pairs: Pairs, through: Generators, *, held: bool = False) -> Generators:
    """Of generators through all pairs, and others that these lead to, those that keep limits of places."""
    places = pairs.limits.places
    if not isinstance(places, PlaceLimits) or not len(through):
        return through
    placed = places.placed(through)
    missed = np.maximum(-np.nan_to_num(places.rows(placed).value, nan=-np.inf).min(axis=1), 0.0)
    order = best_apart(placed, missed, NEAR)[:STARTS]
    found = met(pairs, placed[order], pairs.limits, ENDS, held=held)
    found = found.joined([found, pairs.kept(placed[missed <= 0])])
    return found if len(pairs.turned) >= pairs.aims.kind.EXACT else raised(pairs, found, held=held)
