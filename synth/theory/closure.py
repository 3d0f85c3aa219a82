"""The loop O2-A-B-O4 closed from the diagonal A-O4, on numbers."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray


def coupler_of(
    diagonal: ComplexArray, r3: FloatArray, r4: FloatArray, assembly: FloatArray
) -> tuple[ComplexArray, FloatArray]:
    """From A to B, and by how much the loop closes.

    Parameters
    ----------
    diagonal : ndarray of complex, shape (...)
        From A to O4.
    r3, r4, assembly : ndarray, shape (...)

    Returns
    -------
    coupler : ndarray of complex, shape (...)
        Finite also where the loop is open, and then of no meaning.
    beside2 : ndarray, shape (...)
        Square of the distance of B from the diagonal; not above 0 where the loop is open.
    """
    length = np.abs(diagonal)
    along = (length**2 + (r3**2 - r4**2)) / (2 * length)
    beside2 = r3**2 - along**2
    beside = assembly * np.sqrt(np.where(beside2 > 0, beside2, 1.0))
    return (along + 1j * beside) * diagonal / length, beside2
