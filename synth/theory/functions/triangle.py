"""The triangle of O2 and the pivots of a cylinder on the driver, and its limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import FloatArray, Limits
from grashof.synth.loop.dual import Dual
from grashof.synth.theory.functions.limits import joined_rows

LEAST_LEVER = float(np.radians(2.0))  # least angle between cylinder and arm, where none is required
_LONG, _FAR = 8.0, 3.0  # where limits leave them free: first length over the least, base and arm over that
_TRIES = 20  # triangles that are tried for each one wanted
_BATCHES = 30


def opening(base: FloatArray, arm: FloatArray, length: FloatArray) -> FloatArray:
    """Angle at O2 between the base and the pivot of a cylinder, rad; NaN where it cannot be as long.

    tan^2 of half of it is (L^2 - (b - c)^2) / ((b + c)^2 - L^2), in which no digits cancel near 0 and pi.
    """
    apart = (length - base + arm) * (length + base - arm)
    left = (base + arm - length) * (base + arm + length)
    with np.errstate(invalid="ignore"):
        found: FloatArray = 2 * np.arctan2(np.sqrt(apart), np.sqrt(left))
    return found


def turned_by(triangle: FloatArray, inputs: FloatArray) -> FloatArray:
    """Driver rotations at lengthenings (N,), by logarithms (3,) of base, arm and first length."""
    base, arm, length = np.exp(triangle)
    return opening(base, arm, length + inputs) - opening(base, arm, length)


def opening_slopes(base: FloatArray, arm: FloatArray, length: FloatArray) -> tuple[FloatArray, ...]:
    """Derivatives of the opening by the base, the arm and the length; infinite in dead positions."""
    angle = opening(base, arm, length)
    with np.errstate(invalid="ignore", divide="ignore"):
        sine, cosine = np.sin(angle), np.cos(angle)
        return (
            (arm * cosine - base) / (base * arm * sine),
            (base * cosine - arm) / (base * arm * sine),
            length / (base * arm * sine),
        )


@dataclass(frozen=True, slots=True)
class TriangleLimits:
    """Limits of the distances of base and pivot from O2, and of the first and least length."""

    stroke: float
    base: Limits
    closed: Limits  # as far as the ratio of lengths allows
    lever: float  # rad, least angle between cylinder and arm
    ratio: float  # greatest ratio of base and arm, either way
    unit: float  # of the lengths of the linkage: r1, or the travel

    def reach(self, logs: FloatArray) -> float:
        """Greatest logarithm of the unit over r2 that leaves r2 no shorter than the arm, of logs (3,)."""
        return float(np.log(self.unit) - logs[1])

    def rows(self, logs: Dual) -> Dual:
        """Limits (M, L), zero or positive where they are kept, of the logarithms of base, arm and length."""
        base, arm, length = (np.exp(logs.column(k)) for k in range(3))
        parts = [
            sign * (logs.column(k) - float(np.log(edge)))
            for k, limits in ((0, self.base), (2, self.closed))
            for sign, edge in zip((1.0, -1.0), limits, strict=True)
            if 0 < edge < np.inf
        ]
        apart = logs.column(0) - logs.column(1)
        parts += [np.log(self.ratio) - apart, np.log(self.ratio) + apart]
        most = float(np.cos(max(self.lever, LEAST_LEVER)))
        for reached in (length, length + self.stroke):
            cosine = (arm * arm + reached * reached - base * base) / (2.0 * arm * reached)
            parts += [most - cosine, most + cosine]
        return joined_rows(parts)

    @property
    def empty(self) -> bool:
        """Whether the ranges alone leave no triangle."""
        return self.closed[0] > self.closed[1] * (1 + 1e-9) or self.base[0] > self.base[1]

    def kept(self, logs: FloatArray) -> FloatArray:
        """The least of the limits of some triangles (M, 3), shape (M,)."""
        least: FloatArray = self.rows(Dual(logs, np.zeros((*logs.shape, 0)))).value.min(axis=1)
        return np.nan_to_num(least, nan=-np.inf)

    def drawn(self, rng: np.random.Generator, count: int, about: FloatArray | None = None) -> FloatArray:
        """Logarithms of base, arm and first length of random triangles within the limits, (at most count, 3).

        About given ones (K, 3) within a factor e^0.2 or so, if there are any.
        """
        found: list[FloatArray] = []
        for _ in range(_BATCHES):
            logs = self._anywhere(rng, _TRIES * count) if about is None else _near(about, rng, _TRIES * count)
            fixed = [k for k, (low, high) in ((0, self.base), (2, self.closed)) if high <= low * (1 + 1e-9)]
            for k in fixed:
                logs[:, k] = np.log((self.base, self.base, self.closed)[k][0])
            found.append(logs[self.kept(logs) >= 0])
            if sum(map(len, found)) >= count:
                break
        return np.concatenate(found)[:count]

    def _anywhere(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Even in the logarithm of the first length; the arm where the triangle closes."""
        least, most = self.closed[0], min(self.closed[1], max(self.closed[0], self.stroke / 2) * _LONG)
        length = np.exp(rng.uniform(np.log(least), np.log(max(least, most)), count))
        near = max(self.base[0], least / _FAR / _FAR)
        far = min(self.base[1], max(near, _FAR * (max(least, most) + self.stroke)))
        base = np.exp(rng.uniform(np.log(near), np.log(max(near, far)), count))
        low = np.maximum(length + self.stroke - base, np.abs(base - length))
        high = base + length
        arm = low + np.maximum(high - low, 0.0) * rng.random(count)
        return np.asarray(np.log(np.maximum(np.column_stack([base, arm, length]), 1e-300)))


def _near(about: FloatArray, rng: np.random.Generator, count: int) -> FloatArray:
    logs: FloatArray = about[rng.integers(len(about), size=count)] + 0.1 * rng.standard_normal((count, 3))
    return logs
