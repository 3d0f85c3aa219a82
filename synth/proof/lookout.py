"""Designs in pairs of pieces: what branch and bound goes by, judged from the linkage alone."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.analysis import Verdict, verify
from grashof.problems import Linkage, TransmissionOver
from grashof.problems.values.arrays import ComplexArray, IntArray
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import Screened
from grashof.synth.proof.asked import Asked
from grashof.synth.proof.pairs import Pairs
from grashof.synth.proof.table import Table
from grashof.synth.starts.dyad_pairs import judged_pairs
from grashof.synth.theory.burmester import Dyads, centre_points, polish

MOST = 4000  # pairs looked at of each level, those with the greatest bounds
JUDGED = 3  # of them by the judge


@dataclass(slots=True)
class Lookout:
    """Looks for designs in the middle of pairs.

    Parameters
    ----------
    scaled : ScaledProblem
        With the requirements that the proof is about.
    asked : Asked
    best : Screened, optional
        The best design so far: a single one.
    """

    scaled: ScaledProblem
    asked: Asked
    best: Screened | None = field(default=None)

    def __call__(self, table: Table, pairs: Pairs, least: float) -> float:
        """The transmission angle of a design better than `least`, rad; 0 where none is found."""
        found = self.screened(table, pairs)
        rows = np.flatnonzero(found.feasible & (found.transmission > least))
        for row in rows[np.argsort(-found.transmission[rows], kind="stable")][:JUDGED]:
            transmitted = self._judged(found, int(row))
            if transmitted > least:
                self.best = found[np.array([row])]
                return transmitted
        return 0.0

    def screened(self, table: Table, pairs: Pairs) -> Screened:
        """The linkages in the middle of the pairs with the greatest bounds."""
        order = np.argsort(-pairs.bound, kind="stable")[:MOST]
        pairs = pairs[order]
        driver, driven = (self._dyads(table, which) for which in (pairs.driver, pairs.driven))
        scaled = self.scaled
        if scaled.motion is None:
            raise TypeError("only whole poses that are met exactly have dyads")
        return judged_pairs(scaled.motion, complex(scaled.targets[0]), driver, driven, scaled.wanted)

    def _dyads(self, table: Table, which: IntArray) -> Dyads:
        """Dyads in the middle of pieces, brought onto the curve."""
        unique, back = np.unique(which, return_inverse=True)
        motion = self.scaled.motion
        points: ComplexArray = self.asked.curve.onto(table.pieces.tubes.middle[unique]) + self.asked.origin
        if motion is None:
            raise TypeError("only whole poses that are met exactly have dyads")
        centres = centre_points(motion, points)
        usable = np.isfinite(centres)
        dyads = polish(motion, Dyads(points, np.where(usable, centres, 0.0)), steps=2)
        return dyads[back]

    def _judged(self, found: Screened, row: int) -> float:
        """What the judge finds that a linkage transmits, rad; 0 where it has a defect."""
        verdict = self.verdict(found, row)
        if verdict is None or verdict.defects:
            return 0.0
        over = self.scaled.wanted.transmission_over
        cycle = over is TransmissionOver.CYCLE
        return float(verdict.transmission_min_cycle if cycle else verdict.transmission_min_task)

    def verdict(self, found: Screened, row: int) -> Verdict | None:
        """The verdict on one of some screened linkages."""
        linkage: Linkage = self.scaled.linkages(found.points[row], found.assembly[row])
        problem = self.scaled.problem
        return verify(linkage, problem.task, problem.requirements, problem=problem)
