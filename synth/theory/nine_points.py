"""All four-bars whose coupler curve passes nine points: exact path synthesis without a search."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import ComplexArray
from grashof.synth.theory.homotopy import corrected
from grashof.synth.theory.point_families import FOUR_BARS, crank, turn
from grashof.synth.theory.solutions import solutions_at

REAL = 1e-6  # a vector and its conjugate agree so far, relative to the largest, in a real linkage


def linkages_through(points: ComplexArray, rng: np.random.Generator) -> tuple[ComplexArray, int]:
    """One real linkage of every triplet of cognates that passes nine points, in any order and branch.

    Of distinct `points` (9,): O2, O4, and A, B, P at the first point, (n, 5), all but a path that is lost now
    and then; and the number of complex triplets found, `FOUR_BARS.count` where none is lost.

    >>> from grashof import load
    >>> points = load("nine-points").task.points @ [1, 1j]  # near a circle
    >>> found, solutions = linkages_through(points, np.random.default_rng(0))
    >>> len(found), bool(np.abs(np.abs(coupler_turns(found, points)) - 1).max() < 1e-6)
    (21, True)
    """
    size = np.abs(points[:, None] - points).max() / 2
    steps = (points[1:] - points[0]) / size
    displacements = np.concatenate([steps, steps.conj()])
    found = solutions_at(FOUR_BARS, displacements, rng)
    gap = np.abs(found - FOUR_BARS.mirrored(found)).max(axis=1)
    real = found[gap <= REAL * np.abs(found).max(axis=1)]
    for _ in range(3):
        real[:, 1::2] = real[:, ::2].conj()
        real, _ = corrected(FOUR_BARS.system, real, np.broadcast_to(displacements, (len(real), 16)))
    r2, o2, r4, o4 = FOUR_BARS.distinct(real)[:, ::2].T
    placed: ComplexArray = points[0] + size * np.stack([o2, o4, o2 + r2, o4 + r4, np.zeros_like(o2)], axis=1)
    return placed, len(found)


def coupler_turns(points: ComplexArray, targets: ComplexArray) -> ComplexArray:
    """Turn exp(i phi) of the coupler from the first target to each (N,), of linkages that meet them all.

    `points` (n, 5) are O2, O4, and A, B, P at the first target. The turns (n, N) have the absolute value 1
    where a linkage meets the target.
    """
    o2, o4, a, b, p = (column[:, None] for column in points.T)
    d = targets - p
    links = ((a - o2, o2 - p), (b - o4, o4 - p))
    one, two = (crank((r, r.conj(), o, o.conj()), d, d.conj()) for r, o in links)
    return turn(one, two)[0]
