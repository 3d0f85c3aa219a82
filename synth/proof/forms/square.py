"""Propagation: whether conditions leave anything of the square, or cube, of parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth.proof.forms.forms import ROUNDING, Form

SWEEPS = 2
_WIDER = 1e-9  # of a side: the remaining part is widened by this for rounding
_Side = tuple[FloatArray, FloatArray]


def nothing_left(forms: Sequence[Form]) -> BoolArray:
    """Where no point with all symbols ``|s_k| <= 1`` lets all forms be zero or greater, shape (n,)."""
    count, symbols = len(forms[0].centre), range(len(forms[0].slopes))
    sides: list[_Side] = [(np.full(count, -1.0), np.full(count, 1.0)) for _ in symbols]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(SWEEPS):
            for form in forms:
                most = form.centre + form.rest + ROUNDING * (np.abs(form.centre) + form.slope + form.rest)
                for k in symbols:
                    others = (_greatest(form.slopes[j], sides[j]) for j in symbols if j != k)
                    sides[k] = _tightened(sides[k], form.slopes[k], sum(others, most))
    nothing: BoolArray = np.logical_or.reduce([low > high for low, high in sides])
    return nothing


def _greatest(slope: FloatArray, side: _Side) -> FloatArray:
    greatest: FloatArray = np.maximum(slope * side[0], slope * side[1])
    return greatest


def _tightened(side: _Side, slope: FloatArray, most: FloatArray) -> _Side:
    """The part of a side where slope x + most can be zero or greater."""
    low, high = side
    root = -most / slope
    level = (slope == 0) & (most < 0)
    root = np.where(np.isnan(root), -np.inf, root)
    low = np.where(level, np.inf, np.where(slope > 0, np.maximum(low, root - _WIDER), low))
    high = np.where(slope < 0, np.minimum(high, root + _WIDER), high)
    return low, high
