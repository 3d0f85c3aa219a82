"""Poles of a motion: points that are in one place at two poses."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from grashof.problems.values.arrays import ComplexArray, IntArray
from grashof.synth.theory.burmester import Displacements

_PARALLEL = 1e-4  # between unit rotations: poles of such poses are far away


def poles(motion: Displacements) -> tuple[IntArray, ComplexArray]:
    """Pairs of poses, shape (n, 2), and the points in one place at both, where they are at the first.

    >>> motion = Displacements.from_poses(np.array([1, 1j, -1]), np.radians([0, 90, 90]))
    >>> pairs, places = poles(motion)
    >>> pairs.tolist(), bool(np.allclose(places, [0, -1j]))
    ([[0, 1], [0, 2]], True)
    """
    pairs, places = [], []
    for i, j in combinations(range(len(motion.rotation)), 2):
        turn, move = motion.rotation[j] - motion.rotation[i], motion.shift[j] - motion.shift[i]
        if abs(turn) > _PARALLEL:
            pairs.append((i, j))
            places.append(-move / turn)
    return np.array(pairs, dtype=np.int64).reshape(-1, 2), np.array(places, dtype=np.complex128)
