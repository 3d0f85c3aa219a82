"""Known designs traced through the pieces, or tiles, of a proof while these are halved."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.proof.curve.table import Table
from grashof.synth.theory.burmester import Dyads

JUST_BELOW = 1e-7  # rad
NOWHERE = -1
# How far beyond a piece rounding may take a dyad: of its length, of its width, of its centre.
Slack = tuple[float, float, float]
# Which of some pairs of pieces may hold a design that transmits more than given angles, and their bounds.
RowsLeft = Callable[[list[IntArray], FloatArray], tuple[IntArray, FloatArray]]


@dataclass(frozen=True)
class Designs:
    """Dyads of linkages in the frame of a proof, and the transmission angle that counts, rad."""

    driver: Dyads
    driven: Dyads
    transmission: FloatArray

    def __len__(self) -> int:
        return len(self.driver)

    def __getitem__(self, index: IntArray | BoolArray) -> "Designs":
        return Designs(self.driver[index], self.driven[index], self.transmission[index])


@dataclass(frozen=True)
class Side:
    """One dyad of each design, and the cover that has to hold it."""

    first: IntArray
    "Pieces of the cover before any is halved."
    halve: Callable[[IntArray], IntArray]
    "The two halves of pieces, shape (n, 2); negative where a half holds nothing."
    holds: Callable[[IntArray, IntArray], BoolArray]
    "Whether pieces hold the dyads of designs, both by number, entry by entry."

    def pieces_of(self, designs: IntArray) -> IntArray:
        """The first piece that holds the dyad of each design; `NOWHERE` where none does."""
        found = np.full(len(designs), NOWHERE)
        for piece in self.first[::-1]:
            found[self.holds(np.full(len(designs), piece), designs)] = piece
        return found

    def halves_of(self, pieces: IntArray, designs: IntArray) -> IntArray:
        """The half of each piece that holds the dyad of each design."""
        found = np.full(len(designs), NOWHERE)
        for half in self.halve(pieces).T:
            rows = np.flatnonzero(half >= 0)
            rows = rows[self.holds(half[rows], designs[rows])]
            found[rows] = half[rows]
        return found


def of_table(table: Table, role: BoolArray, dyads: Dyads, slack: Slack) -> Side:
    """Dyads and the pieces of a table that may hold them: by the definition of tubes alone."""
    z, c = dyads.moving, dyads.ground

    def holds(which: IntArray, designs: IntArray) -> BoolArray:
        tubes, centres = table.pieces.tubes[which], table.pieces.centres[which]
        moved = (z[designs] - tubes.middle) * tubes.direction.conj()
        s = moved.real / np.maximum(tubes.half, 1e-300)
        off = np.abs(moved.imag - tubes.tilt * s - tubes.bow * (s * s - 0.5))
        inside = (np.abs(s) <= 1 + slack[0]) & (off <= tubes.rest + slack[1])
        apart = np.abs(c[designs] - centres.middle - centres.along * np.clip(s, -1, 1))
        return inside & (apart <= centres.rest + slack[2] * (1 + np.abs(c[designs])))

    return Side(np.flatnonzero(role), table.halve, holds)


@dataclass(frozen=True)
class Descent:
    """How many designs were in no piece, or excluded, and how near a bound came, rad."""

    lost: int
    excluded: int
    nearest: float


def descent(sides: Sequence[Side], least: FloatArray, rows_left: RowsLeft, levels: int) -> Descent:
    """Designs down halves of pieces, each with its own transmission angle, `least`, as the threshold."""
    designs, lost, excluded, nearest = np.arange(len(least)), 0, 0, np.inf
    pieces = [side.pieces_of(designs) for side in sides]
    for _ in range(levels):
        there = np.logical_and.reduce([piece >= 0 for piece in pieces])
        lost += int((~there).sum())
        designs, pieces = designs[there], [piece[there] for piece in pieces]
        rows, bound = rows_left(pieces, least[designs] - JUST_BELOW)
        excluded += len(designs) - len(rows)
        nearest = min(nearest, float((bound - least[designs[rows]]).min(initial=np.inf)))
        pieces = [side.halves_of(each, designs) for side, each in zip(sides, pieces, strict=True)]
    return Descent(lost, excluded, nearest)
