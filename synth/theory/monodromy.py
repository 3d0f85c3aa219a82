"""The solutions of the nine-point problem, or one like it, for general points, from a single one.

Followed around closed loops in the space of the points, a solution comes back as another one; loops
are added until no new one has come for some time. It is done once, by a script, for `nine_points`
and `eight_points`.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from grashof.problems.values.arrays import ComplexArray
from grashof.synth.theory.homotopy import System, follow
from grashof.synth.theory.nine_points import TRIPLETS
from grashof.synth.theory.nine_points import distinct as distinct_triplets
from grashof.synth.theory.nine_points import system as nine_point_system

CAREFUL = 1e-8


def general_problem(rng: np.random.Generator) -> tuple[ComplexArray, ComplexArray]:
    """Random complex displacements (16,) and one solution (1, 8) for them."""
    unknowns = _general(rng, 8)
    x, xs, a, as_, y, ys, b, bs = unknowns
    turn = np.exp(rng.normal(0, 0.3, 8) + 1j * rng.uniform(0, 2 * np.pi, 8))
    # Each link keeps its length: d ds + p d + q ds + c = 0, for both dyads; their difference is linear.
    p1, q1, c1 = xs / turn - as_, x * turn - a, x * as_ * (1 - turn) + a * xs * (1 - 1 / turn)
    p2, q2, c2 = ys / turn - bs, y * turn - b, y * bs * (1 - turn) + b * ys * (1 - 1 / turn)
    slope, offset = -(p1 - p2) / (q1 - q2), -(c1 - c2) / (q1 - q2)  # ds = slope d + offset
    half = (offset + p1 + q1 * slope) / 2
    d = (-half + np.sqrt(half**2 - slope * (q1 * offset + c1))) / slope
    return np.concatenate([d, slope * d + offset]), unknowns[None]


def collect(
    displacements: ComplexArray,
    solutions: ComplexArray,
    rng: np.random.Generator,
    most: int = TRIPLETS,
    patience: int = 8,
    progress: Callable[[int], object] | None = None,
    system: System = nine_point_system,
    distinct: Callable[[ComplexArray], ComplexArray] = distinct_triplets,
) -> ComplexArray:
    """Solutions (m, K), one of every triplet, that loops through random problems lead to from known ones.

    It stops when `most` are known, or after `patience` loops on end without a new one; `progress` is called
    with their number after every loop. `distinct` leaves out those known earlier and their cognates.
    """
    idle = 0
    while len(solutions) < most and idle < patience:
        count = len(displacements)
        corners = [displacements, _general(rng, count), _general(rng, count), displacements]
        moved = solutions
        for start, target in pairwise(corners):
            moved, reached = follow(system, moved, start, target, CAREFUL)
            moved = moved[reached]
        before = len(solutions)
        solutions = distinct(np.concatenate([solutions, moved]))
        idle = idle + 1 if len(solutions) == before else 0
        if progress is not None:
            progress(len(solutions))
    return solutions


def _general(rng: np.random.Generator, count: int) -> ComplexArray:
    return np.asarray((rng.normal(size=count) + 1j * rng.normal(size=count)) / np.sqrt(2))
