"""Shapes of linkages whose first loop is a four-bar, and whose loops close by construction, with derivatives.

With O2 = 0 and r1 = 1 a shape is a row of free numbers: shares of the possible lengths of each loop (see
`feasible`), the places of C and D, the direction of a slide. The gap
between C and D is sampled over the motion of the first loop, so that the last lengths close all of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from grashof.problems.values.arrays import TURN, BoolArray, FloatArray
from grashof.problems.values.linkages.mechanism import Mechanism, Parameter
from grashof.synth.loop.chain import gap_of
from grashof.synth.loop.differences import Differences
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.dyad import Bars
from grashof.synth.loop.feasible import Demand, bars_between, feasible
from grashof.synth.loop.vector import Vector

SAMPLES = 48  # of a turn, or of a range, for the extremes of a gap
SHORT = 2e-3  # share by which samples may understate these
SPREAD = 1.0  # of random places of C and D, over r1
FIRST = 3  # free numbers of the first loop
ENDS = 2  # ends of the task motion, among the columns of derivatives


@dataclass(frozen=True, slots=True)
class Shapes:
    """The shapes of a mechanism as columns of free numbers, and the motion over which their loops close."""

    mechanism: Mechanism
    turning: bool = True  # they close all round the turn; otherwise over the task motion
    margin: float = 0.0  # of full rotation
    transmission: float = 0.0  # rad
    over_turn: bool = True  # that angle all round the turn; otherwise over the task motion

    @property
    def later(self) -> list[Parameter]:
        """The parameters of loops after the first, in order, without their assemblies."""
        names = {row.name for row in self.mechanism.one_loop.parameters}
        return [row for row in self.mechanism.parameters if row.name not in names and row.kind != "sign"]

    @property
    def width(self) -> int:
        """Number of columns."""
        return FIRST + sum(1 + row.paired for row in self.later)

    @property
    def by_ends(self) -> bool:
        """Whether they depend on the ends of the task motion."""
        return not self.turning or (self.transmission > 0 and not self.over_turn)

    def drawn(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Random free numbers, (count, width)."""
        columns = [scipy.special.logit(rng.random((count, FIRST)))]
        for row in self.later:
            if row.paired:
                columns.append(rng.normal(0, SPREAD, (count, 2)))
            elif row.kind == "angle":
                columns.append(rng.uniform(-np.pi, np.pi, (count, 1)))
            else:
                columns.append(scipy.special.logit(rng.random((count, 1))))
        return np.concatenate(columns, axis=1)

    def made(self, free: FloatArray, longer: BoolArray, sides: FloatArray, ends: FloatArray) -> Made:
        """Dimensions from free numbers (n, width); see `Made`.

        `longer` has r2 > r1 where O4 is a pivot; `sides` (n, loops) are the assemblies, `ends` (n, 2) the
        driver angles at the ends of the task motion, rad, ascending.
        """
        return Made(self, free, longer, sides, ends)


class Made:
    """Dimensions of shapes by name, as `Dual` (n, 1) with width + 3 columns of slopes; NaN where none close.

    The last three columns are the ends of the task motion and the driver angle at a target, which no
    dimension depends on.
    """

    def __init__(
        self, shapes: Shapes, free: FloatArray, longer: BoolArray, sides: FloatArray, ends: FloatArray
    ) -> None:
        self.shapes, self.free, self.longer, self.sides, self.ends = shapes, free, longer, sides, ends
        self.columns = free.shape[1] + ENDS + 1
        self.given: dict[str, Any] = {"o4": Vector(1.0, 0.0)}
        self._first_loop()
        if len(shapes.mechanism.loops) > 1:
            self._later_loop()

    def _column(self, k: int) -> Dual:
        """A free number, or an end of the motion."""
        both = np.concatenate([self.free, self.ends], axis=1)
        return Dual(both[:, [k]], np.eye(self.columns)[k][None, None])

    def _made(self, found: Differences, column: int, at: Sequence[int], inner: Sequence[Dual] = ()) -> Dual:
        """A value of a function of `inner` numbers, and of the columns `at`."""

        def slope() -> FloatArray:
            by = found.slopes[:, column, None]
            total = np.zeros((len(by), 1, self.columns))
            total[..., list(at)] = by[..., len(inner) :]
            for k, each in enumerate(inner):
                total += by[..., [k]] * each.slope
            return total

        return Dual(found.values[:, [column]], slope)

    def _first_loop(self) -> None:
        ends = range(self.shapes.width, self.shapes.width + ENDS)

        def lengths(numbers: FloatArray) -> FloatArray:
            free, low, high = numbers[..., :FIRST], numbers[..., FIRST], numbers[..., FIRST + 1]
            longer = np.broadcast_to(self.longer[:, None], low.shape)
            sizes = feasible(Bars(), scipy.special.expit(free), longer, self._demand(low, high))
            return np.stack([sizes.r2, sizes.r3, sizes.r4], axis=-1)

        found = Differences(lengths, np.concatenate([self.free[:, :FIRST], self.ends], axis=1))
        for column, name in enumerate(("r2", "r3", "r4")):
            self.given[name] = self._made(found, column, [*range(FIRST), *ends])

    def _demand(self, low: FloatArray, high: FloatArray) -> Demand:
        """The demand on the first loop, for ends of the motion from the ground line."""
        shapes = self.shapes
        task = Demand.covering(low, high, shapes.transmission)
        if not shapes.turning:
            return task
        turn = Demand.turning(shapes.transmission * shapes.over_turn, shapes.margin)
        return turn.over(task) if shapes.by_ends else turn

    def _later_loop(self) -> None:
        loop, place = self.shapes.mechanism.loops[-1], FIRST
        for row in self.shapes.later:
            if row.paired:
                self.given[row.name] = Vector(self._column(place), self._column(place + 1))
            elif row.kind == "angle":
                self.given[row.name] = self._column(place)
            place += 1 + row.paired
        extremes, at = self._extremes(), (self.shapes.width - 2, self.shapes.width - 1)
        numbers = np.concatenate([each.value for each in extremes] + [self.free[:, at]], axis=1)
        bars = self._between_slides if loop.dyad.slides else self._between_pins
        found = Differences(bars, numbers)
        for column, name in enumerate((*loop.bars, *filter(None, [loop.offset]))):
            self.given[name] = self._made(found, column, at, extremes)

    def _between_pins(self, numbers: FloatArray) -> FloatArray:
        near, far, near_mu, far_mu, first, second = np.moveaxis(numbers, -1, 0)
        shares = scipy.special.expit(np.stack([first, second], axis=-1))
        demand = Demand.turning(self.shapes.transmission, self.shapes.margin * self.shapes.turning)
        near, far = near * (1 - SHORT), far * (1 + SHORT)
        within = near_mu * (1 - SHORT), far_mu * (1 + SHORT)
        return np.stack(bars_between(near, far, shares, demand, within), axis=-1)

    def _between_slides(self, numbers: FloatArray) -> FloatArray:
        """|offset - h| <= cos(mu) r5 for all distances h of C from the line through O2, to its left."""
        low, high, low_mu, high_mu, longer, share = np.moveaxis(numbers, -1, 0)
        cosine = np.cos(self.shapes.transmission)
        slack = SHORT * (high - low)
        least_of = (  # where both ranges of the offset, or one of each, meet
            (high - low, 2.0),
            (high_mu - low_mu, 2 * cosine),
            (np.maximum(high - low_mu, high_mu - low), 1 + cosine),
        )
        shortest = np.maximum.reduce([(apart + 2 * slack) / share for apart, share in least_of])
        r5 = shortest * (1 + np.exp(longer))
        least = np.maximum(high + slack - r5, high_mu + slack - cosine * r5)
        most = np.minimum(low - slack + r5, low_mu - slack + cosine * r5)
        return np.stack([r5, least + scipy.special.expit(share) * (most - least)], axis=-1)

    def _extremes(self) -> list[Dual]:
        """Least and greatest gap of the last loop where it closes, and where it transmits."""
        shapes, turn = self.shapes, np.arange(SAMPLES) * TURN / SAMPLES
        share = np.arange(SAMPLES) / (SAMPLES - 1)
        every = [turn] if shapes.turning else []
        every += [share] if shapes.by_ends else []
        found = []
        for way in every:
            round_turn = way is turn
            low, high = self.ends[:, :1], self.ends[:, 1:]
            theta2 = np.broadcast_to(way, (len(low), SAMPLES)) if round_turn else low + (high - low) * way
            gap = self._gap(plain(self.given), theta2)
            for index in (np.argmin(gap, axis=1), np.argmax(gap, axis=1)):
                if round_turn:
                    at: Any = way[index][:, None]
                else:
                    first, last = (self._column(shapes.width + end) for end in range(ENDS))
                    at = first + way[index][:, None] * (last - first)
                found.append(self._gap(self.given, at))
        return found if len(found) == 4 else [*found, *found]

    def _gap(self, given: Mapping[str, Any], theta2: Any) -> Any:
        driver = Vector(np.cos(theta2), np.sin(theta2))
        return gap_of(self.shapes.mechanism, given, driver, list(self.sides.T[..., None]))


def plain(given: Mapping[str, Any]) -> dict[str, Any]:
    """Dimensions without derivatives."""
    return {name: _plain(each) for name, each in given.items()}


def _plain(each: Any) -> Any:
    if isinstance(each, Vector):
        return Vector(_plain(each.x), _plain(each.y))
    return each.value if isinstance(each, Dual) else each
