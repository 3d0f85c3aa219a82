"""Long tasks searched by some of their targets first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray
from grashof.synth.starts.closed_loop import Batch, Loop, SearchTargets, body_turns, shares_of_turn
from grashof.synth.starts.loop_search import project
from grashof.synth.theory.stopping import raise_if_overdue

SMALLEST = 1e-6  # share of a turn: gaps get no smaller
AROUND = 180  # driver angles at which each of many targets in any order is looked for
CLOSED = 1e-9  # of a unit vector


def thinned(target: SearchTargets, most: int) -> tuple[SearchTargets, IntArray]:
    """At most `most` targets, evenly picked, and the indices of those; the first and the last are kept."""
    count = len(target.points)
    index = np.arange(count)
    if count <= most:
        return target, index
    index = np.unique(np.round(np.linspace(0, count - 1, most)).astype(np.int64))
    return _some(target, index), index


def _some(target: SearchTargets, index: IntArray) -> SearchTargets:
    names = ("points", "weights", "turns", "turn_weights", "timing")
    column = {int(k): number for number, k in enumerate(index)}
    at = tuple(replace(limit, k=column[limit.k]) for limit in target.at if limit.k in column)
    return replace(target, at=at, **{name: getattr(target, name)[index] for name in names})


def refined(
    target: SearchTargets, index: IntArray, batch: Batch, places: ComplexArray | None = None
) -> Batch:
    """Linkages of a thinned task with driver angles at every target.

    In between by the length of the path; of targets in any order, where each is nearest. `target` has all of
    them, `index` those that `batch` knows. Linkages stand at `places` z0, z1, z2 (n, 3) in sizes, or where
    they fit those targets best.
    """
    count = len(target.points)
    if len(index) == count:
        return batch
    if target.jumbled:
        with np.errstate(all="ignore"):
            return _each_nearest(target, index, batch, places)
    assembly = np.broadcast_to(batch.assembly[:, :1], (len(batch), count))
    unknowns = batch.unknowns
    if not target.timed:
        length = lengths_along(target)
        _, gone = shares_of_turn(unknowns[:, 4:])
        every = np.stack([np.interp(length, length[index], row) for row in gone])
        gaps = np.concatenate([np.diff(every, axis=1), 1 - every[:, -1:]], axis=1)
        unknowns = np.concatenate([unknowns[:, :4], np.log(np.maximum(gaps, SMALLEST))], axis=1)
    return replace(batch, unknowns=unknowns, assembly=assembly)


def lengths_along(target: SearchTargets) -> FloatArray:
    """The length of the path up to every target, (N,)."""
    return np.concatenate([[0.0], np.cumsum(target.steps)])


def _each_nearest(target: SearchTargets, index: IntArray, batch: Batch, places: ComplexArray | None) -> Batch:
    """Linkages with each driver angle, of an even grid, at which a target is missed least."""
    some = _some(target, index)
    known = Loop.of(some, batch)
    z = project(some, known)[0] if places is None else places
    _, to_body = body_turns(some, known)
    grid = np.broadcast_to(np.linspace(-np.pi, np.pi, AROUND, endpoint=False), (len(batch), AROUND))
    around = replace(
        batch,
        unknowns=np.concatenate([batch.unknowns[:, :3], grid], axis=1),
        assembly=np.broadcast_to(batch.assembly[:, :1], grid.shape),
    )
    loop = Loop.of(target, around)
    p = z[:, :1] + z[:, 1:2] * loop.e2 + z[:, 2:] * loop.e3
    open_ones = np.abs(np.abs(loop.e3) - 1) > CLOSED
    turned = np.angle(loop.e3) + to_body[:, None]
    nearest = np.empty((len(batch), len(target.points)), dtype=np.int64)
    for row in range(len(batch)):  # all at once would take much memory
        raise_if_overdue()
        miss = _missed(target, p[row], turned[row])
        nearest[row] = np.argmin(np.where(open_ones[row], np.inf, miss), axis=1)
    return replace(
        batch,
        unknowns=np.concatenate([batch.unknowns[:, :3], grid[0][nearest]], axis=1),
        assembly=np.broadcast_to(batch.assembly[:, :1], nearest.shape),
    )


def _missed(target: SearchTargets, p: ComplexArray, turned: FloatArray) -> FloatArray:
    """Squared misses of every target at some driver angles (G,); (N, G), sizes squared."""
    off = p - target.points[:, None]
    miss: FloatArray = target.weights[:, None] * (off.real**2 + off.imag**2)
    if target.has_angles:
        turn = turned - target.turns[:, None]
        turn -= TURN * np.round(turn / TURN)
        miss += target.turn_weights[:, None] * turn**2
    return miss
