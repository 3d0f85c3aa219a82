"""One search: rounds of starts, solved batch by batch until the ledger has enough."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count
from time import perf_counter
from typing import TypeVar

import numpy as np

from grashof.problems import Problem, Search
from grashof.synth.programme.nonlinear_programme import MOST_ITERATIONS
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Round, Start
from grashof.synth.programme.user_functions import mended
from grashof.synth.results.attempt import Attempt
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.journal import Journal, Unrecorded
from grashof.synth.results.ledger import SAME, Ledger
from grashof.synth.results.workers import CRASHED, Work
from grashof.synth.starts.finder import Finder, asked_first, finder_for, rounds
from grashof.synth.theory.stopping import Stopped

_LOG = logging.getLogger(__name__)
# Solves between two looks at what is verified, fixed, so that workers change nothing: of exact designs,
# and of least squares, where every look may spare solves.
BATCH, BATCH_LEAST_SQUARES = 16, 8
EXPECTED = 3  # rounds that most searches take: so many are begun ahead
LAST = 8  # solves at most of a search that is stopped before it has a design
T = TypeVar("T")
LARGER = 2  # times the draws and starts of a usual round: rounds that more effort adds
FEW = 8  # exact designs: with fewer, zones are filled from those of least squares, too
CONTINUED = 3  # times at most that the solve of the least error goes on


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a search is.

    Parameters
    ----------
    solved, starts : int
        Solves done, and most that there can be.
    enough : int
        How many distinct verified designs are enough.
    designs : tuple of Candidate
        Those found so far, best first: accepted under what this search asks for (`Candidate.problem`),
        all targets met or least squares, before a choice is made of them. ``Result(problem, designs)``
        makes a list of them.
    """

    solved: int
    starts: int
    enough: int
    designs: tuple[Candidate, ...] = field(default=(), repr=False)

    @property
    def verified(self) -> int:
        """How many distinct verified designs there are."""
        return len(self.designs)


@dataclass(frozen=True, slots=True)
class Run:
    """How a search is run.

    Parameters
    ----------
    search : Search
    work : Work
        Where screenings and attempts are made.
    asked_to_stop : callable
        Asked between solves: to be content with what there is.
    journal : Journal
    progress : callable, optional
        Called with a `Progress` after every batch.
    seconds : dict
        Time by stage.
    crashed : list of int
        Numbers of the starts that end the process that solves them.
    """

    search: Search
    work: Work
    asked_to_stop: Callable[[], bool]
    journal: Journal = field(default_factory=Unrecorded)
    progress: Callable[[Progress], object] | None = None
    seconds: dict[str, float] = field(default_factory=lambda: {"screening": 0.0, "solving": 0.0})
    crashed: list[int] = field(default_factory=list)

    def ended(self) -> bool:
        """Whether to be content with what there is; nothing is recorded any more then."""
        if not self.asked_to_stop():
            return False
        self.journal.close()
        return True

    def whole(self, result: T) -> T:
        """A result, which is recorded only if it was not cut short."""
        self.ended()
        return result

    def solve(self, scaled: ScaledProblem, starts: list[Start], first: int) -> list[Attempt]:
        """Attempts from starts, numbered from a first one, in their order."""
        if not starts:
            return []
        step = ("solve", (first, *starts), scaled.problem)
        made = self.journal.done(*step, lambda: self.whole(self.work.attempts(scaled, starts, first)))
        self._log(made, first)
        return made

    def _log(self, made: list[Attempt], first: int) -> None:
        for number, one in enumerate(made, first):
            if one.status == CRASHED:
                self.crashed.append(number)
                _LOG.warning("start %d ends the process that solves it, and is given up", number)
            elif _LOG.isEnabledFor(logging.DEBUG):
                _LOG.debug("start %d: %s, %s", number, one.outcome, one.status)

    def screened(self, scaled: ScaledProblem, effort: int, number: int) -> Round | None:
        """One round of a search; those that more effort adds are larger."""
        which = (effort, number, self.search.enough, self.search.seed, LARGER)
        if not self.journal.recorded:
            for later in range(number + 1, min(number + self.work.width, EXPECTED)):
                self.work.begin_screening(scaled, effort, later, *which[2:])
        return self.journal.done(
            "screen", which, scaled.problem, lambda: self.whole(self.work.screened(scaled, *which))
        )

    def begin(self, scaled: ScaledProblem, starts: list[Start]) -> None:
        """Begin solves that may be wanted, where that costs no time."""
        if not self.journal.recorded:
            self.work.begin_attempts(scaled, starts)

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Add the time of what is inside to a stage."""
        since = perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + perf_counter() - since


def searches(scaled: ScaledProblem, run: Run) -> list[Ledger]:
    """The search as it is asked; where targets may be missed, one or two without.

    First with all of them met, where that can be expected; then by least squares, where few do. Two
    poses leave least squares nothing to make small.
    """

    def search(problem: Problem) -> Ledger:
        asked = scaled.of_problem(problem)
        return search_designs(replace(asked, of_use=error_of_use(scaled)), run)

    first = search(asked_first(scaled.problem))
    met_by_few = first.scaled.exact and len(first.best) < FEW
    if scaled.bounded and met_by_few and first.complete and len(scaled.targets) > 2:
        return [first, search(scaled.problem.without_zones())]
    return [first]


def search_designs(scaled: ScaledProblem, run: Run) -> Ledger:
    """Find starts, solve from them, and keep what is verified, round by round until there is enough."""
    finder = finder_for(scaled)
    ledger = Ledger(scaled, run.search, finder.exhausted)
    _LOG.info("search begun: %s, %d targets", type(finder).__name__, len(scaled.targets))
    for number, found in enumerate(_rounds(finder, ledger, run), start=1):
        with run.timed("solving"):
            _solve_round(found, ledger, run)
        error = "" if scaled.exact else f", least error {ledger.least:.3g} sizes"
        told = number, len(found.starts), ledger.solved, ledger.starts, len(ledger.best), error
        _LOG.info("round %d: %d starts; %d of %d solves, %d designs%s", *told)
        if run.ended():
            ledger.complete = ledger.done or ledger.ended
            break
    if not scaled.exact:
        _continue_best(ledger, run)
    return ledger


def _rounds(finder: Finder, ledger: Ledger, run: Run) -> Iterator[Round]:
    """Rounds until what the effort asks for is done: those of ``effort = 1`` first, then larger ones."""
    for effort in count():
        any_starts = False
        for found in rounds(finder, partial(_timed_round, ledger, run, effort)):
            any_starts = any_starts or bool(found.starts)
            yield found
            if ledger.done or (not effort and ledger.ended):
                break
        if not effort:
            ledger.plan_more()
        if ledger.done or not any_starts:
            return


def _timed_round(ledger: Ledger, run: Run, effort: int, number: int) -> Round | None:
    """One round; none where it was stopped before it had any start."""
    with run.timed("screening"):
        try:
            return run.screened(ledger.scaled, effort, number)
        except Stopped:
            ledger.complete = False
            return None


def _solve_round(found: Round, ledger: Ledger, run: Run) -> None:
    """Solve starts batch by batch until enough is found or the search is ended."""
    ledger.begin(found)
    scaled, enough = ledger.scaled, run.search.enough
    starts = mended(scaled, found.starts)
    batch = min(BATCH, enough) if scaled.exact else BATCH_LEAST_SQUARES
    for begin in range(0, len(starts), batch):
        ended = run.ended()
        if not ledger.within_round or (ended and (ledger.best or begin)):
            return
        some = ledger.worthwhile(found, starts[begin : begin + (LAST if ended else batch)], first=begin == 0)
        run.begin(scaled, some + ledger.promising(found, starts[begin + batch :]))
        if some:
            _solve(some[: ledger.starts - ledger.solved], ledger, run)
        _tell(ledger, run)


def _continue_best(ledger: Ledger, run: Run) -> None:
    """Go on from the least error where its solve stopped for want of iterations."""
    scaled = ledger.scaled
    for _ in range(CONTINUED):
        best = min(ledger.verified, key=lambda one: one.error(scaled.problem), default=None)
        if best is None or best.iterations < MOST_ITERATIONS or run.ended():
            return
        before = ledger.least
        _solve([Start.of_linkage(scaled, best.linkage, best.verdict)], ledger, run)
        _tell(ledger, run)
        if ledger.least > before * (1 - SAME):
            return


def _tell(ledger: Ledger, run: Run) -> None:
    if run.progress is not None:
        run.progress(Progress(ledger.solved, ledger.starts, run.search.enough, ledger.best))


def _solve(starts: list[Start], ledger: Ledger, run: Run) -> None:
    """Solve and verify, then rank what is verified."""
    ledger.take(run.solve(ledger.scaled, starts, ledger.solved))
    ledger.rank()


def error_of_use(scaled: ScaledProblem) -> float:
    """Up to which error a design is of use where zones are allowed, root mean square, sizes."""
    if scaled.zones is None:
        return 0.0
    zones = np.where(np.isfinite(scaled.zones), scaled.zones, 0.0)
    square = (scaled.weights * zones[0] ** 2 + scaled.turn_weights * zones[1] ** 2).sum()
    return float(np.sqrt(square / len(scaled.targets)))
