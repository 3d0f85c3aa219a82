"""Many solutions of a polynomial system followed at once while its parameters change."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.theory.stopping import raise_if_stopped

# Solutions (n, K), parameters (n, M) and their change (n, M) give the residual (n, K), its
# derivative by the solutions (n, K, K) and its change along the change of the parameters (n, K).
System = Callable[[ComplexArray, ComplexArray, ComplexArray], tuple[ComplexArray, ComplexArray, ComplexArray]]

FIRST, LARGEST, SMALLEST = 0.02, 0.25, 1e-9  # steps, as shares of the path
GROW_AFTER = 3  # consecutive good steps that double the step
CORRECTIONS = 2  # Newton steps after each prediction
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

    Runge-Kutta prediction of Davidenko's equation, Newton correction, each path with a step of its own
    (Sommese & Wampler, *The Numerical Solution of Systems of Polynomials*, 2005, ch. 2).
    """
    solutions = solutions.copy()
    way = target - start
    done, step = np.zeros(len(solutions)), np.full(len(solutions), FIRST)
    good_steps = np.zeros(len(solutions), dtype=np.int64)
    active = np.arange(len(solutions))
    for _ in range(steps):
        if not len(active):
            break
        raise_if_stopped()
        here, length = done[active], np.minimum(step[active], 1 - done[active])
        with np.errstate(all="ignore"):
            tried, correction = _stepped(system, solutions[active], here, length, start, way)
            good = correction <= tolerance * np.abs(tried).max(axis=1)
        moved = active[good]
        solutions[moved], done[moved] = tried[good], (here + length)[good]
        good_steps[active] = np.where(good, good_steps[active] + 1, 0)
        grow = good_steps[active] >= GROW_AFTER
        good_steps[active[grow]] = 0
        step[active] = np.minimum(np.where(grow, 2 * length, np.where(good, length, length / 2)), LARGEST)
        lost = (step[active] < SMALLEST) | (np.abs(solutions[active]).max(axis=1) > FAR)
        active = active[(done[active] < 1) & ~lost]
    return solutions, done >= 1


def _stepped(
    system: System,
    solutions: ComplexArray,
    here: FloatArray,
    length: FloatArray,
    start: ComplexArray,
    way: ComplexArray,
) -> tuple[ComplexArray, FloatArray]:
    """Solutions a step on, and the greatest last correction of an unknown (NaN where singular)."""

    def slope(at: ComplexArray, share: FloatArray) -> ComplexArray:
        parameters = start + share[:, None] * way
        _, jacobian, change = system(at, parameters, np.broadcast_to(way, parameters.shape))
        return -_solved(jacobian, change)

    h = length[:, None]
    k1 = slope(solutions, here)
    k2 = slope(solutions + h / 2 * k1, here + length / 2)
    k3 = slope(solutions + h / 2 * k2, here + length / 2)
    k4 = slope(solutions + h * k3, here + length)
    tried = solutions + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    correction = np.zeros(len(tried))
    for _ in range(CORRECTIONS):
        tried, correction = corrected(system, tried, start + (here + length)[:, None] * way)
    return tried, correction


def corrected(
    system: System, solutions: ComplexArray, parameters: ComplexArray
) -> tuple[ComplexArray, FloatArray]:
    """One Newton step on every solution (n, K), and its greatest component (n,); NaN where singular."""
    residual, jacobian, _ = system(solutions, parameters, np.zeros_like(parameters))
    change = _solved(jacobian, residual)
    return solutions - change, np.abs(change).max(axis=1)


def _solved(matrix: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Solutions of linear systems (n, K, K), rows scaled; NaN where singular or not finite."""
    scale = np.abs(matrix).max(axis=2)
    scale = np.where(scale > 0, scale, 1.0)
    matrix, right = matrix / scale[..., None], right / scale
    sound = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
    matrix[~sound], right[~sound] = np.eye(matrix.shape[1]), np.nan
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
    except np.linalg.LinAlgError:  # one exactly singular matrix refuses them all
        sound = np.abs(np.linalg.det(matrix)) > 0
        matrix[~sound], right[~sound] = np.eye(matrix.shape[1]), np.nan
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
