"""Integrals of curves that may have peaks, kinks and jumps, with what they may be wrong by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

from grashof.problems.values.arrays import FloatArray

Curve = Callable[[FloatArray], FloatArray]

NODES, WEIGHTS = legendre.leggauss(16)  # of a panel from -1 to 1
_SETTLED = 1e-13  # share of the integral of the magnitude: halving a panel changes it by no more
_NARROW = 1e-14  # share of the whole: no panel is narrower
_ROUNDING = 1e-15  # share of the integral of the magnitude
_UNSETTLED = 4.0  # times the last change: what may follow of a panel that is left as it is
_FULL = 1e-9  # relative error up to which all digits of a number count
_MOST = 1 << 18  # values of the curve, beyond which it is left as it is


@dataclass(frozen=True, slots=True, eq=False)
class Panels:
    """Integral of a curve, panel by panel.

    Parameters
    ----------
    edges : ndarray, shape (M + 1,)
        Ends of the panels, in order.
    parts : ndarray, shape (..., M)
        Integral over each of them.
    error : ndarray, shape (...)
        What their sum may be wrong by: the last change that halving the panels made, and rounding.
    """

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


def integrate(curve: Curve, edges: npt.ArrayLike) -> Panels:
    """Integral of one curve or several, by panels that are halved until the sum stays as it is.

    Parameters
    ----------
    curve : callable
        From places, shape (N,), to values, shape (..., N).
    edges : array_like, shape (M + 1,)
        Where it is integrated from and to, and ends of panels between, in order.

    Returns
    -------
    Panels
        Not finite where the curve is not.

    Notes
    -----
    Gauss-Legendre sums of 16 nodes over each panel and over its halves. Panels about a kink or jump are
    halved down to rounding; a curve that is smooth in panels a few times as wide as its narrowest
    peak takes few.

    Examples
    --------
    >>> found = integrate(lambda x: np.abs(x - 0.3), [0, 1])
    >>> float(found.total.round(12)), bool(found.error < 1e-12)
    (0.29, True)
    """
    edges = np.asarray(edges, dtype=np.float64)
    low, high = edges[:-1], edges[1:]
    narrowest = _NARROW * np.abs(edges[-1] - edges[0])
    whole, _ = _sums(curve, low, high)
    settled, error, spent = np.zeros(whole.shape[:-1]), np.zeros(whole.shape[:-1]), 0
    done: list[tuple[FloatArray, FloatArray]] = []
    while low.size:
        ends = np.stack([low, (low + high) / 2, high], axis=1)
        first, last = ends[:, :2].ravel(), ends[:, 1:].ravel()
        halves, sizes = _sums(curve, first, last)
        spent += first.size * len(NODES)
        change, size = np.abs(_paired(halves) - whole), _paired(sizes)
        scale = (settled + size.sum(axis=-1))[..., None]
        rough = (change > _SETTLED * scale).reshape(-1, low.size).any(axis=0)
        kept = ~rough | (np.abs(high - low) <= narrowest) | (spent > _MOST)
        error = error + (np.where(rough, _UNSETTLED, 1.0) * change)[..., kept].sum(axis=-1)
        settled = settled + size[..., kept].sum(axis=-1)
        both = np.repeat(kept, 2)
        done.append((first[both], halves[..., both]))
        low, high, whole = first[~both], last[~both], halves[..., ~both]
    begins = np.concatenate([each for each, _ in done])
    order = np.argsort(begins if edges[-1] >= edges[0] else -begins, kind="stable")
    parts = np.concatenate([each for _, each in done], axis=-1)[..., order]
    return Panels(np.append(begins[order], edges[-1]), parts, np.asarray(error + _ROUNDING * settled))


def held(value: float, error: float) -> float:
    """A number without the digits that an error may change: 0 where none is left.

    Examples
    --------
    >>> held(1234.5678, 0.03), held(1234.5678, 1e-9), held(1e-9, 1e-6), held(1.0, float("nan"))
    (1234.6, 1234.5678, 0.0, nan)
    """
    if not np.isfinite(error):
        return float("nan")
    if error <= _FULL * abs(value):
        return value
    if error >= abs(value):
        return 0.0
    return float(round(value, -int(np.ceil(np.log10(2 * error)))))


def gauss_legendre(edges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places and weights of Gauss-Legendre sums over panels with these ends, each of shape (N,)."""
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half + half * NODES).ravel(), (half * WEIGHTS).ravel()


def _sums(curve: Curve, low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gauss-Legendre sums of a curve and of its magnitude over panels, shape (..., panels)."""
    half = (high - low)[:, None] / 2
    values = np.asarray(curve(((low + high)[:, None] / 2 + half * NODES).ravel()), dtype=np.float64)
    values = values.reshape(*values.shape[:-1], *half.shape[:1], len(NODES))
    return values @ WEIGHTS * half[:, 0], np.abs(values) @ WEIGHTS * np.abs(half[:, 0])


def _paired(halves: FloatArray) -> FloatArray:
    return np.asarray(halves[..., ::2] + halves[..., 1::2])
