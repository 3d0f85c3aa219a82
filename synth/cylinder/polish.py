"""The best cylinder near a given one: the least lever is maximised within all limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.cylinder.planes import Plane, Room, performance
from grashof.synth.theory import minimax

_MOST = 60  # iterations of quadratic programmes

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

    kept: Any = {
        "type": "ineq",
        "fun": lambda z: margins(z[None])[0],
        "jac": lambda z: minimax.slopes(margins, z),
    }
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
    """The same by linear programmes, which may begin and end outside the limits."""
    scale = _Scale.of(plane, room)

    def rows(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        levers, limits = scale.margins(x)
        return -levers, limits

    return scale.pivots_at(minimax.by_linear(rows, scale.unknowns(pivots), *scale.bounds))


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
