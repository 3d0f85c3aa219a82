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
    """Random complex displacements and one solution for them.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    displacements : ndarray of complex, shape (16,)
    solutions : ndarray of complex, shape (1, 8)

    Examples
    --------
    >>> displacements, solutions = general_problem(np.random.default_rng(0))
    >>> residual, _, _ = nine_point_system(solutions, displacements[None], np.zeros((1, 16), dtype=complex))
    >>> bool(np.abs(residual).max() < 1e-10)
    True
    """
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
    """Solutions that loops through random problems lead to, one of every triplet.

    Parameters
    ----------
    displacements : ndarray of complex, shape (M,)
    solutions : ndarray of complex, shape (n, K)
        Known ones.
    rng : numpy.random.Generator
    most : int
        Stop when so many are known.
    patience : int
        Stop after so many loops on end without a new one.
    progress : callable, optional
        Called with the number of known solutions after every loop.
    system : System
        The nine-point problem, if no other.
    distinct : callable
        Solutions without those that came earlier, or are cognates of such.

    Returns
    -------
    ndarray of complex, shape (m, K)
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
