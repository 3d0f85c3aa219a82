"""The kinds of search, and which of them suits a problem; options of a search."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from grashof.problems import Problem, ProblemError, Search
from grashof.problems.values.checks import located, whole_number
from grashof.synth.programme.start import Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.exact_poses import FewPoses, ManyPoses, Parallelograms
from grashof.synth.starts.finder import DesignFinder, Finder, StartFinder
from grashof.synth.starts.functions.finder import Functions
from grashof.synth.starts.functions.mirrored import MirroredFunctions
from grashof.synth.starts.least_squares import LeastSquares
from grashof.synth.starts.precision_points import EightPoints, NinePoints, PrecisionPoints
from grashof.synth.starts.six_bars.dwells import Dwells
from grashof.synth.starts.six_bars.finder import SixBars
from grashof.synth.starts.strokes.limit_positions import LimitPositions
from grashof.synth.starts.strokes.tandem import TandemRockers

# The first that suits a problem is taken; the last suits all.
KINDS: tuple[type[StartFinder] | type[DesignFinder], ...] = (
    SixBars,
    MirroredFunctions,
    Functions,
    LimitPositions,
    Dwells,
    TandemRockers,
    Parallelograms,
    FewPoses,
    ManyPoses,
    NinePoints,
    EightPoints,
    PrecisionPoints,
    LeastSquares,
)


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
    return next(kind(scaled) for kind in KINDS if kind.suits(scaled))


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
