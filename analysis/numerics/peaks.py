"""Greatest values of several curves at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from grashof.problems.values.arrays import FloatArray

_MOST = 3
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

    def each_its_own(places: FloatArray) -> FloatArray:
        values = curves(places.ravel())
        return own(_infinite_if_none(values).reshape(len(values), *places.shape))

    found = [greatest(each_its_own, at) for at in stretches]
    values, places = (np.stack(each) for each in zip(*found, strict=True))
    best = values.argmax(axis=0)[None]
    return np.take_along_axis(values, best, axis=0)[0], np.take_along_axis(places, best, axis=0)[0]


def greatest(
    curves: Curves, places: FloatArray, most: int = _MOST, rounds: int = _ROUNDS
) -> tuple[FloatArray, FloatArray]:
    """Greatest value of each of many curves between two ends, each sampled where it is high by itself.

    Parameters
    ----------
    curves : callable
        From places to values of the R curves, shape (R, N): from places that are the same for all, shape
        (1, N), or each curve's own, shape (R, N). See `own`.
    places : ndarray, shape (N,)
        Ascending: dense samples from end to end.
    most : int
        So many of the highest samples that no neighbour exceeds are looked at more closely,
    rounds : int
        so many times, each an eighth as far about them. Four are enough for smooth curves.

    Returns
    -------
    values, places : ndarray, shape (R,)

    Examples
    --------
    >>> def curves(x):
    ...     return np.stack([np.sin(x[0]), 5 - (x[-1] - 2.0) ** 2])
    >>> values, places = greatest(curves, np.linspace(0, 3, 30))
    >>> values.round(12).tolist(), places.round(6).tolist()
    ([1.0, 5.0], [1.570796, 2.0])
    """
    values = curves(places[None])
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=-np.inf)
    summit = np.where((values >= padded[:, :-2]) & (values >= padded[:, 2:]), values, -np.inf)
    top = np.argsort(-summit, axis=1, kind="stable")[:, :most]
    low, high = places[np.maximum(top - 1, 0)], places[np.minimum(top + 1, len(places) - 1)]
    at, heights = [places[top]], [np.take_along_axis(values, top, axis=1)]
    for _ in range(rounds):
        near = low[..., None] + (high - low)[..., None] * np.linspace(0, 1, _POINTS)
        near[..., -1] = high  # and not beyond it by rounding
        here = curves(near.reshape(len(near), -1)).reshape(near.shape)
        peak = here.argmax(axis=2)[..., None]
        at.append(np.take_along_axis(near, peak, axis=2)[..., 0])
        heights.append(np.take_along_axis(here, peak, axis=2)[..., 0])
        low = np.take_along_axis(near, np.maximum(peak - 1, 0), axis=2)[..., 0]
        high = np.take_along_axis(near, np.minimum(peak + 1, _POINTS - 1), axis=2)[..., 0]
    beside = [np.take_along_axis(here, np.clip(peak + k, 0, _POINTS - 1), axis=2)[..., 0] for k in (-1, 0, 1)]
    at.append(np.clip(vertex(at[-1], near[..., 1] - near[..., 0], *beside), near[..., 0], near[..., -1]))
    heights.append(curves(at[-1]))
    every, where = np.concatenate(heights, axis=1), np.concatenate(at, axis=1)
    best = every.argmax(axis=1)[:, None]
    return np.take_along_axis(every, best, axis=1)[:, 0], np.take_along_axis(where, best, axis=1)[:, 0]


def own(values: FloatArray) -> FloatArray:
    """Values of R curves at their own places, from those at the places of all, shape (R, R or 1, ...)."""
    row = np.arange(len(values))
    return np.asarray(values[row, row % values.shape[1]])


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


def _infinite_if_none(values: FloatArray) -> FloatArray:
    return np.where(np.isnan(values), np.inf, values)
