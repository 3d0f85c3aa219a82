"""How exactly a linkage is made."""

from __future__ import annotations

from dataclasses import dataclass

from grashof.problems.values.checks import positive_bounded
from grashof.problems.values.value_bases import check_fields, set_fields


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
        set_fields(self, length_tolerance=length_tolerance, band=length_tolerance if band is None else band)
        check_fields(self, "manufacturing.", length_tolerance=positive_bounded, band=positive_bounded)

    @property
    def deviation(self) -> float:
        """Standard deviation of each made dimension, length."""
        return self.length_tolerance / 3
