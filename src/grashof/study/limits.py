"""How far plots are drawn of what grows without bound."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.study.section import Plot

_PEAK = 12.0  # times the typical size: so far is drawn what grows without bound
_TRACK = 4.0  # the same of tracks, whose typical part would else be small
_SPIKE = 3.0  # times the values two steps beside it: no smooth peak is so sharp
_NOISE = 1e-6  # times what only one value in twenty exceeds: rounding


def greatest_drawn(plot: Plot) -> float:
    """Size up to which a plot draws values, of tracks the distance from `middle`; inf where all are drawn.

    Towards a dead position a rate grows without bound, at a toggle position of the output the mechanical
    advantage, towards parallel links the instant centre goes to infinity. What just has a peak, however high,
    is drawn whole: it is smooth, and the values beside it are nearly as large.
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
    """The point that tracks lie about, shape (2,): the median of theirs."""
    every = np.concatenate([np.reshape(each, (-1, 2)) for each in plot.series.values()] or [np.zeros((0, 2))])
    known = every[np.isfinite(every).all(axis=1)]
    return np.median(known, axis=0) if len(known) else np.zeros(2)


def broken_beyond(values: FloatArray, most: float) -> FloatArray:
    """Values (N,), every second NaN where they jump through infinity beyond `most`: no line joins the two."""
    over = np.where(values > most, 1, np.where(values < -most, -1, 0))
    jumps = np.flatnonzero(over[:-1] * over[1:] < 0)
    broken = values.copy()
    broken[jumps] = np.nan
    return broken


def _distance(track: FloatArray, centre: FloatArray) -> FloatArray:
    distance: FloatArray = np.hypot(*(track - centre).T)
    return distance


def _spiked(sizes: FloatArray, most: float) -> bool:
    """Whether values beyond a size stand alone, much larger than those two steps before and after."""
    if len(sizes) < 3:
        return False
    closed = np.isclose(
        sizes[0], sizes[-1], rtol=1e-6, equal_nan=True
    )  # a turn, which goes on where it began
    ends = np.full((2, 2), np.inf) if not closed else np.array([sizes[-3:-1], sizes[1:3]])
    padded = np.nan_to_num(np.concatenate([ends[0], sizes, ends[1]]), nan=0.0, posinf=np.inf)
    beside = np.maximum(padded[1:-3], padded[3:-1])
    whole = np.where(np.isnan(sizes), 2 * _SPIKE * beside, sizes)  # unknown in the very pole
    far = np.maximum(padded[:-4], padded[4:])
    return bool(((whole > most) & (whole > _SPIKE * far)).any())
