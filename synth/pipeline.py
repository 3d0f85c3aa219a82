"""From a problem to a ranked list of verified designs."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from grashof.analysis.judge.design import Constraint, OwnObjective
from grashof.problems import Problem, ProblemError
from grashof.problems.values.text import readable
from grashof.synth.programme.user_functions import refuse_no_list, refuse_unusable
from grashof.synth.proof.claims.bounds import Proving
from grashof.synth.proof.poses.atlas import atlas_of, round_of_regions
from grashof.synth.proof.provers import bounds_after, bounds_before, certified_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.conclusion import conclude, needless
from grashof.synth.results.lists import one_list
from grashof.synth.results.result import Result
from grashof.synth.search.chunks import solve
from grashof.synth.search.finder import finder_for, search_of
from grashof.synth.search.history import StopCondition, StopReason
from grashof.synth.search.journal import journal_of
from grashof.synth.search.run import Progress, Run
from grashof.synth.search.searches import nothing_to_search, searches
from grashof.synth.search.workers import working
from grashof.synth.theory.stopping import StopRequested, stopping

_LOG = logging.getLogger(__name__)


def synthesize(
    problem: Problem,
    *,
    constraints: Sequence[Constraint] = (),
    objective: OwnObjective | None = None,
    starts: int | None = None,
    enough: int | None = None,
    seed: int | None = None,
    effort: float | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    time_limit: float | None = None,
    progress: Callable[[Progress], object] | None = None,
    stop: Callable[[], bool] | None = None,
    record: Path | None = None,
    keep_record: bool = False,
    gap: float = 0.01,
    prove: bool = False,
) -> Result:
    """Find, verify and rank linkages for a problem.

    Parameters
    ----------
    problem : Problem
    constraints : sequence of callable
        Your own: functions of a `Design`, zero or negative where met, made of arithmetic that works
        on symbols (`**`, `np.hypot`, `casadi.fmax`). With more processes, functions of a module.
    objective : callable, optional
        Your own in place of the problem's: a function of the same kind that gives one scalar, smaller
        where the design is better. It decides where an ``[objective]`` would.
    starts, enough, seed : int, optional
    effort : float, optional
        Override the problem's own (see `Search`).
    workers : int
        Processes, begun once a search takes longer than a second or so. The result does not depend on it.
    executor : concurrent.futures.Executor, optional
        Where to work instead; not shut down. `workers` is its number of workers, which sets the amount of
        work begun ahead. Threads gain nothing: one of them solves at a time.
    time_limit : float, s, optional
        The search ends soon after it.
    progress : callable, optional
        Called with a `Progress` after every batch, and with the first design that a proof finds before
        the search.
    stop : callable, optional
        Called often; the search ends soon after it returns True.
    record : Path, optional
        Folder in which a search of more than two seconds is recorded while it runs; it resumes the record
        of the same search, and removes it at its end unless it was stopped. A full disk ends the record,
        not the search. Not with constraints or an objective of your own.
    keep_record : bool
        Leave the record of a complete search, too, until its list is saved.
    gap : float, deg
        Difference to which proofs bring their bounds together, 0.0001 to 90.
    prove : bool
        Give proofs minutes where they need them, not seconds.

    Returns
    -------
    Result
        Perhaps empty; then `Result.note` and `Result.nearest` show why.

    Raises
    ------
    ProblemError
        The problem, or another argument, is invalid.
    SolverError
        A worker process or the executor was lost.

    Notes
    -----
    Several threads may search at once, each with its own `stop` and `time_limit`, and judge designs by
    functions of your own; they solve in turn, and must not use CasADi beside that meanwhile.

    Examples
    --------
    >>> from grashof import load
    >>> result = synthesize(load("luggage"), enough=5)
    >>> result.best.verdict.ok, bool(result.best.verdict.error_max < 1e-9)
    (True, True)
    """
    stop_condition = StopCondition.of(time_limit, stop)
    search = search_of(problem, workers, starts=starts, enough=enough, seed=seed, effort=effort)
    refuse_no_list(constraints)
    proving = Proving.patient(gap) if prove else Proving(gap)
    if record is not None and (constraints or objective is not None):
        raise ProblemError("record does not go with constraints or an objective of your own")
    how = problem.task.kind, search.seed, search.effort, search.starts, workers
    _LOG.info("%s: %s; seed %d, effort %g, at most %d starts, %d at a time", readable(problem.name), *how)
    kinds = [ScaledProblem.of(problem.for_kind(kind), constraints, objective) for kind in problem.mechanism]
    for scaled in kinds:
        refuse_unusable(scaled, in_processes=workers > 1 or executor is not None)
    if finder_for(kinds[0]).degenerate():
        return needless(kinds[0], stop_condition)
    found: list[Result] = []
    with journal_of(record, problem, search, keep=keep_record) as journal, working(workers, executor) as work:
        run = Run(search, work, stop_condition, journal, progress, proving=proving)
        for number, scaled in enumerate(kinds, start=1):
            part = stop_condition.part(number, len(kinds))
            with stopping(part):
                run = replace(run, stop_requested=part)
                found.append(_one_kind(scaled, run, part))
            if part.ending not in (StopReason.COMPLETE, StopReason.TIME_LIMIT):
                break
    return one_list(problem, found)


def _one_kind(scaled: ScaledProblem, run: Run, stop_condition: StopCondition) -> Result:
    """The list of one kind of linkage: bounds and regions from theory, then the search."""
    with run.timed("proving"):
        bounds = bounds_before(scaled, replace(run.proving, report=run.report_proven))
        if bounds is not None and bounds.none:
            return conclude(scaled, nothing_to_search(scaled, run), run, stop_condition, bounds)
        atlas, known = None, None
        with suppress(StopRequested):  # the finder has a quick pass in place of it
            atlas = None if bounds is None else atlas_of(scaled, bounds)
            known = None if atlas is None else round_of_regions(scaled, atlas, run.search.enough)
    ledgers = searches(scaled, run, known)
    with run.timed("proving"):
        proven = bounds_after(scaled, run.proving, bounds, [each for one in ledgers for each in one.best])
        dyads = certified_of(scaled) if bounds is None else None
    by_search = proven is bounds and any(each.best for each in ledgers)
    if proven is not None and proven.found is not None and not by_search:
        solve([proven.found.linkage], ledgers[0], run)  # it was reported: a stopped search has it, too
    return conclude(scaled, ledgers, run, stop_condition, proven or dyads, atlas)
