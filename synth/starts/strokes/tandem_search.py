"""The search for linkages with two swings: differential evolution over what the swings leave free.

Every linkage of a population has both swings by construction (`tandem_shapes`). Of two, the one that misses
the limits by less is better, or where both keep them that of the better objective (Deb 2000).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from grashof.problems import Box, Problem, Requirements, Rotatability
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray, Limits
from grashof.problems.values.box import ANYWHERE
from grashof.problems.values.region import standing
from grashof.synth.starts.strokes.tandem_shapes import (
    DRIVEN_BY_4,
    DRIVEN_BY_CRANK,
    SHAPE,
    Swings,
    TandemMotion,
    Tandems,
    tandems,
    transmissions,
)
from grashof.synth.theory.stopping import raise_if_overdue

MEMBERS, GENERATIONS = 40, 200  # of each population
DRAWN, LEADERS = 6, 5  # times as many are drawn; number of the best in whose direction others move
SIGNS = ((False, False), (False, True), (True, False), (True, True))
PLACES = 6  # numbers that place O2, O4 and D
WIDTH = PLACES + SHAPE
# Beyond what is required, for peaks between samples: deg of transmission angle; share of the margin.
SPARE_DEG, SPARE = 0.02, 1e-3
# Transmission angles: with less a linkage is as good as locked, or peaks hide between samples.
LEAST_DEG, USABLE_DEG = 0.5, 15.0
BROAD = (0.25, 4.0)  # lengths of the ground that are tried where it is free, in sizes
AWAY = (0.3, 6.0)  # distances of D from O2 likewise
OF_SWINGS = 100.0  # weight of what makes a linkage one with both swings, beside other limits
TINY = 1e-12
UNSOUND = 1e6  # miss of a linkage that does not close
NEAR = 0.01  # spread of numbers about a known linkage
STEP, CROSSING = (0.4, 0.9), 0.8  # of differential evolution (Storn & Price 1997)
# Numbers that are angles, which go round.
_ROUND = {
    DRIVEN_BY_4: (PLACES + 3, PLACES + 4),
    DRIVEN_BY_CRANK: (PLACES + 4,),
}


class Population(NamedTuple):
    """Linkages (n,) of one pair of hosts: their numbers in [0, 1], signs, misses and scores."""

    unknowns: FloatArray  # (n, WIDTH)
    sides: BoolArray  # (n, 2)
    missed: FloatArray  # of limits; 0 where all are kept
    score: FloatArray  # the greater the better

    def taken(self, index: IntArray | BoolArray) -> Population:
        """Some of them."""
        return Population(self.unknowns[index], self.sides[index], self.missed[index], self.score[index])

    def where(self, chosen: BoolArray, other: Population) -> Population:
        """These where they are chosen, elsewhere others."""
        return Population(
            np.where(chosen[:, None], self.unknowns, other.unknowns),
            np.where(chosen[:, None], self.sides, other.sides),
            np.where(chosen, self.missed, other.missed),
            np.where(chosen, self.score, other.score),
        )

    @property
    def order(self) -> IntArray:
        """Indices, the best first."""
        return np.lexsort((-self.score, self.missed))


def joined(*parts: Population) -> Population:
    """Several as one."""
    return Population(*map(np.concatenate, zip(*parts, strict=True)))


@dataclass(frozen=True)
class TandemAim:
    """Limits and goals of a problem with two swings."""

    problem: Problem
    wanted: Requirements  # resolved, in the problem's unit
    least_deg: float = LEAST_DEG  # transmission angle

    @classmethod
    def of(cls, problem: Problem) -> TandemAim:
        """Of a problem."""
        task = problem.task
        wanted = problem.requirements.resolved(task.size, scale_free=task.scale_free)
        return cls(problem, wanted, max(LEAST_DEG, wanted.transmission_min_deg))

    @property
    def usable(self) -> TandemAim:
        """The same with a transmission angle that can be used, where none is required."""
        stated = self.wanted.transmission_min_deg > 0
        return self if stated else replace(self, least_deg=USABLE_DEG)

    @cached_property
    def swings(self) -> Swings:
        """Swings and time ratios."""
        task = self.problem.task
        return Swings(task.swings or (0.0, 0.0), task.time_ratios)

    @cached_property
    def drives(self) -> list[tuple[int, int]]:
        """The hosts of the second four-bar that may do; driven by link 4 both outputs turn back at once."""
        return [DRIVEN_BY_4, DRIVEN_BY_CRANK] if self.swings.together else [DRIVEN_BY_CRANK]

    def ratio_of(self, place: int, hosts: tuple[int, int]) -> float | None:
        """The time ratio of the first or second four-bar, where that is stated."""
        return self.swings.ratios(hosts)[place]

    @cached_property
    def limited(self) -> bool:
        """Whether anything but proportions is limited, so that the size is of account."""
        wanted = self.wanted
        lengths = [getattr(wanted, name) for name in ("link_length", "size", *_LENGTHS[1:])]
        return any(each is not None for each in (*lengths, *(b for b in self._boxes if b != ANYWHERE)))

    @property
    def _boxes(self) -> list[Box]:
        wanted = self.wanted
        return [standing(wanted.o2), standing(wanted.o4), standing(wanted.d)]

    @cached_property
    def size(self) -> float:
        """A length of the linkages: as limits of lengths state it, or the pivots that are not free."""
        two, four, six = (_middle(box) for box in self._boxes)
        ends = [each for each in (two, four) if each is not None]
        if six is None or len(ends) != 1 or not abs(six - ends[0]):
            return self.problem.task.size
        return abs(six - ends[0]) / 2

    def pivots(self, places: FloatArray) -> ComplexArray:
        """O2, O4 and D (n, 3) by numbers in [0, 1], (n, PLACES): a pair for each.

        Shares of its box, or where it is free its distance and direction from another pivot.
        """
        (two, four, six), (first, second, third) = self._boxes, np.split(places, 3, axis=1)
        nowhere = np.zeros(len(places), dtype=np.complex128)
        if two != ANYWHERE or (four == ANYWHERE and six == ANYWHERE):
            o2 = _inside(two, nowhere, first)
        elif four != ANYWHERE:
            o2 = _inside(four, nowhere, second) - self._ground(first)
        else:
            o2 = _inside(six, nowhere, third) - self._away(first)
        o4 = _inside(four, o2 + self._ground(second), second)
        if (turned := self.wanted.angle_of("ground_angle_deg")) is not None:
            o4 = o2 + np.abs(o4 - o2) * np.exp(1j * turned)
        return np.stack([o2, o4, _inside(six, o2 + self._away(third), third)], axis=-1)

    def places(self, o2: complex, o4: complex, d: complex) -> list[float]:
        """The numbers by which `pivots` gives O2, O4 and D, or places near them."""
        found = list[float]()
        ground, away = self._ground_numbers(o4 - o2), self._away_numbers(d - o2)
        from_other = ground if self._boxes[1] != ANYWHERE else away
        for box, place, otherwise in zip(self._boxes, (o2, o4, d), (from_other, ground, away), strict=True):
            sides = (box.x, place.real), (box.y, place.imag)
            for ((least, most), at), number in zip(sides, otherwise, strict=True):
                bounded = np.isfinite(most - least)
                found.append(float((at - least) / (most - least or 1.0) if bounded else number))
        return found

    @property
    def _ground_lengths(self) -> Limits:
        """Least and greatest length of a ground line that is free."""
        if self.wanted.r1 is not None:
            least, most = self.wanted.r1
            return max(least, 1e-9 * self.size), min(most, BROAD[1] * self.size + least)
        spread = BROAD if self.limited else (1.0, 1.0)
        return spread[0] * self.size, spread[1] * self.size

    def _ground(self, pair: FloatArray) -> ComplexArray:
        """From O2 to O4."""
        low, high = np.log(self._ground_lengths)
        turned = self.wanted.angle_of("ground_angle_deg")
        free = turned is None and any(box != ANYWHERE for box in self._boxes)
        angle = TURN * pair[:, 1] if free else np.full(len(pair), turned or 0.0)
        way: ComplexArray = np.exp(low + (high - low) * pair[:, 0] + 1j * angle)
        return way

    def _ground_numbers(self, way: complex) -> tuple[float, float]:
        low, high = np.log(self._ground_lengths)
        return float((np.log(abs(way)) - low) / ((high - low) or 1.0)), float(np.angle(way)) / TURN % 1

    def _away(self, pair: FloatArray) -> ComplexArray:
        """From O2 to D."""
        low, high = np.log(self.size * np.array(AWAY))
        way: ComplexArray = np.exp(low + (high - low) * pair[:, 0] + 1j * TURN * pair[:, 1])
        return way

    def _away_numbers(self, way: complex) -> tuple[float, float]:
        low, high = np.log(self.size * np.array(AWAY))
        return float((np.log(abs(way) or 1e-300) - low) / (high - low)), float(np.angle(way)) / TURN % 1

    def made(self, hosts: tuple[int, int], unknowns: FloatArray, sides: BoolArray) -> Tandems:
        """Linkages by their numbers."""
        pivots = self.pivots(unknowns[:, :PLACES])
        return tandems(self.swings, hosts, pivots, unknowns[:, PLACES:], sides)

    def judged(self, hosts: tuple[int, int], unknowns: FloatArray, sides: BoolArray) -> Population:
        """Linkages with their misses and scores."""
        with np.errstate(all="ignore"):
            made = self.made(hosts, unknowns, sides)
            motion = made.motion()
            values = self._values(made, motion)
            missed = sum(self._misses(made, motion, values))
            score = self._score(values)
        sound = np.isfinite(missed) & np.isfinite(score)
        return Population(unknowns, sides, np.where(sound, missed, UNSOUND), np.where(sound, score, -np.inf))

    def synchrony(self, hosts: tuple[int, int], unknowns: FloatArray, sides: BoolArray) -> FloatArray:
        """Synchrony errors, (n,)."""
        with np.errstate(all="ignore"):
            found = self.made(hosts, unknowns, sides).motion().synchrony_errors(self.swings.swings)
        return np.nan_to_num(found, nan=np.inf)

    def _values(self, made: Tandems, motion: TandemMotion) -> dict[str, FloatArray]:
        """Quantities by their keys, in the problem's units, the crank turning at its speed."""
        dynamics = self.problem.dynamics
        omega2 = 1.0 if dynamics is None else dynamics.omega2
        lengths = np.stack(list(made.lengths.values()))
        return {
            "transmission": transmissions(made, motion),
            "output_acceleration_max": omega2**2 * motion.accelerations,
            "omega4_max": omega2 * np.abs(motion.first.speed).max(axis=1),
            "synchrony_error": motion.synchrony_errors(self.swings.swings),
            "size": motion.sizes(made),
            "link_ratio": lengths.max(axis=0) / lengths.min(axis=0),
            **made.lengths,
        }

    def _score(self, values: dict[str, FloatArray]) -> FloatArray:
        """The objective, as far as its quantities are known; otherwise the transmission angle."""
        total = 1e-9 * values["transmission"]
        known = [(goal, weight) for goal, weight in self.problem.goals if _plain(goal.key) in values]
        if not known:
            return values["transmission"]
        for goal, weight in known:
            total = total + weight * goal.better * values[_plain(goal.key)] / self.problem.scale(goal)
        return total

    def _misses(
        self, made: Tandems, motion: TandemMotion, values: dict[str, FloatArray]
    ) -> Iterator[FloatArray]:
        """By how much each limit is missed, (n,): 0 where it is kept."""
        wanted, size = self.wanted, self.size
        yield from OF_SWINGS * np.maximum(1e-9 - made.margins, 0.0).T
        if made.hosts == DRIVEN_BY_4:  # link 6 moves in one sense with link 4, or in the opposite one
            ratio = motion.second.ratio
            yield OF_SWINGS * np.maximum(-ratio.min(axis=1) * ratio.max(axis=1), 0.0)
        turns = values["r1"] - made.r2 - np.abs(made.r3 - made.r4), made.r3 + made.r4 - values["r1"] - made.r2
        total = values["r1"] + made.r2 + made.r3 + made.r4
        margin = 0.0 if wanted.rotatability is Rotatability.ANY else wanted.rotatability_margin * (1 + SPARE)
        yield OF_SWINGS * np.maximum(margin - np.min(turns, axis=0) / total, 0.0)
        least = np.radians(self.least_deg + SPARE_DEG)
        yield np.maximum(least - values["transmission"], 0.0)
        for key, (low, high) in self._limits.items():
            yield np.maximum(np.log(max(low, TINY) / np.maximum(values[key], TINY)), 0.0)
            yield np.maximum(np.log(np.maximum(values[key], TINY) / max(high, TINY)), 0.0)
        for box, place in zip(self._boxes, (made.o2, made.o4, made.d), strict=True):
            for (low, high), at in ((box.x, place.real), (box.y, place.imag)):
                slack = 1e-10 * size
                yield np.maximum(np.maximum(low - slack - at, at - high - slack), 0.0) / size

    @cached_property
    def _limits(self) -> dict[str, Limits]:
        """Limits of quantities, by key, a little inside."""
        wanted = self.wanted
        found: dict[str, Limits] = {"link_ratio": (0.0, wanted.link_ratio_max * (1 - 1e-9))}
        for name in _LENGTHS:
            limit = getattr(wanted, name) or wanted.link_length
            if limit is not None:
                found[name] = (limit[0] * (1 - 1e-10), limit[1] * (1 + 1e-10))
        for name in ("size", "output_acceleration_max", "omega4_max", "synchrony_error"):
            limit = getattr(wanted, name)
            if limit is not None:
                found[name] = (limit[0] * (1 + SPARE), limit[1] * (1 - SPARE))
        return found


_LENGTHS = ("r1", "r2", "r3", "r4", "r5", "r6")


def _plain(key: str) -> str:
    """The key of a quantity, whichever motion a transmission angle is of: the task is the turn."""
    return "transmission" if key.startswith("transmission") else key


def _middle(box: Box) -> complex | None:
    """A place in the middle of a box, or of its sides that are bounded; None where none is."""
    if box == ANYWHERE:
        return None
    half = np.full((1, 2), 0.5)
    return complex(_inside(box, np.zeros(1, dtype=np.complex128), half)[0])


def _inside(box: Box, near: ComplexArray, share: FloatArray) -> ComplexArray:
    """Places (n,) in a box, by shares of its sides (n, 2); along an axis on which it is open near others."""
    parts = []
    for axis, ((low, high), at) in enumerate(((box.x, near.real), (box.y, near.imag))):
        bounded = np.isfinite(high - low)
        parts.append(low + share[:, axis] * (high - low) if bounded else np.clip(at, low, high))
    return parts[0] + 1j * parts[1]


Judged = Callable[[FloatArray, BoolArray], Population]


def drawn(rng: np.random.Generator, count: int) -> tuple[FloatArray, BoolArray]:
    """Random numbers, `count` for each pair of signs."""
    return rng.random((len(SIGNS) * count, WIDTH)), np.repeat(np.array(SIGNS), count, axis=0)


def drawn_near(
    unknowns: FloatArray, sides: BoolArray, rng: np.random.Generator
) -> tuple[FloatArray, BoolArray]:
    """Numbers (WIDTH,), and some close to them."""
    near = unknowns + NEAR * rng.normal(size=(MEMBERS, WIDTH))
    near[0] = unknowns
    return np.clip(near, 0, 1), np.tile(sides, (MEMBERS, 1))


def evolved(
    judged: Judged, begun: Population, rng: np.random.Generator, hosts: tuple[int, int], generations: int
) -> tuple[Population, list[Population]]:
    """The last generation of populations of `MEMBERS` side by side, and all that were tried on the way."""
    best, tried, count = begun, [begun], len(begun.score)
    own = np.repeat(np.arange(0, count, MEMBERS), MEMBERS)  # where the population of each begins
    goes_round = np.isin(np.arange(WIDTH), _ROUND[hosts])
    for _ in range(generations):
        raise_if_overdue()
        ranked = np.lexsort((-best.score, best.missed, own))
        leader = ranked[own + rng.integers(0, LEADERS, count)]
        one, other = (own + rng.integers(0, MEMBERS, count) for _ in range(2))
        here = best.unknowns
        ways = np.stack([here[leader] - here, here[one] - here[other]])
        ways = np.where(goes_round, (ways + 0.5) % 1 - 0.5, ways)
        trial = here + rng.uniform(*STEP, (count, 1)) * ways.sum(axis=0)
        trial = np.where(rng.random(trial.shape) < CROSSING, trial, here)
        inside = np.where(goes_round, trial % 1, np.clip(trial, 0, 1))
        trial = np.where(goes_round | (inside == trial), inside, (here + inside) / 2)
        found = judged(trial, best.sides)
        better = (found.missed < best.missed) | ((found.missed == best.missed) & (found.score > best.score))
        tried.append(found)
        best = found.where(better, best)
    return best, tried


def searched(
    aim: TandemAim,
    hosts: tuple[int, int],
    rng: np.random.Generator,
    judged: Judged | None = None,
    generations: int = GENERATIONS,
) -> Population:
    """All linkages of one pair of hosts that a search tries and that keep the limits, else the closest.

    A population for each pair of signs; the best of these then goes on.
    """
    judge = judged or partial(aim.judged, hosts)
    begun = judge(*drawn(rng, DRAWN * MEMBERS))
    group = np.repeat(np.arange(len(SIGNS)), DRAWN * MEMBERS)
    ranked = np.lexsort((-begun.score, begun.missed, group)).reshape(len(SIGNS), -1)
    last, every = evolved(judge, begun.taken(ranked[:, :MEMBERS].ravel()), rng, hosts, generations)
    first = int(last.order[0]) // MEMBERS * MEMBERS
    leading = last.taken(np.arange(first, first + MEMBERS))
    found = joined(*every, *evolved(judge, leading, rng, hosts, generations)[1])
    kept = np.flatnonzero(found.missed == 0)
    return found.taken(kept if len(kept) else found.order[:MEMBERS])
