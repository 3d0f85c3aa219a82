"""The kinds of search, and which of them suits a problem."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from grashof.problems import Problem, ProblemError
from grashof.problems.values.checks import located
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.design_finder import DesignFinder
from grashof.synth.starts.exact_poses import FewPoses, ManyPoses, Parallelograms
from grashof.synth.starts.functions.finder import Functions
from grashof.synth.starts.least_squares import LeastSquares
from grashof.synth.starts.precision_points import EightPoints, NinePoints, PrecisionPoints
from grashof.synth.starts.strokes.limit_positions import LimitPositions

# The first that suits a problem is taken.
KINDS: tuple[Any, ...] = (
    Functions,
    LimitPositions,
    Parallelograms,
    FewPoses,
    ManyPoses,
    NinePoints,
    EightPoints,
    PrecisionPoints,
)


class Finder(Protocol):
    """A kind of search: how it finds starts, and what it knows of the problems that it suits."""

    @property
    def beginning(self) -> str:
        """What the search begins with, for those who wait."""

    @property
    def freedom(self) -> bool:
        """Whether targets that are met leave a programme anything to decide."""

    @property
    def cognates(self) -> bool:
        """Whether linkages that move as a design does are looked at, too: no start leads to each of them."""

    @property
    def exhausted(self) -> str:
        """Why a search ends that has gone through all its rounds."""

    def refuse(self) -> None:
        """Raise `ProblemError` for targets that cannot be searched for."""

    def degenerate(self) -> str:
        """Why the targets need no linkage; empty where they need one."""

    @property
    def patience(self) -> float:
        """So many rounds on end without a start end the search."""

    @property
    def rounds_a_pass(self) -> int:
        """After so many rounds they may begin again, with other random numbers."""

    def quick_pass(self, rng: np.random.Generator) -> Round | None:
        """A few starts found at once, where the first round takes long; None elsewhere."""

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """One round of starts for `enough` designs, which depends on no other one; None after the last.

        With `size` times the usual draws where that helps.
        """

    def relaxed(self, rng: np.random.Generator) -> Sequence[Proposal]:
        """Starts that may miss what no linkage meets."""

    def obstacle(self, rng: np.random.Generator, counts: Mapping[str, int], /) -> str:
        """Why theory, or what the rounds counted, leaves no design; empty where it may leave one."""


class StartFinder(Finder, Protocol):
    """One from whose starts a programme is solved."""

    def near(self, rng: np.random.Generator) -> Screened:
        """Linkages that meet the requirements, or nearly do."""


def rounds(finder: Finder, made: Callable[[int], Round | None]) -> Iterator[Round]:
    """Rounds of a finder, as `made` makes them, until there is none or too many are barren."""
    barren, number = 0, 0
    while (found := made(number)) is not None:
        barren = 0 if found.starts else barren + 1
        yield found
        if barren >= finder.patience:
            return
        number += 1 + found.skip


def finder_for(scaled: ScaledProblem) -> StartFinder | DesignFinder:
    """The first kind of search that suits a problem."""
    suitable = (kind(scaled) for kind in KINDS if kind.suits(scaled))
    made: StartFinder | DesignFinder = next(suitable, LeastSquares(scaled))
    return made


def refuse_unsearchable(problem: Problem) -> None:
    """Raise `ProblemError` unless the targets can be searched for with every kind of linkage asked for."""
    for kind in problem.mechanism:
        try:
            finder_of(problem.for_kind(kind)).refuse()
        except ProblemError as error:
            raise error if len(problem.mechanism) == 1 else located(error, f"mechanism {kind}") from None


def finder_of(problem: Problem) -> Finder:
    """The kind of search that a problem begins with."""
    return finder_for(ScaledProblem.of(asked_first(problem)))


def asked_first(problem: Problem) -> Problem:
    """The problem that a search begins with: where targets may be missed, to meet all, or least squares."""
    if not problem.task.in_plane or (problem.zones is None and problem.requirements.error_factor is None):
        return problem
    return problem.without_zones(
        # all are met where linkages that do can be expected
        exact=problem.requirements.exact is not False and problem.task.exact_by_default
    )
