"""Designs in pairs of pieces: what branch and bound goes by, judged from the linkage alone."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.analysis import Verdict, verify
from grashof.problems import Linkage, TransmissionOver
from grashof.problems.values.arrays import ComplexArray
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
        best_first = pairs[np.argsort(-pairs.bound, kind="stable")[:MOST]]
        found = screened_pairs(self.scaled, self.asked, table, best_first)
        rows = np.flatnonzero(found.feasible & (found.transmission > least))
        for row in rows[np.argsort(-found.transmission[rows], kind="stable")][:JUDGED]:
            transmitted = self._judged(found, int(row))
            if transmitted > least:
                self.best = found[np.array([row])]
                return transmitted
        return 0.0

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


def screened_pairs(scaled: ScaledProblem, asked: Asked, table: Table, pairs: Pairs) -> Screened:
    """The linkages in the middle of pairs, brought onto the curve."""
    motion = scaled.motion
    if motion is None:
        raise TypeError("only whole poses that are met exactly have dyads")
    unique, back = np.unique(np.concatenate([pairs.driver, pairs.driven]), return_inverse=True)
    points: ComplexArray = asked.curve.onto(table.pieces.tubes.middle[unique]) + asked.origin
    centres = centre_points(motion, points)
    usable = np.isfinite(centres)
    dyads = polish(motion, Dyads(points, np.where(usable, centres, 0.0)), steps=2)
    driver, driven = dyads[back[: len(pairs)]], dyads[back[len(pairs) :]]
    return judged_pairs(motion, complex(scaled.targets[0]), driver, driven, scaled.wanted)
