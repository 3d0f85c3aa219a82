"""Least or smallest greatest error of one function generator under limits, from a start nearby."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.theory.functions.fit import DesiredOutput, Limits
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.stopping import raise_if_overdue

STEPS = 60
CORRECTIONS = 2  # of a step
PRICE = 10.0  # rad, or units of the travel: of a limit missed by one, so that missing it never pays
_FIRST, _LEAST, _MOST = 0.1, 1e-11, 0.5  # of the trust region
_HEAVY = 1e4  # of the slack in a step of least squares


@dataclass(frozen=True, slots=True)
class Optimum:
    """Where the refinement of one generator ended."""

    generator: Generators
    error: float  # root mean square or greatest error at the samples
    missed: float  # amount by which the worst limit is missed; zero where all are met
    steps: int


@dataclass(frozen=True, slots=True)
class Aim:
    """The error to be minimised, and the limits."""

    desired: DesiredOutput  # for the greatest error, the samples
    limits: Limits  # as `ShapeLimits.of`
    greatest: bool = False  # the greatest error is minimised, or else the (weighted) mean square
    held: bool = False  # the first driver angle stays
    band: float = np.inf  # greatest error that is allowed at any sample

    def errors(self, generator: Generators) -> FloatArray:
        """Output less the desired one at the samples, about the best zero, shape (N,); NaN: open."""
        off = (generator.outputs(self.desired.turned) - self.desired.output)[0]
        if self.greatest:
            middle = (off.max() + off.min()) / 2
        else:
            middle = self.desired.weights @ off / self.desired.weights.sum()
        centred: FloatArray = off - middle
        return centred

    def error(self, generator: Generators) -> float:
        """Greatest, or root mean square."""
        errors = self.errors(generator)
        if self.greatest:
            return float(np.abs(errors).max())
        return float(np.sqrt(self.desired.weights @ errors**2 / self.desired.weights.sum()))

    def missed(self, generator: Generators) -> float:
        """Amount by which the worst limit is missed."""
        short = float(-self.limits(generator).value.min(initial=0.0))
        if np.isfinite(self.band):
            short = max(short, float(np.abs(self.errors(generator)).max()) - self.band)
        return short

    def score(self, generator: Generators) -> float:
        """The number that falls from step to step; infinite where the loop is open."""
        value = self.error(generator) + PRICE * self.missed(generator)
        return value if np.isfinite(value) else np.inf


def refined(aim: Aim, start: Generators, steps: int = STEPS) -> Optimum:
    """The optimum near one start, closed at all samples; it may miss limits.

    Errors and limits are linearised about the best shape so far; within a trust region, there remains a
    linear programme for the greatest error or linear least squares under inequalities for the mean square
    (Lawson & Hanson, *Solving Least Squares Problems*, ch. 23). A slack lets starts miss limits.
    """
    generator, score, radius = start, aim.score(start), _FIRST
    if not np.isfinite(score):
        return Optimum(generator, np.inf, np.inf, 0)
    linear = _Linear.of(aim, generator)
    flat = 0
    taken = 0
    while taken < steps and linear.finite:
        raise_if_overdue()
        taken += 1
        moved, predicted_score = linear.step(radius)
        there, fresh = linear.best_along(generator, moved)
        gain, expected_gain = score - fresh, score - predicted_score
        if gain > 0:
            generator, score = there, fresh
            linear = _Linear.of(aim, generator)
        share = gain / expected_gain if expected_gain > 0 else 0.0
        if share > 0.7:
            radius = min(_MOST, max(radius, 2.5 * float(np.abs(moved).max())))
        elif share < 0.2:
            radius = 0.3 * min(radius, float(np.abs(moved).max()) or radius)
        flat = flat + 1 if abs(expected_gain) <= 1e-7 * score + 1e-16 else 0
        if radius < _LEAST or flat > 1:
            break
    return Optimum(generator, aim.error(generator), max(0.0, aim.missed(generator)), taken)


@dataclass(frozen=True, slots=True)
class _Linear:
    """An aim, linearised about a shape."""

    aim: Aim
    errors: FloatArray  # (N,)
    slopes: FloatArray  # (N, K)
    limits: FloatArray  # (L,)
    by_shape: FloatArray  # (L, K)
    free: FloatArray  # (K,), 0 for what stays

    @classmethod
    def of(cls, aim: Aim, generator: Generators) -> _Linear:
        slopes = generator.slopes(aim.desired.turned)[0]
        limits = aim.limits(generator)
        free = np.append(np.ones(generator.UNKNOWNS - 1), 0.0 if aim.held else 1.0)
        return cls(aim, aim.errors(generator), slopes, limits.value[0], limits.slope[0], free)

    @property
    def finite(self) -> bool:
        """Whether the output has a rate everywhere: in a dead position it has none."""
        return bool(np.isfinite(self.slopes).all())

    def step(self, radius: float) -> tuple[FloatArray, float]:
        """The best step, shape (K,), and the score predicted for it."""
        moved = self._greatest(radius) if self.aim.greatest else self._square(radius)
        off = self.errors + self.slopes @ moved
        short = max(0.0, float(-(self.limits + self.by_shape @ moved).min(initial=0.0)))
        if self.aim.greatest:
            error = (off.max() - off.min()) / 2
        else:
            weights = self.aim.desired.weights
            off = off - weights @ off / weights.sum()
            error = np.sqrt(weights @ off**2 / weights.sum())
        if np.isfinite(self.aim.band):
            short = max(short, float(np.abs(off).max()) - self.aim.band)
        return moved, float(error) + PRICE * short

    def best_along(self, generator: Generators, moved: FloatArray) -> tuple[Generators, float]:
        """Where a step leads, or that step brought back to the errors that it predicted, and the score there.

        The valleys of these errors are narrow and curved: without the correction (of second order, Fletcher)
        steps along them would have to be tiny.
        """
        there = generator.changed(generator.shape + moved)
        best = there, self.aim.score(there)
        centred = (self.slopes - self.slopes.mean(axis=0)) * self.free
        predicted = self.errors + self.slopes @ moved
        scale = float(np.einsum("nk,nk->", centred, centred))
        normal = centred.T @ centred + 1e-8 * scale * np.eye(generator.UNKNOWNS)
        for _ in range(CORRECTIONS):
            strayed = self.aim.errors(there) - predicted
            if not np.isfinite(strayed).all():
                break
            back = np.linalg.solve(normal, centred.T @ (strayed - strayed.mean()))
            there = generator.changed(there.shape - back)
            score = self.aim.score(there)
            if not score < best[1]:
                break
            best = there, score
        return best

    def _greatest(self, radius: float) -> FloatArray:
        """Linear programme in the step, the zero, the greatest error and the slack."""
        from scipy.optimize import linprog  # here: few problems need it

        count, kept, unknowns = len(self.errors), len(self.limits), len(self.free)
        scale = max(float(np.ptp(self.errors)) / 2, 1e-12)
        one, none = np.ones((count, 1)), np.zeros((count, 1))
        over = np.hstack([self.slopes / scale, -one, -one, none])
        under = np.hstack([-self.slopes / scale, one, -one, none])
        rows = np.hstack([-self.by_shape, np.zeros((kept, 2)), -np.ones((kept, 1))])
        right = np.concatenate([-self.errors / scale, self.errors / scale, self.limits])
        most = radius * self.free
        bounds = [*zip(-most, most, strict=True), (None, None), (0, None), (0, None)]
        cost = np.array([0.0] * unknowns + [0.0, 1.0, PRICE / scale])
        found = linprog(cost, np.vstack([over, under, rows]), right, bounds=bounds, method="highs")
        return np.zeros(unknowns) if found.x is None else np.asarray(found.x[:unknowns])

    def _square(self, radius: float) -> FloatArray:
        """Least squares in the step and the slack, the zero eliminated, under inequalities."""
        unknowns = len(self.free)
        weights = self.aim.desired.weights / self.aim.desired.weights.sum()
        root = np.sqrt(weights)
        centred = self.slopes - weights @ self.slopes
        damp = 1e-9 * np.linalg.norm(centred * root[:, None]) * np.eye(unknowns)
        matrix = np.zeros((len(self.errors) + unknowns + 1, unknowns + 1))
        matrix[: len(self.errors), :unknowns] = centred * root[:, None] * self.free
        matrix[len(self.errors) : -1, :unknowns] = damp
        matrix[-1, -1] = _HEAVY
        side = np.zeros(len(matrix))
        side[: len(self.errors)] = -self.errors * root
        rows = np.hstack([self.by_shape, np.ones((len(self.limits), 1))])
        bounds = -self.limits
        box = np.hstack([np.vstack([np.eye(unknowns), -np.eye(unknowns)]), np.zeros((2 * unknowns, 1))])
        slack = np.append(np.zeros(unknowns), 1.0)[None]
        inequality = np.vstack([rows, box, slack])
        least = np.concatenate([bounds, np.full(2 * unknowns, -radius), [0.0]])
        if np.isfinite(self.aim.band):
            band = self.aim.band
            inequality = np.vstack([
                inequality,
                np.hstack([-centred, np.ones((len(centred), 1))]),
                np.hstack([centred, np.ones((len(centred), 1))]),
            ])  # fmt: skip
            least = np.concatenate([least, self.errors - band, -self.errors - band])
        found = under_inequalities(matrix, side, inequality, least)
        return np.clip(found[:unknowns], -radius, radius) * self.free


def under_inequalities(
    matrix: FloatArray, side: FloatArray, rows: FloatArray, least: FloatArray
) -> FloatArray:
    """Least squares (n,) of ``matrix @ z - side`` under ``rows @ z >= least``; zeros where these contradict.

    `matrix` (m, n) has full column rank; `rows` are (k, n). LSI as least distance, and that as non-negative
    least squares (Lawson & Hanson, *Solving Least Squares Problems*, 1974, ch. 23).
    """
    from scipy.optimize import nnls  # here: few problems need it

    q, r = np.linalg.qr(matrix)
    inner = q.T @ side
    turned = np.linalg.solve(r.T, rows.T).T
    right = least - turned @ inner
    size = np.maximum(np.linalg.norm(turned, axis=1), 1e-300)
    turned, right = turned / size[:, None], right / size
    scale = max(float(np.abs(right).max(initial=0.0)), 1e-300)
    system = np.vstack([turned.T, right / scale])
    target = np.zeros(len(system))
    target[-1] = 1.0
    try:
        dual, _ = nnls(system, target, maxiter=30 * len(right))
    except RuntimeError:  # it goes round in circles
        return np.zeros(matrix.shape[1])
    rest = system @ dual - target
    if np.linalg.norm(rest) < 1e-12 or rest[-1] == 0:
        return np.zeros(matrix.shape[1])
    distance = -rest[:-1] / rest[-1] * scale
    found: FloatArray = np.linalg.solve(r, distance + inner)
    return found


def with_extremes(aim: Aim, generator: Generators, turned: FloatArray, output: FloatArray) -> Aim:
    """The same aim with samples where a generator errs most on a dense grid, shape (K,) each."""
    off = (generator.outputs(turned) - output)[0]
    inner = np.flatnonzero((off[1:-1] - off[:-2]) * (off[2:] - off[1:-1]) <= 0) + 1
    at = np.concatenate([aim.desired.turned, turned[inner]])
    desired = np.concatenate([aim.desired.output, output[inner]])
    order = np.unique(at, return_index=True)[1]
    weights = np.concatenate([aim.desired.weights, np.ones(len(inner))])
    return replace(aim, desired=DesiredOutput(at[order], desired[order], weights[order]))
