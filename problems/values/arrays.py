"""Array types, and the full turn."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
BoolArray: TypeAlias = npt.NDArray[np.bool_]
ComplexArray: TypeAlias = npt.NDArray[np.complex128]
Limits: TypeAlias = tuple[float, float]

TURN = 2 * np.pi  # rad


def turned_from(angle: npt.ArrayLike, other: npt.ArrayLike, period: float = TURN) -> FloatArray:
    """From another angle to an angle, within half a period either way, rad."""
    apart = np.subtract(angle, other, dtype=np.float64) + period / 2
    return np.asarray(apart % period - period / 2)


def turned_beyond(angle: npt.ArrayLike, limits: tuple[float, float], period: float = TURN) -> FloatArray:
    """By how much angles lie beyond a range of angles, after it (positive) or before it, rad; 0 within."""
    middle, half = (limits[0] + limits[1]) / 2, (limits[1] - limits[0]) / 2
    apart = turned_from(angle, middle, period)
    return np.asarray(apart - np.clip(apart, -half, half))


def frozen_array(values: npt.ArrayLike) -> FloatArray:
    """Read-only float64 copy of `values` (a NumPy scalar where they have no shape)."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array[()] if array.ndim == 0 else array
