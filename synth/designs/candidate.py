"""A design with the verdict of the judge."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from grashof.analysis import Design, Verdict
from grashof.analysis.judge.design import greatest
from grashof.analysis.judge.measures import Values
from grashof.problems import Linkage, Problem
from grashof.problems.values.linkages.mechanisms import kinds_text, lengths_text
from grashof.problems.values.value_bases import Displayed
from grashof.synth.theory.distinct import signature

SAME_ERROR = 1e-6  # sizes: least-squares errors up to it count as equal, or up to a greater tolerance


@dataclass(frozen=True, slots=True, repr=False)
class Candidate(Displayed):
    """A design with the judge's verdict on it.

    Parameters
    ----------
    linkage : Linkage
    verdict : Verdict
    problem : Problem
        The problem that it solves.
    start : int
        Number of the start that it came from.
    iterations : int
        Of Ipopt.
    cognate_of : str
        Id of the design whose coupler curve this one traces too; empty for the others.
    best_at : str
        The strength of a design in a list, such as "least error", or "objective" where it does not come
        first; empty for the others.
    caution : str
        Why a design comes last in a list though it meets all requirements, such as its size; else empty.
    family : str
        Id of the best design of those like it; empty before designs are sorted into families.
    region : int
        Number of the region that it lies in, from 1; 0 where regions are not known, or it lies in none.
    own_objective : float, optional
        Its value under the user's own objective, less is better; None without one.
    values : Values
        Its quantities, by their keys; each is measured when it is first read.
    """

    linkage: Linkage
    verdict: Verdict
    problem: Problem
    start: int
    iterations: int
    cognate_of: str = ""
    best_at: str = ""
    caution: str = ""
    family: str = ""
    region: int = 0
    own_objective: float | None = None
    values: Values = field(default=None, compare=False)  # type: ignore[assignment]  # kept by `replace`

    def __post_init__(self) -> None:
        if self.values is None or not self.values.are_of(self.linkage, self.verdict, self.problem):
            object.__setattr__(self, "values", Values(self.linkage, self.verdict, self.problem))

    def __repr__(self) -> str:
        return f"<Candidate {self._words}>"

    @property
    def id(self) -> str:
        """Name by the design itself: the same for the same numbers (to six digits) in any list.

        It begins with a letter, so that no spreadsheet takes it for a number.
        """
        linkage = self.linkage
        others = [
            x
            for row, x in zip(linkage.mechanism.parameters, linkage.parameters, strict=True)
            if not row.in_length
        ]
        numbers = [*signature(linkage), *others]
        text = " ".join(f"{number + 0.0:.5e}" for number in numbers)
        text += kinds_text([linkage.mechanism.word])
        return "d" + hashlib.sha256(text.encode()).hexdigest()[:7]

    @property
    def _words(self) -> str:
        lengths = lengths_text(self.linkage)
        worst = np.degrees(self.verdict.transmission_min_task)
        return f"{self.id}: {self.verdict.grashof_class}, {lengths}, mu {worst:.1f} deg over the task"

    def error(self, problem: Problem) -> float:
        """The error of the design, in sizes of the task.

        The greatest position error where every target must be met, or else the root mean square that
        least squares minimises. Of a function rad, or shares of the full travel.
        """
        if problem.task.has_output.any():
            return self._output_error(problem)
        if problem.requirements.is_exact(problem.task):
            return float(np.nan_to_num(self.verdict.error_max)) / problem.task.size
        return float(np.sqrt(self.verdict.square / len(problem.task))) / problem.task.size

    def _output_error(self, problem: Problem) -> float:
        """Error of a function: the greatest at the pairs that must be met, or by its norm."""
        unit = problem.task.output_unit
        if problem.requirements.is_exact(problem.task):
            return float(self.verdict.output_error.max()) / unit
        if problem.task.norm == "max":
            return self.verdict.structural_error_max / unit
        return float(np.sqrt(self.verdict.square / len(problem.task))) / unit

    def objective(self, problem: Problem) -> float:
        """Score by the objective, regardless of the error; greater is better."""
        score = sum(
            weight * goal.better * self.values[goal.key] / problem.scale(goal)
            for goal, weight in problem.goals
        )
        if self.own_objective is not None:
            score = -self.own_objective
        return -np.inf if np.isnan(score) else float(score)

    def asked_by(self, problem: Problem) -> Candidate:
        """The design with the values of another problem; the verdict stays."""
        return self if problem is self.problem else replace(self, problem=problem)

    def valued(self, objective: Callable[[Design], Any]) -> Candidate:
        """The design with its value under the user's own objective."""
        design = Design.judged(self.linkage, self.verdict)
        return replace(self, own_objective=greatest(objective, design, "objective"))

    def score(self, problem: Problem) -> float:
        """Score of the design in a search; greater is better.

        The objective, or in least squares the error, none up to `same_error`. Designs are ranked by
        `ranking_key`.
        """
        if problem.by_objective:
            return self.objective(problem)
        error = self.error(problem)
        return 0.0 if error <= same_error(problem) else -error


def same_error(problem: Problem) -> float:
    """Errors up to this one count as equal; in sizes of the task."""
    tolerance = problem.requirements.tolerance
    return tolerance if problem.requirements.is_exact(problem.task) else max(SAME_ERROR, tolerance)
