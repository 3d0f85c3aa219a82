"""Bounds of the best design, and the limits of the proofs that find them."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from grashof.problems.values.checks import number_within
from grashof.synth.designs.candidate import Candidate

_LOG = logging.getLogger(__name__)
_PATIENT = 20_000_000  # pairs
STOPPED = "it was stopped"
TOO_SMALL = "a dyad whose centre is open stays within pieces as small as rounding"


@dataclass(frozen=True, slots=True)
class Proving:
    """Limits of proofs."""

    gap: float = 0.01  # deg, difference to which bounds are brought together
    most_pairs: int = 1_000_000  # budget of pairs of pieces, independent of the clock
    minutes: bool = False  # whether proofs that always take long are wanted
    # Called with the first design that a proof finds and the judge accepts
    report: Callable[[Candidate], object] | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "gap", number_within(self.gap, 1e-4, 90.0, "gap"))

    @classmethod
    def patient(cls, gap: float) -> Proving:
        """With a budget that takes minutes."""
        return cls(gap, _PATIENT, minutes=True)


@dataclass(frozen=True, slots=True)
class Bounds:
    """Bounds of the greatest transmission angle of all linkages that meet the requirements with forms."""

    # In rad, of a design that the judge accepts for that, or of a stroke's member; 0 where none is known
    lower: float = 0.0
    upper: float = np.pi / 2  # rad; no design has more
    closed: bool = False  # whether the bounds have met, or no design remains
    found: Candidate | None = field(default=None, compare=False)  # the design with `lower`
    # Pieces of the curve to begin with, that may be drivers, and driven; of a stroke pieces of families
    pieces: tuple[int, int] = (0, 0)
    pairs: int = 0
    levels: int = 0
    seconds: float = 0.0  # s
    left_out: tuple[str, ...] = ()  # requirements without a form, by their fields
    why: str = ""  # reason why there are none, or they have not met; else empty
    refused: bool = False  # whether proofs do not cover such a problem

    @property
    def none(self) -> bool:
        """Whether the absence of designs is proven."""
        return self.closed and not self.lower


def logged(bounds: Bounds) -> Bounds:
    """These bounds, after a line in the log."""
    why = f"; {bounds.why}" if bounds.why else ""
    numbers = np.degrees(bounds.lower), np.degrees(bounds.upper), bounds.pairs, bounds.seconds, why
    _LOG.info("bounds: %.4f to %.4f deg, %d pairs, %.2f s%s", *numbers)
    return bounds
