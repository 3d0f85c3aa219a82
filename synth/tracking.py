"""Designs that follow their problem: solved again from their place when a target or a limit moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from grashof.analysis.judge.design import Constraint, OwnObjective
from grashof.problems import Problem, ProblemError
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.linkages.mechanisms import is_of
from grashof.synth.designs.candidate import Candidate, same_error
from grashof.synth.designs.judging import Steps, ToJudge, in_step
from grashof.synth.programme.start import Start
from grashof.synth.programme.user_functions import refuse_no_list, refuse_unusable
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempted
from grashof.synth.search.finder import finder_for
from grashof.synth.starts.finder import DesignFinder

_TRADED = 1.001  # times the least error: designs with more error have traded it for something else


def track(
    designs: Sequence[Candidate],
    problem: Problem,
    *,
    constraints: Sequence[Constraint] = (),
    objective: OwnObjective | None = None,
) -> tuple[Candidate, ...]:
    """Designs of one problem, moved to do another one that differs slightly.

    Parameters
    ----------
    designs : sequence of Candidate
    problem : Problem
        The changed one: targets elsewhere, more or fewer of them, other limits.
    constraints, objective
        Your own, as in `synthesize`.

    Returns
    -------
    tuple of Candidate
        One for each design, in their order, judged for `problem`. A lost design has defects, `verdict.ok` is
        False: it is the result of the solver, or where that is not a linkage the design as it was.

    Raises
    ------
    ProblemError
        An argument is invalid, or the problem does not request the kind of a design.

    Notes
    -----
    One solve of some 10 ms each; no search, so that better designs elsewhere are not seen. A design moves no
    farther than necessary where all targets must be met, and in least squares where it has more error than
    another one in exchange for its size or transmission: its error may then be as large as before, or as many
    times the least error. Others move to the least error near them.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from grashof import load, synthesize
    >>> from grashof.problems import MotionTask
    >>> problem = load("luggage")
    >>> best = synthesize(problem, enough=5).best
    >>> moved = problem.task.positions.copy()
    >>> moved[1] += 0.05
    >>> there = replace(problem, task=MotionTask(moved, problem.task.angles))
    >>> (design,) = track([best], there)
    >>> design.verdict.ok, bool(design.verdict.error_max < 1e-9), design.linkage == best.linkage
    (True, True, False)
    """
    refuse_no_list(constraints)
    if not isinstance(problem, Problem):
        raise wrong_value("problem", problem, "a Problem")
    kinds = _kinds_of(designs, problem)
    ready = {kind: ScaledProblem.of(problem.for_kind(kind), constraints, objective) for kind in kinds}
    for scaled in ready.values():
        refuse_unusable(scaled, in_processes=False)
    exact = problem.requirements.is_exact(problem.task) and problem.zones is None
    errors = [0.0 if exact else one.error(one.problem) for one in designs]
    least = max(min(errors, default=0.0), same_error(problem))
    free = {number: np.inf for number, error in enumerate(errors) if error < _TRADED * least}
    moved = _all_moved(ready, designs, free)
    # The least error now bounds that of the designs that traded error.
    reached = min((one.error(problem) for one in moved.values() if one.verdict.ok), default=np.inf)
    reached = max(reached, same_error(problem))
    traded = {
        number: max(error / least * reached, error)
        for number, error in enumerate(errors)
        if number not in free
    }
    moved |= _all_moved(ready, designs, traded)
    return tuple(replace(moved[number], problem=problem) for number in range(len(designs)))


def _kinds_of(designs: Sequence[Candidate], problem: Problem) -> list[str]:
    """Kinds of linkage among the designs, each of which the problem has to request."""
    kinds: dict[str, None] = {}
    for number, design in enumerate(designs):
        if not isinstance(design, Candidate):
            raise wrong_value(f"designs[{number}]", design, "a Candidate, as results list them")
        kind = design.linkage.mechanism.word
        if not is_of(design.linkage, problem.mechanism):
            requested = ", ".join(problem.mechanism)
            raise ProblemError(f"designs[{number}] is a {kind}; the problem requests {requested}")
        kinds[kind] = None
    return list(kinds)


def _all_moved(
    ready: Mapping[str, ScaledProblem], designs: Sequence[Candidate], allowed: Mapping[int, float]
) -> dict[int, Candidate]:
    """Designs with errors allowed, by number, each moved; those of a kind are judged together."""
    moved = dict[int, Candidate]()
    for kind, scaled in ready.items():
        alike = [number for number in allowed if designs[number].linkage.mechanism.word == kind]
        routines = [_moved(scaled, designs[number], number, allowed[number]) for number in alike]
        moved |= zip(alike, in_step(scaled, routines), strict=True)
    return moved


def _moved(scaled: ScaledProblem, design: Candidate, number: int, most_error: float) -> Steps[Candidate]:
    """A design after one solve from its place; one that traded error may have as much again.

    Of a function or a stroke: the design of the new task that is nearest to it.
    """
    found = yield from _solved(scaled, design, number, most_error)
    if found is None:
        found = yield _as_it_is(design)
    return replace(found, best_at=design.best_at, family=design.family)


def _solved(
    scaled: ScaledProblem, design: Candidate, number: int, most_error: float
) -> Steps[Candidate | None]:
    """The result of the solver, as of `_moved`; None where it is not a linkage."""
    finder = finder_for(scaled)
    if isinstance(finder, DesignFinder):
        for each in finder.follow(design):
            done = yield from attempted(scaled, each, number)
            if done.candidate is not None:
                return done.candidate
        return None
    verdict = design.verdict
    if verdict.theta2.shape != (len(scaled.problem.task),):
        verdict = (yield _as_it_is(design)).verdict
    start = Start.of_linkage(scaled, design.linkage, verdict)
    start = start.under(settled=scaled.exact, stay=scaled.exact)
    if np.isfinite(most_error):
        near = start.under(stay=True, most_error=most_error)
        done = yield from attempted(scaled, near, number, cognates=False)
        if done.verified:
            return done.verified[0]
    done = yield from attempted(scaled, start, number, cognates=False)
    return done.candidate


def _as_it_is(design: Candidate) -> ToJudge:
    """A design to be judged again, with the cylinder that drives it."""
    return ToJudge(design.linkage, design.start, design.iterations, cylinder=design.verdict.cylinder)
