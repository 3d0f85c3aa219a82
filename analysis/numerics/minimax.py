"""Chebyshev fits: the least peak of a curve that parameters shift linearly."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from grashof.analysis.numerics.peaks import Curve
from grashof.problems import SolverError
from grashof.problems.values.arrays import FloatArray

_SAMPLES = 181
_ROUNDS = 40
_SETTLED = 1e-9  # share of the peak above the lower bound at which to stop
_FINE = 1e-10  # the finest tolerance of the solver


class LeastPeak(NamedTuple):
    """Parameters, shape (K,), and the greatest remaining magnitude."""

    parameters: FloatArray
    peak: float


def least_peak(
    base: Curve,
    effects: Curve,
    start: float,
    end: float,
    outermost: Callable[[Curve], tuple[float, float]],
) -> LeastPeak:
    """Parameters x (K,) that minimise the maximum of |base + effects x| between two ends.

    `base` maps places (N,) to (N,), `effects` to (N, K); `outermost` gives the places of a curve's least and
    largest value. A linear programme at some places, to which the peaks of its curve are added (an exchange
    method: Hettich & Kortanek 1993, *SIAM Rev.* 35(3), 380-429). NaN if a curve is not finite; SolverError if
    the programme is not solved. Chebyshev: x^2 less the best straight line on [0, 1] leaves 1/8.
    """
    places = np.linspace(start, end, _SAMPLES)
    best = LeastPeak(np.zeros(effects(places[:1]).shape[-1]), np.inf)
    if not (np.isfinite(base(places)).all() and np.isfinite(effects(places)).all()):
        return LeastPeak(np.full(best.parameters.shape, np.nan), np.nan)
    bound = -1.0
    for _ in range(_ROUNDS):
        before = bound
        parameters, bound = least_peak_at(base(places), effects(places))

        def left(t: FloatArray, chosen: FloatArray = parameters) -> FloatArray:
            return base(t) + effects(t) @ chosen

        peaks = np.array(outermost(left))
        peak = float(np.abs(left(peaks)).max())
        if peak < best.peak:
            best = LeastPeak(parameters, peak)
        if peak - bound <= _SETTLED * peak or bound <= before:  # no progress by the new places
            break
        places = np.concatenate([places, peaks])
    return best


def least_peak_at(base: FloatArray, effects: FloatArray) -> tuple[FloatArray, float]:
    """The parameters of the least peak at some places, and that peak."""
    scale, sizes = float(np.abs(base).max()) or 1.0, np.abs(effects).max(axis=0)
    sizes = np.where(sizes > 0, sizes, 1.0)
    ones = np.ones((len(base), 1))
    rows = np.block([[effects / sizes, -ones], [-effects / sizes, -ones]])
    sides = np.concatenate([-base, base]) / scale
    goal = [0.0] * effects.shape[1] + [1.0]
    bounds: list[tuple[float | None, float | None]] = [(None, None)] * effects.shape[1] + [(0.0, None)]
    found = scipy.optimize.linprog(
        goal,
        A_ub=rows,
        b_ub=sides,
        bounds=bounds,
        options={"primal_feasibility_tolerance": _FINE, "dual_feasibility_tolerance": _FINE},
    )
    if found.x is None:
        raise SolverError(f"no least peak was found: {found.message}")
    return np.asarray(found.x[:-1] * scale / sizes), float(found.x[-1] * scale)
