"""A curve as a polygon that looks like it: samples where it runs fast or bends, not at even steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, turned_from

_CHORD = 0.01  # share of the curve's extent: no chord is longer
_TURN = np.radians(4)  # nor turns more against the next
_SEEN = 0.002  # share of the extent: between shorter chords no turn is seen, as at a cusp
_MOST = 2000
_ROUNDS = 24


def smooth_polygon(
    curve: Callable[[FloatArray], FloatArray], places: npt.ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Places (M,) and points (M, 2) of a curve, so close together that lines between look like it.

    Places, in order, are halved while a chord exceeds a hundredth of the extent or turns by more than 4 deg,
    up to about 2000 in all; points are NaN where there are none.
    """
    places = np.asarray(places, dtype=np.float64)
    points = curve(places)
    for _ in range(_ROUNDS):
        cut = np.flatnonzero(_coarse(points))[: max(_MOST - len(places), 0)]
        if not cut.size:
            break
        between = (places[cut] + places[cut + 1]) / 2
        places = np.insert(places, cut + 1, between)
        points = np.insert(points, cut + 1, curve(between), axis=0)
    return places, points


def _coarse(points: FloatArray) -> npt.NDArray[np.bool_]:
    """Chords to be halved, shape (N - 1,); those at a gap are not."""
    known = points[np.isfinite(points).all(axis=1)]
    if len(known) < 2:
        return np.zeros(max(len(points) - 1, 0), dtype=bool)
    extent = np.ptp(known, axis=0).max()
    chords = np.diff(points, axis=0)
    lengths = np.hypot(*chords.T)
    coarse: npt.NDArray[np.bool_] = lengths > _CHORD * extent
    ways = np.arctan2(chords[:, 1], chords[:, 0])
    turns = np.abs(turned_from(ways[1:], ways[:-1]))
    longer = np.maximum(lengths[1:], lengths[:-1])
    bent = (turns > _TURN) & (longer > _SEEN * extent)
    coarse[1:] |= bent & (lengths[1:] > longer / 2)
    coarse[:-1] |= bent & (lengths[:-1] > longer / 2)
    return coarse
