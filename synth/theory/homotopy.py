"""Many solutions of a polynomial system followed at once while its parameters change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.theory.stopping import raise_if_stopped

# Solutions (n, K), parameters (n, M) and their change (n, M) give the residual (n, K), its
# derivative by the solutions (n, K, K) and its change along the change of the parameters (n, K).
System = Callable[[ComplexArray, ComplexArray, ComplexArray], tuple[ComplexArray, ComplexArray, ComplexArray]]

FIRST, LARGEST, SMALLEST = 0.02, 0.25, 1e-9  # steps, as shares of the path
# The second correction grows with that power of the step: twice that of the prediction's error. The next step
# would bring it to its tolerance, but for a share; it is longer or shorter by no more than some factors.
ORDER, KEPT, CHANGE = 1 / 12, 0.8, (0.5, 1.5)
FAR = 1e7  # a larger solution has gone to infinity
STEPS = 2000


def follow(
    system: System,
    solutions: ComplexArray,
    start: ComplexArray,
    target: ComplexArray,
    tolerance: float = 1e-6,
    steps: int = STEPS,
) -> tuple[ComplexArray, BoolArray]:
    """Follow solutions (n, K) along a straight line from the parameters `start` to `target`, (M,).

    Solutions at `target`, and whether each was reached, (n,): not where a path went to infinity, ended at a
    singular point or took more than `steps` steps. `tolerance` is the largest last Newton correction of a
    step, relative to the largest unknown; larger ones halve the step. Too large a one lets paths jump to
    their neighbours.

    Prediction by the polynomial of degree five through the last three points and their slopes (Hermite), in
    the beginning by Runge-Kutta's method for Davidenko's equation; Newton correction, the second of which
    gives the slope as well; each path has a step of its own (Sommese & Wampler, *The Numerical Solution of
    Systems of Polynomials*, 2005, ch. 2).
    """
    way = target - start
    ends, reached = solutions.copy(), np.zeros(len(solutions), dtype=bool)
    paths = _Paths.begun(system, solutions, start, way)
    for _ in range(steps):
        if not len(paths.number):
            break
        raise_if_stopped()
        here, length = paths.share[0], np.minimum(paths.step, 1 - paths.share[0])
        with np.errstate(all="ignore"):
            there = here + length
            predicted = _predicted(system, paths, there, start, way)
            tried, correction, slope = _corrected(system, predicted, there, start, way)
            share = correction / (tolerance * np.abs(tried).max(axis=1))
            good = share <= 1
            longer = np.clip(KEPT * share**-ORDER, *CHANGE)
        paths = paths.moved(good, there, tried, slope)
        paths.step = np.minimum(np.where(np.isfinite(longer), longer, CHANGE[0]) * length, LARGEST)
        done = paths.share[0] >= 1
        ends[paths.number], reached[paths.number] = paths.points[0], done
        lost = (paths.step < SMALLEST) | (np.abs(paths.points[0]).max(axis=1) > FAR)
        if (done | lost).any():
            paths = paths.of(~(done | lost))
    return ends, reached


@dataclass(slots=True)
class _Paths:
    """Paths that are followed: their last three points, the latest first."""

    number: IntArray  # (n,)
    share: FloatArray  # (3, n): of the way, NaN where there is no such point yet
    points: ComplexArray  # (3, n, K)
    slopes: ComplexArray  # (3, n, K), by the share of the way
    step: FloatArray  # (n,)

    @classmethod
    def begun(cls, system: System, solutions: ComplexArray, start: ComplexArray, way: ComplexArray) -> _Paths:
        """Paths at their beginning."""
        count = len(solutions)
        share, points = np.full((3, count), np.nan), np.empty((3, *solutions.shape), dtype=np.complex128)
        share[0], points[:] = 0.0, solutions
        slopes = np.zeros_like(points)
        with np.errstate(all="ignore"):
            slopes[0] = _slope(system, solutions, share[0], start, way)
        return cls(np.arange(count), share, points, slopes, np.full(count, FIRST))

    def moved(self, good: BoolArray, share: FloatArray, points: ComplexArray, slopes: ComplexArray) -> _Paths:
        """The paths with another point, where that is good."""

        def after(last: Any, new: Any) -> Any:
            chosen = good.reshape(-1, *[1] * (new.ndim - 1))
            return np.where(chosen, np.concatenate([new[None], last[:2]]), last)

        return _Paths(
            self.number,
            after(self.share, share),
            after(self.points, points),
            after(self.slopes, slopes),
            self.step,
        )

    def of(self, rows: BoolArray) -> _Paths:
        """Some of them."""
        return _Paths(
            self.number[rows],
            self.share[:, rows],
            self.points[:, rows],
            self.slopes[:, rows],
            self.step[rows],
        )


def _predicted(
    system: System, paths: _Paths, share: FloatArray, start: ComplexArray, way: ComplexArray
) -> ComplexArray:
    """Points (n, K) of paths at a share of the way ahead."""
    known = np.isfinite(paths.share[2])
    predicted: ComplexArray = np.empty_like(paths.points[0])
    predicted[known] = _by_hermite(paths.of(known), share[known])
    if not known.all():
        first = paths.of(~known)
        at, h = first.points[0], (share[~known] - first.share[0])[:, None]
        k1 = first.slopes[0]
        half = first.share[0] + h[:, 0] / 2
        k2 = _slope(system, at + h / 2 * k1, half, start, way)
        k3 = _slope(system, at + h / 2 * k2, half, start, way)
        k4 = _slope(system, at + h * k3, share[~known], start, way)
        predicted[~known] = at + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return predicted


def _by_hermite(paths: _Paths, share: FloatArray) -> ComplexArray:
    """The polynomial through three points with their slopes, at other places, (n, K)."""
    at = paths.share
    found: ComplexArray = np.zeros_like(paths.points[0])
    for i in range(3):
        others = [at[j] for j in range(3) if j != i]
        base = np.prod([(share - other) / (at[i] - other) for other in others], axis=0) ** 2
        bend = sum(1 / (at[i] - other) for other in others)
        ahead = share - at[i]
        found += (base * (1 - 2 * ahead * bend))[:, None] * paths.points[i]
        found += (base * ahead)[:, None] * paths.slopes[i]
    return found


def _slope(
    system: System, at: ComplexArray, share: FloatArray, start: ComplexArray, way: ComplexArray
) -> ComplexArray:
    """Change of solutions (n, K) with the share of the way."""
    parameters = start + share[:, None] * way
    _, jacobian, change = system(at, parameters, np.broadcast_to(way, parameters.shape))
    slope: ComplexArray = -_solved(jacobian, change[..., None])[..., 0]
    return slope


def _corrected(
    system: System, predicted: ComplexArray, share: FloatArray, start: ComplexArray, way: ComplexArray
) -> tuple[ComplexArray, FloatArray, ComplexArray]:
    """Solutions after two Newton steps, the greatest second correction (NaN where singular), and slopes."""
    parameters = start + share[:, None] * way
    residual, jacobian, _ = system(predicted, parameters, np.zeros_like(parameters))
    once = predicted - _solved(jacobian, residual[..., None])[..., 0]
    residual, jacobian, change = system(once, parameters, np.broadcast_to(way, parameters.shape))
    both = _solved(jacobian, np.stack([residual, change], axis=-1))
    return once - both[..., 0], np.abs(both[..., 0]).max(axis=1), -both[..., 1]


def corrected(
    system: System, solutions: ComplexArray, parameters: ComplexArray
) -> tuple[ComplexArray, FloatArray]:
    """One Newton step on every solution (n, K), and its greatest component (n,); NaN where singular."""
    residual, jacobian, _ = system(solutions, parameters, np.zeros_like(parameters))
    change = _solved(jacobian, residual[..., None])[..., 0]
    return solutions - change, np.abs(change).max(axis=1)


def _solved(matrix: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Solutions (n, K, R) of linear systems (n, K, K), rows scaled; NaN where singular or not finite."""
    parts = matrix.view(np.float64)
    scale = np.sqrt(np.einsum("nij,nij->ni", parts, parts))
    scale = np.where(scale > 0, scale, 1.0)[..., None]
    matrix, right = matrix / scale, right / scale
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:  # one exactly singular matrix refuses them all
        sound = np.abs(np.linalg.det(matrix)) > 0
        matrix[~sound], right[~sound] = np.eye(matrix.shape[1]), np.nan
        return np.asarray(np.linalg.solve(matrix, right))
