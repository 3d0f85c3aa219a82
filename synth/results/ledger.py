"""What a search has found so far, and when it is enough."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import ceil

import numpy as np

from grashof.problems import Search
from grashof.problems.values.arrays import ComplexArray
from grashof.problems.values.checks import counted
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Round, Start
from grashof.synth.results.attempt import Attempt
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.ranking import ranked

FRUITLESS = 64  # so many solves without one verified exact design end the search
STALE = 20  # so many rounds on end without a new exact design, too
# Least squares: the best has come up in so many rounds, or so many rounds are done.
AGREEING, MOST_ROUNDS = 3, 8
SAME = 1e-3  # share: errors closer to the best one are the best one
COPY = 0.1  # of the promise: starts closer at all targets end alike
COPY_FLOOR = 1e-3  # sizes: where limits bind, closer than that at least
EXACT_ERROR = 1e-7  # sizes: no error to speak of


@dataclass(slots=True)
class Ledger:
    """Bookkeeping of a search.

    Parameters
    ----------
    scaled : ScaledProblem
    search : Search
    """

    scaled: ScaledProblem
    search: Search
    verified: list[Candidate] = field(default_factory=list)
    rejected: list[Attempt] = field(default_factory=list)
    best: tuple[Candidate, ...] = ()
    counts: Counter[str] = field(default_factory=Counter)
    solved: int = 0
    rounds: int = 0
    work: int = 0
    planned: float = np.inf
    latest: list[Start] = field(default_factory=list)
    _stale: int = 0
    _least: list[float] = field(default_factory=list)
    _begun: list[ComplexArray] = field(default_factory=list)

    @property
    def starts(self) -> int:
        """Most solves; `effort` times as many once the rounds of ``effort = 1`` are done."""
        more = 1.0 if np.isinf(self.planned) else max(1.0, self.search.effort)
        return round(self.search.starts * more)

    def begin(self, made: Round) -> None:
        """Open a round."""
        self.counts.update(made.counts)
        self.rounds += 1
        self.latest = made.starts
        self.work += made.size
        self._least.append(np.inf)
        self._stale += bool(self.best)

    def worthwhile(self, made: Round, starts: Sequence[Start], *, first: bool) -> list[Start]:
        """Those of some starts that may yet lead to something; the first of a round always."""
        if self.scaled.exact:
            return list(starts)
        chosen = []
        for number, start in enumerate(starts):
            confirms = first and number == 0
            if confirms or not (self._too_far(made, start) or self._known(made, start)):
                chosen.append(start)
                self._begun.append(_marks(made, start))
        return chosen

    def take(self, attempts: list[Attempt]) -> None:
        """Count a batch, keep what is verified, and rank it."""
        before = len(self.best)
        for made in attempts:
            self.counts[f"solver: {made.status}"] += 1
            self.counts[_outcome(made)] += 1
            if made.candidate is not None and made.candidate.verdict.ok:
                self.verified += [made.candidate, *made.cognates]
                self.counts["cognates verified"] += len(made.cognates)
                self._least[-1] = min(self._least[-1], made.candidate.error(self.scaled.problem))
            else:
                self.rejected.append(made)
        self.solved += len(attempts)
        self.best = ranked(self.scaled.problem, self.verified)
        if len(self.best) > before:
            self._stale = 0

    @property
    def least(self) -> float:
        """Least error of all verified designs, sizes."""
        return min(self._least, default=np.inf)

    @property
    def came_up(self) -> int:
        """In how many rounds the least error came up."""
        return sum(error <= max(self.least * (1 + SAME), EXACT_ERROR) for error in self._least)

    def within_round(self) -> bool:
        """Whether the round may go on."""
        if self.solved >= self.starts:
            return False
        if not self.scaled.exact or self.work > self.planned:
            return True
        return len(self.best) < self.search.enough and not self._fruitless

    def plan_more(self) -> None:
        """End the rounds of ``effort = 1``; what is left of a greater effort follows."""
        self.planned = self.work

    @property
    def done(self) -> bool:
        """Whether all is done that the effort asks for."""
        return self.work >= self.search.effort * self.planned or self.solved >= self.starts

    @property
    def ended(self) -> bool:
        """Whether the rounds of ``effort = 1`` (or less) have done what can be expected of them."""
        if self.scaled.exact:
            return len(self.best) >= self.search.enough or bool(self.no_use)
        share = min(1.0, self.search.effort)
        agreed = self.came_up >= ceil(AGREEING * share) and self.rounds >= ceil(AGREEING * share)
        exactly = self.least <= EXACT_ERROR
        return agreed or exactly or self.rounds >= max(1, round(MOST_ROUNDS * share)) or bool(self.no_use)

    @property
    def no_use(self) -> str:
        """Why to solve no more, however short the list is; empty where it may be of use."""
        if self.solved >= self.starts:
            return f"starts = {self.starts} allows no more"
        if self.scaled.exact and self._stale >= STALE * min(1.0, self.search.effort):
            return f"the last {self._stale} rounds of starts brought nothing new"
        return "none of them gave a design" if self.scaled.exact and self._fruitless else ""

    @property
    def _fruitless(self) -> bool:
        return not self.best and self.solved >= FRUITLESS * min(1.0, self.search.effort)

    def why(self, complete: bool) -> str:
        """Why the search ended; for exact designs, only where there are fewer than enough."""
        solves = f"{self.solved} of {counted(self.starts, 'solve')}"
        if not complete:
            return f"the search ended after {solves}: it was stopped"
        if not self.scaled.exact:
            solves = counted(self.solved, "solve")
            agreed = f"the best came up in {self.came_up} of {counted(self.rounds, 'round')}"
            return f"the search ended after {solves}: {agreed if self.best else 'no design came up'}"
        if len(self.best) >= self.search.enough:
            return ""
        settled = self.scaled.motion is not None and len(self.scaled.targets) > 4
        exhausted = "the poses leave no freedom" if settled else "there are no other starts"
        return f"the search ended after {solves}: {self.no_use or exhausted}"

    def _too_far(self, made: Round, start: Start) -> bool:
        return start.promise > max(made.prune * max(self.least, EXACT_ERROR), self.scaled.of_use)

    def _known(self, made: Round, start: Start) -> bool:
        marks = _marks(made, start)
        near = max(COPY * start.promise, 0.0 if made.free else COPY_FLOOR)
        return any(
            other.shape == marks.shape and float(np.abs(other - marks).max()) < near for other in self._begun
        )


def _marks(made: Round, start: Start) -> ComplexArray:
    """What tells starts apart: P at all targets, and where limits bind A and B, too."""
    track = start.track[:, np.argsort(start.visit)]
    return track[2:] if made.free else track


def _outcome(result: Attempt) -> str:
    if result.candidate is None:
        return "no linkage"
    if result.candidate.verdict.ok:
        return "verified"
    return f"rejected: {result.candidate.verdict.defects[0].requirement}"
