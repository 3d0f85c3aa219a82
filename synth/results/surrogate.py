"""A short surrogate for a long least-squares task, in solves that trade error for other qualities.

It keeps a few targets, moved to where the design of the least error e meets them. At that design the errors
are orthogonal to all changes of the linkage, so that a design that misses the moved targets by d misses all
targets by the square e^2 + d^2. Its designs are judged on all targets.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis import solve_position
from grashof.problems import ProblemError, Task
from grashof.problems.values.arrays import TURN, IntArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import judged_again, judged_in_time
from grashof.synth.quantities.scaled_problem import ScaledProblem

LONG, FEW = 40, 24  # targets above which a task gets a surrogate, and those of the surrogate
KEPT = 0.98  # of the error that may be added: the judge counts all targets


@dataclass(frozen=True, slots=True)
class Surrogate:
    """The surrogate of a problem; that problem itself where it is short."""

    scaled: ScaledProblem
    least: float = 0.0  # the least error of all targets, sizes; zero where the problem has no surrogate

    @classmethod
    def of(cls, scaled: ScaledProblem, best: Candidate, least: float) -> Surrogate:
        """The surrogate of a problem, unless user functions may depend on any target."""
        count = len(scaled.problem.task)
        if count <= LONG or scaled.every_constraint or scaled.own_objective is not None:
            return cls(scaled)
        index = np.unique(np.round(np.linspace(0, count - 1, FEW)).astype(np.int64))
        try:
            task = met_by(best, scaled.problem.task, index)
        except ProblemError:  # two of them are equal, or none has a position
            return cls(scaled)
        wanted = replace(scaled.problem.requirements.resolved(scaled.problem.task.size), exact=False)
        return cls(scaled.of_problem(replace(scaled.problem, task=task, requirements=wanted)), least)

    @property
    def is_itself(self) -> bool:
        """Whether the problem has no surrogate."""
        return self.least == 0

    def most_error(self, most: float, size: float) -> float:
        """Error of the surrogate, its sizes, for an error `most` of all targets, whose task has this size."""
        if self.is_itself:
            return most
        added = KEPT * float(np.sqrt(max(most**2 - self.least**2, 0.0)))
        return added * size / self.scaled.problem.task.size

    def taken(self, candidate: Candidate) -> Candidate:
        """A design of the full problem, judged by the surrogate."""
        return candidate if self.is_itself else judged_again(self.scaled, candidate)


def met_by(best: Candidate, task: Task, index: IntArray) -> Task:
    """The targets `index` of a task, in order, moved to where a design meets them."""
    linkage, verdict = best.linkage, best.verdict
    state = solve_position(linkage, verdict.theta2[index], verdict.assembly[index])
    places, turned = np.array(state.p), state.theta3 + float(linkage.body_angle)
    turned += TURN * np.round((np.nan_to_num(task.angles[index]) - turned) / TURN)
    if task.returns:
        places[-1], turned[-1] = places[0], turned[0]
    return task.some(index, places, turned)


def on_all_targets(scaled: ScaledProblem, found: list[Candidate], most: float) -> list[Candidate]:
    """Designs of a surrogate that the judge accepts on all targets, up to some error (sizes)."""
    once = {one.id: one for one in found}
    return [one for one in judged_in_time(scaled, list(once.values()), most) if one.verdict.ok]
