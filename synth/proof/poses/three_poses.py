"""Three whole poses: whether one side of the linkage is impossible, and bounds of the best design."""

from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

from grashof.synth.proof.claims.bounds import STOPPED, Bounds, Proving, logged
from grashof.synth.proof.curve.required import THREE, Required, left_out, refusal, unusable, with_forms
from grashof.synth.proof.curve.table import TooMany
from grashof.synth.proof.poses.best_first import MOST_LEFT, BestFirst, Tilings
from grashof.synth.proof.poses.lookout import Lookout
from grashof.synth.proof.poses.pairs import Pairs
from grashof.synth.proof.poses.sides import OneSide, is_empty
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.dyad_pairs import judged_pairs
from grashof.synth.theory.burmester import Dyads, polish
from grashof.synth.theory.stopping import StopRequested

FEW = 100  # pairs of first tiles, as where pivots are given: these are bounded at once
FEW_PAIRS = 20_000  # in all, then
LOOKED_AT = 1000  # pairs of each step with the greatest bounds, and about as many spread over all
SIDES = {True: "link 2, with O2 and A,", False: "link 4, with O4 and B,"}


@dataclass(slots=True)
class _Middles:
    """Looks for designs in the middle of pairs of tiles."""

    look: Lookout
    scaled: ScaledProblem
    required: Required
    steps: int = field(default=0)

    def __call__(self, sides: Tilings, pairs: Pairs, least: float) -> float:
        """The transmission angle of a design better than `least`, rad; 0 where none is found."""
        motion = self.scaled.motion
        if motion is None:
            raise TypeError("only whole poses that are met exactly have dyads")
        # Those with the greatest bounds are the least resolved; good designs are elsewhere, too.
        every = max(1, len(pairs) // LOOKED_AT)
        best = Pairs.joined([pairs[:LOOKED_AT], pairs[self.steps % every :: every]])
        self.steps += 1
        driver, driven = (
            polish(
                motion, Dyads(*(each.middle[which] + self.required.origin for each in (of.z, of.c))), steps=2
            )
            for of, which in ((sides.driver.sites, best.driver), (sides.driven.sites, best.driven))
        )
        found = judged_pairs(motion, complex(self.scaled.targets[0]), driver, driven, self.scaled.wanted)
        return self.look.best_of(found, least)


def sides_of(scaled: ScaledProblem) -> Bounds | None:
    """A proof that there is no design, as no dyad of one side meets its requirements; else None.

    The objective does not matter.
    """
    required, without = _required(scaled)
    since = perf_counter()
    for is_driver, words in SIDES.items():
        try:
            empty = is_empty(OneSide.of(required, is_driver=is_driver))
        except (TooMany, StopRequested):
            return None
        if empty:
            why = f"{words} meets the poses nowhere within its limits"
            spent = perf_counter() - since
            return logged(Bounds(upper=required.floor, closed=True, seconds=spent, left_out=without, why=why))
    return None


def _required(scaled: ScaledProblem, at_least: float | None = None) -> tuple[Required, tuple[str, ...]]:
    """The requirements that have forms, and those that are left out."""
    without = left_out(scaled)
    return Required.of(with_forms(scaled) if without else scaled, at_least), without


def bounds_of_three(
    scaled: ScaledProblem, proving: Proving, at_least: float | None = None, lower: float = 0.0
) -> Bounds | None:
    """Bounds of the best design; None where the question does not arise, or where it would take minutes.

    With `at_least`, deg, it only decides whether a design has that much, and ends with the first one;
    `lower`, rad, is the transmission angle of a design that is known, as judged.
    """
    if scaled.motion is None or len(scaled.targets) != THREE or scaled.kind.dyad.bars < 2:
        return None
    if scaled.problem.driver is None and not unusable(scaled) and (none := sides_of(scaled)) is not None:
        return none
    why = refusal(scaled, THREE)
    if why:
        return Bounds(why=why, refused=True) if proving.minutes else None
    since = perf_counter()
    required, without = _required(scaled, at_least)
    about = with_forms(scaled) if without else scaled
    search = BestFirst(required, float(np.radians(proving.gap)), proving.most_pairs, lower=lower)
    look = Lookout(about, required, None if without else proving.report)
    begun = (0, 0)
    try:
        sides = Tilings.covering(required)
        begun = len(sides.driver), len(sides.driven)
        if not proving.minutes:
            if begun[0] * begun[1] > FEW:
                return None
            search.most_pairs = min(search.most_pairs, FEW_PAIRS)
        search.run(sides, _Middles(look, about, required), content=at_least is not None)
        decided = search.done or (at_least is not None and search.lower)
        why = "" if decided else _open(search)
    except TooMany as ended:
        why = str(ended)
    except StopRequested:
        why = STOPPED
    if not (proving.minutes or search.done):
        return None
    return search.bounds(since, begun, look.best, without, why)


def _open(search: BestFirst) -> str:
    """Why a branch and bound ended before its bounds met."""
    if search.left is not None and len(search.left) > MOST_LEFT:
        return f"more than {MOST_LEFT} pairs are left"
    return f"the budget of {search.most_pairs} pairs ended" if search.over_budget else STOPPED
