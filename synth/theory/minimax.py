"""Minimax of several functions within limits, by linear programmes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from grashof.problems.values.arrays import FloatArray

_STEP = 1e-7  # step of differences
_ROUNDS, _FIRST, _LEAST, _WIDEST = 40, 0.02, 1e-9, 0.3  # programmes, and their region of trust
_GAIN = 1e-10  # of the greatest value; less does not justify another programme
_WEIGHT = 300.0  # of a limit against a value
_INSIDE = 1e-9  # margin to the limits, since programmes end on them

# From unknowns (N, n) to values (N, K), and margins (N, J) that are negative beyond the limits.
Rows = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


def by_linear(
    rows: Rows, x: FloatArray, low: FloatArray, high: FloatArray, rounds: int = _ROUNDS
) -> FloatArray:
    """Unknowns (n,) that minimise the greatest value within the limits, by programmes in a region of trust.

    Where as many values and limits meet as there are unknowns, this converges as Newton's method does (Madsen
    1975, minimax); a missed limit costs in proportion, so the search may begin and end outside the
    limits. Unknowns, values and margins are to be of the order of 1.

    Examples
    --------
    >>> def rows(x):  # the greatest of x, -x and 0.3 - x, where x is at least 0.2
    ...     return np.concatenate([x, -x, 0.3 - x], axis=1), x - 0.2
    >>> by_linear(rows, np.array([0.9]), np.array([-1.0]), np.array([1.0])).round(6).tolist()
    [0.2]
    """
    trust, x = _FIRST, np.clip(x, low, high)
    values, margins = rows(x[None])
    cost = _cost(values, margins)
    for _ in range(rounds):
        region = np.stack([np.maximum(low - x, -trust), np.minimum(high - x, trust)], axis=1)
        step, predicted = _step(rows, x, region, values[0], margins[0])
        if cost - predicted < _GAIN or trust < _LEAST:
            break
        next_values, next_margins = rows((x + step)[None])
        reached = _cost(next_values, next_margins)
        share = (cost - reached) / (cost - predicted)
        if share > 0:
            x, values, margins, cost = x + step, next_values, next_margins, reached
        trust = trust / 3 if share < 0.25 else min(2 * trust, _WIDEST) if share > 0.75 else trust
    return x


def slopes(values: Callable[[FloatArray], FloatArray], x: FloatArray) -> FloatArray:
    """Derivatives of (N, K) values at x (n,) by differences; shape (K, n)."""
    aside = _STEP * np.eye(len(x))
    every = values(np.concatenate([x + aside, x - aside]))
    slope: FloatArray = ((every[: len(x)] - every[len(x) :]) / (2 * _STEP)).T
    return slope


def _cost(values: FloatArray, margins: FloatArray) -> float:
    return float(values.max() - _WEIGHT * np.minimum(margins - _INSIDE, 0.0).sum())


def _step(
    rows: Rows, x: FloatArray, region: FloatArray, values: FloatArray, margins: FloatArray
) -> tuple[FloatArray, float]:
    """The best step of the linear model, and the cost that it predicts."""
    from scipy import optimize  # only here, and few problems need it

    slope = slopes(lambda z: np.concatenate(rows(z), axis=1), x)
    reach = np.abs(slope) @ np.abs(region).max(axis=1)  # most by which each changes in the region
    # Values that stay below another, and margins that stay, cannot matter to the programme.
    high, kept = (values - reach[: len(values)]).max(), margins - reach[len(values) :] < _INSIDE
    counts = values + reach[: len(values)] >= high
    value_slope, margin_slope = slope[: len(values)][counts], slope[len(values) :][kept]
    values, margins = values[counts], margins[kept]
    count, size = len(margins), len(x)
    table = np.block([
        [value_slope, -np.ones((len(values), 1)), np.zeros((len(values), count))],
        [-margin_slope, np.zeros((count, 1)), -np.eye(count)],
    ])  # fmt: skip
    linprog: Any = optimize.linprog
    found = linprog(
        np.concatenate([np.zeros(size), [1.0], np.full(count, _WEIGHT)]),
        A_ub=table,
        b_ub=np.concatenate([-values, margins - _INSIDE]),
        bounds=[*map(tuple, region), (None, None), *[(0, None)] * count],
        method="highs-ds",
    )
    return (np.zeros(size), np.inf) if found.x is None else (found.x[:size], float(found.fun))
