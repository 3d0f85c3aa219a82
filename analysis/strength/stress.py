"""Stresses in a cross-section from its section forces."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def von_mises(axial: FloatArray, bending: FloatArray, shear: FloatArray) -> FloatArray:
    """Greatest equivalent stress in a section.

    Parameters
    ----------
    axial : ndarray, shape (...)
        Magnitude of normal force / area.
    bending : ndarray, shape (...)
        Magnitude of bending moment * extreme fibre / second moment of area.
    shear : ndarray, shape (...)
        Shear stress at the neutral axis, where it is greatest.

    Returns
    -------
    ndarray, shape (...)

    Notes
    -----
    At a share y of the way from the neutral axis to the extreme fibre the stresses are
    sigma = axial + bending y and tau = shear (1 - y^2), and sigma'^2 = sigma^2 + 3 tau^2 (von Mises;
    Shigley, *Mechanical Engineering Design*, secs. 3-10, 3-11 and 5-5). The parabola is exact for a
    rectangle. The greatest lies at y = 0, at y = 1, or at the middle root of the cubic
    y^3 + p y + q = 0, p = bending^2 / (6 shear^2) - 1, q = axial bending / (6 shear^2).

    Examples
    --------
    >>> von_mises(np.array([3.0, 3.0]), np.array([4.0, 0.0]), np.array([0.0, 2.0])).round(6).tolist()
    [7.0, 4.582576]
    """
    p = bending**2 / (6 * shear**2) - 1
    q = axial * bending / (6 * shear**2)
    third = np.arccos(3 * q / (2 * p) * np.sqrt(-3 / p)) / 3
    inner = 2 * np.sqrt(-p / 3) * np.cos(third - 2 * np.pi / 3)
    inner = np.clip(np.where(np.isfinite(inner), inner, 0.0), 0.0, 1.0)
    squares = [(axial + bending * y) ** 2 + 3 * (shear * (1 - y**2)) ** 2 for y in (0.0, 1.0, inner)]
    found: FloatArray = np.sqrt(np.max(np.broadcast_arrays(*squares), axis=0))
    return found
