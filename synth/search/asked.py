"""What is asked of a search besides the problem, checked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from grashof.problems import Problem, ProblemError, Search
from grashof.problems.values.checks import finite_number, whole_number
from grashof.problems.values.errors import wrong_value
from grashof.synth.search.finder import refuse_unsearchable
from grashof.synth.search.history import StopCondition


def search_of(problem: Problem, workers: int, **given: float | None) -> Search:
    """The problem's own search options, or those given; ProblemError where it, or an option, is invalid."""
    if not isinstance(problem, Problem):
        raise ProblemError(f"problem is a {type(problem).__name__}; it must be a Problem, such as load gives")
    options = {name: number for name, number in given.items() if number is not None}
    search = replace(problem.search, **options)  # type: ignore[arg-type]  # checked there
    whole_number(workers, 1, "workers")
    refuse_unsearchable(problem)
    return search


def asking(time_limit: float | None, stop: Callable[[], bool] | None) -> StopCondition:
    """What asks to end: a time from now on, s (ProblemError if invalid), or somebody who wants it."""
    if time_limit is not None and finite_number(time_limit, "time_limit") <= 0:
        raise wrong_value("time_limit", time_limit, "a time in s greater than zero")
    return StopCondition(time_limit, stop)
