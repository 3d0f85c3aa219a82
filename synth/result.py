"""Results: verified designs, ranked, and what became of all the others."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from grashof.analysis import Verdict
from grashof.problems import FourBar, NoSolutionError, Objective, Problem, TransmissionOver
from grashof.problems.checks import BoolArray, FloatArray, counted
from grashof.problems.display import Displayed
from grashof.synth.distinct import DISTINCT, pick_apart, signature

if TYPE_CHECKING:
    import pandas as pd


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
    """

    linkage: FourBar
    verdict: Verdict
    start: int
    iterations: int
    cognate_of: str = ""
    torque_peak: float = np.nan

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

    def score(self, problem: Problem) -> float:
        """How good the design is by the problem's objective; greater is better.

        With ``exact = false`` the error comes first.
        """
        if not problem.requirements.is_exact(problem.task):
            return -float(np.sqrt(self.verdict.square / len(problem.task))) / problem.task.size
        transmission = self.transmission(problem.requirements.transmission_over)
        size = self.verdict.size / problem.task.size
        if not problem.objective.torque:
            return float(weigh(problem.objective, np.array(transmission), np.array(size)))
        torque = np.inf if np.isnan(self.torque_peak) else self.torque_peak / problem.reference_torque
        return float(weigh(problem.objective, np.array(transmission), np.array(size), np.array(torque)))


def weigh(
    objective: Objective, transmission: FloatArray, size: FloatArray, torque: FloatArray | None = None
) -> FloatArray:
    """Scores of transmission angles (rad), sizes (in sizes of the task) and torques (in reference torques).

    All of shape (n,); the torque only where it has a weight.
    """
    score = objective.transmission * transmission / (np.pi / 2) - objective.compactness * size
    return score if torque is None else score - objective.torque * torque


@dataclass(frozen=True, slots=True, repr=False)
class Result(Displayed):
    """A ranked list of verified, distinct designs, best first; `nearest` when there is none.

    Parameters
    ----------
    problem : Problem
    candidates : tuple of Candidate
    nearest : tuple of Candidate
        For an empty list: designs with one requirement missed, each as little as was possible.
    counts : mapping of str to int
        Solves by outcome.
    seconds : mapping of str to float
        Time by stage.
    note : str
        Why the list is empty or was cut short; empty otherwise.
    complete : bool
        False when the search was interrupted.
    ended : str
        Why the search ended before it had as many designs as were asked for; empty when it had.
    """

    problem: Problem
    candidates: tuple[Candidate, ...]
    nearest: tuple[Candidate, ...]
    counts: Mapping[str, int]
    seconds: Mapping[str, float]
    note: str = ""
    complete: bool = True
    ended: str = ""

    def __repr__(self) -> str:
        best = f"best {self.best._words}" if self.candidates else self.note
        return f"<Result of {self.problem.name}: {counted(len(self), 'design')}; {best}>"

    @property
    def best(self) -> Candidate:
        """The first design; `NoSolutionError` says what stood in the way when there is none."""
        if not self.candidates:
            raise NoSolutionError(self.note)
        return self.candidates[0]

    def __len__(self) -> int:
        return len(self.candidates)

    def to_frame(self) -> pd.DataFrame:
        """One verified design a row, best first; columns as the README lists them."""
        from grashof.synth.table import to_frame  # pandas takes half a second to import

        return to_frame(self.problem, self.candidates)

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write `to_frame` with floats in full precision."""
        self.to_frame().to_csv(path, index=False, lineterminator="\n")


def ranked(problem: Problem, candidates: list[Candidate]) -> tuple[Candidate, ...]:
    """Distinct candidates, best first; of two that are not distinct the better one stays."""
    if not candidates:
        return ()
    score = np.array([candidate.score(problem) for candidate in candidates])
    origin = np.nanmean(problem.task.positions, axis=0)
    signatures = np.array([signature(candidate.linkage, origin) for candidate in candidates])
    return tuple(candidates[i] for i in pick_apart(signatures, score, DISTINCT, len(candidates)))


def pareto_optimal(problem: Problem, candidates: tuple[Candidate, ...]) -> BoolArray:
    """Which candidates no other one beats in error, worst transmission, size and torque; shape (n,).

    Errors up to 1e-9 sizes are exact and count as equal. The torque is the greatest on the task
    when the problem has dynamics; where it is not known it counts as infinite.

    Parameters
    ----------
    problem : Problem
    candidates : tuple of Candidate
    """
    over = problem.requirements.transmission_over
    costs = np.array([
        (
            max(candidate.verdict.error_rms / problem.task.size, 1e-9),
            -candidate.transmission(over),
            candidate.verdict.size,
            np.inf if np.isnan(candidate.torque_peak) else candidate.torque_peak,
        )
        for candidate in candidates
    ]).reshape(-1, 4)  # fmt: skip
    if problem.dynamics is None:
        costs[:, 3] = 0.0
    no_worse = (costs[:, None] <= costs[None]).all(axis=2)
    better = (costs[:, None] < costs[None]).any(axis=2)
    beaten: BoolArray = np.any(no_worse & better, axis=0)
    return ~beaten
