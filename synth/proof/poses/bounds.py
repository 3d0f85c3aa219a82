"""Bounds of the best that four poses allow: what branch and bound comes to, for one kind of linkage."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

from grashof.problems.values.checks import number_within
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.proof.curve.asked import Asked, left_out, refusal, with_forms
from grashof.synth.proof.curve.table import Table, TooMany
from grashof.synth.proof.curve.trail import Trail
from grashof.synth.proof.poses.branch_and_bound import MOST_LEFT, MOST_LEVELS, Search
from grashof.synth.proof.poses.lookout import Lookout
from grashof.synth.theory.stopping import Stopped

_LOG = logging.getLogger(__name__)
_PATIENT = 20_000_000  # pairs


@dataclass(frozen=True, slots=True)
class Proving:
    """How far proofs go.

    Parameters
    ----------
    gap : float, deg
        Up to which bounds are brought together.
    most_pairs : int
        Budget of pairs of pieces: what a proof takes does not depend on the clock.
    """

    gap: float = 0.01
    most_pairs: int = 1_000_000

    def __post_init__(self) -> None:
        object.__setattr__(self, "gap", number_within(self.gap, 1e-4, 90.0, "gap"))

    @classmethod
    def patient(cls, gap: float) -> Proving:
        """With a budget that takes minutes."""
        return cls(gap, _PATIENT)


@dataclass(frozen=True, slots=True)
class Bounds:
    """What is known of the greatest transmission angle of all linkages that meet what has forms.

    Parameters
    ----------
    lower : float, rad
        Of a design that the judge accepts for that; 0 where none is known.
    upper : float, rad
        No design has more.
    closed : bool
        Whether the bounds have met, or no design is left.
    found : Candidate, optional
        The design with `lower`.
    pieces : tuple of int
        Pieces of the curve to begin with: that may be drivers, and driven.
    pairs, levels : int
    seconds : float, s
    left_out : tuple of str
        Requirements without a form, by their fields.
    why : str
        Why there are no bounds, or why they have not met; else empty.
    refused : bool
        Whether there is no proof for such a problem at all.
    """

    lower: float = 0.0
    upper: float = np.pi / 2
    closed: bool = False
    found: Candidate | None = field(default=None, compare=False)
    pieces: tuple[int, int] = (0, 0)
    pairs: int = 0
    levels: int = 0
    seconds: float = 0.0
    left_out: tuple[str, ...] = ()
    why: str = ""
    refused: bool = False

    @property
    def none(self) -> bool:
        """Whether it is proven that there is no design."""
        return self.closed and not self.lower


def bounds_of(
    scaled: ScaledProblem, proving: Proving, at_least: float | None = None, trail: Trail | None = None
) -> Bounds | None:
    """Bounds of the best design; None where the question does not arise.

    Parameters
    ----------
    scaled : ScaledProblem
    proving : Proving
    at_least : float, deg, optional
        Only decide whether a design has that much: end with the first one.
    trail : Trail, optional
        Where a certificate is written from what was looked at.
    """
    why = refusal(scaled)
    if why is None:
        return None
    if why:
        return Bounds(why=why, refused=True)
    since = perf_counter()
    without = left_out(scaled)
    about = with_forms(scaled) if without else scaled
    asked = Asked.of(about, at_least)
    search = Search(asked, float(np.radians(proving.gap)), proving.most_pairs)
    look = Lookout(about, asked)
    begun = (0, 0)
    try:
        table = Table.covering(asked, trail)
        begun = int(table.pieces.driver.sum()), int(table.pieces.driven.sum())
        search.run(table, look, content=at_least is not None)
        why = "" if search.done or (search.lower and at_least is not None) else _open(search)
    except TooMany:
        why = "the curve takes too many pieces to be covered"
    except Stopped:
        why = _STOPPED
    made = Bounds(
        lower=search.lower,
        upper=search.upper,
        closed=search.done,
        found=look.best,
        pieces=begun,
        pairs=search.pairs,
        levels=search.levels,
        seconds=perf_counter() - since,
        left_out=without,
        why=why,
    )
    told = np.degrees(made.lower), np.degrees(made.upper), made.pairs, made.seconds, f"; {why}" if why else ""
    _LOG.info("bounds: %.4f to %.4f deg, %d pairs, %.2f s%s", *told)
    return made


_STOPPED = "it was stopped"
TOO_SMALL = "a dyad whose centre is open stays within pieces as small as rounding"


def _open(search: Search) -> str:
    """Why a branch and bound ended before its bounds met."""
    if search.levels >= MOST_LEVELS:
        return TOO_SMALL
    if search.left is not None and len(search.left) > MOST_LEFT:
        return f"more than {MOST_LEFT} pairs are left"
    return f"the budget of {search.most_pairs} pairs ended" if search.over_budget else _STOPPED
