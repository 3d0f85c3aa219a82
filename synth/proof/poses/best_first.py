"""Branch and bound over pairs of tiles: four parameters, the pairs with the greatest bounds first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import Side
from grashof.synth.proof.poses.branch_and_bound import AT_ONCE, Bracket, all_pairs, in_blocks
from grashof.synth.proof.poses.pairs import Pairs, sides_left
from grashof.synth.proof.poses.sides import OneSide, Tiling

MOST_LEFT = 3_000_000  # pairs kept in memory
HALVED = AT_ONCE // 2  # pairs, together
# The transmission angle of a design in the pairs, rad, where one has more than the given angle; else 0.
Lookout = Callable[["Tilings", Pairs, float], float]


@dataclass(frozen=True, slots=True)
class Tilings:
    """The tiles of both sides."""

    required: Required
    driver: Tiling
    driven: Tiling

    @classmethod
    def covering(cls, required: Required) -> Tilings:
        """Tiles that hold all dyads that may meet the requirements on one.

        TooMany where they take more tiles than a cover may have; `StopRequested` on request.
        """
        driver, driven = (Tiling.covering(OneSide.of(required, is_driver=each)) for each in (True, False))
        return cls(required, driver, driven)

    @property
    def every(self) -> tuple[IntArray, IntArray]:
        """All tiles of each side."""
        return np.arange(len(self.driver)), np.arange(len(self.driven))

    def bounded(self, driver: IntArray, driven: IntArray, least: float) -> Pairs:
        """The pairs of tiles that may hold a linkage with a transmission angle of more than `least`, rad."""
        rows, bound = self.each_bounded(driver, driven, np.full(len(driver), least))
        return Pairs(driver[rows], driven[rows], bound)

    def each_bounded(
        self, driver: IntArray, driven: IntArray, least: FloatArray
    ) -> tuple[IntArray, FloatArray]:
        """Which pairs may hold a linkage that transmits more than `least`, rad, and their bounds."""
        first, second = self.driver.sites, self.driven.sites
        one = Side(first.z[driver], first.c[driver], is_driver=True)
        other = Side(second.z[driven], second.c[driven], is_driver=False)
        return sides_left(self.required, one, other, first.sense[driver], least)

    def halved(self, pairs: Pairs) -> tuple[IntArray, IntArray]:
        """Pairs with one tile halved, the larger one of each."""
        first = self.driver.sizes[pairs.driver] >= self.driven.sizes[pairs.driven]
        of_driver, of_driven = pairs[first], pairs[~first]
        one, other = self.driver.halve(of_driver.driver), self.driven.halve(of_driven.driven)
        drivers = np.concatenate([one.ravel(), np.repeat(of_driven.driver, 2)])
        driven = np.concatenate([np.repeat(of_driver.driven, 2), other.ravel()])
        some = (drivers >= 0) & (driven >= 0)
        return drivers[some], driven[some]


@dataclass(slots=True)
class BestFirst(Bracket):
    """A branch and bound whose upper bound falls from step to step; `levels` counts these."""

    def run(self, sides: Tilings, look: Lookout, *, content: bool = False) -> None:
        """Bound all pairs, then halve those with the greatest bounds, until none is left.

        It ends early with the budget, on request, or where it is `content` with any
        design; `upper` is valid even then.
        """
        self.left = self.bounded(all_pairs(*sides.every), sides.bounded)
        self.begun = self.left is not None
        while self.left is not None and len(self.left):
            best, rest = _parted(self.left)
            self.left = Pairs.joined([best, rest])
            self.lower = max(self.lower, look(sides, self.left, max(self.lower, self.required.floor)))
            if content and self.lower:
                return
            best, rest = (part[part.bound > self.threshold] for part in (best, rest))
            self.left = Pairs.joined([best, rest])
            self.over_budget = len(self.left) > MOST_LEFT
            if not len(self.left) or self.over_budget:
                return
            halves = self.bounded(in_blocks(*sides.halved(best)), sides.bounded)
            if halves is None:
                return
            self.left, self.levels = Pairs.joined([rest, halves]), self.levels + 1


def _parted(pairs: Pairs) -> tuple[Pairs, Pairs]:
    """The pairs with the greatest bounds, which are halved together, and the others."""
    if len(pairs) <= HALVED:
        return pairs, pairs[:0]
    order = np.argpartition(-pairs.bound, HALVED)
    return pairs[order[:HALVED]], pairs[order[HALVED:]]
