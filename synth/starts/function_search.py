"""The search for function generators: exact ones of three to five pairs, and optima of any number."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.function_aims import FunctionAims
from grashof.synth.theory.function_fit import Wanted, best_apart, fitted
from grashof.synth.theory.function_limits import ShapeLimits
from grashof.synth.theory.function_optima import Aim, Optimum, refined, with_extremes
from grashof.synth.theory.function_output import Generators, output_angles, worst_cosine
from grashof.synth.theory.function_points import (
    through_five_pairs,
    through_four_and,
    through_four_pairs,
    through_three_pairs,
)
from grashof.synth.theory.function_starts import full_cranks, function_starts
from grashof.synth.theory.stopping import asked_to_stop

GRID = 220  # start angles of driver and output each, of three pairs
CURVE = 2000  # output angles at a fifth place, of four pairs
CRANKS = 8000  # random full cranks, from which least squares begins besides
PULLS = (0.1, 1.0)  # rad: what a missed limit counts as in least squares
BASINS, TRIED, SHORT = 9, 30, 5  # starts that are refined to the end, and those tried in few steps
WORSE = 10.0  # times the least error: a sense of output and driver in which no choice is offered
HOPELESS = 50.0  # times the least error: no further
LEAST, LOCAL = "least error", "least error nearby"
CELL, NEAR = 0.04, 0.02  # of optima, and of exact designs: closer ones are alike
LEVELS = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)  # deg of transmission, that a choice is offered at
MET = 1e-9  # rad: exact
ROUNDING = 2e-8  # of limits
ZOOMED, ZOOMS, ZOOM = 6, 3, 120  # exact designs about which others are tried, how often, and how many each


@dataclass(frozen=True, slots=True)
class FoundFunction:
    """One generator that the search came to.

    Parameters
    ----------
    made : Generators
        One.
    driver : int
        Sense of the driver.
    steps : int
        Of its refinement.
    best_at : str
        What it was made for; empty for exact ones.
    """

    made: Generators
    driver: int
    steps: int = 0
    best_at: str = ""


class FunctionPairs:
    """The kind of search that functions have; it proposes whole designs."""

    beginning = "looking for four-bars that generate the function"

    @staticmethod
    def refuse() -> None:
        """Nothing is left to refuse: the task did."""


def exact_functions(
    aims: FunctionAims, rng: np.random.Generator, most: int, effort: float
) -> list[FoundFunction]:
    """Generators through all pairs that keep the limits, the most promising distinct ones first."""
    found: list[tuple[FloatArray, Generators, int]] = []
    for sense, driver, first in aims.ways():
        made = _through(aims, sense, first, rng, effort)
        if len(made) and not asked_to_stop():
            found.append((promise(aims, made, sense), made, driver))
    if not found:
        return []
    merit = np.concatenate([each for each, _, _ in found])
    drivers = np.concatenate([np.full(len(made), driver) for _, made, driver in found])
    made = Generators.joined([each for _, each, _ in found])
    cell = NEAR
    best = best_apart(made, -merit, cell)
    while len(best) > 4 * most:  # a curve or surface of designs: farther apart
        cell *= 1.5
        best = best_apart(made, -merit, cell)
    return [FoundFunction(made[k : k + 1], int(drivers[k])) for k in best[:most]]


def _through(
    aims: FunctionAims, sense: int, first: float | None, rng: np.random.Generator, effort: float
) -> Generators:
    """All that are found through the pairs and keep the limits."""
    wanted = aims.pairs(sense)
    turned, output = wanted.turned - wanted.turned[0], wanted.output - wanted.output[0]
    count = len(turned)
    if count > 5 or (first is not None and count > 3):
        starts = function_starts(wanted, rng, first)
        near = fitted(wanted, starts, aims.limits.of, held=first is not None)[0]
        return _kept(aims, near, wanted)
    if first is not None:
        psi = np.pi * (np.arange(round(GRID**2 * effort)) + rng.random()) / round(GRID**2 * effort)
        both = [
            through_three_pairs(turned, output, np.full(len(psi), start), psi)
            for start in (first + wanted.turned[0], first + wanted.turned[0] + np.pi)
        ]
        made = Generators.joined(both)
        held = np.abs(np.angle(np.exp(1j * (made.shape[:, 3] - first - wanted.turned[0])))) < MET
        return _kept(aims, _begun(made[held], wanted), wanted)
    if count == 5:
        return _kept(aims, _begun(through_five_pairs(turned[None], output[None])[0], wanted), wanted)
    if count == 4:
        return _on_curve(aims, sense, wanted, turned, output, round(CURVE * effort))
    return _on_surface(aims, sense, wanted, turned, output, round(GRID * np.sqrt(effort)), rng)


def _on_curve(
    aims: FunctionAims, sense: int, wanted: Wanted, turned: FloatArray, output: FloatArray, count: int
) -> Generators:
    """Of four pairs: the curve, and once more where it is best."""
    wide = int(np.argmax(np.diff(turned)))
    fifth = (turned[wide] + turned[wide + 1]) / 2
    pool = _kept(aims, _begun(through_four_pairs(turned, output, count), wanted), wanted)
    step = 2 * np.pi / count
    for _ in range(ZOOMS):
        if not len(pool):
            break
        best = pool[best_apart(pool, -promise(aims, pool, sense), NEAR)[:ZOOMED]]
        at = _output_at(best, wanted.turned[0], fifth)
        tried = (at[:, None] + step * np.linspace(-1, 1, ZOOM)).ravel()
        more = _kept(aims, _begun(through_four_and(turned, output, fifth, tried), wanted), wanted)
        pool, step = Generators.joined([pool, more]), 3 * step / ZOOM
    return pool


def _on_surface(
    aims: FunctionAims,
    sense: int,
    wanted: Wanted,
    turned: FloatArray,
    output: FloatArray,
    count: int,
    rng: np.random.Generator,
) -> Generators:
    """Of three pairs: both start angles on a grid, and once more where they are best."""
    half = np.pi * np.arange(count) / count
    shift = np.pi * rng.random(2) / count
    driver, first = (each.ravel() for each in np.meshgrid(half + shift[0], half + shift[1]))
    pool = _kept(aims, _begun(through_three_pairs(turned, output, driver, first), wanted), wanted)
    step = np.pi / count
    across = np.linspace(-1, 1, round(np.sqrt(ZOOM)))
    about = np.stack([each.ravel() for each in np.meshgrid(across, across)])
    for _ in range(ZOOMS):
        if not len(pool):
            break
        best = pool[best_apart(pool, -promise(aims, pool, sense), NEAR)[:ZOOMED]]
        drivers = best.shape[:, 3] + wanted.turned[0]
        outputs = output_angles(best, wanted.turned[:1])[:, 0]
        tried = [
            (at[:, None] + step * move).ravel() for at, move in zip((drivers, outputs), about, strict=True)
        ]
        more = _kept(aims, _begun(through_three_pairs(turned, output, *tried), wanted), wanted)
        pool, step = Generators.joined([pool, more]), 2.5 * step / len(across)
    return pool


def _output_at(made: Generators, before: float, turned: float) -> FloatArray:
    """Output rotation from the first pair to a place, shape (M,)."""
    path = output_angles(made, before + np.linspace(0.0, turned, 65))
    rotated: FloatArray = path[:, -1] - path[:, 0]
    return rotated


def _begun(made: Generators, wanted: Wanted) -> Generators:
    """The same, from the beginning of the range instead of the first pair."""
    shape = made.shape.copy()
    shape[:, 3] -= wanted.turned[0]
    return Generators(shape, made.assembly)


def _kept(aims: FunctionAims, made: Generators, wanted: Wanted) -> Generators:
    """Those within the limits that meet every pair on one branch."""
    made = made.finite
    made = made[worst_cosine(made, aims.limits.span) < 1]
    made = made[aims.limits.of(made)[0].min(axis=1) >= -ROUNDING]
    if not len(made):
        return made
    dense = np.unique(np.concatenate([wanted.turned, np.linspace(0.0, aims.limits.span, 41)]))
    path = output_angles(made, dense)[:, np.searchsorted(dense, wanted.turned)]
    off = path - path[:, :1] - (wanted.output - wanted.output[0])
    return made[np.abs(off).max(axis=1) < max(MET, 0.5 * aims.problem.requirements.tolerance)]


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
        return np.arccos(np.minimum(worst_cosine(made, aims.limits.span), 1.0))
    if key == "transmission_min_cycle":
        return np.arccos(np.minimum(worst_cosine(made, 2 * np.pi), 1.0))
    if key == "link_ratio":
        lengths = made.lengths
        ratio: FloatArray = lengths.max(axis=1) / lengths.min(axis=1)
        return ratio
    if key in ("structural_error_max", "structural_error_rms"):
        errors = aims.samples(sense, 31).errors(made)
        size: FloatArray = (
            np.abs(errors).max(axis=1) if key.endswith("max") else np.sqrt((errors**2).mean(axis=1))
        )
        return size
    if key == "size":
        pivots = made.shape[:, 3:] + np.linspace(0.0, aims.limits.span, 13)
        a = made.lengths[:, 1:2] * np.exp(1j * pivots)
        b = 1 + made.lengths[:, 3:] * np.exp(1j * output_angles(made, pivots[0] - pivots[0, 0]))
        every = np.concatenate([a, b, np.zeros((len(made), 1)), np.ones((len(made), 1))], axis=1)
        wide = np.hypot(np.ptp(every.real, axis=1), np.ptp(every.imag, axis=1))
        extent: FloatArray = aims.ground.length * wide
        return extent
    return None


def optimal_functions(
    aims: FunctionAims, rng: np.random.Generator, effort: float, levels: tuple[float, ...] | None = None
) -> Iterator[FoundFunction]:
    """Generators of least error that keep the limits, and a choice of those that transmit better.

    Parameters
    ----------
    aims : FunctionAims
    rng : Generator
    effort : float
        So many times as many starts.
    levels : tuple of float, deg, optional
        Of transmission, that designs are made for besides.
    """
    asked = float(np.degrees(aims.limits.transmission))
    usual = tuple(level for level in LEVELS if level > asked + 1)
    better: dict[tuple[int, int], list[Generators]] = {}
    reached, errors = 0.0, dict[int, float]()
    for number, level in enumerate((0.0, *(usual if levels is None else levels))):
        if number and (asked_to_stop() or level <= reached):
            continue
        limits = replace(aims.limits, transmission=max(aims.limits.transmission, float(np.radians(level))))
        words = f"transmission from {level:g} deg" if number else LEAST
        least = min(errors.values(), default=np.inf)
        for way, (sense, driver, first) in enumerate(aims.ways()):
            if number and errors.get(way, np.inf) > WORSE * least:
                continue
            search = _Optima(aims, limits, sense, first)
            starts = search.starts(rng, effort if not number else min(1.0, effort))
            for optimum in search.optima(starts, few=bool(number)):
                better.setdefault((way, driver), []).append(optimum.made)
                if not number and optimum.error < min(errors.values(), default=np.inf):
                    reached = float(np.degrees(np.arccos(worst_cosine(optimum.made, limits.span)[0])))
                if not number:
                    errors[way] = min(errors.get(way, np.inf), optimum.error)
                yield FoundFunction(optimum.made, driver, optimum.steps, words)
    for way, (sense, driver, first) in enumerate(aims.ways()):  # what was found on the way may lead further
        made = better.get((way, driver), [])
        for optimum in _Optima(aims, aims.limits, sense, first).optima(Generators.joined(made), few=True):
            yield FoundFunction(optimum.made, driver, optimum.steps, LEAST)


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
            kinds = [function_starts(wanted, rng, self.first)]
            if full:
                cranks = full_cranks(rng, CRANKS, self.first, limits.shortest)
                kinds.append(cranks[limits.of(cranks)[0].min(axis=1) > -0.1])
            for starts in kinds:
                for pull in PULLS if full else PULLS[:1]:
                    made, square = fitted(wanted, starts, limits.of, pull=pull, held=self.first is not None)
                    found.append(made[best_apart(made, square, CELL)[:TRIED]])
        made = Generators.joined(found)
        square = wanted.square(wanted.errors(made))
        return made[best_apart(made, np.nan_to_num(square, nan=np.inf), CELL)]

    def aim(self) -> Aim:
        """What is made least."""
        greatest, stated = (
            self.aims.task.norm == "max",
            self.aims.problem.requirements.structural_error_max_deg,
        )
        wanted = self.aims.samples(self.sense) if greatest else self.aims.pairs(self.sense)
        band = np.inf if stated is None else float(np.radians(stated[1]))
        return Aim(wanted, self.limits.of, greatest=greatest, held=self.first is not None, band=band)

    def optima(self, starts: Generators, *, few: bool) -> Iterator[Optimum]:
        """The best distinct optima from starts that come best first; of `few` only the most promising."""
        aim, share = self.aim(), 3 if few else 1
        tried = [refined(aim, starts[k : k + 1], SHORT) for k in range(min(TRIED // share, len(starts)))]
        worth = np.array([one.error + 10 * one.missed for one in tried])
        hopeful = [tried[k] for k in _apart(tried, worth) if worth[k] <= HOPELESS * worth.min() + MET]
        ends = [refined(aim, one.made) for one in hopeful[: BASINS // share]]
        if aim.greatest:
            dense = self.aims.dense(self.sense)
            ends = [refined(with_extremes(aim, one.made, *dense), one.made) for one in ends]
        good = [one for one in ends if one.missed <= ROUNDING]
        for k in _apart(good, np.array([one.error for one in good])):
            yield good[k]


def _apart(some: list[Optimum], worth: FloatArray) -> list[int]:
    """Which of some optima are distinct and finite, the least of `worth` first."""
    finite = np.flatnonzero(np.isfinite(worth))
    made = Generators.joined([some[k].made for k in finite])
    return finite[best_apart(made, worth[finite], CELL)].tolist() if finite.size else []
