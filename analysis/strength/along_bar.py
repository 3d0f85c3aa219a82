"""Greatest values along a bar, and its deflection."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from grashof.analysis.numerics.peaks import vertex
from grashof.analysis.strength.section_forces import BarForces, polynomial
from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray

_CELLS = 8  # in each span
_NEWTON = 5
_ZOOMS = 3


class Along(NamedTuple):
    """The greatest value along a bar, shape (...), and its distance from the link's origin, length."""

    value: FloatArray
    at: FloatArray


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def greatest(
    bar: BarForces, *polynomials: FloatArray, size: bool = False, spans: BoolArray | None = None
) -> Along:
    """Greatest value or size of some polynomials up to degree 3, coefficients (..., K - 1, N) as in `bar`.

    It lies at an end of a span or where the derivative, a quadratic, is zero. `spans` (..., K - 1) states
    which count; by default all that exist.
    """
    places = [_candidates(bar, terms) for terms in polynomials]
    values = np.concatenate([polynomial(*each) for each in zip(polynomials, places, strict=True)], axis=-1)
    return _best(bar, np.abs(values) if size else values, np.concatenate(places, axis=-1), spans)[0]


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def greatest_of(bar: BarForces, value: Callable[..., FloatArray], *pieces: FloatArray) -> Along:
    """Greatest value of a smooth function of polynomials: samples in each span, then ever closer ones."""

    def of(own: Sequence[FloatArray], places: FloatArray) -> FloatArray:
        return value(*(polynomial(terms, places) for terms in own))

    places = _cells(bar)
    (_, at), span = _best(bar, of(pieces, places), places)
    own = [np.take_along_axis(terms, span[..., None, None], axis=-2)[..., 0, :] for terms in pieces]
    full = np.take_along_axis(bar.spans, span[..., None], axis=-1)
    start = np.take_along_axis(bar.stations, span[..., None], axis=-1)[..., 0]
    inside, step = at - start, full[..., 0] / _CELLS
    for _ in range(_ZOOMS):
        near = np.clip(inside[..., None] + step[..., None] * np.linspace(-1, 1, _CELLS + 1), 0, full)
        heights = of(own, near)
        top = heights.argmax(axis=-1)[..., None]
        inside = np.take_along_axis(near, top, axis=-1)[..., 0]
        step = step * 2 / _CELLS
    beside = [np.take_along_axis(heights, np.clip(top + k, 0, _CELLS), axis=-1) for k in (-1, 0, 1)]
    last = np.clip(vertex(inside[..., None], step[..., None], *beside), 0, full)
    height = of(own, last)
    higher = height > beside[1]
    inside = np.where(higher, last, inside[..., None])[..., 0]
    return Along(np.where(higher, height, beside[1])[..., 0], start + inside)


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def deflection(bar: BarForces, stiffness: float) -> FloatArray:
    """Deflection, to its left, of a bar held in its joints: coefficients (..., K - 1, 6) as those of `bar`.

    w'' = M / (E I), with the stiffness E I in N length^2, integrated twice exactly, and w = 0 in both joints:
    a beam with overhangs (Timoshenko, *Strength of Materials*, part I, ch. V; Shigley, sec. 4-3).
    """
    bent = bar.moment / stiffness
    spans, stations = bar.spans, bar.stations
    slope = height = np.zeros(bar.length.shape)
    pieces, heights = [], [height]
    for span in range(spans.shape[-1]):
        own = bent[..., span, :]
        terms = np.stack([height, slope, *(own[..., k] / ((k + 1) * (k + 2)) for k in range(4))], axis=-1)
        step = spans[..., span, None]
        slope = slope + step[..., 0] * polynomial(own / np.arange(1, 5), step)[..., 0]
        height = polynomial(terms, step)[..., 0]
        pieces.append(terms)
        heights.append(height)
    knots, bow = np.stack(heights, axis=-1), np.stack(pieces, axis=-2)
    origin = np.argmax(stations >= 0, axis=-1)[..., None]
    end = np.argmax(stations >= bar.length[..., None], axis=-1)[..., None]
    first, last = (np.take_along_axis(knots, joint, axis=-1) for joint in (origin, end))
    tilt = (last - first) / bar.length[..., None]
    bow[..., 0] -= first + tilt * stations[..., :-1]
    bow[..., 1] -= tilt
    return bow


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def greatest_deflection(bar: BarForces, bow: FloatArray) -> Along:
    """Greatest size of a deflection, overhangs too, by Newton's method where the slope changes its sign."""
    first = _derivative(bow)
    second, cells = _derivative(first), _cells(bar)
    low, high = cells[..., :-1], cells[..., 1:]
    tilt = polynomial(first, cells)
    at = low + (high - low) * _finite(tilt[..., :-1] / (tilt[..., :-1] - tilt[..., 1:]))
    for _ in range(_NEWTON):
        at = np.clip(at - _finite(polynomial(first, at) / polynomial(second, at)), low, high)
    places = np.concatenate([cells, at], axis=-1)
    return _best(bar, np.abs(polynomial(bow, places)), places)[0]


def _derivative(terms: FloatArray) -> FloatArray:
    slope: FloatArray = terms[..., 1:] * np.arange(1, terms.shape[-1])
    return slope


def _finite(values: FloatArray) -> FloatArray:
    return np.where(np.isfinite(values), values, 0.0)


def _cells(bar: BarForces) -> FloatArray:
    return bar.spans[..., None] * np.linspace(0, 1, _CELLS + 1)


def _candidates(bar: BarForces, terms: FloatArray) -> FloatArray:
    """Ends of the spans, and two places within each where the derivatives are zero, shape (..., K - 1, 4)."""
    slope = [terms[..., k] * k for k in range(1, terms.shape[-1])] + [np.zeros(())] * 2
    constant, linear, square = slope[:3]
    root = np.sqrt(linear**2 - 4 * square * constant)
    sum_of_both = -(linear + np.where(linear < 0, -root, root)) / 2
    roots = np.stack(np.broadcast_arrays(sum_of_both / square, constant / sum_of_both), axis=-1)
    spans = bar.spans[..., None]
    level = np.clip(np.where(np.isnan(roots), 0.0, roots), 0.0, spans)
    return np.concatenate([np.zeros_like(spans), spans, level], axis=-1)


def _best(
    bar: BarForces, values: FloatArray, places: FloatArray, spans: BoolArray | None = None
) -> tuple[Along, IntArray]:
    """Greatest of values (..., K - 1, S) at places in their spans, and in which span it is."""
    counted = np.where((bar.real if spans is None else spans)[..., None], values, -np.inf)
    flat = counted.reshape(*counted.shape[:-2], -1)
    top = flat.argmax(axis=-1)[..., None]
    span = top // counted.shape[-1]
    inside = np.take_along_axis(places.reshape(*places.shape[:-2], -1), top, axis=-1)
    at = np.take_along_axis(bar.stations, span, axis=-1) + inside
    return Along(np.take_along_axis(flat, top, axis=-1)[..., 0], at[..., 0]), span[..., 0]
