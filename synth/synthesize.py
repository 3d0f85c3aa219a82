"""From a problem to a ranked list: starts, solves in batches, verification, ranking."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import count
from time import perf_counter
from typing import Any, Protocol

import numpy as np

from grashof.analysis.judge.design import Constraint
from grashof.problems import Problem, ProblemError, Search
from grashof.problems.values.checks import counted, finite_number, whole_number
from grashof.synth.programme.nonlinear_programme import MOST_ITERATIONS
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Round, Start
from grashof.synth.programme.user_constraints import mended, refuse_unusable
from grashof.synth.results.explain import STOPPED, Explanation, Failure, explain
from grashof.synth.results.families import listed
from grashof.synth.results.ledger import EXACT_ERROR, SAME, Ledger
from grashof.synth.results.ranking import ranked
from grashof.synth.results.result import Result
from grashof.synth.results.trade_offs import Chosen, decided, of_use, offered
from grashof.synth.results.workers import Solver, solving
from grashof.synth.starts import exact_poses, paths
from grashof.synth.starts.path_screening import path_target

# Solves between two looks at what is verified, fixed, so that workers change nothing: of exact designs,
# and of least squares, where every look may spare solves.
BATCH, BATCH_LEAST_SQUARES = 16, 8
LARGER = 2  # times the draws and starts of a usual round: rounds that more effort adds
CONTINUED = 3  # times at most that the solve of the least error goes on
FEW = 8  # exact designs: with fewer, zones are filled from those of least squares, too
NEAR_EFFORT, NEAR = 0.35, 8  # of a search for designs that come near


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a search is.

    Parameters
    ----------
    solved, starts : int
        Solves done, and most that there can be.
    verified, enough : int
        Distinct verified designs, and how many are enough.
    """

    solved: int
    starts: int
    verified: int
    enough: int


def synthesize(
    problem: Problem,
    *,
    constraints: Sequence[Constraint] = (),
    starts: int | None = None,
    enough: int | None = None,
    seed: int | None = None,
    effort: float | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    time_limit: float | None = None,
    progress: Callable[[Progress], object] | None = None,
    stop: Callable[[], bool] | None = None,
) -> Result:
    """Find, verify and rank linkages for a problem.

    Parameters
    ----------
    problem : Problem
    constraints : sequence of callable
        Your own: functions of a `Design`, zero or negative where met, made of arithmetic that works
        on symbols (`**`, `np.hypot`, `casadi.fmax`). With more processes, functions of a module.
    starts, enough, seed : int, optional
    effort : float, optional
        Override the problem's own (see `Search`).
    workers : int
        Processes. The result does not depend on it; a search of a second or two gains nothing.
    executor : concurrent.futures.Executor, optional
        Where to solve instead; not shut down. Threads gain nothing: one of them solves at a time.
    time_limit : float, s, optional
        No new batch is begun after it.
    progress : callable, optional
        Called with a `Progress` after every batch.
    stop : callable, optional
        Asked before every batch; the search ends when it says True.

    Returns
    -------
    Result
        Perhaps empty; then `Result.note` and `Result.nearest` say what stood in the way.

    Raises
    ------
    ProblemError
        The problem cannot be stated to this version.
    SolverError
        A worker process or the executor was lost.

    Examples
    --------
    >>> from grashof import load
    >>> result = synthesize(load("luggage"), enough=5)
    >>> result.best.verdict.ok, bool(result.best.verdict.error_max < 1e-9)
    (True, True)
    """
    if not isinstance(problem, Problem):
        raise ProblemError(f"problem is a {type(problem).__name__}; allowed is a Problem, such as load gives")
    if isinstance(constraints, str) or not isinstance(constraints, Sequence):
        raise ProblemError(f"constraints is {constraints!r}; allowed is a list of functions of a design")
    given: dict[str, Any] = {"starts": starts, "enough": enough, "seed": seed, "effort": effort}
    search = replace(problem.search, **{name: n for name, n in given.items() if n is not None})
    whole_number(workers, 1, "workers")
    if time_limit is not None and finite_number(time_limit, "time_limit") <= 0:
        raise ProblemError(f"time_limit is {time_limit!r}; allowed is a time in s greater than zero")
    refuse_unsupported(problem)
    begun = perf_counter()
    scaled = ScaledProblem.of(problem, constraints)
    refuse_unusable(scaled, in_processes=workers > 1 or executor is not None)
    reason = paths.degenerate(scaled) if scaled.motion is None else exact_poses.degenerate(scaled)
    if reason:
        return Result(problem, (), (), {}, {"total": perf_counter() - begun}, note=f"no design: {reason}")

    def ended() -> bool:
        out_of_time = time_limit is not None and perf_counter() - begun > time_limit
        return out_of_time or (stop is not None and stop())

    with solving(workers, executor) as solve:
        seconds = {"screening": 0.0, "solving": 0.0}
        return _search(scaled, _Run(search, solve, ended, progress, seconds))


def refuse_unsupported(problem: Problem) -> None:
    """Raise `ProblemError` for a problem that this version cannot search for."""
    if problem.task.zones is not None:  # what is looked for first
        problem = problem.without_zones(exact=problem.requirements.exact)
    scaled, task = ScaledProblem.of(problem), problem.task
    if scaled.motion is not None:
        exact_poses.refuse_equal_poses(task)
    elif (count := len(path_target(scaled).points)) < 3:
        free = " where parts are left free, the driver is timed or requirements.exact is false"
        raise ProblemError(
            f"{task.kind}.{task.target}s has {counted(count, f'distinct {task.target}')}; "
            f"allowed are three or more{'' if task.only_points else free}"
        )


class Finder(Protocol):
    """A way to find starts."""

    def rounds(
        self, scaled: ScaledProblem, enough: int, rng: np.random.Generator, size: int
    ) -> Iterator[Round]:
        """Rounds of starts, the larger the more is asked for."""


@dataclass(frozen=True, slots=True)
class _Run:
    """How a search is run."""

    search: Search
    solve: Solver
    ended: Callable[[], bool]
    progress: Callable[[Progress], object] | None
    seconds: dict[str, float]


def _search(scaled: ScaledProblem, run: _Run, *, explained: bool = True) -> Result:
    """Search, choose, or explain why there is nothing to choose from."""
    begun, problem = perf_counter(), scaled.problem
    ledger, complete = _found(_without_zones(scaled), run)
    few = len(problem.task) < 3
    begin = list(ledger.verified)
    near_will_do = scaled.bounded and ledger.scaled.exact and not few
    if near_will_do and len(ledger.best) < FEW and complete:
        ledger, complete = _found(_without_zones(scaled, exact=False), run)
        begin += ledger.verified
    chosen = Chosen(ledger.best, ledger.rejected, 0)
    since = perf_counter()
    if scaled.bounded:
        chosen = decided(scaled, begin, ledger.least, ledger.solved, run.search.effort, run.solve, run.ended)
    elif not scaled.exact and ledger.best and explained:
        chosen = offered(scaled, ledger, run.solve, run.ended)
    run.seconds["choosing"] = perf_counter() - since
    best, said = chosen.designs, Explanation("" if chosen.designs else STOPPED)
    if not best and complete and explained:
        since = perf_counter()
        said = _explained(_without_zones(scaled) if few else scaled, run, ledger, chosen)
        best = ranked(problem, list(said.designs))
        run.seconds["explaining"] = perf_counter() - since
    counts = {**ledger.counts, "solves for the choice": chosen.solved, "verified and distinct": len(best)}
    times = {**run.seconds, "total": perf_counter() - begun}
    why, designs = ledger.why(complete), listed(problem, best)
    fitted = not ledger.scaled.exact and scaled.zones is None and bool(ledger.best)
    least = ledger.least * problem.task.size if fitted else np.nan
    if fitted and ledger.least <= EXACT_ERROR and problem.task.exact_by_default:
        why += "; every target can be met, and without exact = false more such designs are looked for"
    return Result(problem, designs, said.nearest, counts, times, said.note, complete, why, least)


def _without_zones(scaled: ScaledProblem, *, exact: bool = True) -> ScaledProblem:
    """The search that comes first where targets may be missed: exact if that can be, or least squares."""
    if not scaled.bounded:
        return scaled
    problem = scaled.problem
    wanted, by_default = problem.requirements, problem.task.exact_by_default
    exact = exact and wanted.error_factor is None and wanted.exact is not False and by_default
    first = problem.without_zones(exact=exact)
    without = ScaledProblem.of(first, scaled.constraints)
    return replace(without, of_use=of_use(scaled))


def _found(scaled: ScaledProblem, run: _Run) -> tuple[Ledger, bool]:
    """What the rounds of a search come to, and whether they were all gone through."""
    finder = exact_poses if scaled.motion is not None else paths
    ledger, complete = Ledger(scaled, run.search), True
    since = perf_counter()
    for made in _rounds(scaled, finder, ledger):
        screened = perf_counter()
        run.seconds["screening"] += screened - since
        ledger.begin(made)
        _solve_round(scaled, made, ledger, run)
        since = perf_counter()
        run.seconds["solving"] += since - screened
        if run.ended():
            complete = ledger.done or ledger.ended
            break
    if not scaled.exact:
        _solve_to_the_end(scaled, ledger, run)
    return ledger, complete


def _solve_to_the_end(scaled: ScaledProblem, ledger: Ledger, run: _Run) -> None:
    """Go on from the least error where its solve stopped for want of iterations."""
    for _ in range(CONTINUED):
        best = min(ledger.verified, key=lambda one: one.error(scaled.problem), default=None)
        if best is None or best.iterations < MOST_ITERATIONS or run.ended():
            return
        before, start = ledger.least, Start.of_linkage(scaled, best.linkage, best.verdict)
        ledger.take(run.solve(scaled, [start], ledger.solved))
        if ledger.least > before * (1 - SAME):
            return


def _explained(scaled: ScaledProblem, run: _Run, ledger: Ledger, chosen: Chosen) -> Explanation:
    search = run.search

    def near(problem: Problem) -> Result:
        few = replace(search, effort=NEAR_EFFORT, enough=min(search.enough, NEAR))
        alone = replace(run, search=few, progress=None, seconds=dict.fromkeys(run.seconds, 0.0))
        return _search(ScaledProblem.of(problem, scaled.constraints), alone, explained=False)

    failure = Failure(scaled, ledger.latest, chosen.rejected, ledger.counts)
    rng = np.random.default_rng(np.random.SeedSequence(search.seed, spawn_key=(0,)))
    return explain(failure, run.solve, near, rng, run.ended)


def _rounds(scaled: ScaledProblem, finder: Finder, ledger: Ledger) -> Iterator[Round]:
    """Rounds until what the effort asks for is done: those of ``effort = 1`` first, then larger ones."""
    for number in count():
        seed = np.random.SeedSequence(ledger.search.seed, spawn_key=(number,) if number else ())
        rng, size, any_starts = np.random.default_rng(seed), LARGER if number else 1, False
        for made in finder.rounds(scaled, ledger.search.enough, rng, size):
            any_starts = any_starts or bool(made.starts)
            yield made
            if ledger.done or (not number and ledger.ended):
                break
        if not number:
            ledger.plan_more()
        if ledger.done or not any_starts:
            return


def _solve_round(scaled: ScaledProblem, made: Round, ledger: Ledger, run: _Run) -> None:
    """Solve starts batch by batch until enough is found or the search is ended."""
    starts, enough = mended(scaled, made.starts), ledger.search.enough
    batch = min(BATCH, enough) if scaled.exact else BATCH_LEAST_SQUARES
    for begin in range(0, len(starts), batch):
        if run.ended() or not ledger.within_round():
            return
        some = ledger.worthwhile(made, starts[begin : begin + batch], first=begin == 0)
        if some:
            ledger.take(run.solve(scaled, some[: ledger.starts - ledger.solved], ledger.solved))
        if run.progress is not None:
            run.progress(Progress(ledger.solved, ledger.starts, len(ledger.best), enough))
