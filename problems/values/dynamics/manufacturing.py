"""How exactly a linkage is made."""

from __future__ import annotations

from dataclasses import dataclass

from grashof.problems.values.checks import GREATEST, finite_number
from grashof.problems.values.errors import ProblemError


@dataclass(frozen=True, slots=True, init=False)
class Manufacturing:
    """How exactly linkages are made, and how exactly they have to work.

    Parameters
    ----------
    length_tolerance : float, length
        Each made dimension (r1, r2, r3, r4, u, v) is normal about its nominal value, independent of
        the others, with three standard deviations equal to this.
    band : float, length, optional
        How far a made linkage may carry its worst target from where the nominal one carries it;
        `length_tolerance` by default: a linkage as exact as its parts.

    Raises
    ------
    ProblemError
        A length that is not finite and greater than zero.

    Notes
    -----
    Three standard deviations within the limits is the usual reading of a two-sided tolerance
    (process capability Cp = 1; 99.73 % of the parts pass); Dhande & Chakraborty (1973), J. Eng. Ind.
    95(3), 672-676, judge four-bars by the three-sigma band too.

    Examples
    --------
    >>> Manufacturing(0.1)
    Manufacturing(length_tolerance=0.1, band=0.1)
    """

    length_tolerance: float
    band: float

    def __init__(self, length_tolerance: float, band: float | None = None) -> None:
        tolerance = _length(length_tolerance, "manufacturing.length_tolerance")
        object.__setattr__(self, "length_tolerance", tolerance)
        object.__setattr__(self, "band", tolerance if band is None else _length(band, "manufacturing.band"))

    @property
    def deviation(self) -> float:
        """Standard deviation of each made dimension, length."""
        return self.length_tolerance / 3


def _length(value: float, where: str) -> float:
    length = finite_number(value, where)
    if length <= 0:
        raise ProblemError(f"{where} is {length:.15g}; it must be greater than zero")
    if length > GREATEST:
        raise ProblemError(f"{where} is {length:.15g}; it must be at most {GREATEST:g}")
    return length
