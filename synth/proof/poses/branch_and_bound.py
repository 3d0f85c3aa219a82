"""Branch and bound over pairs of pieces: the greatest transmission angle, between bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from grashof.problems.values.arrays import BoolArray, IntArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.proof.claims.bounds import Bounds, logged
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import NOTHING, Table
from grashof.synth.proof.poses.pairs import Pairs, bounded
from grashof.synth.theory.stopping import stop_requested

AT_ONCE = 8192  # pairs bounded together
MOST_LEFT = 1_000_000  # pairs kept in memory
MOST_LEVELS = 60  # pieces are as small as rounding then
# The transmission angle of a design in the pairs, rad, where one has more than the given angle; else 0.
Lookout = Callable[[Table, Pairs, float], float]
Blocks = Iterator[tuple[IntArray, IntArray]]


@dataclass(slots=True)
class Bracket:
    """The greatest transmission angle of linkages in pairs of pieces, between bounds."""

    required: Required
    gap: float  # rad, difference to which the bounds are brought together
    most_pairs: int  # budget
    lower: float = 0.0  # rad, transmission angle of a design that is known; 0 where none is
    pairs: int = 0  # number of pairs bounded
    levels: int = 0  # number of times that all remaining ones were halved
    left: Pairs | None = None  # that may hold designs better than `upper`; none where the search is done
    begun: bool = False  # whether every pair of the first level was bounded
    over_budget: bool = False

    @property
    def threshold(self) -> float:
        """Designs that transmit less do not count, rad."""
        return max(self.lower + self.gap if self.lower else 0.0, self.required.floor)

    @property
    def done(self) -> bool:
        """Whether no design transmits more than `threshold`."""
        return self.begun and self.left is not None and not len(self.left)

    @property
    def upper(self) -> float:
        """No design transmits more, rad."""
        if not self.begun or self.left is None:
            return float(np.pi / 2)
        return max(self.threshold, float(self.left.bound.max(initial=0.0)))

    def bounds(
        self,
        since: float,
        begun: tuple[int, int],
        found: Candidate | None,
        left_out: tuple[str, ...],
        why: str,
    ) -> Bounds:
        """The result since a time, with the pieces that it began with and the best design."""
        return logged(
            Bounds(
                lower=self.lower,
                upper=self.upper,
                closed=self.done,
                found=found,
                pieces=begun,
                pairs=self.pairs,
                levels=self.levels,
                seconds=perf_counter() - since,
                left_out=left_out,
                why=why,
            )
        )

    def bounded(self, blocks: Blocks, bound: Callable[[IntArray, IntArray, float], Pairs]) -> Pairs | None:
        """The remaining pairs; None where the budget ends, or on request."""
        nothing = np.zeros(0, dtype=np.int64)
        found = [Pairs(nothing, nothing, np.zeros(0))]
        for one, other in blocks:
            self.over_budget = self.pairs + len(one) > self.most_pairs
            if self.over_budget or stop_requested():
                return None
            self.pairs += len(one)
            found.append(bound(one, other, self.threshold))
        return Pairs.joined(found)


def all_pairs(drivers: IntArray, driven: IntArray) -> Blocks:
    """All pairs of two lots of pieces, in blocks."""
    rows = max(1, AT_ONCE // max(1, len(driven)))
    for begin in range(0, len(drivers), rows):
        some = drivers[begin : begin + rows]
        yield np.repeat(some, len(driven)), np.tile(driven, len(some))


def in_blocks(one: IntArray, other: IntArray) -> Blocks:
    """Pairs in blocks."""
    for begin in range(0, len(one), AT_ONCE):
        block = slice(begin, begin + AT_ONCE)
        yield one[block], other[block]


@dataclass(slots=True)
class Search(Bracket):
    """A branch and bound, breadth first."""

    def run(self, table: Table, look: Lookout, *, content: bool = False) -> None:
        """Bound all pairs, look for designs in those that are left, halve these, until none is left.

        It ends early with the budget, on request, or where it is `content` with any
        design; `upper` is valid even then.
        """
        self.left = self.first(table)
        while self.left is not None and len(self.left):
            self.lower = max(self.lower, look(table, self.left, max(self.lower, self.required.floor)))
            if content and self.lower:
                return
            self.left = self.left[self.left.bound > self.threshold]
            self.over_budget = len(self.left) > MOST_LEFT or self.levels >= MOST_LEVELS
            if not len(self.left) or self.over_budget:
                return
            halved = self.halved(table, self.left)
            if halved is None:
                return
            if table.trail is not None:
                table.trail.halved.append((self.left.driver, self.left.driven))
            self.left, self.levels = halved, self.levels + 1

    def first(self, table: Table) -> Pairs | None:
        """All pairs of the pieces of a cover; None where they are too many, or on request."""
        drivers = np.flatnonzero(table.pieces.driver)
        driven = np.flatnonzero(table.pieces.driven)
        found = self._bounded(table, all_pairs(drivers, driven))
        self.begun = found is not None
        return found

    def halved(
        self, table: Table, pairs: Pairs, first: BoolArray | None = None, second: BoolArray | None = None
    ) -> Pairs | None:
        """The pairs of halves of the pieces of pairs; with masks, these drivers and driven pieces alone."""
        one = np.repeat(_halves(table, pairs.driver, first), 2, axis=1).ravel()
        other = np.tile(_halves(table, pairs.driven, second), (1, 2)).ravel()
        some = (one >= 0) & (other >= 0)
        one, other = one[some], other[some]
        some = table.pieces.driver[one] & table.pieces.driven[other]
        one, other = one[some], other[some]
        return self._bounded(table, in_blocks(one, other))

    def _bounded(self, table: Table, blocks: Blocks) -> Pairs | None:
        return self.bounded(blocks, lambda *pair: bounded(self.required, table.pieces, *pair))


def _halves(table: Table, which: IntArray, long: BoolArray | None) -> IntArray:
    """Halves of pieces, shape (n, 2); where `long` is False the piece itself, alone."""
    if long is None:
        return table.halve(which)
    made = np.stack([which, np.full(len(which), NOTHING)], axis=1)
    made[long] = table.halve(which[long])
    return made
