"""Functions of a period known by even samples."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray


def highest(values: FloatArray) -> FloatArray:
    """The greatest of even samples of a period (..., N), by a parabola through the three about it; (...).

    >>> samples = np.cos(np.arange(24) / 24 * 2 * np.pi + 0.1)
    >>> round(float(highest(samples)), 4), round(float(samples.max()), 4)
    (0.9999, 0.995)
    """
    top = values.argmax(axis=-1)[..., None] + np.arange(-1, 2)
    before, at, after = np.moveaxis(np.take_along_axis(values, top % values.shape[-1], axis=-1), -1, 0)
    bend = before - 2 * at + after
    share = np.clip(np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < 0), -0.5, 0.5)
    found: FloatArray = at - 0.25 * (before - after) * share
    return found
