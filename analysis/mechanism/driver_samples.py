"""Driver angles at which whatever varies over a motion is sampled."""

from __future__ import annotations

import numpy as np

from grashof.analysis.mechanism.second_loop import cut, recurring
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray

_SAMPLES = 481
_NEAR = np.logspace(-8, -2, 31)  # rad, about the positions that come closest to a dead one


def driver_samples(linkage: Linkage, start: float, end: float) -> FloatArray:
    """Driver angles between two ends, close where a dead position may be near.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    start, end : float, rad
        In either order; both are among the samples.

    Returns
    -------
    ndarray, shape (N,), rad
        Ascending. With O2A along the ground line the diagonal A-O4 is shortest or longest, so that the
        linkage comes closest to a dead position there; elsewhere it does at the ends of its motion. A second
        loop does where the width of its gap has an extreme.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> samples = driver_samples(FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3), 0.5, 6.0)
    >>> float(samples[0]), float(samples[-1]), bool((samples == np.pi).any())
    (0.5, 6.0, True)
    """
    return close_samples(linkage, start, end, _SAMPLES, second=True)


def close_samples(linkage: Linkage, start: float, end: float, count: int, *, second: bool) -> FloatArray:
    """Such driver angles, `count` and those near; with `second` those about a second loop, too."""
    low, high = min(start, end), max(start, end)
    spread = closer_at_ends(low, high, count)
    spread[[0, -1]] = low, high
    aligned = ground_line(linkage, low, high)
    if second and len(linkage.mechanism.dyads) > 1:
        aligned = np.concatenate([aligned, recurring(cut(linkage).extremes, low, high)])
    near = (aligned[:, None] + np.concatenate([-_NEAR, [0.0], _NEAR])).ravel()
    return np.unique(np.concatenate([spread, near[(near > low) & (near < high)]]))


def ground_line(linkage: Linkage, low: float, high: float) -> FloatArray:
    """Driver angles between two ends at which O2A lies along the ground line, shape (N,), rad."""
    theta1 = float(linkage.theta1)
    halves = np.arange(np.ceil((low - theta1) / np.pi), np.floor((high - theta1) / np.pi) + 1)
    return np.asarray(theta1 + np.pi * halves)


def closer_at_ends(low: float, high: float, count: int) -> FloatArray:
    """Places from end to end, shape (count,), closer together towards both."""
    share: FloatArray = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    return low + (high - low) * share
