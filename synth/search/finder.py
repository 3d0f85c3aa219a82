"""The kinds of search, and which of them suits a problem; options of a search."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from grashof.problems import Problem, ProblemError, Search
from grashof.problems.values.checks import located, whole_number
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.design_finder import DesignFinder
from grashof.synth.starts.dwells import Dwells
from grashof.synth.starts.exact_poses import FewPoses, ManyPoses, Parallelograms
from grashof.synth.starts.functions.finder import Functions
from grashof.synth.starts.least_squares import LeastSquares
from grashof.synth.starts.precision_points import EightPoints, NinePoints, PrecisionPoints
from grashof.synth.starts.strokes.limit_positions import LimitPositions

# The first that suits a problem is taken.
KINDS: tuple[Any, ...] = (
    Functions,
    LimitPositions,
    Dwells,
    Parallelograms,
    FewPoses,
    ManyPoses,
    NinePoints,
    EightPoints,
    PrecisionPoints,
)


class Finder(Protocol):
    """A kind of search: its way to find starts, and its knowledge of the problems that it suits."""

    @property
    def beginning(self) -> str:
        """First stage of the search, as shown to users."""

    @property
    def freedom(self) -> bool:
        """Whether targets that are met leave freedom to a programme."""

    @property
    def cognates(self) -> bool:
        """Whether linkages that move as a design does are judged, too: no start leads to each of them."""

    @property
    def exhausted(self) -> str:
        """Why a search ends after all its rounds."""

    def refuse(self) -> None:
        """Raise `ProblemError` for targets that cannot be searched for."""

    def degenerate(self) -> str:
        """Why the targets need no linkage; empty where they need one."""

    @property
    def patience(self) -> float:
        """Consecutive rounds without a start after which the search ends."""

    @property
    def rounds_a_pass(self) -> int:
        """Rounds after which the search may begin again, with other random numbers."""

    def quick_pass(self, rng: np.random.Generator) -> Round | None:
        """A few starts found at once, where the first round takes long; None elsewhere."""

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """One independent round of starts for `enough` designs; None after the last.

        With `size` times the usual draws where that helps.
        """

    def relaxed(self, rng: np.random.Generator) -> Sequence[Proposal]:
        """Starts that may miss requirements that no linkage meets."""

    def obstacle(self, rng: np.random.Generator, counts: Mapping[str, int], /) -> str:
        """Why theory, or the counts of the rounds, leave no design; empty where they may leave one."""


class StartFinder(Finder, Protocol):
    """A finder from whose starts a programme is solved."""

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
    """Raise `ProblemError` unless the targets can be searched for with every kind of linkage requested."""
    for kind in problem.mechanism:
        try:
            finder_of(problem.for_kind(kind)).refuse()
        except ProblemError as error:
            raise error if len(problem.mechanism) == 1 else located(error, f"mechanism {kind}") from None


def search_of(problem: Problem, workers: int, **given: float | None) -> Search:
    """The problem's own search options, or those given; ProblemError where it, or an option, is invalid."""
    if not isinstance(problem, Problem):
        raise ProblemError(f"problem is a {type(problem).__name__}; it must be a Problem, such as load gives")
    options = {name: number for name, number in given.items() if number is not None}
    search = replace(problem.search, **options)  # type: ignore[arg-type]  # checked there
    whole_number(workers, 1, "workers")
    refuse_unsearchable(problem)
    return search


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
