"""Targets to be met exactly, other than whole poses alone; for nine or eight points all linkages."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from grashof.problems import SliderCrank
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.loop.dyad import Bars, ClosingDyad, Slider, coupler_of
from grashof.synth.programme.start import Round
from grashof.synth.quantities.driver_motion import shorter_way
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.coupler_search import CouplerSearch, searched_round
from grashof.synth.starts.loop_search import Placed, judged
from grashof.synth.starts.selection import starts_of
from grashof.synth.theory.cognates import cognate_points, driven_at_o4
from grashof.synth.theory.eight_point_linkages import Through, slider_cranks_through
from grashof.synth.theory.nine_points import coupler_turns, linkages_through
from grashof.synth.theory.point_families import FOUR_BARS, SLIDER_CRANKS

BARREN = 12  # consecutive rounds without a start after which the search ends
SEARCHES = 6  # rounds of the search before all linkages through nine points are computed
THROUGH = "linkages through the points"  # counted
FOLLOWED = "known solutions followed"  # counted: complex ones among them, cognates as one


class PrecisionPoints(CouplerSearch):
    """Any targets to be met exactly."""

    patience: ClassVar[float] = BARREN

    def round(self, _number: int, enough: int, rng: np.random.Generator, _size: int, /) -> Round | None:
        """A round of the search."""
        return searched_round(self.scaled, enough, rng)


class EveryLinkage(PrecisionPoints):
    """Distinct points of an untimed path that leave no freedom: finitely many linkages, all computable."""

    patience: ClassVar[float] = np.inf
    points: ClassVar[int]
    dyad: ClassVar[type[ClosingDyad]]
    solutions: ClassVar[int]  # that are known for general points

    @property
    def rounds_a_pass(self) -> int:
        """Some searches, then all linkages."""
        return 1 + (SEARCHES if self.scaled.wanted.order else 0)

    @classmethod
    def suits(cls, scaled: ScaledProblem) -> bool:
        """Exactly the number of points that determines the linkages, to be met exactly."""
        if not isinstance(scaled.kind.dyad, cls.dyad) or not scaled.exact or scaled.timed:
            return False
        if not scaled.problem.task.only_points:
            return False
        points = SearchTargets.of(scaled).points
        if len(points) != cls.points:
            return False
        apart = np.abs(points[:, None] - points) + np.eye(len(points))
        return bool(apart.min() > 1e-9)

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """A round of the search, which for points in order usually finishes first; then all linkages."""
        if number < self.rounds_a_pass - 1:
            return searched_round(self.scaled, enough, rng)
        # these are not computed again, however large the round
        return self._all_linkages(rng) if number < self.rounds_a_pass and size == 1 else None

    @abstractmethod
    def _all_linkages(self, rng: np.random.Generator) -> Round:
        """The feasible ones of all linkages through the points."""

    def _settled(self, linkages: Screened, chosen: IntArray, every: int, followed: int) -> Round:
        starts = [start.under(settled=True) for start in starts_of(self.scaled, linkages, chosen)]
        feasible = int(_usable(linkages).sum())
        return Round(starts, {"feasible finds": feasible, THROUGH: every, FOLLOWED: followed})

    def obstacle(self, _rng: np.random.Generator, counts: Mapping[str, int], /) -> str:
        """A note that no linkage meets the requirements; empty where they were not computed."""
        every = counts.get(THROUGH, 0)
        return f"none of the {every} linkages through the points meets all requirements" if every else ""


class NinePoints(EveryLinkage):
    """Nine points, four-bars."""

    points: ClassVar[int] = 9
    dyad: ClassVar[type[ClosingDyad]] = Bars
    solutions: ClassVar[int] = FOUR_BARS.count

    def _all_linkages(self, rng: np.random.Generator) -> Round:
        """Of every triplet of cognates through the points the first feasible one; the others follow."""
        target = SearchTargets.of(self.scaled)
        through, followed = linkages_through(target.points, rng)
        linkages = judged(self.scaled, target, *_at_points(_driven_from_both_sides(through), target))
        feasible = _usable(linkages).reshape(-1, 3, 2)
        usable = feasible.any(axis=2)
        first = usable & (np.cumsum(usable, axis=1) == 1)
        chosen = np.flatnonzero(feasible & first[..., None])
        return self._settled(linkages, chosen, 3 * len(through), followed)


class EightPoints(EveryLinkage):
    """Eight points, slider-cranks."""

    points: ClassVar[int] = 8
    dyad: ClassVar[type[ClosingDyad]] = Slider
    solutions: ClassVar[int] = SLIDER_CRANKS.count

    def _all_linkages(self, rng: np.random.Generator) -> Round:
        """All that are feasible; cognates among them are linkages of their own."""
        target = SearchTargets.of(self.scaled)
        through = slider_cranks_through(target.points, rng)
        linkages = judged(self.scaled, target, *_sliders_at_points(through, target))
        chosen = np.flatnonzero(_usable(linkages))
        return self._settled(linkages, chosen, len(through.theta2), through.solutions)


def _usable(linkages: Screened) -> BoolArray:
    """Which are feasible with a driver that goes round once at most, shape (n,)."""
    once: BoolArray = np.ptp(linkages.theta2, axis=1) <= TURN
    return linkages.feasible & once


def _driven_from_both_sides(linkages: ComplexArray) -> ComplexArray:
    """Linkages (n, 5) and their cognates, each driven from either side; (6 n, 5)."""
    cognates = cognate_points(linkages.T, timed=False)
    one_side = [linkages.T, *cognates[:2]]
    other_side = [driven_at_o4(linkages.T), *cognates[2:]]
    return np.stack([one_side, other_side]).transpose(3, 1, 0, 2).reshape(-1, 5)


def _at_points(points: ComplexArray, target: SearchTargets) -> tuple[Placed, FloatArray]:
    """Linkages (n, 5) that pass all points: where they stand there, and the shorter sense of the driver."""
    o2, _, a, b, p = (column[:, None] for column in points.T)
    turns = coupler_turns(points, target.points)
    a, b = target.points + (a - p) * turns, target.points + (b - p) * turns
    theta2, direction = shorter_way(np.angle(a - o2))
    none, p = np.zeros(len(points)), np.broadcast_to(target.points, a.shape)
    return Placed(none, points[:, 0], points[:, 1], a, b, p, theta2, body_angle=none), direction


def _sliders_at_points(through: Through[SliderCrank], target: SearchTargets) -> tuple[Placed, FloatArray]:
    """Slider-cranks that pass all points: where they stand there, and the shorter sense of the driver."""
    found = through.linkages
    o2 = found.o2 @ np.array([1, 1j])
    theta2, direction = shorter_way(through.theta2)
    crank = found.r2[:, None] * np.exp(1j * theta2)
    along, r3 = np.exp(1j * found.slide_angle)[:, None], found.r3[:, None]
    coupler, _ = coupler_of(Slider(), 1j * along, crank, r3, found.offset[:, None], through.assembly)
    a = o2[:, None] + crank
    b = a + coupler
    o4, none = b[:, 0] + (r3 * along)[:, 0], np.zeros(len(o2))
    p = np.broadcast_to(target.points, a.shape)
    return Placed(none, o2, o4, a, b, p, theta2, body_angle=none), direction
