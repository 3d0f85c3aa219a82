"""The search for function generators: exact ones of three to five pairs, and optima of any number."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.theory.functions.fit import Wanted, best_apart, fitted
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.optima import Aim, Optimum, refined, with_extremes
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.starts import crank_starts, function_starts
from grashof.synth.theory.stopping import asked_to_stop

GRID = 220  # start angles of driver and output each, of three pairs
CURVE = 2000  # output angles at a fifth place, of four pairs
CRANKS = 8000  # random full cranks, from which least squares begins besides
PULLS = (0.1, 1.0)  # rad, or shares of the travel: what a missed limit counts as in least squares
BASINS, TRIED, SHORT = 9, 30, 5  # starts that are refined to the end, and those tried in few steps
WORSE = 10.0  # times the least error: a sense of output and driver in which no choice is offered
FIRST, SPARSE, GLANCED = 3, 16, 12  # of a glance: starts tried, one of so many fitted, in so many steps
BEST = 2  # of the ends at a transmission angle that a choice is offered at
HOPELESS = 50.0  # times the least error: no further
LEAST, LOCAL = "least error", "least error nearby"
CELL, NEAR = 0.04, 0.02  # of optima, and of exact designs: closer ones are alike
LEVELS = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)  # deg of transmission, that a choice is offered at
MET = 1e-9  # rad, or shares of the travel: exact
SETTLED = 8  # times that the best is refined once more
ROUNDING = 2e-8  # of limits
_ERRORS = tuple(f"{kind}_error_{name}" for kind in ("structural", "travel") for name in ("max", "rms"))
ZOOMED, ZOOMS, ZOOM = 6, 3, 120  # exact designs about which others are tried, how often, and how many each


@dataclass(frozen=True, slots=True)
class FoundFunction:
    """One generator that the search came to."""

    made: Generators  # one
    driver: int  # its sense
    steps: int = 0  # of its refinement
    best_at: str = ""  # what it was made for; empty for exact ones


class FunctionPairs:
    """The kind of search that functions have; it proposes whole designs."""

    beginning = "looking for linkages that generate the function"

    @staticmethod
    def refuse() -> None:
        """Nothing is left to refuse: the task did."""


def exact_functions(
    aims: FunctionAims, rng: np.random.Generator, most: int, effort: float
) -> list[FoundFunction]:
    """Generators through all pairs that keep the limits, the most promising distinct ones first."""
    found: list[tuple[FloatArray, Generators, int]] = []
    for sense, driver, first in aims.ways():
        made = _through(aims, sense, driver, first, rng, effort)
        if len(made) and not asked_to_stop():
            found.append((promise(aims, made, sense), made, driver))
    if not found:
        return []
    merit = np.concatenate([each for each, _, _ in found])
    drivers = np.concatenate([np.full(len(made), driver) for _, made, driver in found])
    made = aims.kind.joined([each for _, each, _ in found])
    cell = NEAR
    best = best_apart(made, -merit, cell)
    while len(best) > 4 * most:  # a curve or surface of designs: farther apart
        cell *= 1.5
        best = best_apart(made, -merit, cell)
    return [FoundFunction(made[k : k + 1], int(drivers[k])) for k in best[:most]]


def _through(
    aims: FunctionAims, sense: int, driver: int, first: float | None, rng: np.random.Generator, effort: float
) -> Generators:
    """All that are found through the pairs and keep the limits."""
    wanted, kind, limits = aims.pairs(sense), aims.kind, aims.limits_of(driver)
    turned, output = wanted.turned - wanted.turned[0], wanted.output - wanted.output[0]
    count, pairs = len(turned), _Pairs(aims, sense, limits, wanted, turned, output)
    pinned = _pinned(aims) and count < kind.EXACT
    if count > kind.EXACT or (first is not None and count > kind.LINEAR) or pinned:
        starts = function_starts(kind, wanted, rng, first)
        near = fitted(wanted, starts, limits.of, held=first is not None)[0]
        return pairs.kept(near)
    if first is not None:
        angle = np.pi * (np.arange(round(GRID**2 * effort)) + rng.random()) / round(GRID**2 * effort)
        both = [
            kind.at_starts(turned, output, np.full(len(angle), start), kind.place_of(angle))
            for start in (first + wanted.turned[0], first + wanted.turned[0] + np.pi)
        ]
        made = kind.joined(both)
        held = np.abs(np.angle(np.exp(1j * (made.first - first - wanted.turned[0])))) < MET
        return pairs.kept(made[held].begun(wanted.turned[0]))
    if count == kind.EXACT:
        return pairs.through()
    if count == kind.EXACT - 1:
        return pairs.on_curve(round(CURVE * effort))
    return pairs.on_surface(round(GRID * np.sqrt(effort)), rng)


def _pinned(aims: FunctionAims) -> bool:
    """Whether the offset is given, so that no sweep would come upon it."""
    offset = aims.wanted.offset
    return offset is not None and offset[0] == offset[1]


@dataclass(frozen=True, slots=True)
class _Pairs:
    """Generators through a few pairs, in one sense."""

    aims: FunctionAims
    sense: int
    limits: ShapeLimits
    wanted: Wanted
    turned: FloatArray  # from the first pair
    output: FloatArray

    def through(self) -> Generators:
        """Of as many pairs as can be met: all there are."""
        made, _ = self.aims.kind.through(self.turned[None], self.output[None])
        return self.kept(made.begun(self.wanted.turned[0]))

    def through_and(self, between: float, tried: FloatArray) -> Generators:
        """Through the pairs and one more at a driver angle, at each of several outputs."""
        turned = np.broadcast_to(np.append(self.turned, between), (len(tried), len(self.turned) + 1))
        output = np.broadcast_to(self.output, (len(tried), len(self.output)))
        made, _ = self.aims.kind.through(turned, np.concatenate([output, tried[:, None]], axis=1))
        return self.kept(made.begun(self.wanted.turned[0]))

    def on_curve(self, count: int) -> Generators:
        """Of one pair less: the curve, and once more where it is best."""
        wide = int(np.argmax(np.diff(self.turned)))
        # the other pair is between two of them, where every linkage without a defect closes
        between = (self.turned[wide] + self.turned[wide + 1]) / 2
        tried, step = self.aims.kind.tried_between(count)
        pool = self.through_and(between, tried)
        for _ in range(ZOOMS):
            if not len(pool):
                break
            at = _output_at(self.best(pool), self.wanted.turned[0], between)
            more = self.through_and(between, (at[:, None] + step * np.linspace(-1, 1, ZOOM)).ravel())
            pool, step = self.aims.kind.joined([pool, more]), 3 * step / ZOOM
        return pool

    def on_surface(self, count: int, rng: np.random.Generator) -> Generators:
        """Of two pairs less: both starts on a grid, and once more where they are best."""
        kind = self.aims.kind
        half = np.pi * np.arange(count) / count
        shift = np.pi * rng.random(2) / count
        driver, first = (each.ravel() for each in np.meshgrid(half + shift[0], half + shift[1]))
        pool = self.at_starts(driver, first)
        step = np.pi / count
        across = np.linspace(-1, 1, round(np.sqrt(ZOOM)))
        about = np.stack([each.ravel() for each in np.meshgrid(across, across)])
        for _ in range(ZOOMS):
            if not len(pool):
                break
            best = self.best(pool)
            drivers = best.first + self.wanted.turned[0]
            angles = kind.angle_of(best.outputs(self.wanted.turned[:1])[:, 0])
            tried = [
                (at[:, None] + step * move).ravel() for at, move in zip((drivers, angles), about, strict=True)
            ]
            pool, step = kind.joined([pool, self.at_starts(*tried)]), 2.5 * step / len(across)
        return pool

    def at_starts(self, driver: FloatArray, angle: FloatArray) -> Generators:
        """Those with given starts."""
        kind = self.aims.kind
        made = kind.at_starts(self.turned, self.output, driver, kind.place_of(angle))
        return self.kept(made.begun(self.wanted.turned[0]))

    def best(self, pool: Generators) -> Generators:
        """A few of the most promising that are distinct."""
        return pool[best_apart(pool, -promise(self.aims, pool, self.sense), NEAR)[:ZOOMED]]

    def kept(self, made: Generators) -> Generators:
        """Those within the limits that meet every pair on one branch."""
        made = made.finite
        made = made[made.worst_cosine(self.limits.span) < 1]
        made = made[self.limits.of(made).value.min(axis=1) >= -ROUNDING]
        if not len(made):
            return made
        wanted = self.wanted
        dense = np.unique(np.concatenate([wanted.turned, np.linspace(0.0, self.limits.span, 41)]))
        path = made.outputs(dense)[:, np.searchsorted(dense, wanted.turned)]
        off = path - path[:, :1] - (wanted.output - wanted.output[0])
        most = max(MET, 0.5 * self.aims.problem.requirements.tolerance)
        return made[np.abs(off).max(axis=1) < most]


def _output_at(made: Generators, before: float, turned: float) -> FloatArray:
    """Output from the first pair to a place, shape (M,)."""
    path = made.outputs(before + np.linspace(0.0, turned, 65))
    rotated: FloatArray = path[:, -1] - path[:, 0]
    return rotated


def promise(aims: FunctionAims, made: Generators, sense: int) -> FloatArray:
    """What the objective makes of generators, as far as it is known here, shape (M,); greater is better."""
    score = np.zeros(len(made))
    for goal, weight in aims.problem.goals:
        value = _known(aims, goal.key, made, sense)
        if value is not None:
            score += weight * goal.better * value / aims.problem.scale(goal)
    return np.where(np.isfinite(score), score, -np.inf)


def _known(aims: FunctionAims, key: str, made: Generators, sense: int) -> FloatArray | None:
    """A quantity of generators; None for those that only the judge measures."""
    if key == "transmission_min_task":
        return np.arccos(np.minimum(made.worst_cosine(aims.limits.span), 1.0))
    if key == "transmission_min_cycle":
        return np.arccos(np.minimum(made.worst_cosine(2 * np.pi), 1.0))
    if key == "link_ratio":
        return made.link_ratio
    if key in _ERRORS:
        errors = aims.unit * aims.samples(sense, 31).errors(made)
        size: FloatArray = (
            np.abs(errors).max(axis=1) if key.endswith("max") else np.sqrt((errors**2).mean(axis=1))
        )
        return size
    if key == "size":
        return made.extent(aims.limits.span, aims.task.size)
    return None


def optimal_functions(
    aims: FunctionAims, rng: np.random.Generator, effort: float, levels: tuple[float, ...] | None = None
) -> Iterator[FoundFunction]:
    """Generators of least error that keep the limits, and a choice of those that transmit better.

    With `effort` times as many starts; designs are made for `levels` of transmission, in deg, besides.
    """
    asked = float(np.degrees(aims.limits.transmission))
    usual = tuple(level for level in LEVELS if level > asked + 1)
    better: dict[tuple[int, int], list[Generators]] = {}
    reached, errors = 0.0, dict[int, float]()
    for number, level in enumerate((0.0, *(usual if levels is None else levels))):
        if number and (asked_to_stop() or level <= reached):
            continue
        transmission = max(aims.limits.transmission, float(np.radians(level)))
        words = f"transmission from {level:g} deg" if number else LEAST
        least = min(errors.values(), default=np.inf)
        for way, (sense, driver, first) in enumerate(aims.ways()):
            if number and errors.get(way, np.inf) > WORSE * least:
                continue
            limits = replace(aims.limits_of(driver), transmission=transmission)
            search = _Optima(aims, limits, sense, first)
            if not number and not way:
                yield from (FoundFunction(one.made, driver, one.steps, words) for one in search.glance())
            starts = search.starts(rng, effort if not number else min(1.0, effort))
            for optimum in search.optima(starts, few=bool(number)):
                better.setdefault((way, driver), []).append(optimum.made)
                if not number and optimum.error < min(errors.values(), default=np.inf):
                    reached = float(np.degrees(np.arccos(optimum.made.worst_cosine(aims.limits.span)[0])))
                if not number:
                    errors[way] = min(errors.get(way, np.inf), optimum.error)
                yield FoundFunction(optimum.made, driver, optimum.steps, words)
    last: list[tuple[float, int, _Optima, Optimum]] = []
    for way, (sense, driver, first) in enumerate(aims.ways()):  # what was found on the way may lead further
        made = aims.kind.joined(better.get((way, driver), []))
        search = _Optima(aims, aims.limits_of(driver), sense, first)
        for optimum in search.optima(made, few=True):
            last.append((optimum.error, driver, search, optimum))
            yield FoundFunction(optimum.made, driver, optimum.steps, LEAST)
    for _, driver, search, optimum in sorted(last, key=lambda one: one[0])[:1]:
        settled = search.settled(optimum)
        yield FoundFunction(settled.made, driver, settled.steps, LEAST)


@dataclass(frozen=True, slots=True)
class _Optima:
    """Optima in one sense of output and driver, under limits of the shape."""

    aims: FunctionAims
    limits: ShapeLimits
    sense: int
    first: float | None

    def starts(self, rng: np.random.Generator, effort: float) -> Generators:
        """Least squares from many starts, best first; limits pull."""
        aims, limits = self.aims, self.limits
        by_pairs = len(aims.task) >= 6 and aims.task.norm == "rms"
        wanted = aims.pairs(self.sense) if by_pairs else aims.samples(self.sense)
        full = limits.margin is not None or bool(limits.shortest)
        found: list[Generators] = []
        for _ in range(max(1, round(effort))):
            kinds = [function_starts(aims.kind, wanted, rng, self.first)]
            if full:
                cranks = crank_starts(aims.kind, wanted, rng, CRANKS, self.first, limits.shortest)
                kinds.append(cranks[limits.of(cranks).value.min(axis=1) > -0.1])
            for starts in kinds:
                for pull in PULLS if full else PULLS[:1]:
                    made, square = fitted(wanted, starts, limits.of, pull=pull, held=self.first is not None)
                    found.append(made[best_apart(made, square, CELL)[:TRIED]])
        made = aims.kind.joined(found)
        square = wanted.square(wanted.errors(made))
        return made[best_apart(made, np.nan_to_num(square, nan=np.inf), CELL)]

    def aim(self) -> Aim:
        """What is made least."""
        greatest, most = self.aims.task.norm == "max", self.aims.greatest_error
        wanted = self.aims.samples(self.sense) if greatest else self.aims.pairs(self.sense)
        return Aim(wanted, self.limits.of, greatest=greatest, held=self.first is not None, band=most)

    def optima(self, starts: Generators, *, few: bool) -> Iterator[Optimum]:
        """The best distinct optima from starts that come best first; of `few` only the best ones."""
        aim = self.aim()
        tried = self._tried(aim, starts, TRIED)
        worth = np.array([_worth(one) for one in tried])
        hopeful = [tried[k] for k in _apart(tried, worth) if worth[k] <= HOPELESS * worth.min() + MET]
        ends = [refined(aim, one.made) for one in hopeful[:BASINS]]
        if few:
            ends = sorted(ends, key=_worth)[:BEST]
        if aim.greatest:
            ends = [self._with_extremes(aim, one) for one in ends]
        good = [one for one in ends if one.missed <= ROUNDING]
        for k in _apart(good, np.array([one.error for one in good])):
            yield good[k]

    def glance(self) -> Iterator[Optimum]:
        """One that is good, from few starts: most often there is one, before the search has begun."""
        rng, aim = np.random.default_rng(0), self.aim()
        starts = function_starts(self.aims.kind, aim.wanted, rng, self.first)[::SPARSE]
        made, square = fitted(
            aim.wanted, starts, self.limits.of, pull=PULLS[0], held=self.first is not None, steps=GLANCED
        )
        best = made[best_apart(made, square, CELL)]
        if not len(best):
            return
        end = refined(aim, min(self._tried(aim, best, FIRST), key=_worth).made)
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
            end = self._with_extremes(aim, end) if aim.greatest else refined(aim, end.made)
            if abs(end.error - before) <= MET * before or asked_to_stop():
                break
        return end

    def _with_extremes(self, aim: Aim, end: Optimum) -> Optimum:
        """The same with all extremes of its error in view."""
        return refined(with_extremes(aim, end.made, *self.aims.dense(self.sense)), end.made)


def _worth(one: Optimum) -> float:
    """Its error and what it misses, less is better."""
    return one.error + 10 * one.missed


def _apart(some: list[Optimum], worth: FloatArray) -> list[int]:
    """Which of some optima are distinct and finite, the least of `worth` first."""
    finite = np.flatnonzero(np.isfinite(worth))
    if not finite.size:
        return []
    made = some[0].made.joined([some[k].made for k in finite])
    best: list[int] = finite[best_apart(made, worth[finite], CELL)].tolist()
    return best
