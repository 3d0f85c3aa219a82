"""The section of the bars."""

from __future__ import annotations

from dataclasses import dataclass

from grashof.problems.values.checks import bounded, positive_number
from grashof.problems.values.stated import Stated


@dataclass(frozen=True, slots=True)
class SectionSpec(Stated):
    """A rectangular section of all bars.

    Parameters
    ----------
    width, height : float, length
        In the plane of motion, and across it.
    """

    width: float
    height: float

    def __post_init__(self) -> None:
        for name in self.__slots__:
            object.__setattr__(self, name, positive_number(bounded(getattr(self, name), name), name))

    @property
    def areas(self) -> tuple[float, float, float]:
        """Of the sections of links 2, 3 and 4, length^2."""
        return (self.width * self.height,) * 3

    @property
    def widths(self) -> tuple[float, float, float]:
        """In the plane of motion, of links 2, 3 and 4; 0 where only the area is known."""
        return (self.width,) * 3
