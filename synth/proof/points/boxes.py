"""Boxes that hold exactly one linkage that passes all points."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth.proof.points.equations import PointEquations

_NEWTON = 4  # steps from a linkage to the zero nearby
_INFLATED = (2.0, 8.0)  # times the correction that is left: radii that are tried
_LEAST = 1e-18  # of unknowns: no radius is less
_WIDER = 1 + 1e-9  # bounds, for rounding of sums
_ROUNDING = 64 * np.finfo(float).eps  # of products of matrices


def boxes(passing: PointEquations, unknowns: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Boxes about the zeros near some linkages, in each of which Krawczyk's test proves exactly one.

    Middles (n, K) and half the widths (n, K), NaN where the test proves nothing, as at a double zero;
    `unknowns` (n, K) are those of `PointEquations.rows`. With Y near the inverse of the slopes J at the
    middle c, and D a bound of how they vary in the box, a box of half-widths r holds exactly one zero of F
    where |Y F(c)| + (|1 - Y J| + |Y| D) r < r (Krawczyk, *Computing* 4, 1969).

    A double zero is not claimed: through equal points, any turn of the coupler will do.

    >>> middle, radius = boxes(PointEquations(np.zeros(9, dtype=complex), "four-bar"), np.ones((1, 16)))
    >>> bool(np.isnan(radius).all())
    True
    """
    middle = unknowns.copy()
    with np.errstate(all="ignore"):
        for _ in range(_NEWTON):
            at = passing.rows(middle, np.zeros_like(middle))
            middle = middle - _times(inverses(at.slopes), at.value)
        at = passing.rows(middle, np.zeros_like(middle))
        inverse = inverses(at.slopes)
        rounding = at.rounding + _ROUNDING * np.abs(at.value)
        left = (np.abs(_times(inverse, at.value)) + _times(np.abs(inverse), rounding)) * _WIDER
        radius, proven = np.full_like(middle, np.nan), np.zeros(len(middle), dtype=bool)
        for factor in _INFLATED:
            tried = factor * left + _LEAST * (1 + np.abs(middle))
            held = holds_one(passing, middle, inverse, left, tried) & ~proven
            radius[held] = tried[held]
            proven |= held
    return middle, radius


def holds_one(
    passing: PointEquations, middle: FloatArray, inverse: FloatArray, left: FloatArray, radius: FloatArray
) -> BoolArray:
    """Krawczyk's test: which boxes of half-widths `radius`, (n, K), hold exactly one zero, shape (n,)."""
    at = passing.rows(middle, radius)
    product, size = inverse @ at.slopes, np.abs(inverse) @ np.abs(at.slopes)
    varies = np.abs(np.eye(middle.shape[1]) - product) + _ROUNDING * size + np.abs(inverse) @ at.spread
    return np.asarray((left + _times(varies, radius) * _WIDER < radius).all(axis=1))


def inverses(slopes: FloatArray) -> FloatArray:
    """About the inverses of matrices, shape (n, K, K); zero where they are not finite."""
    sound = np.isfinite(slopes).all(axis=(1, 2))
    inverse = np.zeros_like(slopes)
    inverse[sound] = np.linalg.pinv(slopes[sound])
    return inverse


def _times(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    product: FloatArray = (matrix @ vector[..., None])[..., 0]
    return product
