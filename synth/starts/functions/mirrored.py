"""Functions of four-bars that are their own mirror image in one position, such as the steering of a car."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import DrivenLinkage, Round
from grashof.synth.starts.functions.aims import SAMPLES, FunctionAims
from grashof.synth.starts.functions.finder import WORSE, Functions
from grashof.synth.starts.functions.optima import Optima
from grashof.synth.starts.functions.pairs import ROUNDING
from grashof.synth.theory.functions.fit import DesiredOutput
from grashof.synth.theory.functions.four_bar import FourBars
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.stopping import raise_if_overdue

SPREAD = 121, 241  # of the first look: logarithms of r2 over r1, and driver angles in the mirrored position
FINE, LAST = 201, 4  # samples of the range in the last rounds, and the number of these rounds
ZOOM, ROUNDS, CLOSER = 17, 14, 0.25  # numbers tried at a time, rounds, and the share that each keeps
REACH, STEEP, SAME = 0.15, 8.0, 1e-11  # around a place: both numbers, angle over ratio; rad that end it
BASINS = 4  # number of lowest places that are refined
FEW = 2  # of them at a transmission angle, of which the best counts
PRICE = 10.0  # rad: price of a limit missed by 1
NONE = "no mirrored four-bar was found that closes over the range and keeps the limits"


@dataclass(frozen=True, slots=True)
class Mirrored:
    """Mirrored four-bars of one sense of output and driver by two numbers, log(r2 / r1) and an angle.

    The angle, rad, is that of the driver in the mirrored position, where B is the mirror image of A.
    """

    search: Optima
    desired: DesiredOutput = field(init=False)  # the compared samples, and last the mirrored position

    def __post_init__(self) -> None:
        object.__setattr__(self, "desired", self._desired(SAMPLES))

    @property
    def aims(self) -> FunctionAims:
        """The aims of the search."""
        return self.search.aims

    @property
    def turned(self) -> float:
        """Driver rotation from the beginning of the range to the mirrored position."""
        return float(self.aims.task.mirror or 0.0)

    def made(self, places: FloatArray) -> FourBars:
        """The four-bars of places (M, 2)."""
        a = np.exp(places[:, 0] + 1j * places[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            return FourBars.of_pivots(a, 1 - a.conj()).begun(self.turned)

    def place(self, generator: Generators) -> FloatArray:
        """The place of a generator that begins at the first pair, (1, 2)."""
        return generator.begun(-self.turned).shape[:, [0, -1]]

    def _desired(self, count: int) -> DesiredOutput:
        aims, sense = self.aims, self.search.sense
        desired = aims.samples(sense, count) if aims.task.norm == "max" else aims.pairs(sense)
        middle = sense * float(aims.task.output(np.array(aims.task.mirror_turn)))
        return DesiredOutput(
            np.append(desired.turned, self.turned), np.append(desired.output, middle), desired.weights
        )

    def scores(self, places: FloatArray, desired: DesiredOutput) -> tuple[FloatArray, FloatArray]:
        """Errors of places (M, 2), infinite where the loop is open, and the miss of the worst limit."""
        batch = self.made(places)
        with np.errstate(all="ignore"):
            order = np.argsort(desired.turned, kind="stable")
            off = np.empty((len(batch), len(order)))
            off[:, order] = batch.outputs(desired.turned[order]) - desired.output[order]
            off = (off - off[:, -1:])[:, :-1]
            if self.aims.task.norm == "max":
                error = np.abs(off).max(axis=1)
            else:
                error = np.sqrt(off**2 @ desired.weights / desired.weights.sum())
            missed = np.maximum(-self.search.limits.of(batch).value.min(axis=1), 0.0)
        missed = np.maximum(missed, np.abs(off).max(axis=1) - self.aims.greatest_error)
        return np.nan_to_num(error, nan=np.inf), np.nan_to_num(missed, nan=np.inf)

    def worth(self, places: FloatArray, desired: DesiredOutput) -> FloatArray:
        """Errors with the price of missed limits; less is better."""
        error, missed = self.scores(places, desired)
        worth: FloatArray = error + PRICE * np.where(missed > ROUNDING / 2, missed, 0.0)
        return worth

    def basins(self, most: int) -> FloatArray:
        """Places on a grid that are better than those beside them, (M, 2), best first."""
        caps = float(self.search.limits.caps[1, 0]), -float(self.search.limits.caps[0, 1])
        high, low = np.clip(caps, -7.0, 7.0)
        logs = np.linspace(low, max(high, low), SPREAD[0])
        angles = np.linspace(-np.pi, np.pi, SPREAD[1], endpoint=False)
        grid = np.stack(np.meshgrid(logs, angles, indexing="ij"), axis=-1)
        worth = np.concatenate([self._row(row) for row in grid]).reshape(grid.shape[:2])
        around = np.pad(worth, ((0, 0), (1, 1)), mode="wrap")
        around = np.pad(around, ((1, 1), (0, 0)), constant_values=np.inf)
        beside = [
            around[1 + i : 1 + i + len(logs), 1 + j : 1 + j + len(angles)]
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
            if i or j
        ]
        lowest = np.isfinite(worth) & (worth <= np.min(beside, axis=0))
        order = np.argsort(worth[lowest], kind="stable")[:most]
        found: FloatArray = grid[lowest][order]
        return found

    def _row(self, places: FloatArray) -> FloatArray:
        raise_if_overdue()
        return self.worth(places, self.desired)

    def narrowed(self, place: FloatArray) -> FloatArray:
        """The best place near another one, (2,): ever fewer ratios about the best, each at its best angle.

        Valleys of the error lie along the ratio, narrow and curved, so that squares would lose them.
        """
        (log, angle), half, fine = place.tolist(), REACH, self._desired(FINE)
        for number in range(ROUNDS):
            raise_if_overdue()
            logs = log + half * np.linspace(-1, 1, ZOOM)
            desired = fine if number >= ROUNDS - LAST else self.desired
            angles, worth = self._at_best_angles(logs, angle, min(REACH, STEEP * half), desired)
            best = int(np.argmin(worth))
            if not np.isfinite(worth[best]):
                break
            log, angle = float(logs[best]), float(angles[best])
            half *= 1.0 if best in (0, ZOOM - 1) and number < LAST else CLOSER
        return np.array([log, angle])

    def _at_best_angles(
        self, logs: FloatArray, angle: float, half: float, desired: DesiredOutput
    ) -> tuple[FloatArray, FloatArray]:
        """The best angle near another one for each ratio, and its worth, (M,) each."""
        angles, worth = np.full(len(logs), angle), np.full(len(logs), np.inf)
        while half > SAME:
            near = angles[:, None] + half * np.linspace(-1, 1, ZOOM)
            places = np.stack([np.broadcast_to(logs[:, None], near.shape), near], axis=-1).reshape(-1, 2)
            every = self.worth(places, desired).reshape(near.shape)
            best = every.argmin(axis=1)[:, None]
            angles, worth = (np.take_along_axis(each, best, axis=1)[:, 0] for each in (near, every))
            half *= CLOSER / 2
        return angles, worth

    def best(self, places: FloatArray) -> Iterator[tuple[float, Generators]]:
        """Errors and generators of the best places near others that keep the limits, best first."""
        found = np.array([self.narrowed(place) for place in places]).reshape(-1, 2)
        error, missed = self.scores(found, self._desired(FINE))
        error = np.where(missed <= ROUNDING, error, np.inf)
        for k in np.argsort(error, kind="stable"):
            if error[k] <= WORSE * error.min() < np.inf:
                yield float(error[k]), self.made(found[k : k + 1])


class MirroredFunctions(Functions):
    """Four-bars of least error that are their own mirror image at a driver rotation.

    Two numbers state them, so that a grid covers them: round 0 lists the least errors, the others, a round
    for each transmission angle, the least error of those that have it.
    """

    beginning: ClassVar[str] = "looking for mirrored linkages that generate the function"

    def quick_pass(self, _rng: np.random.Generator) -> Round | None:
        """None: the first round is as quick."""
        return None

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """Least errors at a transmission angle, or without one."""
        del enough, rng, size
        if number >= self.rounds_a_pass or self.aims.obstacle:
            return None
        level = float(np.radians(self.levels[number - 1])) if number else 0.0
        found = list[tuple[float, Generators, int]]()
        for search in Optima.each(self.aims, level):
            mirrored = Mirrored(search)
            best = mirrored.best(mirrored.basins(FEW if number else BASINS))
            found += [(error, generator, search.driver) for error, generator in best]
        found = sorted(found, key=lambda each: each[0])[: 1 if number else None]
        cosine = found[0][1].worst_cosine(self.aims.limits.span)[0] if found and not number else 1.0
        needless = sum(each <= np.degrees(np.arccos(cosine)) for each in self.levels) if not number else 0
        return self._round([(generator, driver) for _, generator, driver in found], skip=needless)

    def onward(
        self, _designs: Sequence[Candidate], _misses: Sequence[Candidate] = (), /
    ) -> list[Linkage | DrivenLinkage]:
        """None: the grid covers them."""
        return []

    def follow(self, design: Candidate) -> list[Linkage | DrivenLinkage]:
        """The mirrored linkage of least error near a design."""
        begun, found = self.aims.generator(design), list[tuple[Generators, int]]()
        if begun is None:
            return []
        for search in Optima.each(self.aims):
            mirrored = Mirrored(search)
            near = mirrored.best(mirrored.place(begun))
            found += [(generator, search.driver) for _, generator in near]
        return self._designs(found)

    def obstacle(self, _rng: np.random.Generator, counts: Mapping[str, int], /) -> str:
        """Limits that contradict each other, or that no mirrored four-bar keeps."""
        return self.aims.obstacle or ("" if counts.get("feasible finds") else NONE)
