"""The closed curve through the points of a path: a periodic cubic spline over the length of their polygon."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from grashof.problems.values.arrays import FloatArray

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

_NODES = 8  # of the quadrature between two points


def closed_spline(points: FloatArray) -> CubicSpline:
    """The spline through points (N, 2), of which the last does not repeat the first; from 0 on."""
    from scipy.interpolate import CubicSpline  # here: few problems need it

    ring = np.concatenate([points, points[:1]])
    steps = np.hypot(*np.diff(ring, axis=0).T)
    return CubicSpline(np.concatenate([[0.0], np.cumsum(steps)]), ring, bc_type="periodic")


def spline_length(points: FloatArray) -> float:
    """The length of that spline.

    Examples
    --------
    >>> turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    >>> round(spline_length(np.stack([np.cos(turn), np.sin(turn)], axis=1)) / (2 * np.pi), 4)
    1.0
    """
    spline = closed_spline(points)
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    half = np.diff(spline.x)[:, None] / 2
    at = spline.x[:-1, None] + half * (1 + nodes)
    return float((half * weights * np.linalg.norm(spline(at, 1), axis=-1)).sum())


def even_places(points: FloatArray, count: int) -> FloatArray:
    """Even places (count, 2) on that spline, from its first point on."""
    spline = closed_spline(points)
    places: FloatArray = spline(np.arange(count) * spline.x[-1] / count)
    return places
