"""Function generators of least error under limits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.driven import driven_starts
from grashof.synth.starts.functions.pairs import MET, ROUNDING
from grashof.synth.theory.functions.fit import DesiredOutput, best_apart, fitted
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.optima import Aim, Optimum, refined, with_extremes
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.starts import crank_starts, function_starts
from grashof.synth.theory.stopping import stop_requested

CRANKS = 8000  # random full cranks, from which least squares begins besides
PULLS = (0.1, 1.0)  # rad, or shares of the travel: what a missed limit counts as in least squares
BASINS, TRIED, SHORT = 9, 30, 5  # starts that are refined to the end, and those tried in few steps
# Of a quick pass: starts tried, the stride of those fitted, and their steps.
FIRST, SPARSE, QUICK_STEPS = 3, 16, 12
BEST = 2  # of the ends at a transmission angle that a choice is offered at
HOPELESS = 50.0  # times the least error: no further
CELL = 0.04  # of optima: closer ones are alike
SETTLED = 8  # times that the best is refined once more


@dataclass(frozen=True, slots=True)
class Optima:
    """Optima in one sense of output and driver, under limits of the shape."""

    aims: FunctionAims
    limits: ShapeLimits
    sense: int
    driver: int
    first: float | None

    @classmethod
    def each(cls, aims: FunctionAims, transmission: float = 0.0) -> list[Self]:
        """One for every sense of output and driver; with a transmission angle, rad, if more than required."""
        least = max(aims.limits.transmission, transmission)
        return [
            cls(aims, replace(aims.limits_of(driver, sense), transmission=least), sense, driver, first)
            for sense, driver, first in aims.ways()
        ]

    def starts(self, rng: np.random.Generator, effort: float) -> Generators:
        """Least squares from many starts, best first; limits pull."""
        aims, limits = self.aims, self.limits
        by_pairs = len(aims.task) >= 6 and aims.task.norm == "rms"
        desired = aims.pairs(self.sense) if by_pairs else aims.samples(self.sense)
        full = limits.margin is not None or bool(limits.shortest)
        found: list[Generators] = []
        for _ in range(max(1, round(effort))):
            kinds = [self._near(desired, rng)]
            if full:
                cranks = crank_starts(aims.kind, desired, rng, CRANKS, self.first, limits.shortest)
                kinds.append(cranks[limits.of(cranks).value.min(axis=1) > -0.1])
            for starts in kinds:
                for pull in PULLS if full else PULLS[:1]:
                    batch, square = fitted(desired, starts, limits.of, pull=pull, held=self.first is not None)
                    found.append(batch[best_apart(batch, square, CELL)[:TRIED]])
        batch = aims.kind.joined(found)
        square = desired.square(desired.errors(batch))
        return batch[best_apart(batch, np.nan_to_num(square, nan=np.inf), CELL)]

    def _near(self, desired: DesiredOutput, rng: np.random.Generator) -> Generators:
        """Generators near the desired output."""
        if self.aims.triangle is not None:
            return driven_starts(self.aims, desired, rng, 1.0)
        return function_starts(self.aims.kind, desired, rng, self.first)

    def aim(self) -> Aim:
        """The error to be made least."""
        greatest, most = self.aims.task.norm == "max", self.aims.greatest_error
        desired = self.aims.samples(self.sense) if greatest else self.aims.pairs(self.sense)
        return Aim(desired, self.limits.of, greatest=greatest, held=self.first is not None, band=most)

    def optima(self, starts: Generators, *, few: bool) -> Iterator[Optimum]:
        """The best distinct optima from starts that come best first; of `few` only the best ones."""
        aim = self.aim()
        tried = self._tried(aim, starts, TRIED)
        worth = np.array([_worth(one) for one in tried])
        hopeful = [tried[k] for k in _apart(tried, worth) if worth[k] <= HOPELESS * worth.min() + MET]
        ends = [refined(aim, one.generator) for one in hopeful[:BASINS]]
        if few:
            ends = sorted(ends, key=_worth)[:BEST]
        if aim.greatest:
            ends = [self._with_extremes(aim, one) for one in ends]
        good = [one for one in ends if one.missed <= ROUNDING]
        for k in _apart(good, np.array([one.error for one in good])):
            yield good[k]

    def quick_pass(self) -> Iterator[Optimum]:
        """A good optimum from few starts: there usually is one, before the search has begun."""
        rng, aim = np.random.default_rng(0), self.aim()
        starts = self._near(aim.desired, rng)[::SPARSE]
        batch, square = fitted(
            aim.desired, starts, self.limits.of, pull=PULLS[0], held=self.first is not None, steps=QUICK_STEPS
        )
        best = batch[best_apart(batch, square, CELL)]
        if not len(best):
            return
        end = refined(aim, min(self._tried(aim, best, FIRST), key=_worth).generator)
        if aim.greatest:
            end = self._with_extremes(aim, end)
        if end.missed <= ROUNDING:
            yield end

    @staticmethod
    def _tried(aim: Aim, starts: Generators, most: int) -> list[Optimum]:
        """A few steps from each of the first starts."""
        return [refined(aim, starts[k : k + 1], SHORT) for k in range(min(most, len(starts)))]

    def settled(self, end: Optimum) -> Optimum:
        """The same to all its digits: its valley is narrow, and its extremes move with it."""
        for _ in range(SETTLED):
            before, aim = end.error, self.aim()
            end = self._with_extremes(aim, end) if aim.greatest else refined(aim, end.generator)
            if abs(end.error - before) <= MET * before or stop_requested():
                break
        return end

    def _with_extremes(self, aim: Aim, end: Optimum) -> Optimum:
        """The same with all extremes of its error in view."""
        return refined(with_extremes(aim, end.generator, *self.aims.dense(self.sense)), end.generator)


def _worth(one: Optimum) -> float:
    """Its error and its misses; less is better."""
    return one.error + 10 * one.missed


def _apart(some: list[Optimum], worth: FloatArray) -> list[int]:
    """Which of some optima are distinct and finite, the least of `worth` first."""
    finite = np.flatnonzero(np.isfinite(worth))
    if not finite.size:
        return []
    batch = some[0].generator.joined([some[k].generator for k in finite])
    best: list[int] = finite[best_apart(batch, worth[finite], CELL)].tolist()
    return best
