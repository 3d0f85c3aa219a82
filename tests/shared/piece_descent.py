"""Known designs traced through the pieces of a proof while these are halved."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.table import Table

JUST_BELOW = 1e-7  # rad
NOWHERE = -1
# How far beyond a piece rounding may take a dyad: of its length, of its width, of its centre.
Slack = tuple[float, float, float]


@dataclass(frozen=True)
class Descent:
    """How many designs were in no piece, or excluded, and how near a bound came, rad."""

    lost: int
    excluded: int
    nearest: float


def holds(table: Table, which: IntArray, z: ComplexArray, c: ComplexArray, slack: Slack) -> BoolArray:
    """Whether pieces hold dyads, entry by entry: by the definition of tubes alone."""
    tubes, centres = table.pieces.tubes[which], table.pieces.centres[which]
    moved = (z - tubes.middle) * tubes.direction.conj()
    s = moved.real / np.maximum(tubes.half, 1e-300)
    off = np.abs(moved.imag - tubes.tilt * s - tubes.bow * (s * s - 0.5))
    inside = (np.abs(s) <= 1 + slack[0]) & (off <= tubes.rest + slack[1])
    apart = np.abs(c - centres.middle - centres.along * np.clip(s, -1, 1))
    return inside & (apart <= centres.rest + slack[2] * (1 + np.abs(c)))


def pieces_of(table: Table, role: BoolArray, z: ComplexArray, c: ComplexArray, slack: Slack) -> IntArray:
    """The first piece of a cover that holds each dyad; `NOWHERE` where none does."""
    found = np.full(len(z), NOWHERE)
    for piece in np.flatnonzero(role)[::-1]:
        found[holds(table, np.full(len(z), piece), z, c, slack)] = piece
    return found


def halves_of(table: Table, which: IntArray, z: ComplexArray, c: ComplexArray, slack: Slack) -> IntArray:
    """The half of each piece that holds each dyad."""
    halves, found = table.halve(which), np.full(len(z), NOWHERE)
    for half in halves.T:
        rows = np.flatnonzero(half >= 0)
        inside = rows[holds(table, half[rows], z[rows], c[rows], slack)]
        found[inside] = half[inside]
    return found


# Which pairs of pieces, or pieces, may hold a design that transmits more than given angles, and their bounds.
RowsLeft = Callable[[list[IntArray], FloatArray], tuple[IntArray, FloatArray]]


def descent(
    table: Table,
    dyads: Sequence[tuple[BoolArray, ComplexArray, ComplexArray]],
    least: FloatArray,
    rows_left: RowsLeft,
    levels: int,
    slack: Slack,
) -> Descent:
    """Designs down halves of pieces, each with its own transmission angle, `least`, as the threshold.

    Of each of their dyads the pieces that may hold it, its moving point and its pivot.
    """
    points = [(z, c) for _, z, c in dyads]
    pieces = [pieces_of(table, role, z, c, slack) for role, z, c in dyads]
    lost = excluded = 0
    nearest = np.inf
    for _ in range(levels):
        there = np.logical_and.reduce([piece >= 0 for piece in pieces])
        lost += int((~there).sum())
        points, least = [(z[there], c[there]) for z, c in points], least[there]
        pieces = [piece[there] for piece in pieces]
        rows, bound = rows_left(pieces, least - JUST_BELOW)
        excluded += len(least) - len(rows)
        nearest = min(nearest, float((bound - least[rows]).min(initial=np.inf)))
        pieces = [halves_of(table, each, z, c, slack) for each, (z, c) in zip(pieces, points, strict=True)]
    return Descent(lost, excluded, nearest)
