"""Four whole poses: bounds of the best design, by branch and bound over pairs of pieces of the curve."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from grashof.synth.proof.claims.bounds import STOPPED, TOO_SMALL, Bounds, Proving
from grashof.synth.proof.curve.required import Required, left_out, refusal, with_forms
from grashof.synth.proof.curve.table import Table, TooMany, Trail
from grashof.synth.proof.poses.branch_and_bound import MOST_LEFT, MOST_LEVELS, Search
from grashof.synth.proof.poses.lookout import Lookout
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import StopRequested


def bounds_of_four(
    scaled: ScaledProblem, proving: Proving, at_least: float | None = None, trail: Trail | None = None
) -> Bounds | None:
    """Bounds of the best design; None where the question does not arise.

    With `at_least`, deg, it only decides whether a design has that much, and ends with the first one. `trail`
    records the parts examined, for a certificate.
    """
    why = refusal(scaled)
    if why is None:
        return None
    if why:
        return Bounds(why=why, refused=True)
    since = perf_counter()
    without = left_out(scaled)
    about = with_forms(scaled) if without else scaled
    required = Required.of(about, at_least)
    search = Search(required, float(np.radians(proving.gap)), proving.most_pairs)
    look = Lookout(about, required, None if without else proving.report)
    begun = (0, 0)
    try:
        table = Table.covering(required, trail)
        begun = int(table.pieces.driver.sum()), int(table.pieces.driven.sum())
        search.run(table, look, content=at_least is not None)
        why = "" if search.done or (search.lower and at_least is not None) else _open(search)
    except TooMany as ended:
        why = str(ended)
    except StopRequested:
        why = STOPPED
    return search.bounds(since, begun, look.best, without, why)


def _open(search: Search) -> str:
    """Why a branch and bound ended before its bounds met."""
    if search.levels >= MOST_LEVELS:
        return TOO_SMALL
    if search.left is not None and len(search.left) > MOST_LEFT:
        return f"more than {MOST_LEFT} pairs are left"
    return f"the budget of {search.most_pairs} pairs ended" if search.over_budget else STOPPED
