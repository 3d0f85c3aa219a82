"""Proofs about a list: that its best is the best there is, an upper bound, or that there is none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from grashof.problems import Problem
from grashof.problems.values.linkages.mechanisms import FOUR_BAR
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import Quantity
from grashof.synth.designs.candidate import Candidate
from grashof.synth.proof.claims.bounds import Bounds

ROUNDING = "doubles, enclosures widened for rounding; poses as stored, limits by 2e-9"
_NOISE = 1e-6  # deg: targets are met up to rounding, and so are bounds


class Claim(StrEnum):
    """A claim about a list."""

    BEST = "best"
    BOUND = "bound"
    NONE = "none"
    FOLLOWED = "followed"
    REFUSED = "refused"


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """A proof about the designs of a problem, as in ``run.json``.

    Parameters
    ----------
    claim : Claim
        best: no design has more than `upper`, at most the gap above the best that is listed; bound: no
        design has more than `upper`; none: there is no design; followed: every solution that is known
        numerically was followed; refused: there is no proof.
    complete : bool
        Whether all solutions are known; not where they are only followed.
    mechanism : str
        The kind of linkage.
    quantity : str
        The bounded quantity, by its column.
    lower, upper : float or None, deg
        Value of the best listed design, as judged; and the bound that no design exceeds.
    pieces : tuple of int
        First pieces of the curve, or plane, of dyads: those that may be drivers, and driven; of five poses
        dyads; of a stroke pieces of one-parameter families, and 0; of points listed linkages, and 0.
    pairs, levels : int
        Pairs of pieces, or pieces, that were bounded, and the number of times that the remaining ones were
        halved; of three
        poses, a part.
    seconds : float, s
    left_out : tuple of str
        Requirements that the proof does without, by their keys: designs that meet them have `upper` at most.
    regions : int
        Connected sets of designs above half the best, or the angle demanded; 0 where they are not known.
    region_size : float, sizes
        Half the length of the pieces that distinguish them; 0 where they are not known.
    rounding, why : str
        How rounding is accounted for; why there is no proof, no closer bound, or no design on one side; what
        was followed.
    """

    claim: Claim
    complete: bool = False
    mechanism: str = FOUR_BAR
    quantity: str
    lower: float | None = None
    upper: float | None = None
    pieces: tuple[int, int] = (0, 0)
    pairs: int = 0
    levels: int = 0
    seconds: float = 0.0
    left_out: tuple[str, ...] = ()
    regions: int = 0
    region_size: float = 0.0
    rounding: str = ROUNDING
    why: str = ""

    @property
    def stated(self) -> dict[str, Any]:
        """All fields, for a file."""
        values = {name: getattr(self, name) for name in self.__slots__}
        pieces, left_out = list(self.pieces), list(self.left_out)
        return {**values, "claim": str(self.claim), "pieces": pieces, "left_out": left_out}


def best_listed(problem: Problem, designs: Sequence[Candidate]) -> float | None:
    """The greatest transmission angle of some designs, deg, as judged; None without designs."""
    key = quantity_of(problem).key
    return max((float(np.degrees(one.values[key])) for one in designs), default=None)


def proof_of(problem: Problem, bounds: Bounds, lower: float | None, gap: float) -> Proof:
    """The proof from bounds, where the best known design has a transmission angle `lower`, deg."""
    upper = float(np.degrees(bounds.upper))
    claim, why = Claim.BOUND, bounds.why
    if bounds.refused:
        claim = Claim.REFUSED
    elif lower is not None and lower > upper + _NOISE:
        claim = Claim.REFUSED
        why = f"a design has {lower:.6g} deg, more than the bound of {upper:.6g} deg, which is a fault"
    elif bounds.none and lower is None:
        claim = Claim.NONE
    elif lower is not None and upper <= lower + gap + _NOISE:
        claim = Claim.BEST
    return Proof(
        claim=claim,
        complete=claim is Claim.NONE,
        mechanism=problem.mechanism[0],
        quantity=quantity_of(problem).column,
        lower=lower,
        upper=None if claim is Claim.REFUSED else upper,
        pieces=bounds.pieces,
        pairs=bounds.pairs,
        levels=bounds.levels,
        seconds=round(bounds.seconds, 4),
        left_out=bounds.left_out,
        why=why,
    )


def quantity_of(problem: Problem) -> Quantity:
    """The transmission angle that a problem is about."""
    return problem.requirements.as_required(QUANTITIES["transmission"])
