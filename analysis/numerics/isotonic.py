"""Isotonic regression of many rows at once, without a loop over their numbers."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray


def isotonic_regression(values: FloatArray, weights: FloatArray) -> FloatArray:
    """The nearest rows that do not fall, by weighted squares.

    Adjacent violators are pooled (Best & Chakravarti 1990), all of them in a step: what falls from number to
    number ends in one pool, in whichever order it is pooled.

    Parameters
    ----------
    values : ndarray of float, shape (R, N)
    weights : ndarray of float, shape (R, N)
        Greater than zero.

    Returns
    -------
    ndarray of float, shape (R, N)

    Examples
    --------
    >>> import numpy as np
    >>> isotonic_regression(np.array([[1.0, 4.0, 2.0, 5.0]]), np.array([[1.0, 1.0, 3.0, 1.0]]))
    array([[1. , 2.5, 2.5, 5. ]])
    """
    means: FloatArray = values.ravel()
    mass: FloatArray = weights.ravel()
    size: IntArray = np.ones(means.shape, dtype=np.int64)
    first: BoolArray = np.broadcast_to(np.arange(values.shape[1]) == 0, values.shape).ravel()
    while (falls := (np.diff(means, prepend=-np.inf) < 0) & ~first).any():
        begin = np.flatnonzero(~falls)
        total = np.add.reduceat(mass, begin)
        alone = np.diff(begin, append=len(means)) == 1
        pooled = np.where(alone, means[begin], np.add.reduceat(mass * means, begin) / total)
        means, mass, size, first = pooled, total, np.add.reduceat(size, begin), first[begin]
    return np.repeat(means, size).reshape(values.shape)
