"""The pieces that a proof examined, in order: enough to write its certificate from."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.problems.values.arrays import IntArray
from grashof.synth.proof.curve.pieces import Tubes

ROOT = -1  # parent of the rectangles that a cover begins with


@dataclass(slots=True)
class Trail:
    """Rectangles by number, as they were looked at, and the pairs of pieces that were halved."""

    rectangles: list[Tubes] = field(default_factory=list)
    # Numbers of the rectangles that these are halves of
    parents: list[IntArray] = field(default_factory=list)
    # Number of the rectangle that each piece of the table is in
    pieces: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    first: int = 0  # how many of these pieces a proof begins with
    # Driver and driven pieces of pairs, level by level
    halved: list[tuple[IntArray, IntArray]] = field(default_factory=list)

    def look(self, rectangles: Tubes, parents: IntArray) -> IntArray:
        """Note rectangles; their numbers."""
        begin = sum(map(len, self.parents))
        self.rectangles.append(rectangles)
        self.parents.append(parents)
        return np.arange(begin, begin + len(parents))
