"""Designs in pairs of pieces, which guide branch and bound, judged from the linkage alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from grashof.problems.values.arrays import ComplexArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import judged
from grashof.synth.designs.polishing import polished_solve
from grashof.synth.programme.nonlinear_programme import solve_by_exchange
from grashof.synth.programme.start import Start
from grashof.synth.proof.claims.proof import quantity_of
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import Table
from grashof.synth.proof.poses.pairs import Pairs
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.dyad_pairs import judged_pairs
from grashof.synth.starts.sampled_dyads import stated_dyads
from grashof.synth.theory.burmester import Dyads, centre_points, polish

MOST = 4000  # pairs examined at each level, those with the greatest bounds
JUDGED = 3  # of them by the judge
CLIMBS, MOST_CLIMBS = 2, 4  # solves of a level, and in all, where no pair has a design in its middle


@dataclass(slots=True)
class Lookout:
    """Looks for designs in the middle of pairs; where none is, as under limits of zero width, near it."""

    scaled: ScaledProblem  # with the requirements that the proof is about
    required: Required
    report: Callable[[Candidate], object] | None = None  # called with the first design
    best: Candidate | None = field(default=None)  # the best design so far
    _climbs: int = field(default=0)

    def __call__(self, table: Table, pairs: Pairs, least: float) -> float:
        """The transmission angle of a design better than `least`, rad; 0 where none is found."""
        best_first = pairs[np.argsort(-pairs.bound, kind="stable")[:MOST]]
        return self.best_of(screened_pairs(self.scaled, self.required, table, best_first), least)

    def best_of(self, found: Screened, least: float) -> float:
        """Transmission angle of a design better than `least`, rad, among linkages or near them; else 0."""
        rows = np.flatnonzero(found.feasible & (found.transmission > least))
        for row in rows[np.argsort(-found.transmission[rows], kind="stable")][:JUDGED]:
            if transmitted := self._taken(found.points[row], float(found.assembly[row]), 0.0, least):
                return transmitted
        if found.feasible.any() or self._climbs >= MOST_CLIMBS:
            return 0.0
        nearest = np.argsort(found.violations.sum(axis=1), kind="stable")[:CLIMBS]
        return max([self._climbed(found, int(row), least) for row in nearest], default=0.0)

    def _climbed(self, found: Screened, row: int, least: float) -> float:
        """The result of a solve from a pair."""
        self._climbs += 1
        start = Start.of_screened(found, row, self.scaled.objective)
        solve = polished_solve(self.scaled, start, solve_by_exchange(self.scaled, start))
        if not np.isfinite(solve.points).all():
            return 0.0
        return self._taken(np.array(solve.points), start.assembly, solve.body_angle, least)

    def _taken(self, points: ComplexArray, assembly: float, body_angle: float, least: float) -> float:
        """Transmission angle of a linkage that the judge accepts and that has more than `least`; else 0."""
        made = judged(self.scaled, points, int(assembly), body_angle, start=0, iterations=0)
        if made is None or not made.verdict.ok:
            return 0.0
        transmitted = float(made.values[quantity_of(self.scaled.problem).key])
        if transmitted <= least:
            return 0.0
        if self.best is None and self.report is not None:
            self.report(made)
        self.best = made
        return transmitted


def screened_pairs(scaled: ScaledProblem, required: Required, table: Table, pairs: Pairs) -> Screened:
    """The linkages in the middle of pairs, brought onto the curve, and to dyads in stated places."""
    motion = scaled.motion
    if motion is None:
        raise TypeError("only whole poses that are met exactly have dyads")
    unique, back = np.unique(np.concatenate([pairs.driver, pairs.driven]), return_inverse=True)
    points: ComplexArray = required.curve.onto(table.pieces.tubes.middle[unique]) + required.origin
    centres = centre_points(motion, points)
    usable = np.isfinite(centres)
    dyads = polish(motion, Dyads(points, np.where(usable, centres, 0.0)), steps=2)
    stated = stated_dyads(scaled, motion)
    for z, c in zip(stated.moving, stated.ground, strict=True):
        near = np.abs(points - z) <= 2 * table.pieces.tubes.half[unique]
        dyads.moving[near], dyads.ground[near] = z, c
    driver, driven = dyads[back[: len(pairs)]], dyads[back[len(pairs) :]]
    return judged_pairs(motion, complex(scaled.targets[0]), driver, driven, scaled.wanted)
