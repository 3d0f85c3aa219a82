"""Function generators through all of three to five pairs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.theory.functions.fit import DesiredOutput, best_apart, fitted
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.starts import function_starts

GRID = 220  # start angles of driver and output each, of three pairs
CURVE = 2000  # output angles at a fifth place, of four pairs
NEAR = 0.02  # of exact designs: closer ones are alike
MET = 1e-9  # rad, or shares of the travel: exact
ROUNDING = 2e-8  # of limits
KNOWN = {"transmission_min_task", "transmission_min_cycle", "link_ratio"}  # here as to the judge
_ERRORS = tuple(f"{kind}_error_{name}" for kind in ("structural", "travel") for name in ("max", "rms"))
ZOOMED, ZOOMS, ZOOM = 6, 3, 120  # exact designs about which others are tried, rounds, and trials of each


def through_pairs(
    aims: FunctionAims, sense: int, driver: int, first: float | None, rng: np.random.Generator, effort: float
) -> Generators:
    """All that are found through the pairs, their inputs angles, and keep the limits."""
    pairs = Pairs.of(aims, sense, driver)
    desired, kind, limits, turned, output = pairs.desired, aims.kind, pairs.limits, pairs.turned, pairs.output
    count = len(turned)
    offset = aims.wanted.offset  # where it is given, no sweep would find it
    pinned = offset is not None and offset[0] == offset[1] and count < kind.EXACT
    if count > kind.EXACT or (first is not None and count > kind.LINEAR) or pinned:
        starts = function_starts(kind, desired, rng, first)
        near = fitted(desired, starts, limits.of, held=first is not None)[0]
        return pairs.kept(near)
    if first is not None:
        angle = np.pi * (np.arange(round(GRID**2 * effort)) + rng.random()) / round(GRID**2 * effort)
        both = [
            kind.at_starts(turned, output, np.full(len(angle), start), kind.place_of(angle))
            for start in (first + desired.turned[0], first + desired.turned[0] + np.pi)
        ]
        batch = kind.joined(both)
        held = np.abs(np.angle(np.exp(1j * (batch.first - first - desired.turned[0])))) < MET
        return pairs.kept(batch[held].begun(desired.turned[0]))
    if count == kind.EXACT:
        return pairs.through()
    if count == kind.EXACT - 1:
        return pairs.on_curve(round(CURVE * effort))
    return pairs.on_surface(round(GRID * np.sqrt(effort)), rng)


@dataclass(frozen=True, slots=True)
class Pairs:
    """Generators through a few pairs, in one sense."""

    aims: FunctionAims
    sense: int
    limits: ShapeLimits
    desired: DesiredOutput
    turned: FloatArray  # from the first pair
    output: FloatArray

    @classmethod
    def of(cls, aims: FunctionAims, sense: int, driver: int) -> Pairs:
        """The pairs of a task in its senses of output and driver."""
        desired = aims.pairs(sense)
        turned, output = desired.turned - desired.turned[0], desired.output - desired.output[0]
        return cls(aims, sense, aims.limits_of(driver, sense), desired, turned, output)

    def through(self) -> Generators:
        """All generators through the greatest number of pairs that can be met."""
        batch, _ = self.aims.kind.through(self.turned[None], self.output[None])
        return self.kept(batch.begun(self.desired.turned[0]))

    def through_and(self, between: float, tried: FloatArray) -> Generators:
        """Through the pairs and one more at a driver angle, at each of several outputs."""
        turned = np.broadcast_to(np.append(self.turned, between), (len(tried), len(self.turned) + 1))
        output = np.broadcast_to(self.output, (len(tried), len(self.output)))
        batch, _ = self.aims.kind.through(turned, np.concatenate([output, tried[:, None]], axis=1))
        return self.kept(batch.begun(self.desired.turned[0]))

    def on_curve(self, count: int) -> Generators:
        """Generators through one pair less: along the curve, then refined where it is best."""
        wide = int(np.argmax(np.diff(self.turned)))
        # the other pair is between two of them, where every linkage without a defect closes
        between = (self.turned[wide] + self.turned[wide + 1]) / 2
        tried, step = self.aims.kind.tried_between(count)
        pool = self.through_and(between, tried)
        for _ in range(ZOOMS):
            if not len(pool):
                break
            path = self.best(pool).outputs(self.desired.turned[0] + np.linspace(0.0, between, 65))
            at = path[:, -1] - path[:, 0]
            more = self.through_and(between, (at[:, None] + step * np.linspace(-1, 1, ZOOM)).ravel())
            pool, step = self.aims.kind.joined([pool, more]), 3 * step / ZOOM
        return pool

    def on_surface(self, count: int, rng: np.random.Generator) -> Generators:
        """Generators through two pairs less: both starts on a grid, then refined where they are best."""
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
            drivers = best.first + self.desired.turned[0]
            angles = kind.angle_of(best.outputs(self.desired.turned[:1])[:, 0])
            tried = [
                (at[:, None] + step * move).ravel() for at, move in zip((drivers, angles), about, strict=True)
            ]
            pool, step = kind.joined([pool, self.at_starts(*tried)]), 2.5 * step / len(across)
        return pool

    def at_starts(self, driver: FloatArray, angle: FloatArray) -> Generators:
        """Those with given starts."""
        kind = self.aims.kind
        batch = kind.at_starts(self.turned, self.output, driver, kind.place_of(angle))
        return self.kept(batch.begun(self.desired.turned[0]))

    def best(self, pool: Generators) -> Generators:
        """A few of the most promising that are distinct."""
        return pool[best_apart(pool, -expected_score(self.aims, pool, self.sense), NEAR)[:ZOOMED]]

    def kept(self, batch: Generators) -> Generators:
        """Those within the limits that meet every pair on one branch."""
        batch = batch.finite
        batch = batch[batch.worst_cosine(self.limits.span) < 1]
        batch = batch[self.limits.of(batch).value.min(axis=1) >= -ROUNDING]
        if not len(batch):
            return batch
        desired = self.desired
        dense = np.unique(np.concatenate([desired.turned, np.linspace(0.0, self.limits.span, 41)]))
        path = batch.outputs(dense)[:, np.searchsorted(dense, desired.turned)]
        off = path - path[:, :1] - (desired.output - desired.output[0])
        most = max(MET, 0.5 * self.aims.problem.requirements.tolerance)
        return batch[np.abs(off).max(axis=1) < most]


def expected_score(aims: FunctionAims, batch: Generators, sense: int) -> FloatArray:
    """Score of generators by the quantities of the objective that are known here, shape (M,)."""
    score = np.zeros(len(batch))
    for goal, weight in aims.problem.goals:
        value = _known(aims, goal.key, batch, sense)
        if value is not None:
            score += weight * goal.better * value / aims.problem.scale(goal)
    return np.where(np.isfinite(score), score, -np.inf)


def _known(aims: FunctionAims, key: str, batch: Generators, sense: int) -> FloatArray | None:
    """A quantity of generators; None for those that only the judge measures."""
    if key == "transmission_min_task":
        return np.arccos(np.minimum(batch.worst_cosine(aims.limits.span), 1.0))
    if key == "transmission_min_cycle":
        return np.arccos(np.minimum(batch.worst_cosine(2 * np.pi), 1.0))
    if key == "link_ratio":
        return batch.link_ratio
    if key in _ERRORS:
        errors = aims.unit * aims.samples(sense, 31).errors(batch)
        size: FloatArray = (
            np.abs(errors).max(axis=1) if key.endswith("max") else np.sqrt((errors**2).mean(axis=1))
        )
        return size
    if key == "size":
        return batch.extent(aims.limits.span, aims.task.size)
    return None
