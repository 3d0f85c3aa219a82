"""How a search is run: where its steps are made, what is recorded, who asks it to stop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any, TypeVar

from grashof.problems import Search
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Round, Start
from grashof.synth.results.attempt import Attempt
from grashof.synth.results.journal import Journal, Unrecorded
from grashof.synth.results.ledger import Ledger
from grashof.synth.results.workers import Work, screen

EXPECTED = 3  # rounds that most searches take: so many are begun ahead
T = TypeVar("T")


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
    since : float, s
        When it began.
    """

    search: Search
    work: Work
    asked_to_stop: Callable[[], bool]
    journal: Journal = field(default_factory=Unrecorded)
    progress: Callable[[Progress], object] | None = None
    seconds: dict[str, float] = field(default_factory=lambda: {"screening": 0.0, "solving": 0.0})
    since: float = field(default_factory=perf_counter)

    @property
    def times(self) -> dict[str, float]:
        """Time by stage, and in all."""
        return {**self.seconds, "total": perf_counter() - self.since}

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
        return self.step("solve", (first, *starts), scaled, lambda: self.work.attempts(scaled, starts, first))

    def screened(self, scaled: ScaledProblem, number: int) -> Round | None:
        """One round of a search."""
        which = (number, self.search.enough, self.search.seed)
        if not self.journal.recorded:
            for later in range(number + 1, min(number + self.work.width, EXPECTED)):
                self.work.begin(screen, scaled, 0, later, *which[1:])
        return self.step("screen", which, scaled, lambda: self.work.made(screen, scaled, 0, *which))

    def step(self, kind: str, of: tuple[Any, ...], scaled: ScaledProblem, do: Callable[[], T]) -> T:
        """The result of a step of the search, as recorded or done now."""
        return self.journal.done(kind, of, scaled.problem, lambda: self.whole(do()))

    def begin(self, scaled: ScaledProblem, starts: list[Start]) -> None:
        """Begin solves that may be wanted, where that costs no time."""
        if not self.journal.recorded:
            self.work.begin_attempts(scaled, starts)

    def tell(self, ledger: Ledger) -> None:
        """Report how far the search is to who wants to know."""
        if self.progress is not None:
            enough = self.search.enough
            self.progress(Progress(ledger.solved, ledger.starts, len(ledger.best), enough))

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Add the time of what is inside to a stage."""
        since = perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + perf_counter() - since
