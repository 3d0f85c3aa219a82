"""Long paths searched by some of their points first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import IntArray
from grashof.synth.starts.closed_loop import Batch, SearchTargets, shares_of_turn

SMALLEST = 1e-6  # share of a turn: gaps get no smaller


def thinned(target: SearchTargets, most: int) -> tuple[SearchTargets, IntArray]:
    """At most `most` points of a path, evenly picked, and which; the first and the last are kept.

    Parameters
    ----------
    target : SearchTargets
    most : int

    Returns
    -------
    SearchTargets
    index : ndarray of int
        Of the points kept.
    """
    count = len(target.points)
    index = np.arange(count)
    if count <= most or (target.jumbled):
        return target, index
    index = np.unique(np.round(np.linspace(0, count - 1, most)).astype(np.int64))
    names = ("points", "weights", "turns", "turn_weights", "timing")
    return replace(target, **{name: getattr(target, name)[index] for name in names}), index


def refined(target: SearchTargets, index: IntArray, batch: Batch) -> Batch:
    """Linkages of a thinned path with driver angles at every point, in between by the length of the path.

    Parameters
    ----------
    target : SearchTargets
        With all points.
    index : ndarray of int
        Of the points that `batch` knows.
    batch : Batch

    Returns
    -------
    Batch
    """
    count = len(target.points)
    if len(index) == count:
        return batch
    assembly = np.broadcast_to(batch.assembly[:, :1], (len(batch), count))
    unknowns = batch.unknowns
    if not target.timed:
        length = np.concatenate([[0.0], np.cumsum(target.steps)])
        _, gone = shares_of_turn(unknowns[:, 4:])
        every = np.stack([np.interp(length, length[index], row) for row in gone])
        gaps = np.concatenate([np.diff(every, axis=1), 1 - every[:, -1:]], axis=1)
        unknowns = np.concatenate([unknowns[:, :4], np.log(np.maximum(gaps, SMALLEST))], axis=1)
    return replace(batch, unknowns=unknowns, assembly=assembly)
