"""The best cylinder near a given one: the least lever is maximised within all limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.cylinder.planes import Plane, Room, performance

_STEP = 1e-7  # of differences
_MOST = 60  # iterations of quadratic programmes
_ROUNDS, _FIRST, _LEAST, _WIDEST = 40, 0.02, 1e-9, 0.3  # linear programmes, and their region of trust
_GAIN = 1e-10  # sine of the lever angle; less does not justify another programme
_WEIGHT = 300.0  # of a limit, in logarithms, against a lever
_INSIDE = 1e-9  # margin to the limits in linear programmes, since they end on them

Pivots = tuple[complex, complex]  # of the link, and the base


def by_quadratic(plane: Plane, room: Room, pivots: Pivots) -> Pivots:
    """Pivots that maximise the least lever t, with all levers at least t, by quadratic programmes (SLSQP).

    The resulting pivots may be beyond the limits.
    """
    from scipy import optimize  # only here, and few problems have cylinders

    scale = _Scale.of(plane, room)
    least = performance(plane, *(np.array([each]) for each in pivots)).least

    def margins(z: FloatArray) -> FloatArray:
        levers, limits = scale.margins(z[:, :4])
        return np.concatenate([levers - z[:, 4:], limits], axis=1)

    kept: Any = {"type": "ineq", "fun": lambda z: margins(z[None])[0], "jac": lambda z: _slopes(margins, z)}
    given: dict[str, Any] = {
        "jac": lambda _: np.array([0.0, 0.0, 0.0, 0.0, -1.0]),
        "bounds": [*zip(*scale.bounds, strict=True), (-1.0, 1.0)],
    }
    minimize: Any = optimize.minimize
    found = minimize(
        lambda z: float(-z[4]),
        np.concatenate([scale.unknowns(pivots), least]),
        constraints=kept,
        method="SLSQP",
        options={"maxiter": _MOST, "ftol": 1e-9},
        **given,
    )
    return scale.pivots_at(found.x[:4]) if np.isfinite(found.x).all() else pivots


def by_linear(plane: Plane, room: Room, pivots: Pivots) -> Pivots:
    """The same by linear programmes in a region of trust.

    Where as many levers and limits meet as there are unknowns, this converges as Newton's method does (Madsen
    1975, minimax); a limit that is overstepped costs in proportion, so the search may begin, and end, outside
    the limits.
    """
    scale, trust = _Scale.of(plane, room), _FIRST
    x = np.clip(scale.unknowns(pivots), *scale.bounds)
    levers, limits = scale.margins(x[None])
    score = _score(levers, limits)
    for _ in range(_ROUNDS):
        step, predicted = _step(scale, x, trust, levers[0], limits[0])
        if predicted - score < _GAIN or trust < _LEAST:
            break
        next_levers, next_limits = scale.margins((x + step)[None])
        reached = _score(next_levers, next_limits)
        share = (reached - score) / (predicted - score)
        if share > 0:
            x, levers, limits, score = x + step, next_levers, next_limits, reached
        trust = trust / 3 if share < 0.25 else min(2 * trust, _WIDEST) if share > 0.75 else trust
    return scale.pivots_at(x)


def _score(levers: FloatArray, limits: FloatArray) -> float:
    return float(levers.min() + _WEIGHT * np.minimum(limits - _INSIDE, 0.0).sum())


def _step(
    scale: _Scale, x: FloatArray, trust: float, levers: FloatArray, limits: FloatArray
) -> tuple[FloatArray, float]:
    """The best step of the linear model, and the score that it predicts."""
    from scipy import optimize

    count = len(limits)
    slope = _slopes(lambda z: np.concatenate(scale.margins(z), axis=1), x)
    lever_slope, limit_slope = slope[: len(levers)], slope[len(levers) :]
    rows = np.block([
        [-lever_slope, np.ones((len(levers), 1)), np.zeros((len(levers), count))],
        [-limit_slope, np.zeros((count, 1)), -np.eye(count)],
    ])  # fmt: skip
    low, high = scale.bounds
    region = np.stack([np.maximum(low - x, -trust), np.minimum(high - x, trust)], axis=1)
    linprog: Any = optimize.linprog
    found = linprog(
        np.concatenate([np.zeros(4), [-1.0], np.full(count, _WEIGHT)]),
        A_ub=rows,
        b_ub=np.concatenate([levers, limits - _INSIDE]),
        bounds=[*map(tuple, region), (None, None), *[(0, None)] * count],
        method="highs-ds",
    )
    return (np.zeros(4), -np.inf) if found.x is None else (found.x[:4], -float(found.fun))


def _slopes(values: Any, x: FloatArray) -> FloatArray:
    """Derivatives of (N, rows) values at x by differences; shape (rows, len(x))."""
    aside = _STEP * np.eye(len(x))
    every = values(np.concatenate([x + aside, x - aside]))
    slope: FloatArray = ((every[: len(x)] - every[len(x) :]) / (2 * _STEP)).T
    return slope


@dataclass(frozen=True, slots=True, eq=False)
class _Scale:
    """Pivots as four unknowns of like size: that of the link in reaches, the base in sides of its box."""

    plane: Plane
    room: Room
    first: FloatArray
    sizes: FloatArray

    @classmethod
    def of(cls, plane: Plane, room: Room) -> _Scale:
        span = np.maximum(room.high - room.low, 1e-12 * room.reach)
        return cls(plane, room, np.array([0.0, 0.0, *room.low]), np.array([room.reach, room.reach, *span]))

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Of the unknowns; those of the link are among the limits."""
        far = np.full(2, np.inf)
        side = (self.room.high - self.room.low) / self.sizes[2:]
        return np.concatenate([-far, np.zeros(2)]), np.concatenate([far, side])

    def unknowns(self, pivots: Pivots) -> FloatArray:
        point, base = pivots
        return (np.array([point.real, point.imag, base.real, base.imag]) - self.first) / self.sizes

    def pivots(self, x: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        scaled = self.first + x * self.sizes
        return scaled[:, 0] + 1j * scaled[:, 1], scaled[:, 2] + 1j * scaled[:, 3]

    def pivots_at(self, x: FloatArray) -> Pivots:
        points, bases = self.pivots(x[None])
        return complex(points[0]), complex(bases[0])

    def margins(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Levers, and margins to the limits, of (N, 4) unknowns."""
        points, bases = self.pivots(x)
        found = performance(self.plane, points, bases)
        inside = 1 - (np.abs(points - self.room.middle) / self.room.reach) ** 2
        limits = np.concatenate([self.room.left(found), inside[:, None]], axis=1)
        return found.levers, np.clip(np.where(np.isnan(limits), 0.0, limits), -50.0, 50.0)
