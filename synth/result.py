"""Results: verified designs, ranked, and what became of all the others."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from grashof.analysis import Verdict
from grashof.analysis.limited import SLACK
from grashof.problems import FourBar, NoSolutionError, Objective, Problem, TransmissionOver
from grashof.problems.checks import BoolArray, FloatArray, counted
from grashof.problems.display import Displayed
from grashof.synth.distinct import DISTINCT, pick_apart, signature

if TYPE_CHECKING:
    import pandas as pd

SAME_ERROR = 1e-6  # sizes: least-squares errors up to it count as equal, or up to a greater tolerance
DIGITS = 9  # decimals of errors (in sizes) and objectives that count; the others are rounding noise
# Nobody would build what is greater (in sizes of the task), turns its driver by less, or comes
# closer to a dead position (rad).
MOST_SIZE, LEAST_TURN, LEAST_TRANSMISSION = 10.0, float(np.radians(5)), float(np.radians(0.1))
# It is ranked as if its error were so many times as great, and its objective worse by this share.
WORSE_ERROR, WORSE_OBJECTIVE = 1.02, 0.01


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
        The best design of each family, best first, then all the others, best first.
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
        Why the search ended: of exact designs, before it had as many as were asked for; else empty.
    least_error : float, length
        Least squares: the least error that was found, as `Candidate.error` has it; NaN otherwise.
    """

    problem: Problem
    candidates: tuple[Candidate, ...]
    nearest: tuple[Candidate, ...]
    counts: Mapping[str, int]
    seconds: Mapping[str, float]
    note: str = ""
    complete: bool = True
    ended: str = ""
    least_error: float = np.nan

    def __repr__(self) -> str:
        best = f"best {self.best._words}" if self.candidates else self.note
        return f"<Result of {self.problem.name}: {counted(len(self), 'design')}; {best}>"

    @property
    def best(self) -> Candidate:
        """The first design; `NoSolutionError` says what stood in the way when there is none."""
        if not self.candidates:
            raise NoSolutionError(self.note)
        return self.candidates[0]

    @property
    def most_error(self) -> float:
        """Up to which error the objective decides, length, by ``error_factor``; NaN where there is none."""
        factor = self.problem.requirements.error_factor
        if factor is None or np.isnan(self.least_error):
            return np.nan
        return factor * max(self.least_error, same_error(self.problem) * self.problem.task.size)

    @property
    def families(self) -> tuple[tuple[Candidate, ...], ...]:
        """Designs that are alike, best first; the families in the order of their best designs."""
        members: dict[str, list[Candidate]] = {}
        for candidate in self.candidates:
            members.setdefault(candidate.family or candidate.id, []).append(candidate)
        return tuple(tuple(family) for family in members.values())

    def top(self, families: int) -> Result:
        """The same with the first so many families only, each with all its members."""
        kept = {each.id for family in self.families[:families] for each in family}
        return replace(self, candidates=tuple(each for each in self.candidates if each.id in kept))

    def __len__(self) -> int:
        return len(self.candidates)

    def to_frame(self) -> pd.DataFrame:
        """One verified design a row, best first; columns as the README lists them."""
        from grashof.synth.table import to_frame  # pandas takes half a second to import

        return to_frame(self.problem, self.candidates)

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write `to_frame` with floats in full precision."""
        self.to_frame().to_csv(path, index=False, lineterminator="\n")


def same_error(problem: Problem) -> float:
    """Errors up to this one count as equal; in sizes of the task."""
    tolerance = problem.requirements.tolerance
    return tolerance if problem.requirements.is_exact(problem.task) else max(SAME_ERROR, tolerance)


def impractical(problem: Problem, verdict: Verdict) -> bool:
    """Whether nobody would build it: far too large, a driver that hardly turns, or a dead position met."""
    return bool(
        verdict.size > MOST_SIZE * problem.task.size
        or np.ptp(verdict.theta2) < LEAST_TURN
        or verdict.transmission_min_task < LEAST_TRANSMISSION
    )


def ranking_key(problem: Problem, candidate: Candidate) -> tuple[float, ...]:
    """What designs are sorted by, best first: the one place that says which of two is better.

    The error, none up to `same_error`; the objective; what people build; the smaller size; and
    the dimensions, so that no two designs tie. What nobody would build (`impractical`) counts
    with 1.02 times its least-squares error and an objective 1 % worse.
    """
    avoided = impractical(problem, candidate.verdict)
    error, objective = candidate.error(problem), candidate.objective(problem)
    if avoided:
        objective -= WORSE_OBJECTIVE * abs(objective)
        error *= 1.0 if problem.by_objective else WORSE_ERROR
    bounded = problem.by_objective and not problem.requirements.is_exact(problem.task)
    counted_error = 0.0 if bounded or error <= same_error(problem) * (1 + SLACK) else round(error, DIGITS)
    cost = np.inf if np.isnan(objective) else -round(objective, DIGITS)
    numbers = signature(candidate.linkage).tolist()
    return (counted_error, cost, float(avoided), candidate.verdict.size, *numbers)


def ranked(problem: Problem, candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Distinct candidates, best first; of two that are not distinct the better one stays."""
    if not candidates:
        return ()
    ordered = sorted(candidates, key=lambda candidate: ranking_key(problem, candidate))
    origin = np.nanmean(problem.task.positions, axis=0)
    signatures = np.array([signature(candidate.linkage, origin) for candidate in ordered])
    picked = pick_apart(signatures, -np.arange(len(ordered), dtype=np.float64), DISTINCT, len(ordered))
    return tuple(ordered[i] for i in picked)


def pareto_optimal(problem: Problem, candidates: tuple[Candidate, ...]) -> BoolArray:
    """Which candidates no other one beats in error, worst transmission, size and torque; shape (n,).

    Errors up to `same_error` count as equal. The torque is the greatest on the task when the
    problem has dynamics; where it is not known it counts as infinite.

    Parameters
    ----------
    problem : Problem
    candidates : tuple of Candidate
    """
    over = problem.requirements.transmission_over
    costs = np.array([
        (
            max(candidate.error(problem), same_error(problem)),
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
