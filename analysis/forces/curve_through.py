"""The curve through the rows of a table: it rises and falls as they do, and nowhere else."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy

from grashof.problems.values.arrays import FloatArray


def curve_through(
    rows: Sequence[Sequence[float]], *, period: float | None = None
) -> Callable[[FloatArray], FloatArray]:
    """The monotone cubic curve through (place, value, value, ...).

    Parameters
    ----------
    rows : sequence, shape (N, 1 + K)
        Places rising; of a period, from one end of it to the other, with equal values there.
    period : float, optional
        In the unit of the places.

    Returns
    -------
    callable
        From places of shape (...) to values of shape (..., K); NaN outside the rows without a period.

    Notes
    -----
    Fritsch & Carlson 1980, *Monotone piecewise cubic interpolation*: continuous with its slope, and
    without the overshoot of a spline at the corners of a measured load.

    Examples
    --------
    >>> load = curve_through([(0, 9.0), (90, 20.0), (180, 20.0), (360, 9.0)], period=360)
    >>> load(np.array([45.0, 135.0, 495.0])).ravel().round(3).tolist()
    [14.5, 20.0, 20.0]
    """
    table = np.array(rows, dtype=np.float64)
    places, values = table[:, 0], table[:, 1:]
    if period is None:
        return scipy.interpolate.PchipInterpolator(places, values, extrapolate=False)
    beside = min(2, len(places) - 1)  # its slopes look at the neighbours
    places = np.concatenate([places[-1 - beside : -1] - period, places, places[1 : 1 + beside] + period])
    values = np.concatenate([values[-1 - beside : -1], values, values[1 : 1 + beside]])
    curve, first = scipy.interpolate.PchipInterpolator(places, values), float(table[0, 0])
    return lambda place: np.asarray(curve(first + (place - first) % period))
