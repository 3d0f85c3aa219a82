"""Derivatives by differences, where they are computed only once they are needed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from grashof.problems.values.arrays import FloatArray

STEP = 1e-6


class Differences:
    """Values (n, m) of a function of (n, ..., k) numbers, and their derivatives (n, m, k) by differences."""

    def __init__(self, function: Callable[[FloatArray], FloatArray], numbers: FloatArray) -> None:
        self.function, self.numbers = function, numbers
        self.values = function(numbers[:, None])[:, 0]

    @cached_property
    def slopes(self) -> FloatArray:
        """Of second order."""
        steps = STEP * np.eye(self.numbers.shape[1])
        both = self.function(self.numbers[:, None] + np.concatenate([steps, -steps]))
        up, down = np.split(both, 2, axis=1)
        return np.swapaxes(up - down, 1, 2) / (2 * STEP)
