"""The loop O2-A-B-O4 closed from the diagonal A-O4, on numbers."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray


def coupler_of(diagonal: ComplexArray, r3: FloatArray, r4: FloatArray, assembly: FloatArray) -> ComplexArray:
    """From A to B; NaN where the loop is open.

    Parameters
    ----------
    diagonal : ndarray of complex, shape (...)
        From A to O4.
    r3, r4, assembly : ndarray, shape (...)
    """
    length = np.abs(diagonal)
    with np.errstate(invalid="ignore", divide="ignore"):
        along = (length**2 + r3**2 - r4**2) / (2 * length)
        coupler: ComplexArray = (along + 1j * assembly * np.sqrt(r3**2 - along**2)) * diagonal / length
    return coupler
