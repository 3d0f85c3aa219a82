"""Designs that follow their problem: solved again from their place when a target or a limit moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.analysis.judge.design import Constraint, OwnObjective
from grashof.problems import Problem, ProblemError
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.linkages.mechanisms import is_of
from grashof.synth.designs.candidate import Candidate, same_error
from grashof.synth.designs.judging import judged_again
from grashof.synth.programme.start import Start
from grashof.synth.programme.user_functions import refuse_no_list, refuse_unusable
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt
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
    moved: dict[int, Candidate] = {}
    reached = np.inf
    for number in np.argsort(errors, kind="stable").tolist():  # the least error bounds that of others
        design = designs[number]
        share = errors[number] / least
        most = np.inf if share < _TRADED else max(share * max(reached, same_error(problem)), errors[number])
        moved[number] = _moved(ready[design.linkage.mechanism.word], design, number, most)
        if moved[number].verdict.ok:
            reached = min(reached, moved[number].error(problem))
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


def _moved(scaled: ScaledProblem, design: Candidate, number: int, most_error: float) -> Candidate:
    """A design after one solve from its place; one that traded error may have as much again.

    Of a function or a stroke: the design of the new task that is nearest to it.
    """
    finder = finder_for(scaled)
    if isinstance(finder, DesignFinder):
        tried = [attempt(scaled, each, number).candidate for each in finder.follow(design)]
        nearest = next((one for one in tried if one is not None), judged_again(scaled, design))
        return replace(nearest, best_at=design.best_at, family=design.family)
    same = design.verdict.theta2.shape == (len(scaled.problem.task),)
    verdict = design.verdict if same else judged_again(scaled, design).verdict
    start = Start.of_linkage(scaled, design.linkage, verdict)
    start = start.under(settled=scaled.exact, stay=scaled.exact)
    if np.isfinite(most_error):
        traded = attempt(scaled, start.under(stay=True, most_error=most_error), number, cognates=False)
        if traded.verified:
            return replace(traded.verified[0], best_at=design.best_at, family=design.family)
    found = attempt(scaled, start, number, cognates=False).candidate
    if found is None:
        return judged_again(scaled, design)
    return replace(found, best_at=design.best_at, family=design.family)
