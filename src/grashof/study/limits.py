"""Limits of plots whose values grow without bound."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.study.section import Plot

_PEAK = 12.0  # times the typical size: limit of values that grow without bound
_TRACK = 4.0  # the same for tracks, whose typical part would otherwise be small
_SPIKE = 3.0  # times the values two steps away: no smooth peak is this sharp
_NOISE = 1e-6  # times the 95 % quantile: smaller values are rounding


def greatest_drawn(plot: Plot) -> float:
    """Size up to which values are drawn, for tracks the distance from `middle`; inf if all are drawn.

    Rates grow without bound towards a dead position, the mechanical advantage towards a toggle position of
    the output, the distance of the instant centre towards parallel links. A mere peak, however high, is drawn
    completely: it is smooth, and the values next to it are nearly as large.
    """
    if plot.bounded or plot.unit == "deg":
        return np.inf  # angles stay finite
    centre = middle(plot) if plot.places is None else None
    sizes = [np.abs(each) if centre is None else _distance(each, centre) for each in plot.series.values()]
    if not sizes:
        return np.inf
    known = np.concatenate([each[np.isfinite(each)] for each in sizes])
    if not known.size:
        return np.inf
    known = known[known > _NOISE * np.quantile(known, 0.95)]
    most = _PEAK * float(np.median(known)) if known.size else 0.0
    if not (most > 0 and known.max() > most and (plot.swings or any(_spiked(each, most) for each in sizes))):
        return np.inf
    return most if centre is None else most * _TRACK / _PEAK


def middle(plot: Plot) -> FloatArray:
    """The median of all points of the tracks, shape (2,)."""
    every = np.concatenate([np.reshape(each, (-1, 2)) for each in plot.series.values()] or [np.zeros((0, 2))])
    known = every[np.isfinite(every).all(axis=1)]
    return np.median(known, axis=0) if len(known) else np.zeros(2)


def broken_beyond(values: FloatArray, most: float) -> FloatArray:
    """Values (N,) with NaN before each jump through infinity beyond `most`, so that no line joins the two."""
    over = np.where(values > most, 1, np.where(values < -most, -1, 0))
    jumps = np.flatnonzero(over[:-1] * over[1:] < 0)
    broken = values.copy()
    broken[jumps] = np.nan
    return broken


def _distance(track: FloatArray, centre: FloatArray) -> FloatArray:
    distance: FloatArray = np.hypot(*(track - centre).T)
    return distance


def _spiked(sizes: FloatArray, most: float) -> bool:
    """Whether a value beyond a size is isolated: much larger than those two steps before and after."""
    if len(sizes) < 3:
        return False
    # A full turn continues where it began.
    closed = np.isclose(sizes[0], sizes[-1], rtol=1e-6, equal_nan=True)
    ends = np.full((2, 2), np.inf) if not closed else np.array([sizes[-3:-1], sizes[1:3]])
    padded = np.nan_to_num(np.concatenate([ends[0], sizes, ends[1]]), nan=0.0, posinf=np.inf)
    beside = np.maximum(padded[1:-3], padded[3:-1])
    filled = np.where(np.isnan(sizes), 2 * _SPIKE * beside, sizes)  # unknown in the pole itself
    far = np.maximum(padded[:-4], padded[4:])
    return bool(((filled > most) & (filled > _SPIKE * far)).any())
