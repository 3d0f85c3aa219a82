"""The room a linkage needs: the box around its pivots and all that its points reach."""

from __future__ import annotations

import numpy as np

from grashof.analysis.four_bar.position import places, solve_position
from grashof.problems import FourBar
from grashof.problems.values.arrays import FloatArray

_SAMPLES = 721


def reach_box(linkage: FourBar, start: float, end: float) -> FloatArray:
    """Box around O2, O4 and all that A, B and P reach between two driver angles.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    start, end : float, rad

    Returns
    -------
    ndarray, shape (2, 2), length
        Lower left and upper right corner.

    Notes
    -----
    The motion is sampled, closer towards its ends, where near a dead position the linkage runs away
    from the driver; a parabola through the samples about each extreme refines it.

    Examples
    --------
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> reach_box(crank_rocker, 0.0, 2 * np.pi).round(6).tolist()
    [[-1.0, -1.0], [4.0, 3.0]]
    """
    towards_end = (1 - np.cos(np.linspace(0, np.pi, _SAMPLES))) / 2
    where = places(linkage, solve_position(linkage, start + (end - start) * towards_end))
    track = np.concatenate(list(where.values()), axis=-1)
    track = track[np.isfinite(track).all(axis=-1)]
    corners = [getattr(linkage, pivot) for pivot in linkage.GROUND]
    if len(track):
        corners += [*-_peaks(-track).reshape(-1, 2), *_peaks(track).reshape(-1, 2)]
    return np.array([np.min(corners, axis=0), np.max(corners, axis=0)])


def _peaks(curves: FloatArray) -> FloatArray:
    """Maximum of each column, through the parabola about its largest sample."""
    column = np.arange(curves.shape[1])
    top = np.argmax(curves, axis=0)
    largest: FloatArray = curves[top, column]
    if len(curves) < 3:
        return largest
    inner = np.clip(top, 1, len(curves) - 2)
    before, middle, after = (curves[inner + shift, column] for shift in (-1, 0, 1))
    bend = before - 2 * middle + after
    with np.errstate(divide="ignore", invalid="ignore"):
        vertex = middle - (after - before) ** 2 / (8 * bend)
    inside = (bend < 0) & (inner == top) & (np.abs(after - before) <= -2 * bend)
    return np.where(inside, vertex, largest)


def diagonal(box: FloatArray) -> float:
    """Diagonal of a box of two corners, shape (2, 2)."""
    return float(np.hypot(*(box[1] - box[0])))
