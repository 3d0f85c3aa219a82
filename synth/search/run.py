"""How a search is run: where its steps are made, how they are recorded, when it stops."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from time import perf_counter
from typing import Any, TypeVar

import numpy as np

from grashof.problems import Search
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.proof.claims.bounds import Proving
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.finder import finder_for
from grashof.synth.search.journal import Journal
from grashof.synth.search.ledger import Ledger, nearest_of_kinds
from grashof.synth.search.recorded_designs import are_attempts, is_round
from grashof.synth.search.workers import CRASHED, Work, screen
from grashof.synth.starts.finder import DesignFinder

_LOG = logging.getLogger(__name__)
EXPECTED = 3  # rounds that most searches take, begun ahead
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Progress:
    """Progress of a search.

    Parameters
    ----------
    solved : int
        Solves done.
    starts : int, optional
        Most solves, if known.
    enough : int
        Number of distinct verified designs that is enough.
    designs : tuple of Candidate
        Those found so far, best first: accepted under the requirements of this search
        (`Candidate.problem`), all targets met or least squares, before a choice is made of them.
        ``Result(problem, designs)`` makes a list of them.
    """

    solved: int
    starts: int | None
    enough: int
    designs: tuple[Candidate, ...] = field(default=(), repr=False)

    @property
    def verified(self) -> int:
        """Number of distinct verified designs."""
        return len(self.designs)


@dataclass(frozen=True, slots=True)
class Run:
    """How a search is run."""

    search: Search
    work: Work  # where screenings and attempts are made
    stop_requested: Callable[[], bool]  # called between solves: whether to accept the current results
    journal: Journal = field(default_factory=Journal)
    progress: Callable[[Progress], object] | None = None  # called after every batch
    seconds: dict[str, float] = field(default_factory=lambda: {"screening": 0.0, "solving": 0.0})  # by stage
    since: float = field(default_factory=perf_counter)  # when it began, s
    crashed: list[int] = field(default_factory=list)  # numbers of starts that end the process solving them
    proving: Proving = field(default_factory=Proving)  # limits of proofs

    @property
    def times(self) -> dict[str, float]:
        """Time by stage, and in all."""
        return {**self.seconds, "total": perf_counter() - self.since}

    def ended(self) -> bool:
        """Whether to accept the current results; nothing more is recorded then."""
        if not self.stop_requested():
            return False
        self.journal.close()
        return True

    def solve(self, scaled: ScaledProblem, starts: Sequence[Proposal], first: int) -> list[Attempt]:
        """Attempts from starts, numbered from a first one, in their order."""
        if not starts:
            return []
        of = (first, *starts)
        is_valid = partial(are_attempts, scaled, starts)
        made = self.step("solve", of, scaled, lambda: self.work.attempts(scaled, starts, first), is_valid)
        for number, one in enumerate(made, first):
            if one.status == CRASHED:
                self.crashed.append(number)
                _LOG.warning("start %d ends the process that solves it, and is skipped", number)
            elif _LOG.isEnabledFor(logging.DEBUG):
                _LOG.debug("start %d: %s, %s", number, one.outcome, one.status)
        return made

    def quick_pass(self, scaled: ScaledProblem) -> Round | None:
        """Starts found at once, before the first round."""
        seed = self.search.seed
        rng = np.random.default_rng(seed)
        return self.step("quick_pass", (seed,), scaled, lambda: finder_for(scaled).quick_pass(rng), is_round)

    def onward(self, ledger: Ledger) -> Sequence[Proposal]:
        """Proposals of a `DesignFinder` that continue from designs and the nearest misses."""
        scaled, finder = ledger.scaled, finder_for(ledger.scaled)
        if not isinstance(finder, DesignFinder):
            return ()
        misses = [each.candidate for each in nearest_of_kinds(ledger.rejected) if each.candidate is not None]
        of = tuple(each.id for each in (*ledger.best, *misses))
        found = self.step(
            "onward", of, scaled, lambda: Round(finder.onward(ledger.best, misses), {}), is_round
        )
        return found.starts

    def screened(self, scaled: ScaledProblem, number: int) -> Round | None:
        """One round of a search."""
        of = (number, self.search.enough, self.search.seed)
        if not self.journal.recorded:
            for later in range(number + 1, min(number + self.work.width, EXPECTED)):
                self.work.begin(screen, scaled, 0, later, *of[1:])
        return self.step("screen", of, scaled, lambda: self.work.made(screen, scaled, 0, *of), is_round)

    def step(
        self,
        kind: str,
        of: tuple[Any, ...],
        scaled: ScaledProblem,
        do: Callable[[], T],
        is_valid: Callable[[object], bool],
    ) -> T:
        """The result of a step of the search, as recorded where that `is_valid`, or computed now."""

        def done() -> T:
            result = do()
            self.ended()  # a result that was cut short is not recorded
            return result

        return self.journal.done(kind, of, scaled.problem, done, is_valid)

    def begin(self, scaled: ScaledProblem, starts: Sequence[Proposal]) -> None:
        """Begin solves that may be needed, where that costs no time."""
        if not self.journal.recorded:
            self.work.begin_attempts(scaled, starts)

    def report(self, ledger: Ledger) -> None:
        """Report the progress of the search."""
        if self.progress is not None:
            self.progress(Progress(ledger.solved, ledger.starts, self.search.enough, ledger.best))

    def report_proven(self, design: Candidate) -> None:
        """Report a design that a proof finds before the search begins."""
        if self.progress is not None:
            self.progress(Progress(0, self.search.starts, self.search.enough, (design,)))

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Add the time of the block to a stage."""
        since = perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + perf_counter() - since
