"""Integrals of curves that may have peaks, kinks and jumps, with error bounds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

from grashof.analysis.numerics.peaks import Curve
from grashof.problems.values.arrays import BoolArray, FloatArray

NODES, WEIGHTS = legendre.leggauss(16)  # of a panel from -1 to 1
_TERMS = legendre.legvander(NODES, 15) * (WEIGHTS[:, None] * (np.arange(16) + 0.5))
_TO_ENDS = np.stack([_TERMS @ (-1.0) ** np.arange(16), _TERMS.sum(axis=1)], axis=1)  # values at both ends
_GAP = (1 - NODES[-1]) / 2  # share of a panel beyond its last node
_SPLIT = 0.4636  # not the middle, where both parts may hide a jump
_SETTLED = 1e-13  # change by splitting a panel, as a share of the integral of the magnitude, at which to stop
_LEAST_ERROR = 1.5e-12  # the same: some changes are this small by chance
_DOUBT = 2.0  # error of a panel over its last change
_SHRINKS = 0.95  # greatest ratio of successive changes of a convergent integral
_FULL = 1e-9  # relative error up to which all digits of a number count
_MOST = 1 << 18  # values of the curve at which to stop


@dataclass(frozen=True, slots=True, eq=False)
class Panels:
    """Integrals (..., M) between edges (M + 1,); `error` bounds that of their sum, infinite if divergent."""

    edges: FloatArray
    parts: FloatArray
    error: FloatArray

    @property
    def total(self) -> FloatArray:
        """Integral over all panels, shape (...)."""
        return np.asarray(self.parts.sum(axis=-1))

    def until(self, curve: Curve, places: FloatArray) -> FloatArray:
        """Integral of the curve from the first edge to places between the edges, ascending; (..., K)."""
        index = np.clip(np.searchsorted(self.edges, places, side="right") - 1, 0, len(self.edges) - 2)
        half = (places - self.edges[index]) / 2
        values = curve((self.edges[index, None] + half[:, None] * (1 + NODES)).ravel())
        part = values.reshape(*values.shape[:-1], len(places), len(NODES)) @ WEIGHTS * half
        before = np.cumsum(self.parts, axis=-1) - self.parts
        return np.asarray(before[..., index] + np.where(half > 0, part, 0.0))


def integrate(curve: Curve, edges: npt.ArrayLike, narrowest: float = 1e-14) -> Panels:
    """Integral of curves, (N,) to (..., N), by panels that are split until the sum settles.

    `edges` (M + 1,) are in order; panels below a share `narrowest` are not split; not finite where a curve is
    not. Gauss-Legendre sums of 16 nodes over each panel are compared with those over two parts of it. Panels
    whose polynomials do not meet those of their neighbours are split, too: the sums do not reveal a jump
    beyond the last node.
    """
    edges = np.asarray(edges, dtype=np.float64)
    least, spent = narrowest * float(np.abs(edges[-1] - edges[0])), 0
    low, high, count = edges[:-1], edges[1:], len(edges) - 1
    parts_low, parts_high = _split(low, high)  # with their panels in one call of the curve
    both = _Pieces.over(curve, np.append(low, parts_low), np.append(high, parts_high))
    rough, ahead = both[:count], both[count:]
    done, error = rough[:0], np.zeros(rough.part.shape[:-1])
    before = np.full(rough.part.shape, np.inf)
    while rough.low.size:
        parts = ahead if ahead.low.size else _Pieces.over(curve, *_split(rough.low, rough.high))
        ahead = ahead[:0]
        spent += parts.low.size * len(NODES)
        narrow = rough.width <= least
        change, unsettled = parts.changed(rough, done.size.sum(axis=-1))
        kept = ~unsettled.reshape(-1, narrow.size).any(axis=0) | narrow | (spent > _MOST)
        doubt = np.where(unsettled & narrow, _to_come(change, before), _DOUBT) * change
        error = error + doubt[..., kept].sum(axis=-1)
        done, rough = done.and_those(parts[np.repeat(kept, 2)]), parts[np.repeat(~kept, 2)]
        before = np.repeat(change[..., ~kept], 2, axis=-1)
        if not rough.low.size and spent <= _MOST:
            done = done[np.argsort(done.low if edges[-1] >= edges[0] else -done.low, kind="stable")]
            apart = np.any(done.apart(least).reshape(-1, len(done.low)), axis=0)
            rough, done = done[apart], done[~apart]
            before = np.full(rough.part.shape, np.inf)
    done = done[np.argsort(done.low if edges[-1] >= edges[0] else -done.low, kind="stable")]
    error = error + _LEAST_ERROR * done.size.sum(axis=-1)
    return Panels(np.append(done.low, edges[-1]), done.part, np.asarray(error))


def settled_sums(curves: Curve, edges: FloatArray, narrowest: float = 1e-14) -> tuple[FloatArray, BoolArray]:
    """Integrals of curves over panels of their own, and whether `integrate` splits none of them further.

    Curves take places (n, N), `edges` are (n, M + 1); the result has shape (n,) twice. An integral that is
    not settled is still rough.
    """
    low, high = edges[:, :-1], edges[:, 1:]
    rough, parts = _Pieces.over(curves, low, high), _Pieces.over(curves, *_split(low, high))
    _, unsettled = parts.changed(rough, np.zeros(len(edges)))
    apart = parts.apart(narrowest * np.abs(edges[:, [-1]] - edges[:, [0]]))
    settled = ~np.concatenate([unsettled, apart], axis=-1).any(axis=-1)
    return np.asarray(parts.part.sum(axis=-1)), np.asarray(settled)


def held(value: float, error: float) -> float:
    """A number rounded to the digits that an error leaves certain: 0 if there are none.

    >>> held(-123.456, 0.004), held(123.456, 0.006), held(98765.0, 300.0), held(123.456, 1e-8)
    (-123.46, 123.5, 99000.0, 123.456)
    >>> held(1e-9, 1e-6), held(1.0, float("nan"))
    (0.0, nan)
    >>> held(float("inf"), 1.0), held(float("nan"), 1e308)
    (nan, nan)
    """
    if not (np.isfinite(error) and np.isfinite(value)):
        return float("nan")
    if error <= _FULL * abs(value):
        return value
    if error >= abs(value):
        return 0.0
    return float(round(value, -int(np.ceil(np.log10(2) + np.log10(error)))))


def gauss_legendre(edges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places and weights of Gauss-Legendre sums over panels with these ends (..., M), each (..., N)."""
    half = np.diff(edges)[..., None] / 2
    places, weights = edges[..., :-1, None] + half + half * NODES, half * WEIGHTS
    return places.reshape(*edges.shape[:-1], -1), weights.reshape(*edges.shape[:-1], -1)


@dataclass(frozen=True, slots=True, eq=False)
class _Pieces:
    """Panels (M,), or (n, M) of n curves: integrals (..., M) of the curve and its magnitude, and its ends.

    Those are the values (..., 2, M) of its polynomials at both ends.
    """

    low: FloatArray
    high: FloatArray
    part: FloatArray
    size: FloatArray
    ends: FloatArray

    @classmethod
    def over(cls, curve: Curve, low: FloatArray, high: FloatArray) -> _Pieces:
        half = (high - low) / 2
        places = (low + high)[..., None] / 2 + half[..., None] * NODES
        values = np.asarray(curve(places.reshape(*low.shape[:-1], -1)), dtype=np.float64)
        values = values.reshape(*values.shape[:-1], *places.shape[-2:])
        sizes = np.abs(values) @ WEIGHTS * np.abs(half)
        return cls(low, high, values @ WEIGHTS * half, sizes, (values @ _TO_ENDS).swapaxes(-1, -2))

    @property
    def width(self) -> FloatArray:
        return np.abs(self.high - self.low)

    def __getitem__(self, kept: slice | npt.NDArray[np.bool_] | npt.NDArray[np.int64]) -> _Pieces:
        return _Pieces(*(getattr(self, name)[..., kept] for name in self.__slots__))

    def and_those(self, others: _Pieces) -> _Pieces:
        both = ([getattr(self, name), getattr(others, name)] for name in self.__slots__)
        return _Pieces(*(np.concatenate(each, axis=-1) for each in both))

    def changed(self, rough: _Pieces, others: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Changes of panels (..., M) by their parts, and which matter beside the size of others (...)."""
        change = np.abs(self.part[..., ::2] + self.part[..., 1::2] - rough.part)
        return change, change > _SETTLED * (others + self.size.sum(axis=-1))[..., None]

    def apart(self, narrowest: float | FloatArray) -> BoolArray:
        """Whether a jump that matters may hide at an end of a panel, in order, shape (..., M)."""
        jump = np.abs(self.ends[..., 0, 1:] - self.ends[..., 1, :-1])
        none = np.zeros((*jump.shape[:-1], 1))
        beside = np.maximum(np.concatenate([none, jump], -1), np.concatenate([jump, none], -1))
        hidden = beside * _GAP * self.width > _SETTLED * self.size.sum(axis=-1, keepdims=True)
        return np.asarray(hidden & (self.width > narrowest))


def _split(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ends of both parts of each panel."""
    ends = np.stack([low, low + _SPLIT * (high - low), high], axis=-1)
    shape = *low.shape[:-1], -1
    return ends[..., :2].reshape(shape), ends[..., 1:].reshape(shape)


def _to_come(change: FloatArray, before: FloatArray) -> FloatArray:
    """Bound of the further change of a panel over its last one; infinite without convergence."""
    with np.errstate(invalid="ignore", divide="ignore"):
        share = change / before
        return np.where(share < _SHRINKS, np.maximum(share / (1 - share), _DOUBT), np.inf)
