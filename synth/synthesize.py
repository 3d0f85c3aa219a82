"""From a problem to a ranked list: starts, solves in batches, verification, ranking."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import islice
from multiprocessing import get_context
from signal import SIG_IGN, SIGINT, signal
from time import perf_counter

import numpy as np

from grashof.analysis.design import Constraint
from grashof.problems import MotionTask, Problem, ProblemError, Search, SolverError
from grashof.problems.checks import counted, finite_number, whole_number
from grashof.synth import exact_poses, paths
from grashof.synth.attempt import Attempt, attempt
from grashof.synth.explain import STOPPED, Explanation, Failure, explain
from grashof.synth.own import mended, refuse_unusable
from grashof.synth.result import Candidate, Result, ranked
from grashof.synth.setup import Setup
from grashof.synth.start import Start

BATCH = 16  # solves between two looks at what is verified; fixed, so that workers change nothing
FRUITLESS = 64  # so many solves without one verified design end the search
# So many rounds of starts on end that gain nothing, too: least squares and exact.
STALE, STALE_EXACT = 2, 20
# Least-squares designs that are enough where there is no exact one, and rounds of starts for them.
NEAR, NEAR_ROUNDS = 8, 6
GAIN = 1e-4  # of the error


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
        on symbols (`**`, `casadi.sin`, not ``np.max``). With more processes, functions of a module.
    starts, enough, seed : int, optional
        Override the problem's own (see `Search`).
    workers : int
        Processes. The result does not depend on it; a search of a second or two gains nothing.
    executor : concurrent.futures.Executor, optional
        Where to solve instead; not shut down.
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
    given = {"starts": starts, "enough": enough, "seed": seed}
    search = replace(problem.search, **{name: n for name, n in given.items() if n is not None})
    whole_number(workers, 1, "workers")
    if time_limit is not None and finite_number(time_limit, "time_limit") <= 0:
        raise ProblemError(f"time_limit is {time_limit!r}; allowed is a time in s greater than zero")
    refuse_unsupported(problem)
    begun = perf_counter()
    setup = Setup.of(problem, constraints)
    refuse_unusable(setup, in_processes=workers > 1 or executor is not None)
    reason = paths.degenerate(setup) if setup.motion is None else exact_poses.degenerate(setup)
    if reason:
        return Result(problem, (), (), {}, {"total": perf_counter() - begun}, note=f"no design: {reason}")

    def ended() -> bool:
        out_of_time = time_limit is not None and perf_counter() - begun > time_limit
        return out_of_time or (stop is not None and stop())

    return _search(setup, search, begun, ended, progress, workers, executor)


def refuse_unsupported(problem: Problem) -> None:
    """Raise `ProblemError` for a problem that this version cannot search for."""
    task = problem.task
    if not isinstance(task, MotionTask):
        return
    if problem.requirements.is_exact(task) and task.is_whole:
        exact_poses.refuse_equal_poses(task)
    elif (count := len(paths.path_target(Setup.of(problem)).points)) < 3:
        raise ProblemError(
            f"motion.poses has {counted(count, 'distinct pose')}; allowed are three or more where parts are "
            "left free or requirements.exact is false"
        )


def _search(
    setup: Setup,
    search: Search,
    begun: float,
    ended: Callable[[], bool],
    progress: Callable[[Progress], object] | None,
    workers: int,
    executor: Executor | None,
    *,
    explained: bool = True,
) -> Result:
    rng = np.random.default_rng(np.random.SeedSequence(search.seed))
    finder = exact_poses if setup.motion is not None else paths
    found = _Found(setup.problem)

    def near(problem: Problem) -> Result:
        few = replace(search, starts=min(search.starts, FRUITLESS), enough=min(search.enough, NEAR))
        other = Setup.of(problem, setup.constraints)
        return _search(other, few, perf_counter(), ended, None, 1, None, explained=False)

    complete, seconds = True, {"screening": 0.0, "solving": 0.0}
    with _solving(workers, executor) as solve:
        since = perf_counter()
        most = None if explained else NEAR_ROUNDS
        for made in islice(finder.rounds(setup, search.enough, rng), most):
            screened = perf_counter()
            seconds["screening"] += screened - since
            found.counts.update(made.counts)
            before = found.best
            _solve_round(setup, mended(setup, made.starts), search, solve, found, ended, progress)
            since = perf_counter()
            seconds["solving"] += since - screened
            found.stale = found.stale + 1 if before and not found.gained_on(before) else 0
            if not found.wants_more(search):
                break
            if ended():
                complete = False
                break
        said = Explanation("" if found.best else STOPPED)
        if not found.best and complete and explained:
            said = explain(Failure(setup, made.starts, found.rejected, found.counts), solve, near, rng, ended)
            found.best = ranked(setup.problem, list(said.designs))
            seconds["explaining"] = perf_counter() - since
    found.counts["verified and distinct"] = len(found.best)
    times = {**seconds, "total": perf_counter() - begun}
    why = _why_ended(setup, search, found, complete)
    counts = dict(found.counts)
    return Result(setup.problem, found.best, said.nearest, counts, times, said.note, complete, why)


@dataclass(slots=True)
class _Found:
    """What a search has found so far."""

    problem: Problem
    verified: list[Candidate] = field(default_factory=list)
    rejected: list[Attempt] = field(default_factory=list)
    best: tuple[Candidate, ...] = ()
    counts: Counter[str] = field(default_factory=Counter)
    solved: int = 0
    stale: int = 0

    @property
    def exact(self) -> bool:
        """Whether the designs meet every target."""
        return self.problem.requirements.is_exact(self.problem.task)

    def wants_more(self, search: Search) -> bool:
        """Whether the list is too short, solves are left and there is hope."""
        return len(self.best) < search.enough and not self.no_use(search)

    def no_use(self, search: Search) -> str:
        """Why to solve no more, however short the list is; empty where it may be of use."""
        if self.solved >= search.starts:
            return f"starts = {search.starts} allows no more"
        if self.stale >= (STALE_EXACT if self.exact else STALE):
            return (
                f"the last {self.stale} rounds of starts brought nothing {'new' if self.exact else 'better'}"
            )
        return "none of them gave a design" if not self.best and self.solved >= FRUITLESS else ""

    def gained_on(self, before: tuple[Candidate, ...]) -> bool:
        """Whether there are more exact designs than before, or a better least-squares one."""
        if self.exact:
            return len(self.best) > len(before)
        return self.best[0].score(self.problem) > (1 - GAIN) * before[0].score(self.problem)

    def take(self, attempts: list[Attempt]) -> None:
        """Count a batch, keep what is verified, and rank it."""
        for made in attempts:
            self.counts[f"solver: {made.status}"] += 1
            self.counts[_outcome(made)] += 1
            if made.candidate is not None and made.candidate.verdict.ok:
                self.verified += [made.candidate, *made.cognates]
                self.counts["cognates verified"] += len(made.cognates)
            else:
                self.rejected.append(made)
        self.solved += len(attempts)
        self.best = ranked(self.problem, self.verified)


def _solve_round(
    setup: Setup,
    starts: list[Start],
    search: Search,
    solve: Callable[[Setup, list[Start], int], list[Attempt]],
    found: _Found,
    ended: Callable[[], bool],
    progress: Callable[[Progress], object] | None,
) -> None:
    """Solve starts batch by batch until enough is found or the search is ended."""
    most, batch = min(len(starts), search.starts - found.solved), min(BATCH, search.enough)
    for begin in range(0, most, batch):
        if ended():
            return
        found.take(solve(setup, starts[begin : min(begin + batch, most)], found.solved))
        if progress is not None:
            progress(Progress(found.solved, search.starts, len(found.best), search.enough))
        if not found.wants_more(search):
            return


@contextmanager
def _solving(
    workers: int, executor: Executor | None
) -> Iterator[Callable[[Setup, list[Start], int], list[Attempt]]]:
    """A function that makes attempts, in the order of their starts, here or in other processes."""
    own = None
    if executor is None and workers > 1:
        own = executor = ProcessPoolExecutor(
            workers, mp_context=get_context("spawn"), initializer=_ignore_interrupt
        )

    def solve(setup: Setup, batch: list[Start], first: int) -> list[Attempt]:
        numbers = range(first, first + len(batch))
        if executor is None:
            return [attempt(setup, start, number) for start, number in zip(batch, numbers, strict=True)]
        try:
            return list(executor.map(attempt, [setup] * len(batch), batch, numbers))
        except BrokenExecutor as error:
            raise SolverError(f"a worker process was lost: {error}") from error

    try:
        yield solve
    finally:
        if own is not None:
            own.shutdown(cancel_futures=True)


def _ignore_interrupt() -> None:
    """Ctrl-C reaches every process of a terminal; the parent alone decides what it means."""
    signal(SIGINT, SIG_IGN)


def _outcome(result: Attempt) -> str:
    if result.candidate is None:
        return "no linkage"
    if result.candidate.verdict.ok:
        return "verified"
    return f"rejected: {result.candidate.verdict.defects[0].requirement}"


def _why_ended(setup: Setup, search: Search, found: _Found, complete: bool) -> str:
    """Why the search ended with fewer designs than are enough; empty when it has them."""
    if len(found.best) >= search.enough:
        return ""
    settled = setup.motion is not None and len(setup.targets) > 4
    exhausted = "the poses leave no freedom" if settled else "there are no other starts"
    why = (found.no_use(search) or exhausted) if complete else "it was stopped"
    return f"the search ended after {found.solved} of {counted(search.starts, 'solve')}: {why}"
