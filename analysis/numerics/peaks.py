"""Greatest values of several curves at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from grashof.problems.values.arrays import FloatArray

_PEAKS = 3
_POINTS = 17
_ROUNDS = 4  # each narrows the place of a peak eight times; a parabola does the rest

Curves = Callable[[FloatArray], FloatArray]


def peaks(curves: Curves, stretches: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Greatest value of each of several curves, and where it is.

    Parameters
    ----------
    curves : callable
        From places, shape (N,), to values, shape (R, N). NaN counts as infinite.
    stretches : sequence of ndarray, shape (N,)
        Ascending places at which the curves are sampled, for each interval between whose ends they are
        searched. A peak must not be narrower than the samples are apart.

    Returns
    -------
    values, places : ndarray, shape (R,)
        Infinite values where the first sample is.

    Notes
    -----
    Ever closer samples about the highest, then the top of a parabola through three of them: right to
    rounding where the curve is smooth.

    Examples
    --------
    >>> values, places = peaks(lambda x: np.stack([np.sin(x), x]), [np.linspace(0.0, 3.0, 50)])
    >>> values.round(12).tolist(), places.round(9).tolist()
    ([1.0, 3.0], [1.570796327, 3.0])
    """
    found = [_peaks(curves, at) for at in stretches]
    values, places = (np.stack(each) for each in zip(*found, strict=True))
    best = values.argmax(axis=0)[None]
    return np.take_along_axis(values, best, axis=0)[0], np.take_along_axis(places, best, axis=0)[0]


def vertex(
    place: FloatArray, step: FloatArray, before: FloatArray, middle: FloatArray, after: FloatArray
) -> FloatArray:
    """Where the parabola through three values at equal steps is highest; the middle where none is.

    Examples
    --------
    >>> float(vertex(*map(np.float64, (2.0, 1.0, 0.0, 4.0, 4.0))))
    2.5
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = before - 2 * middle + after
        away = (before - after) / (2 * bend)
    inside = (bend < 0) & (before <= middle) & (after <= middle)
    return np.where(inside, place + step * np.where(inside, away, 0.0), place)


def _peaks(curves: Curves, samples: FloatArray) -> tuple[FloatArray, FloatArray]:
    values = _infinite_if_none(curves(samples))
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=-np.inf)
    summit = np.where((values >= padded[:, :-2]) & (values >= padded[:, 2:]), values, -np.inf)
    top = np.argsort(-summit, axis=1, kind="stable")[:, :_PEAKS]
    low, high = samples[np.maximum(top - 1, 0)], samples[np.minimum(top + 1, len(samples) - 1)]
    places, heights = [samples[top]], [np.take_along_axis(values, top, axis=1)]
    for _ in range(_ROUNDS):
        near = low[..., None] + (high - low)[..., None] * np.linspace(0, 1, _POINTS)
        near[..., -1] = high  # and not beyond it by rounding
        own = _own(curves, near)
        peak = own.argmax(axis=2)[..., None]
        places.append(np.take_along_axis(near, peak, axis=2)[..., 0])
        heights.append(np.take_along_axis(own, peak, axis=2)[..., 0])
        low = np.take_along_axis(near, np.maximum(peak - 1, 0), axis=2)[..., 0]
        high = np.take_along_axis(near, np.minimum(peak + 1, _POINTS - 1), axis=2)[..., 0]
    beside = [np.take_along_axis(own, np.clip(peak + k, 0, _POINTS - 1), axis=2) for k in (-1, 0, 1)]
    parabola = vertex(places[-1][..., None], near[..., 1:2] - near[..., :1], *beside)
    top_place = np.clip(parabola, near[..., :1], near[..., -1:])
    places.append(top_place[..., 0])
    heights.append(_own(curves, top_place)[..., 0])
    every, where = np.concatenate(heights, axis=1), np.concatenate(places, axis=1)
    best = every.argmax(axis=1)[:, None]
    return np.take_along_axis(every, best, axis=1)[:, 0], np.take_along_axis(where, best, axis=1)[:, 0]


def _own(curves: Curves, places: FloatArray) -> FloatArray:
    """Values of each curve at its own places, shape (R, ...)."""
    values = _infinite_if_none(curves(places.ravel())).reshape(len(places), *places.shape)
    row = np.arange(len(places))
    return values[row, row]


def _infinite_if_none(values: FloatArray) -> FloatArray:
    return np.where(np.isnan(values), np.inf, values)
