"""The kinds of search, and which of them suits a problem; options of a search."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache

from grashof.problems import Problem, ProblemError, Search
from grashof.problems.values.checks import located, whole_number
from grashof.synth.programme.start import Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.finder import DesignFinder, Finder, StartFinder
from grashof.synth.theory.burmester import Displacements


def rounds(finder: Finder, made: Callable[[int], Round | None]) -> Iterator[Round]:
    """Rounds of a finder, as `made` makes them, until there is none or too many are barren."""
    barren, number = 0, 0
    while (found := made(number)) is not None:
        barren = 0 if found.starts else barren + 1
        yield found
        if barren >= finder.patience:
            return
        number += 1 + found.skip


@lru_cache(maxsize=8)
def finder_for(scaled: ScaledProblem) -> StartFinder | DesignFinder:
    """The first kind of search that suits a problem; the last suits all. None is loaded before it does."""
    task = scaled.problem.task
    if not scaled.one_loop and bool(task.in_plane or task.has_output.any()):
        from grashof.synth.starts.six_bars.finder import SixBars

        return SixBars(scaled)
    if task.has_output.any():
        if task.mirror is not None:
            from grashof.synth.starts.functions.mirrored import MirroredFunctions

            return MirroredFunctions(scaled)
        from grashof.synth.starts.functions.finder import Functions

        return Functions(scaled)
    if task.at_limits:
        from grashof.synth.starts.strokes.limit_positions import LimitPositions

        return LimitPositions(scaled)
    if task.dwell is not None:
        from grashof.synth.starts.six_bars.dwells import Dwells

        return Dwells(scaled)
    if task.swings is not None:
        from grashof.synth.starts.strokes.tandem import TandemRockers

        return TandemRockers(scaled)
    if scaled.motion is not None:  # whole poses, all to be met
        return _of_exact_poses(scaled, scaled.motion)
    if scaled.exact:
        from grashof.synth.starts.precision_points import EightPoints, NinePoints, PrecisionPoints

        every = next((kind for kind in (NinePoints, EightPoints) if kind.suits(scaled)), PrecisionPoints)
        return every(scaled)
    from grashof.synth.starts.least_squares import LeastSquares

    return LeastSquares(scaled)


def _of_exact_poses(scaled: ScaledProblem, motion: Displacements) -> StartFinder:
    from grashof.synth.starts.exact_poses import FewPoses, ManyPoses, Parallelograms

    if len(scaled.targets) > 2 and motion.translates:
        return Parallelograms(scaled)
    return FewPoses(scaled) if len(scaled.targets) < 5 else ManyPoses(scaled)


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
