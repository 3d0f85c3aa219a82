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


def frozen_array(values: npt.ArrayLike) -> FloatArray:
    """Read-only float64 copy of `values` (a NumPy scalar where they have no shape)."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array[()] if array.ndim == 0 else array
