"""The most promising function generators through all pairs."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.driven import through_by_cylinder
from grashof.synth.starts.functions.met import nearest
from grashof.synth.starts.functions.pairs import NEAR, Pairs, expected_score, through_pairs
from grashof.synth.theory.functions.by_cylinder import ByCylinder
from grashof.synth.theory.functions.fit import best_apart
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.stopping import stop_requested


def exact_functions(
    aims: FunctionAims, rng: np.random.Generator, most: int, effort: float
) -> list[tuple[Generators, int]]:
    """Generators through all pairs that keep the limits, each with its driver's sense.

    The most promising distinct ones come first.
    """
    found: list[tuple[FloatArray, Generators, int]] = []
    for sense, driver, first in aims.ways():
        if aims.triangle is None:
            batch = through_pairs(aims.anywhere, sense, driver, first, rng, effort)
            batch = nearest(Pairs.of(aims, sense, driver), batch, held=first is not None)
        else:
            batch = through_by_cylinder(aims, sense, driver, rng, effort)
        if len(batch) and not stop_requested():
            found.append((expected_score(aims, batch, sense), batch, driver))
    if not found:
        return []
    score = np.concatenate([each for each, _, _ in found])
    drivers = np.concatenate([np.full(len(batch), driver) for _, batch, driver in found])
    batch = aims.made.joined([each for _, each, _ in found])
    # Those under triangles near the best one are many, and would crowd out the others.
    (linkages, room) = (batch.lengths_alone, 1) if isinstance(batch, ByCylinder) else (batch, 4)
    cell = NEAR
    best = best_apart(linkages, -score, cell)
    while len(best) > room * most:  # a curve or surface of designs: farther apart
        cell *= 1.5
        best = best_apart(linkages, -score, cell)
    return [(batch[k : k + 1], int(drivers[k])) for k in best[:most]]
