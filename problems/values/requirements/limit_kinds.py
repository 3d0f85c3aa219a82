"""How requirements limit quantities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import Any

import numpy as np

from grashof.problems.values.arrays import Limits
from grashof.problems.values.requirements.quantities import Quantity

# Allowed directions (deg) and rates of the coupler in files, and the least widths of their ranges.
HEADINGS, RATES = (-360.0, 360.0), (-1e6, 1e6)
NARROW_HEADING, NARROW_RATE = 0.1, 1e-3


class Kind(Enum):
    """How a requirement limits its quantity."""

    BETWEEN = auto()  # [lo, hi]
    AT_LEAST = auto()
    AT_MOST = auto()
    EQUAL = auto()  # an angle
    DIRECTION = auto()  # an angle, or [lo, hi]
    INSIDE = auto()  # a box or a region in the plane
    ON_BODY = auto()  # a box or a region in the body's frame
    WORD = auto()  # one of several words, each allowing a range
    HEADING = auto()  # [lo, hi] of a direction that changes, unique up to full turns
    NAMED = auto()  # [lo, hi] of several numbers by name, such as ratios of links

    @property
    def is_angle(self) -> bool:
        """Whether it limits a direction, which is unique only up to full turns."""
        return self in (Kind.EQUAL, Kind.DIRECTION)


@dataclass(frozen=True, slots=True)
class Limit:
    """How a field of `Requirements` limits a quantity."""

    quantity: Quantity
    kind: Kind
    allowed: tuple[float, float]  # least and greatest value in files
    usual: tuple[float, float] | None = None  # limits where none are given, in sizes of the task
    words: Mapping[str, Limits] = field(default_factory=dict)  # the range that each word allows
    narrowest: float = 0.0  # least difference of lo and hi in files

    @property
    def widest(self) -> str:
        """The word that allows most."""
        return max(self.words, key=lambda word: self.words[word][1] - self.words[word][0])

    def ranges(self, value: Any) -> dict[str, Limits]:
        """The ranges that a value of the field allows, angles in rad.

        By the axis of a box, also that around a region, or by the name of a ratio or distance; else by "".
        """
        if self.kind in (Kind.INSIDE, Kind.ON_BODY):
            return {"x": value.x, "y": value.y}
        if self.kind is Kind.NAMED:
            return dict(value)
        if self.kind is Kind.WORD:
            return {"": self.words[value]}
        low, high = value if isinstance(value, tuple) else (value, value)
        if self.kind is Kind.AT_LEAST:
            high = np.inf
        if self.kind is Kind.AT_MOST:
            low = -np.inf
        return {"": (float(low / self.quantity.unit.shown), float(high / self.quantity.unit.shown))}

    def range_text(self, limits: Limits) -> str:
        """Limits as files state them, as `Unit.range_text` or by a word; empty where none are."""
        words = (word for word, allowed in self.words.items() if allowed == limits)
        return next(words, self.quantity.unit.range_text(limits))
