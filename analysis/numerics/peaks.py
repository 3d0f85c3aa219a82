"""Greatest values of several curves at once, extremes of one, and the end of a condition."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np

from grashof.analysis.numerics.brackets import bottoms, five
from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray

_MOST = 3
_STEP = 1 / 16  # share of a bracket
_SLOW = 1 / 4  # a bracket that shrinks less has no such peak: even places follow
_EVEN = np.arange(1, 6) / 6
_FLAT = 1 / 4096  # share of the spacing: of places that tell where a smooth peak is
_LEVEL, _ROUNDING = 1e-3, 1e-12  # shares of the fall over that, and of a peak, by which a vertex may be lower
ROUNDS, SMOOTH = 8, 3  # of curves that may have kinks and jumps, and of those without
_CLOSER = 3  # rounds for each extreme of one curve
_HALVINGS = 64

Curve: TypeAlias = Callable[[FloatArray], FloatArray]  # one curve, or the rows of several


def peaks(
    curves: Curve, stretches: Sequence[FloatArray], rounds: int = ROUNDS
) -> tuple[FloatArray, FloatArray]:
    """Greatest value and its place, (R, ...), of R curves over stretches of ascending samples (..., N).

    Peaks narrower than the spacing of the samples may be missed; shorter rows repeat their last sample. NaN
    counts as infinite, and a curve whose first sample is infinite has no other peak. Rounds as of `greatest`.
    """

    def each_its_own(places: FloatArray) -> FloatArray:
        beside = np.moveaxis(places, 0, -2)
        values = curves(beside.reshape(*beside.shape[:-2], -1))
        values = np.where(np.isnan(values), np.inf, values)
        return own(np.moveaxis(values.reshape(len(values), *beside.shape), -2, 1))

    found = [greatest(each_its_own, at, rounds=rounds) for at in stretches]
    values, places = (np.stack(each) for each in zip(*found, strict=True))
    best = values.argmax(axis=0)[None]
    return np.take_along_axis(values, best, axis=0)[0], np.take_along_axis(places, best, axis=0)[0]


def greatest(
    curves: Curve, places: FloatArray, most: int = _MOST, rounds: int = ROUNDS
) -> tuple[FloatArray, FloatArray]:
    """Greatest value and its place, (R, ...), of R curves over ascending dense samples (..., N).

    Repeated samples count once. Curves take (1, ..., N) or each its own (R, ..., N), see `own`. The `most`
    highest samples are refined by `rounds` steps to where samples about each let its peak be expected: three
    suffice for smooth curves, and eight for kinks; one at a jump is found to a thousandth of the spacing.
    """
    values = curves(places[None])
    summit = summits(values)
    summit[..., 1:] &= places[..., 1:] > places[..., :-1]
    top = highest(np.where(summit, values, -np.inf), most)
    near = np.clip(top[..., None] + np.arange(-2, 3), 0, places.shape[-1] - 1)
    every = np.broadcast_to(places, values.shape)
    x, y = (_taken(each, near.reshape(*top.shape[:-1], -1)).reshape(near.shape) for each in (every, values))
    reach, slow = (x[..., 1], x[..., 3]), np.zeros((*top.shape, 1), dtype=bool)
    for _ in range(rounds):
        width = x[..., 3:4] - x[..., 1:2]
        tried = np.where(slow, x[..., 1:2] + width * _EVEN, _about_peaks(x, y))
        heights = curves(tried.reshape(*top.shape[:-1], -1)).reshape(tried.shape)
        x, y = _with(x, y, tried, heights)
        slow = x[..., 3:4] - x[..., 1:2] > width * _SLOW
    at, found = _levelled(curves, x, y, reach)
    best = found.argmax(axis=-1)[..., None]
    return _taken(found, best)[..., 0], _taken(at, best)[..., 0]


def _levelled(
    curves: Curve, x: FloatArray, y: FloatArray, reach: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Places (..., M) of peaks by five samples (..., 5), within reach, and their values.

    Values beside a smooth peak agree to rounding over half of the digits of its place: a parabola through
    places further away has more of them. It counts where its vertex is as high.
    """
    (low, high), vertices = reach, bottoms(x, -y)[..., 2]
    vertices = np.where(np.isfinite(vertices), vertices, x[..., 2])
    step = (high - low) * _FLAT
    near = np.stack([vertices - step, vertices, vertices + step], axis=-1)
    tried = np.clip(near, low[..., None], high[..., None])
    heights = curves(tried.reshape(*vertices.shape[:-1], -1)).reshape(tried.shape)
    before, middle, after = np.moveaxis(heights, -1, 0)
    level = np.where((near == tried).all(axis=-1), vertex(vertices, step, before, middle, after), vertices)
    at, found = np.where(middle > y[..., 2], vertices, x[..., 2]), np.fmax(middle, y[..., 2])
    higher = curves(level)
    with np.errstate(invalid="ignore"):
        fall, lower = found - np.maximum(before, after), found - higher
        smooth = (lower <= _LEVEL * fall) & (lower <= _ROUNDING * np.abs(found))
    return np.where(smooth, level, at), np.fmax(found, higher)


def _with(
    x: FloatArray, y: FloatArray, places: FloatArray, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Five places about the highest of some and others, (..., 5), and their values."""
    x, y = np.concatenate([x, places], axis=-1), np.concatenate([y, values], axis=-1)
    order = np.argsort(x, axis=-1, kind="stable")
    x, y = _taken(x, order), _taken(y, order)
    around = five(x, y.argmax(axis=-1)[..., None])
    return _taken(x, around), _taken(y, around)


def _about_peaks(x: FloatArray, y: FloatArray) -> FloatArray:
    """Places (..., 5) at and beside the peaks that five samples (..., 5) let expect.

    Where none are expected, half way to the neighbours.
    """
    low, here, high = np.moveaxis(x[..., 1:4], -1, 0)
    halves = np.stack([(low + here) / 2, (here + high) / 2, here], axis=-1)
    expected = bottoms(x, -y)
    below, above, vertex = np.moveaxis(np.where(np.isfinite(expected), expected, halves), -1, 0)
    step = (high - low) * _STEP
    tried = np.stack([below, above, vertex - step, vertex, vertex + step], axis=-1)
    return np.asarray(np.clip(tried, low[..., None], high[..., None]))


def with_extremes(curve: Curve, places: FloatArray, *, periodic: bool) -> tuple[FloatArray, FloatArray]:
    """Ascending dense places (N,) of a smooth curve with its extremes (M,) inserted, and the extremes.

    The curve is monotone between. If `periodic` the places cover a period, whose last one is omitted.

    >>> every, extremes = with_extremes(np.sin, np.linspace(0, 6, 20), periodic=False)
    >>> len(every), (extremes / np.pi).round(9).tolist()
    (22, [0.5, 1.5])
    """
    if len(places) < 3:
        return places, np.empty(0)
    heights = curve(places)
    before, after = np.roll(heights, 1), np.roll(heights, -1)
    low, middle, high = np.roll(places, 1), places.copy(), np.roll(places, -1)
    if periodic:  # the last one is the first
        period = places[-1] - places[0]
        before[0], after[-1] = heights[-2], heights[1]
        low[0], high[-1] = places[-2] - period, places[1] + period
    else:  # one may lie beside an end
        before[[0, -1]] = after[[0, -1]] = heights[[0, -1]]
        low[0], high[-1] = places[0], places[-1]
        middle[[0, -1]] = (low[[0, -1]] + high[[0, -1]]) / 2
    top, bottom = (
        np.flatnonzero((sign * heights >= sign * before) & (sign * heights >= sign * after))
        for sign in (1, -1)
    )
    rows, sign = np.concatenate([top, bottom]), np.repeat([1.0, -1.0], [len(top), len(bottom)])
    near = np.stack([low[rows], middle[rows], high[rows]], axis=-1)
    at = greatest(lambda each: sign[:, None] * curve(each), near, most=1, rounds=_CLOSER)[1][0]
    at = at[(at > near[:, 0]) & (at < near[:, 2])]
    if periodic:
        at = np.unique(places[0] + (at - places[0]) % period)
        return np.unique(np.concatenate([places[:-1], at])), at
    at = np.unique(at)
    return np.unique(np.concatenate([places, at])), at


def last_where(
    holds: Callable[[FloatArray], BoolArray], inside: FloatArray, outside: FloatArray
) -> FloatArray:
    """The last places, to rounding, at which a condition holds on the way from inside to outside; shape (N,).

    >>> last_where(lambda x: x * x <= 2, np.array([0.0, -1.0]), np.array([2.0, -3.0])).round(12).tolist()
    [1.414213562373, -1.414213562373]
    """
    for _ in range(_HALVINGS):
        middle = (inside + outside) / 2
        if ((middle == inside) | (middle == outside)).all():
            break
        still = holds(middle)
        inside, outside = np.where(still, middle, inside), np.where(still, outside, middle)
    return inside


def summits(values: FloatArray) -> BoolArray:
    """Whether values (..., N) are at least as high as those beside them."""
    padded = np.pad(values, [(0, 0)] * (values.ndim - 1) + [(1, 1)], constant_values=-np.inf)
    return np.asarray((values >= padded[..., :-2]) & (values >= padded[..., 2:]))


def highest(values: FloatArray, most: int) -> IntArray:
    """Indices of the highest values along the last axis, highest first."""
    values, found = values.copy(), list[IntArray]()
    for _ in range(min(most, values.shape[-1])):
        found.append(values.argmax(axis=-1)[..., None])
        np.put_along_axis(values, found[-1], -np.inf, axis=-1)
    return np.concatenate(found, axis=-1)


def _taken(values: FloatArray, index: IntArray) -> FloatArray:
    """Entries along the last axis."""
    return np.take_along_axis(values, index, axis=-1)


def own(values: FloatArray) -> FloatArray:
    """Values of R curves at their own places, from those at the places of all, shape (R, R or 1, ...)."""
    row = np.arange(len(values))
    return np.asarray(values[row, row % values.shape[1]])


def vertex(
    place: FloatArray, step: FloatArray, before: FloatArray, middle: FloatArray, after: FloatArray
) -> FloatArray:
    """Vertex of the parabola through three values at equal steps; the middle if it is not a maximum.

    >>> float(vertex(*map(np.float64, (2.0, 1.0, 0.0, 4.0, 4.0))))
    2.5
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = before - 2 * middle + after
        away = (before - after) / (2 * bend)
    inside = (bend < 0) & (before <= middle) & (after <= middle)
    return np.where(inside, place + step * np.where(inside, away, 0.0), place)


def crests(
    before: FloatArray, here: FloatArray, after: FloatArray, reach: float | IntArray = 1
) -> FloatArray:
    """The greatest of three values at equal steps, or of the parabola through them.

    The parabola counts where its vertex is at most `reach` half steps from the middle.

    >>> float(crests(*map(np.float64, (0.0, 4.0, 4.0))))
    4.5
    """
    with np.errstate(invalid="ignore"):  # of infinite values
        bend, rise = 2 * here - before - after, after - before
    among = (np.abs(rise) <= reach * bend) & (bend > 0)
    above = np.divide(rise**2, 8 * bend, out=np.zeros_like(bend), where=among)
    found: FloatArray = np.maximum(np.maximum(before, after), here + above)
    return found
