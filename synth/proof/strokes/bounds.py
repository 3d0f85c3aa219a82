"""A swing or a stroke: bounds of the best there is, over families of one number."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.strokes.cover import covered
from grashof.synth.proof.strokes.required import (
    families_of_stroke,
    floor_of,
    refusal_of_stroke,
    sizes_left_out,
)
from grashof.synth.quantities.scaled_problem import ScaledProblem


def bounds_of_stroke(scaled: ScaledProblem, proving: Proving, at_least: float | None = None) -> Bounds | None:
    """Bounds of the best design; None of other tasks. `at_least` is in deg."""
    if not scaled.problem.task.at_limits:
        return None
    since = perf_counter()
    cover = covered(families_of_stroke(scaled), float(np.radians(proving.gap)), floor_of(scaled, at_least))
    made = Bounds(
        lower=cover.lower,
        upper=cover.upper,
        closed=cover.closed,
        pieces=(cover.begun, 0),
        pairs=cover.bounded,
        levels=cover.levels,
        seconds=perf_counter() - since,
        left_out=sizes_left_out(scaled),
        why="" if cover.closed else "pieces of families stay open, as small as rounding or too many",
    )
    why = refusal_of_stroke(scaled)
    return Bounds(why=why, refused=True) if why and not made.none else made
