"""Function generators of least error under limits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.driven import driven_starts
from grashof.synth.starts.functions.pairs import MET, ROUNDING
from grashof.synth.starts.functions.places import PlaceLimits
from grashof.synth.theory.functions.fit import DesiredOutput, best_apart, best_varied, fitted
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.optima import STEPS, Aim, Ends, refined, with_extremes
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.starts import anywhere, crank_starts, function_starts
from grashof.synth.theory.stopping import stop_requested

CRANKS = 8000  # random full cranks, from which least squares begins besides
ROUGH, ROUGH_STEPS = 13, 7  # samples of the range for the first steps of least squares, and their number
PULLS = (0.1, 1.0)  # rad, or shares of the travel: what a missed limit counts as in least squares
STRONG = (1.0, 10.0)  # the same where more than the shape is limited
BASINS, TRIED, SHORT = 12, 30, 5  # starts that are refined, and those tried in few steps
LONG = 180  # steps where more than the shape is limited: valleys are narrow
EARLY = 12  # steps after which those that have become alike are refined no further
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

    def rough(self, rng: np.random.Generator, effort: float) -> list[tuple[Generators, float]]:
        """Many starts moved a few steps by least squares at few samples, with the pull of limits on them."""
        aims, limits, held = self.aims, self.limits, self.first is not None
        few = aims.pairs(self.sense) if self.by_pairs else aims.samples(self.sense, ROUGH)
        full = limits.margin is not None or bool(limits.shortest)
        found: list[tuple[Generators, float]] = []
        for _ in range(max(1, round(effort))):
            kinds = [self._near(self.desired, rng)]
            if full:
                cranks = crank_starts(aims.kind, self.desired, rng, CRANKS, self.first, limits.shortest)
                cranks = self._placed(cranks)
                kinds.append(cranks[limits.of(cranks).value.min(axis=1) > -0.1])
            for starts in kinds:
                for pull in self._pulls(full):
                    batch, _ = fitted(few, starts, limits.of, pull=pull, held=held, steps=ROUGH_STEPS)
                    found.append((batch, pull))
        return found

    def _pulls(self, full: bool) -> tuple[float, ...]:
        if self.limits.beyond_shape:
            return STRONG
        return PULLS if full else PULLS[:1]

    def starts(self, rough: Iterable[tuple[Generators, float]]) -> Generators:
        """Least squares from many starts, as `rough` gives them, best first; limits pull."""
        desired, held, found = self.desired, self.first is not None, list[Generators]()
        for begun, pull in rough:
            batch, square = fitted(
                desired, begun, self.limits.of, pull=pull, held=held, taken=ROUGH_STEPS - 1
            )
            found.append(batch[best_varied(batch, square, CELL)[:TRIED]])
        batch = self.aims.made.joined(found)
        square = desired.square(desired.errors(batch))
        if self.limits.beyond_shape:
            missed = np.maximum(-self.limits.of(batch).value.min(axis=1), 0.0)
            square = np.sqrt(square / desired.weights.sum()) + missed
        return batch[best_varied(batch, np.nan_to_num(square, nan=np.inf), CELL)]

    @property
    def by_pairs(self) -> bool:
        """Whether the pairs are fitted, rather than samples of the range."""
        return len(self.aims.task) >= 6 and self.aims.task.norm == "rms"

    @property
    def desired(self) -> DesiredOutput:
        """The output that is fitted."""
        return self.aims.pairs(self.sense) if self.by_pairs else self.aims.samples(self.sense)

    def _near(self, desired: DesiredOutput, rng: np.random.Generator, stride: int = 1) -> Generators:
        """Generators near the desired output, or one in `stride` of them."""
        if self.aims.triangle is not None:
            return driven_starts(self.aims, desired, rng, 1 / stride)
        near = function_starts(self.aims.kind, desired, rng, self.first)
        if self.limits.beyond_shape and self.first is None:
            near = near.joined([near, anywhere(self.aims.kind, desired, rng)])
        return self._placed(near[::stride])

    def _placed(self, starts: Generators) -> Generators:
        """Starts in places that suit their limits."""
        places = self.limits.places
        return places.placed(starts.finite) if isinstance(places, PlaceLimits) else starts

    def aim(self) -> Aim:
        """The error to be made least."""
        aims, greatest = self.aims, self.aims.task.norm == "max"
        desired = aims.samples(self.sense) if greatest else aims.pairs(self.sense)
        held, band = self.first is not None, aims.greatest_error
        return Aim(desired, self.limits, greatest=greatest, held=held, band=band)

    @property
    def apart(self) -> tuple[int, int]:
        """Equal for searches whose limits differ in their transmission angle alone."""
        by_driver = self.limits.offset is not None or self.aims.directed
        by_sense = self.limits.rates is not None
        return by_driver * self.driver, by_sense * self.sense

    def quick_pass(self) -> Generators:
        """A good optimum from few starts, if any: there usually is one, before the search has begun."""
        aim = self.aim()
        desired, held = aim.desired, self.first is not None
        starts = self._near(desired, np.random.default_rng(0), SPARSE)
        batch, square = fitted(desired, starts, self.limits.of, pull=PULLS[0], held=held, steps=QUICK_STEPS)
        tried = refined(aim, batch[best_apart(batch, square, CELL)[:FIRST]], SHORT)
        best = tried.generators[np.argsort(tried.worth, kind="stable")[:1]]
        ends = refined(aim, best, QUICK_STEPS if aim.greatest else STEPS)
        if aim.greatest:
            ends = _Batch.of([(self, ends.generators)]).with_extremes(QUICK_STEPS)
        return ends.generators[ends.missed <= ROUNDING]

    def settled(self, end: Optimum) -> Generators:
        """The same to all its digits: its valley is narrow, and its extremes move with it."""
        found, error = end.generator, end.error
        for _ in range(SETTLED):
            before, batch = error, _Batch.of([(self, found)])
            ends = batch.with_extremes() if self.aims.task.norm == "max" else refined(batch.aim, found)
            found, error = ends.generators, float(ends.error[0])
            if abs(error - before) <= MET * before or stop_requested():
                break
        return found


@dataclass(frozen=True, slots=True)
class Optimum:
    """A generator of least error, in a batch of one, and the search that found it."""

    search: Optima
    generator: Generators
    error: float


def optima(
    begun: Iterable[tuple[Optima, Generators]], *, few: bool, missed: float = ROUNDING
) -> list[Optimum]:
    """The best distinct optima of searches, from starts that come best first; of `few` only the best ones.

    Limits may be `missed` by so much.
    """
    together = dict[tuple[int, int], list[tuple[Optima, Generators]]]()
    for search, starts in begun:
        together.setdefault(search.apart, []).append((search, starts[:TRIED]))
    found = list[Optimum]()
    for some in together.values():
        batch = _Batch.of(some)
        batch, _ = batch.chosen(refined(batch.aim, batch.generators, SHORT), _hopeful)
        batch, _ = batch.chosen(refined(batch.aim, batch.generators, EARLY), _distinct)
        steps = LONG if batch.aim.limits.beyond_shape else STEPS
        batch, ends = batch.chosen(refined(batch.aim, batch.generators, steps), _best if few else _distinct)
        if batch.aim.greatest:
            ends = batch.with_extremes()
        batch, ends = batch.chosen(ends, lambda some: _apart(some, some.error, some.missed <= missed))
        for k, error in enumerate(ends.error.tolist()):
            found.append(Optimum(batch.searches[batch.of_search[k]], ends.generators[k : k + 1], error))
    return found


@dataclass(frozen=True, slots=True)
class _Batch:
    """Generators of searches whose limits differ in their transmission angle alone."""

    searches: Sequence[Optima]
    of_search: IntArray  # (M,)
    generators: Generators  # M of them

    @classmethod
    def of(cls, begun: Sequence[tuple[Optima, Generators]]) -> _Batch:
        """All generators of some searches."""
        searches, starts = zip(*begun, strict=True)
        counts = [len(each) for each in starts]
        return cls(searches, np.repeat(np.arange(len(counts)), counts), starts[0].joined(list(starts)))

    @property
    def aim(self) -> Aim:
        """The errors to be made least."""
        each = [search.aim() for search in self.searches]
        outputs = np.stack([aim.desired.output for aim in each])[self.of_search]
        angles = np.array([aim.limits.transmission for aim in each])[self.of_search]
        return replace(
            each[0],
            desired=replace(each[0].desired, output=outputs),
            limits=replace(each[0].limits, transmission=angles),
        )

    def with_extremes(self, steps: int = STEPS) -> Ends:
        """Refined once more, with all extremes of their errors in view."""
        dense = [each.aims.dense(each.sense) for each in self.searches]
        outputs = np.stack([output for _, output in dense])[self.of_search]
        return refined(with_extremes(self.aim, self.generators, dense[0][0], outputs), self.generators, steps)

    def chosen(self, ends: Ends, choose: Callable[[Ends], IntArray]) -> tuple[_Batch, Ends]:
        """The ends that are chosen of each search."""
        each = [np.flatnonzero(self.of_search == k) for k in range(len(self.searches))]
        rows = np.concatenate([rows[choose(ends[rows])] for rows in each])
        return _Batch(self.searches, self.of_search[rows], ends.generators[rows]), ends[rows]


def _hopeful(tried: Ends) -> IntArray:
    """The most promising, best first."""
    near = tried.worth <= HOPELESS * tried.worth.min(initial=np.inf) + MET
    best = np.flatnonzero(near & np.isfinite(tried.worth))
    hopeful: IntArray = best[best_varied(tried.generators[best], tried.worth[best], CELL)][:BASINS]
    return hopeful


def _distinct(ends: Ends) -> IntArray:
    """Those that are not alike, best first."""
    return _apart(ends, ends.worth)


def _best(ends: Ends) -> IntArray:
    """A few of them."""
    return _distinct(ends)[:BEST]


def _apart(ends: Ends, worth: FloatArray, among: BoolArray | bool = True) -> IntArray:
    """Which of some optima are distinct and of finite `worth`, the least first."""
    finite = np.flatnonzero(np.isfinite(worth) & among)
    best: IntArray = finite[best_apart(ends.generators[finite], worth[finite], CELL)]
    return best
