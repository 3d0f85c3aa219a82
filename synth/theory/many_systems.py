"""Least squares of many systems with few unknowns at once."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray


def weighed(rows: FloatArray, right: FloatArray, slope: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Equations over what their residual changes by with the output, so that its errors are made small."""
    with np.errstate(invalid="ignore", divide="ignore"):
        weight = 1.0 / np.maximum(slope, 0.05 * slope.max(axis=1, keepdims=True))
    return rows * weight[..., None], right * weight


def solved(rows: FloatArray, right: FloatArray) -> FloatArray:
    """Least squares of many systems, (M, N, 3) and (M, N) to (M, 3); NaN where they are singular."""
    normal = rows.swapaxes(1, 2) @ rows if rows.shape[1] > 3 else rows
    side = (rows.swapaxes(1, 2) @ right[..., None])[..., 0] if rows.shape[1] > 3 else right
    bad: BoolArray = ~np.isfinite(normal.sum(axis=(1, 2)))
    normal = np.where(bad[:, None, None], np.nan, normal)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        # Cramer's rule: a singular system of many must not spoil the others.
        cross = np.cross(normal[:, 1], normal[:, 2])
        determinant = (normal[:, 0] * cross).sum(axis=-1)
        columns = [cross, np.cross(normal[:, 2], normal[:, 0]), np.cross(normal[:, 0], normal[:, 1])]
        inverse = np.stack(columns, axis=-1) / determinant[:, None, None]
        found: FloatArray = (inverse @ side[..., None])[..., 0]
    return found
