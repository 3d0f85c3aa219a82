"""The curve through the rows of a table: it rises and falls as they do, and nowhere else."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy

from grashof.problems.values.arrays import FloatArray


def curve_through(
    rows: Sequence[Sequence[float]], *, period: float | None = None
) -> Callable[[FloatArray], FloatArray]:
    """The monotone cubic (Fritsch & Carlson 1980) through rows (N, 1 + K) of a rising place and K values.

    A function from places (...) to values (..., K), NaN outside the rows; or of a period, in the unit of the
    places, from one end of which the rows go to the other, with equal values there. It has no overshoot of a
    spline at the corners of a measured load.
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
