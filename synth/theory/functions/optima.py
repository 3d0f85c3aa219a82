"""Least or smallest greatest error of function generators under limits, from starts nearby."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.theory.functions.fit import DesiredOutput
from grashof.synth.theory.functions.least_squares import least_missed, least_square
from grashof.synth.theory.functions.limits import ShapeLimits
from grashof.synth.theory.functions.linear_programmes import least_linear, times
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.stopping import raise_if_overdue

STEPS = 60
CORRECTIONS = 4  # of a step
PRICE = 10.0  # rad, or units of the travel: of a limit missed by one, so that missing it never pays
_FIRST, _LEAST, _MOST = 0.1, 1e-11, 0.5  # of the trust region
_DAMP = 1e-6  # share of the slopes: damping of a step of least squares, whose errors do not depend on places
_PRICE_PLACED = 1e3  # the price where places are limited
_HEAVY = 1e3  # weight of the limits where a step is corrected
_HUGE = 1e10  # rates that are those of a dead position
_ACTIVE = 1e-9  # limits that a step is to meet within this are kept by its correction


@dataclass(frozen=True, slots=True)
class Ends:
    """Where the refinement of some generators ended."""

    generators: Generators  # M of them
    error: FloatArray  # (M,): root mean square or greatest error at the samples
    missed: FloatArray  # (M,): amount by which the worst limit is missed; zero where all are met
    steps: IntArray  # (M,)
    price: float = PRICE  # of a limit missed by one

    def __len__(self) -> int:
        return len(self.error)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Ends:
        error, missed, steps = self.error[index], self.missed[index], self.steps[index]
        return Ends(self.generators[index], error, missed, steps, self.price)

    @property
    def worth(self) -> FloatArray:
        """Errors with the price of missed limits, shape (M,); less is better."""
        worth: FloatArray = self.error + self.price * self.missed
        return worth


@dataclass(frozen=True, slots=True)
class Aim:
    """The error to be minimised, and the limits, of all generators or of each."""

    desired: DesiredOutput  # for the greatest error, the samples
    limits: ShapeLimits
    greatest: bool = False  # the greatest error is minimised, or else the (weighted) mean square
    held: bool = False  # the first driver angle stays
    band: float = np.inf  # greatest error that is allowed at any sample

    @property
    def placed(self) -> bool:
        """Whether steps are those of least squares under limits of places."""
        return self.limits.places is not None and not self.greatest

    @property
    def price(self) -> float:
        """Price of a limit missed by one, in rad or units of the travel."""
        return _PRICE_PLACED if self.placed else PRICE

    def some(self, index: IntArray | BoolArray) -> Aim:
        """The aims of some of the generators."""
        return replace(self, desired=self.desired.some(index), limits=self.limits.some(index))

    def free(self, batch: Generators) -> FloatArray:
        """1 for every number of a shape that may change, 0 for one that stays, (K,)."""
        free = np.ones(batch.UNKNOWNS)
        free[-1] = 0.0 if self.held else 1.0
        if self.limits.places is not None and batch.PLACE.stop:
            free[batch.PLACE] = self.limits.places.free
        return free

    def errors(self, batch: Generators) -> FloatArray:
        """Outputs less the desired ones at the samples, about the best zero of each, (M, N); NaN: open."""
        off = batch.outputs(self.desired.turned) - self.desired.output
        if not self.greatest:
            return self.desired.centred(off)
        middle = (off.max(axis=1) + off.min(axis=1)) / 2
        centred: FloatArray = off - middle[:, None]
        return centred

    def sizes(self, errors: FloatArray) -> FloatArray:
        """Greatest errors, or root mean squares, shape (M,)."""
        if self.greatest:
            return np.asarray(np.abs(errors).max(axis=1))
        return np.asarray(np.sqrt(self.desired.square(errors) / self.desired.weights.sum()))

    def error(self, batch: Generators) -> FloatArray:
        """Greatest errors, or root mean squares, shape (M,); NaN: open."""
        return self.sizes(self.errors(batch))

    def missed(self, errors: FloatArray, limits: FloatArray) -> FloatArray:
        """Amounts by which the worst limit is missed, (M,), with these errors (M, N) and limits (M, L)."""
        short: FloatArray = np.maximum(-limits.min(axis=1, initial=0.0), 0.0)
        if np.isfinite(self.band):
            short = np.maximum(short, np.abs(errors).max(axis=1) - self.band)
        return short

    def ends(self, batch: Generators, steps: IntArray) -> Ends:
        """Generators with their errors and misses."""
        errors = self.errors(batch)
        return Ends(
            batch, self.sizes(errors), self.missed(errors, self.limits.of(batch).value), steps, self.price
        )

    def scores(self, batch: Generators) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The numbers (M,) that fall from step to step, infinite where a loop is open, errors and limits."""
        errors, limits = self.errors(batch), self.limits.of(batch).value
        score = self.sizes(errors) + self.price * self.missed(errors, limits)
        return np.where(np.isfinite(score), score, np.inf), errors, limits


def refined(aim: Aim, starts: Generators, steps: int = STEPS) -> Ends:
    """The optimum near each start, closed at all samples; it may miss limits.

    Errors and limits are linearised about the best shape so far; within a trust region, there remains a
    linear programme for the greatest error or linear least squares under inequalities for the mean square.
    Starts may miss limits: for the first by a price, for the second by the least amount within the region.
    """
    shape, score = starts.shape.copy(), aim.scores(starts)[0]
    radius, flat, taken = np.full(len(starts), _FIRST), np.zeros(len(starts)), np.zeros(len(starts), int)
    going = np.flatnonzero(np.isfinite(score))
    for _ in range(steps):
        linear = _Linear.of(aim.some(going), starts[going].changed(shape[going]))
        if not linear.finite.all():
            going, linear = going[linear.finite], linear.some(linear.finite)
        if not going.size:
            break
        raise_if_overdue()
        taken[going] += 1
        moved, predicted = linear.step(radius[going])
        there, fresh = linear.best_along(moved)
        before = score[going]
        gain, expected = before - fresh, before - predicted
        shape[going[gain > 0]] = there[gain > 0]
        score[going] = np.where(gain > 0, fresh, before)
        share = np.divide(gain, expected, out=np.zeros(len(gain)), where=expected > 0)
        farthest = np.abs(moved).max(axis=1)
        wider = np.minimum(_MOST, np.maximum(radius[going], 2.5 * farthest))
        closer = 0.3 * np.where(farthest > 0, np.minimum(radius[going], farthest), radius[going])
        radius[going] = np.where(share > 0.7, wider, np.where(share < 0.2, closer, radius[going]))
        flat[going] = np.where(np.abs(expected) <= 1e-7 * score[going] + 1e-16, flat[going] + 1, 0)
        going = going[(radius[going] >= _LEAST) & (flat[going] <= 1)]
    return aim.ends(starts.changed(shape), taken)


@dataclass(frozen=True, slots=True)
class _Linear:
    """An aim, linearised about some shapes."""

    aim: Aim
    about: Generators  # M of them
    errors: FloatArray  # (M, N)
    slopes: FloatArray  # (M, N, K), zero by what stays
    limits: FloatArray  # (M, L)
    by_shape: FloatArray  # (M, L, K), likewise

    @classmethod
    def of(cls, aim: Aim, about: Generators) -> _Linear:
        limits, free = aim.limits.of(about), aim.free(about)
        slopes = about.slopes(aim.desired.turned) * free
        return cls(aim, about, aim.errors(about), slopes, limits.value, limits.slope * free)

    def some(self, index: BoolArray) -> _Linear:
        """Some of them."""
        parts = (each[index] for each in (self.errors, self.slopes, self.limits, self.by_shape))
        return _Linear(self.aim.some(index), self.about[index], *parts)

    @property
    def finite(self) -> BoolArray:
        """Whether output and limits have rates everywhere, (M,); in a dead position these are huge."""
        rates = np.concatenate([self.slopes, self.by_shape], axis=1)
        return np.asarray((np.abs(rates) < _HUGE).all(axis=(1, 2)))

    def step(self, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The best steps within radii (M,), shape (M, K), and the scores predicted for them."""
        moved = self._greatest(radius) if self.aim.greatest else self._square(radius)
        off = self.errors + times(self.slopes, moved)
        if self.aim.greatest:
            error = np.ptp(off, axis=1) / 2
        else:
            off = self.aim.desired.centred(off)
            error = self.aim.sizes(off)
        return moved, error + self.aim.price * self.aim.missed(off, self.limits + times(self.by_shape, moved))

    def best_along(self, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Shapes to which steps lead, or these brought back to what was predicted; the scores.

        The valleys of errors and limits are narrow and curved: without the correction (of second order,
        Fletcher) steps along them would have to be tiny.
        """
        shape = self.about.shape + moved
        score, errors, limits = self.aim.scores(self.about.changed(shape))
        best, least = shape.copy(), score.copy()
        centred = self.slopes - self.slopes.mean(axis=1, keepdims=True)
        predicted, kept = self.errors + times(self.slopes, moved), self.limits + times(self.by_shape, moved)
        turned = centred.swapaxes(1, 2)
        normal = _damped(turned @ centred, 1e-8)
        going, far = np.arange(len(shape)), np.abs(moved).max(axis=1, keepdims=True)
        for _ in range(CORRECTIONS):
            strayed = errors - predicted[going]
            known = np.isfinite(strayed).all(axis=1) & np.isfinite(limits).all(axis=1)
            going, strayed, limits = going[known], strayed[known], limits[known]
            if not going.size:
                break
            off = limits - np.minimum(kept[going], 0.0)
            active = (off < 0) | (kept[going] <= _ACTIVE)
            by_shape = _HEAVY * np.where(active[..., None], self.by_shape[going], 0.0)
            pulled = by_shape.swapaxes(1, 2)
            side = times(turned[going], strayed - strayed.mean(axis=1, keepdims=True))
            side += times(pulled, _HEAVY * np.where(active, off, 0.0))
            step = np.linalg.solve(_damped(normal[going] + pulled @ by_shape, 1e-14), side[..., None])[..., 0]
            longest = np.abs(step).max(axis=1, keepdims=True)
            step *= np.minimum(1.0, far[going] / np.maximum(longest, 1e-300))  # a correction is no longer
            shape[going] -= step
            score, errors, limits = self.aim.some(going).scores(self.about[going].changed(shape[going]))
            better = score < least[going]
            going, errors, limits = going[better], errors[better], limits[better]
            best[going], least[going] = shape[going], score[better]
        return best, least

    def _greatest(self, radius: FloatArray) -> FloatArray:
        """Linear programmes in the step over its radius, the zero, the greatest error and the price paid.

        They begin in the corner of the trust region to which the greatest error falls: there the zero is
        between the greatest and the least error, and a price is paid for the limit that is missed by most.
        """
        (count, samples, unknowns), kept = self.slopes.shape, self.limits.shape[1]
        scale = np.maximum(np.ptp(self.errors, axis=1) / 2, 1e-12)[:, None]
        slopes, errors = self.slopes * (radius[:, None] / scale)[..., None], self.errors / scale
        by_shape = self.by_shape * (PRICE * radius[:, None] / scale)[..., None]
        rows = np.zeros((count, 2 * (samples + unknowns) + kept + 1, unknowns + 3))
        over, under, limits, upper, lower = np.split(
            rows[:, :-1], np.cumsum([samples, samples, kept, unknowns]), axis=1
        )
        over[..., :unknowns], under[..., :unknowns], limits[..., :unknowns] = slopes, -slopes, -by_shape
        over[..., unknowns], under[..., unknowns] = -1.0, 1.0
        over[..., -2], under[..., -2] = -1.0, -1.0
        limits[..., -1], rows[:, -1, -1] = -1.0, -1.0
        upper[..., :unknowns], lower[..., :unknowns] = np.eye(unknowns), -np.eye(unknowns)
        box = np.ones((count, 2 * unknowns))
        right = np.concatenate(
            [-errors, errors, PRICE * self.limits / scale, box, np.zeros((count, 1))], axis=1
        )
        each = np.arange(count)
        ahead = slopes[each, errors.argmax(axis=1)] < slopes[each, errors.argmin(axis=1)]
        corner = np.where(ahead, 1.0, -1.0)
        there = errors + times(slopes, corner)
        first = 2 * samples + kept
        short = np.concatenate(
            [-right[:, 2 * samples : first] - times(by_shape, corner), np.zeros((count, 1))], axis=1
        ).argmax(axis=1)
        worst = np.where(short < kept, 2 * samples + short, rows.shape[1] - 1)
        at_corner = first + np.arange(unknowns) + unknowns * ~ahead
        basis = [at_corner, there.argmax(axis=1), samples + there.argmin(axis=1), worst]
        cost = np.concatenate([np.zeros(unknowns + 1), [1.0, 1.0]])
        found = least_linear(cost, rows, right, np.column_stack(basis))
        return np.clip(found[:, :unknowns], -1.0, 1.0) * radius[:, None] * self.aim.free(self.about)

    def _square(self, radius: FloatArray) -> FloatArray:
        """Least squares under limits that are missed by the least amount, the zero eliminated."""
        (count, unknowns), root = (len(radius), self.about.UNKNOWNS), np.sqrt(self.aim.desired.weights)
        root = root / np.linalg.norm(root)
        slopes = self.aim.desired.centred(self.slopes) * radius[:, None, None]
        rows, right = -self.by_shape * radius[:, None, None], self.limits
        if np.isfinite(self.aim.band):
            rows = np.concatenate([rows, slopes, -slopes], axis=1)
            right = np.concatenate([right, self.aim.band - self.errors, self.aim.band + self.errors], axis=1)
        start, missed = least_missed(rows, right)
        matrix = slopes * root[:, None]
        damping = _DAMP * np.linalg.norm(matrix, axis=(1, 2))[:, None, None] * np.eye(unknowns)
        matrix = np.concatenate([matrix, damping], axis=1)
        side = np.concatenate([-self.errors * root, np.zeros((count, unknowns))], axis=1)
        box = np.broadcast_to(
            np.vstack([np.eye(unknowns), -np.eye(unknowns)]), (count, 2 * unknowns, unknowns)
        )
        rows = np.concatenate([rows, box], axis=1)
        right = np.concatenate([right + missed[:, None], np.ones((count, 2 * unknowns))], axis=1)
        moved = least_square(matrix, side, rows, right, start)
        return moved.clip(-1, 1) * radius[:, None] * self.aim.free(self.about)


def _damped(normal: FloatArray, share: float) -> FloatArray:
    """Normal matrices (M, K, K) with a share of their size on their diagonals, so that none is singular."""
    size = np.maximum(np.einsum("mkk->m", normal), 1e-280)
    damped: FloatArray = normal + share * size[:, None, None] * np.eye(normal.shape[1])
    return damped


def with_extremes(aim: Aim, batch: Generators, turned: FloatArray, output: FloatArray) -> Aim:
    """The same aim with samples where generators err most on a dense grid, shape (K,) or (M, K) each."""
    off = batch.outputs(turned) - output
    inner = np.zeros(off.shape, dtype=bool)
    inner[:, 1:-1] = (off[:, 1:-1] - off[:, :-2]) * (off[:, 2:] - off[:, 1:-1]) <= 0
    count = int(inner.sum(axis=1).max(initial=0))
    # Those of each first, in their order; where there are fewer, the first place is repeated.
    at = np.argsort(~inner, axis=1, kind="stable")[:, :count]
    at = np.where(np.take_along_axis(inner, at, axis=1), at, 0)
    more = [np.take_along_axis(np.broadcast_to(each, off.shape), at, axis=1) for each in (turned, output)]
    samples = aim.desired.turned, aim.desired.output
    known = [np.broadcast_to(each, (len(batch), each.shape[-1])) for each in samples]
    places, outputs = (np.concatenate(each, axis=1) for each in zip(known, more, strict=True))
    order = np.argsort(places, axis=1, kind="stable")
    places, outputs = (np.take_along_axis(each, order, axis=1) for each in (places, outputs))
    return replace(aim, desired=DesiredOutput(places, outputs, np.ones(places.shape[1])))
