"""A design with the verdict of the judge."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np

from grashof.analysis import Verdict
from grashof.problems import FourBar, Problem, TransmissionOver
from grashof.problems.values.display import Displayed
from grashof.synth.programme.merit import same_error, weigh
from grashof.synth.theory.distinct import signature


@dataclass(frozen=True, slots=True, repr=False)
class Candidate(Displayed):
    """A design with the judge's verdict on it.

    Parameters
    ----------
    linkage : FourBar
    verdict : Verdict
    start : int
        Number of the start that it came from.
    iterations : int
        Of Ipopt.
    cognate_of : str
        Id of the design whose coupler curve this one traces too; empty for the others.
    torque_peak : float, N m
        Greatest magnitude of the drive torque over the motion used; NaN where it is not known.
    best_at : str
        What a design of a least-squares list was made for, such as "least error"; empty for the others.
    family : str
        Id of the best design of those like it; empty before designs are sorted into families.
    """

    linkage: FourBar
    verdict: Verdict
    start: int
    iterations: int
    cognate_of: str = ""
    torque_peak: float = np.nan
    best_at: str = ""
    family: str = ""

    def __repr__(self) -> str:
        return f"<Candidate {self._words}>"

    @property
    def id(self) -> str:
        """Name by the design itself: the same for the same numbers (to six digits) in any list.

        It begins with a letter, so that no spreadsheet takes it for a number.
        """
        numbers = [*signature(self.linkage), self.linkage.assembly, self.linkage.body_angle]
        text = " ".join(f"{number + 0.0:.5e}" for number in numbers)
        return "d" + hashlib.sha256(text.encode()).hexdigest()[:7]

    @property
    def _words(self) -> str:
        lengths = ", ".join(f"{length:.4g}" for length in self.linkage.lengths)
        worst = np.degrees(self.verdict.transmission_min_task)
        return (
            f"{self.id}: {self.verdict.grashof_class}, r1 to r4 {lengths}, mu {worst:.1f} deg over the task"
        )

    def transmission(self, over: TransmissionOver) -> float:
        """Worst transmission angle over the task or the cycle, rad."""
        if over is TransmissionOver.CYCLE:
            return self.verdict.transmission_min_cycle
        return self.verdict.transmission_min_task

    def error(self, problem: Problem) -> float:
        """What the design misses the task by, in sizes of the task.

        The greatest position error where every target is to be met, or else the root mean square of
        what least squares makes small.
        """
        if problem.requirements.is_exact(problem.task):
            return self.verdict.error_max / problem.task.size
        return float(np.sqrt(self.verdict.square / len(problem.task))) / problem.task.size

    def objective(self, problem: Problem) -> float:
        """How good the design is by the problem's objective, whatever its error; greater is better."""
        transmission = self.transmission(problem.requirements.transmission_over)
        size = self.verdict.size / problem.task.size
        if not problem.objective.torque:
            return float(weigh(problem.objective, np.array(transmission), np.array(size)))
        torque = np.inf if np.isnan(self.torque_peak) else self.torque_peak / problem.reference_torque
        return float(weigh(problem.objective, np.array(transmission), np.array(size), np.array(torque)))

    def score(self, problem: Problem) -> float:
        """How far a search has come with this design; greater is better.

        The objective, or in least squares the error, none up to `same_error`. Designs are ranked by
        `ranking_key`.
        """
        if problem.by_objective:
            return self.objective(problem)
        error = self.error(problem)
        return 0.0 if error <= same_error(problem) else -error
