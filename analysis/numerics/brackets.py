"""Closer and closer brackets of least values of functions that need not be smooth."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray, IntArray

_CROWD = 6.0 ** -np.arange(1, 6)  # distances from an expected bottom, shares of the bracket
_NEAR = 0.2  # share of the bracket
_APART = 1e-6  # the same: places that are closer are one, since rounding could decide between them
_AWAY = np.concatenate([-_CROWD, [0.0], _CROWD])


def closer(places: FloatArray, values: FloatArray) -> FloatArray:
    """Ascending places about the lowest of P ascending ones, (V, P), between its neighbours; (V, 36).

    They crowd about the bottoms that five values let expect: a kink on either side of the lowest place, or
    the vertex of a parabola. Where one of the neighbours is not finite, or too far away for such a bottom to
    have been found, they are even.

    >>> x = np.linspace(0, 1, 17)[None]
    >>> for _ in range(5):
    ...     x = closer(x, np.abs(x - 0.4) + x**3)
    >>> bool(np.ptp(x) < 1e-9), bool(x.min() <= 0.4 <= x.max())
    (True, True)
    """
    near = five(places, values.argmin(axis=1)[:, None])
    x, y = (np.take_along_axis(each, near, axis=1) for each in (places, values))
    low, here, high = x[:, 1], x[:, 2], x[:, 3]
    expected = bottoms(x, y)
    expected = np.where(np.isfinite(expected), expected, here[:, None])
    span = (high - low)[:, None]
    crowded = (expected[:, :, None] + span[:, :, None] * _AWAY).reshape(len(places), 3 * _AWAY.size)
    even = low[:, None] + span * np.linspace(0, 1, crowded.shape[1])
    smooth = np.isfinite(y[:, 1]) & np.isfinite(y[:, 3])
    smooth &= high - low <= _NEAR * (places[:, -1] - places[:, 0])
    tried = np.clip(np.where(smooth[:, None], crowded, even), low[:, None], high[:, None])
    found: FloatArray = np.sort(np.concatenate([x[:, 1:4], tried], axis=1), axis=1)
    return found


def five(places: FloatArray, middle: IntArray) -> IntArray:
    """Indices (..., 5) of two lower places, a middle one (..., 1), and two higher ones; at ends, of the end.

    Places (..., P) ascend; those that hardly differ count once.
    """
    found, gap = [middle], (places[..., -1:] - places[..., :1]) * _APART
    for _ in range(2):
        least, most = (np.take_along_axis(places, each, axis=-1) for each in (found[0], found[-1]))
        below, above = (
            each.sum(axis=-1, keepdims=True) for each in (places < least - gap, places <= most + gap)
        )
        found = [np.maximum(below - 1, 0), *found, np.minimum(above, places.shape[-1] - 1)]
    return np.concatenate(found, axis=-1)


def bottoms(x: FloatArray, y: FloatArray) -> FloatArray:
    """Places (..., 3) at which five places and values (..., 5), of lowest middle, let a bottom be expected.

    At a kink below it, at a kink above it, or at the vertex of a parabola; NaN where that is not between its
    neighbours.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.diff(y, axis=-1) / np.diff(x, axis=-1)
        (low, here, high), (one, two, three, four) = (
            np.moveaxis(each, -1, 0) for each in (x[..., 1:4], slopes)
        )
        rise = np.moveaxis(np.diff(y[..., 1:4], axis=-1), -1, 0)
        found = np.stack([
            low + (rise[0] - three * (here - low)) / (one - three),
            here + (rise[1] - four * (high - here)) / (two - four),
            (low + here) / 2 - two * (high - low) / (2 * (three - two)),
        ], axis=-1)  # fmt: skip
    inside = (found >= low[..., None]) & (found <= high[..., None])
    return np.where(inside, found, np.nan)
