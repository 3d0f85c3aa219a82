"""Propagation: whether conditions leave anything of the square of two parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth.proof.forms.forms import ROUNDING, Form

SWEEPS = 2
_WIDER = 1e-9  # of a side: what is left is widened by this for rounding


def nothing_left(forms: Sequence[Form]) -> BoolArray:
    """Where no point of the square ``|s|, |t| <= 1`` lets all forms be zero or greater, shape (n,)."""
    count = len(forms[0].centre)
    s, t = ((np.full(count, -1.0), np.full(count, 1.0)) for _ in range(2))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(SWEEPS):
            for form in forms:
                most = form.centre + form.rest + ROUNDING * (np.abs(form.centre) + form.slope + form.rest)
                s = _tightened(s, form.s, most + np.maximum(form.t * t[0], form.t * t[1]))
                t = _tightened(t, form.t, most + np.maximum(form.s * s[0], form.s * s[1]))
    nothing: BoolArray = (s[0] > s[1]) | (t[0] > t[1])
    return nothing


def _tightened(
    side: tuple[FloatArray, FloatArray], slope: FloatArray, most: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The part of a side where slope x + most can be zero or greater."""
    low, high = side
    root = -most / slope
    level = (slope == 0) & (most < 0)
    root = np.where(np.isnan(root), -np.inf, root)
    low = np.where(level, np.inf, np.where(slope > 0, np.maximum(low, root - _WIDER), low))
    high = np.where(slope < 0, np.minimum(high, root + _WIDER), high)
    return low, high
