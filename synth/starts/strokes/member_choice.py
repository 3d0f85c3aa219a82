"""A choice of many crank-rockers: how large they are, which no other beats, which are well apart."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.loop.dyad import Bars, coupler_of
from grashof.synth.theory.distinct import DISTINCT, pick_apart
from grashof.synth.theory.limit_positions import StrokeLinkages

_POSITIONS = 73  # of a turn, for the size


def diagonals(members: StrokeLinkages) -> FloatArray:
    """Diagonals of the boxes around O2, O4 and all that A and B reach, O2O4 = 1; shape (n,)."""
    _, r2, r3, r4 = members.lengths.T[..., None]
    a = r2 * np.exp(1j * np.linspace(0, 2 * np.pi, _POSITIONS))
    b = a + np.nan_to_num(coupler_of(Bars(), 1.0, a, r3, r4, members.assembly[:, None])[0])
    places = np.concatenate([a, b, np.ones_like(a[:, :1])], axis=1)
    sides = [np.ptp(part, axis=1) for part in (places.real, places.imag)]
    across: FloatArray = np.hypot(sides[0], sides[1])
    return across


def unbeaten(angle: FloatArray, size: FloatArray) -> BoolArray:
    """Which of some (n,) no other one beats in transmission and size, shape (n,)."""
    order = np.lexsort((size, -angle))
    least = np.minimum.accumulate(size[order])
    best = np.zeros(len(angle), dtype=bool)
    best[order] = size[order] <= least
    return best


def apart(lengths: FloatArray, score: FloatArray, most: int) -> IntArray:
    """Indices of at most so many of some lengths (n, 4), as far apart as leaves that many, best first."""
    worth = np.flatnonzero(np.isfinite(score))  # without those of score -inf
    signatures = np.concatenate([lengths[worth], np.zeros((len(worth), 5))], axis=1)
    for least in (0.1, 0.05, 0.025, DISTINCT):
        picked = pick_apart(signatures, score[worth], least, most)
        if len(picked) >= most:
            break
    return worth[picked]
