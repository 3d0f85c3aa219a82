"""The designs found so far, counts of the search, and when it ends."""

from __future__ import annotations

from bisect import insort
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields, replace
from math import ceil

import numpy as np

from grashof.problems import Problem, Search
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.text import counted
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.ranking import ranking_key
from grashof.synth.programme.start import Proposal, Round, Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import Attempt, Outcome
from grashof.synth.theory.distinct import DISTINCT, apart, task_signature

FRUITLESS = 64  # solves without a verified exact design after which the search ends
STALE = 20  # consecutive rounds without a new exact design after which it ends
# Least squares: rounds that found the best design, or rounds in all, after which the search ends.
AGREEING, MOST_ROUNDS = 3, 8
REACHED = 8  # draws of one round that led to the best: where one is enough, the round confirms itself
SAME = 1e-3  # share: errors closer to the best one are the best one
COPY = 0.1  # of the expected_error: starts closer at all targets lead to the same design
COPY_FLOOR = 1e-3  # sizes: where limits bind, closer than that at least
EXACT_ERROR = 1e-7  # sizes: a negligible error
# Designs that a search remembers, or twice as many as are enough, and misses of each kind.
MOST_KEPT, OF_KIND = 2000, 8


COGNATES, CHOICE, LISTED = (
    "cognates verified",
    "solves for the choice",
    "verified and distinct",
)  # totals of a search


@dataclass(frozen=True, slots=True)
class Tally:
    """Counts of a search."""

    found: Counter[str] = field(default_factory=Counter)  # by the search for starts, such as "feasible finds"
    outcomes: Counter[Outcome] = field(default_factory=Counter)  # of solves
    totals: Counter[str] = field(default_factory=Counter)  # `COGNATES`, `CHOICE`, `LISTED`
    rejected: Counter[str] = field(default_factory=Counter)  # solves by the first requirement missed
    statuses: Counter[str] = field(default_factory=Counter)  # solves by Ipopt's return status

    def add(self, attempts: Iterable[Attempt]) -> None:
        """Count attempts."""
        for one in attempts:
            self.statuses[one.status] += 1
            self.outcomes[one.outcome] += 1
            if one.verified:
                self.totals[COGNATES] += len(one.cognates)
            elif one.candidate is not None:
                self.rejected[one.candidate.verdict.defects[0].requirement] += 1

    def update(self, other: Tally) -> None:
        """Add the counts of another part of the search."""
        for mine in fields(self):
            getattr(self, mine.name).update(getattr(other, mine.name))

    @property
    def general(self) -> dict[str, int]:
        """All but rejections and statuses, by name."""
        ended = {str(each): self.outcomes[each] for each in self.outcomes if each is not Outcome.REJECTED}
        return {**self.found, **ended, **self.totals}

    @property
    def recorded(self) -> dict[str, int]:
        """All counts in one, as ``run.json`` has them."""
        rejected = {f"rejected: {requirement}": n for requirement, n in self.rejected.items()}
        return {**self.general, **rejected, **{f"solver: {status}": n for status, n in self.statuses.items()}}


@dataclass(frozen=True, slots=True)
class Chunk:
    """The outcome of one round, for the ledger of another process."""

    tally: Tally
    designs: tuple[Candidate, ...]  # verified; of those that are not distinct the best
    misses: tuple[Attempt, ...]  # rejected; the nearest of each kind
    solved: int
    size: int  # the work of the round, in usual rounds


@dataclass(slots=True)
class Leaders:
    """All designs added so far, ranked as by `ranked`; each is valued and compared with the others once."""

    problem: Problem
    _every: list[Candidate] = field(default_factory=list)
    _order: list[tuple[tuple[float, ...], int]] = field(default_factory=list)  # keys and numbers, best first
    _alike: list[list[int]] = field(default_factory=list)  # numbers of those not distinct from each
    _signatures: FloatArray = field(default_factory=lambda: np.empty((0, 0)))

    def __len__(self) -> int:
        return len(self._every)

    def add(self, candidates: Iterable[Candidate]) -> None:
        """Add designs."""
        for candidate in candidates:
            number, numbers = len(self._every), task_signature(self.problem.task, candidate.linkage)
            if number == len(self._signatures):
                grown = np.empty((max(16, 2 * number), len(numbers)))
                grown[:number] = self._signatures[:number] if number else 0.0
                self._signatures = grown
            near = np.flatnonzero(~(apart(numbers, self._signatures[:number]) > DISTINCT)).tolist()
            self._signatures[number] = numbers
            self._every.append(candidate)
            self._alike.append(near)
            for other in near:
                self._alike[other].append(number)
            insort(self._order, (ranking_key(self.problem, candidate), number))

    @property
    def distinct(self) -> tuple[Candidate, ...]:
        """Distinct designs, best first; of two that are not distinct the better one."""
        out, chosen = bytearray(len(self._every)), list[Candidate]()
        for _, number in self._order:
            if not out[number]:
                chosen.append(self._every[number])
                for other in self._alike[number]:
                    out[other] = 1
        return tuple(chosen)


@dataclass(slots=True)
class Ledger:
    """Bookkeeping of a search for exact designs, as many as are enough, or for the least error."""

    scaled: ScaledProblem
    search: Search
    exhausted: str  # why a search ends after all its rounds
    verified: list[Candidate] = field(default_factory=list)
    rejected: list[Attempt] = field(default_factory=list)
    best: tuple[Candidate, ...] = ()
    tally: Tally = field(default_factory=Tally)
    latest: Sequence[Proposal] = ()
    complete: bool = True
    solved: int = 0
    work: int = 0
    planned: float = np.inf
    _errors: list[float] = field(default_factory=list)  # the least of each round, sizes
    _reached: int = 0  # draws of the latest round that led to its best start
    _stale: int = 0  # consecutive rounds without a new design
    _begun: list[ComplexArray] = field(default_factory=list)  # marks of starts that were solved
    _leaders: Leaders = field(init=False)

    def __post_init__(self) -> None:
        self._leaders = Leaders(self.scaled.problem)

    def begin(self, made: Round) -> None:
        """Open a round."""
        self.tally.found.update(made.counts)
        self.latest = made.starts
        self.work += made.size
        self._errors.append(np.inf)
        self._reached = made.reached
        self._stale += bool(self.best)

    def worthwhile(self, made: Round, starts: Sequence[Proposal], *, first: bool) -> Sequence[Proposal]:
        """Of least squares the promising starts, and the first of a round; else all."""
        if self.scaled.exact:
            return starts
        chosen = list[Proposal]()
        for number, start in enumerate(starts):
            if not isinstance(start, Start):
                chosen.append(start)
                continue
            confirms, marks = first and number == 0, _marks(made, start)
            if confirms or not (self._too_far(made, start) or self._known(made, start, marks)):
                chosen.append(start)
                self._begun.append(marks)
        return chosen

    def promising(self, made: Round, starts: Sequence[Proposal]) -> list[Proposal]:
        """Starts that may be worthwhile when it is their turn."""
        return [start for start in starts if self.scaled.exact or not self._too_far(made, start)]

    def take(self, attempts: list[Attempt]) -> None:
        """Count a batch, and keep the verified designs."""
        self.tally.add(attempts)
        self.solved += len(attempts)
        for one in attempts:
            self.verified += one.verified
            if one.verified:
                error = one.verified[0].error(self.scaled.problem)
                self._errors[-1:] = [min([*self._errors[-1:], error])]  # a stopped search may have no round
            else:
                self.rejected.append(one)

    def rank(self) -> None:
        """Rank the verified, distinct designs, and forget useless ones."""
        self._leaders.add(self.verified[len(self._leaders) :])
        before, self.best = len(self.best), self._leaders.distinct
        if len(self.best) > before:
            self._stale = 0
        self._forget()

    def absorb(self, one: Chunk) -> None:
        """Add the next chunk."""
        self.tally.update(one.tally)
        problem = self.scaled.problem
        designs = [replace(each, problem=problem, start=self.solved + each.start) for each in one.designs]
        self.verified += designs
        self.rejected += one.misses
        self.solved += one.solved
        self.work += one.size
        if one.size:
            self._errors.append(min((each.error(problem) for each in designs), default=np.inf))
        self.rank()

    @property
    def chunk(self) -> Chunk:
        """The ledger as a chunk."""
        return Chunk(self.tally, self.best, nearest_of_kinds(self.rejected), self.solved, self.work)

    def _forget(self) -> None:
        """Keep memory bounded: of very many designs and misses keep the best."""
        most = max(MOST_KEPT, 2 * self.search.enough)
        if len(self.rejected) > 2 * most:
            self.rejected = list(nearest_of_kinds(self.rejected))
        if len(self.verified) > 2 * most:
            self.verified = list(self.best[:most])
            self._leaders = Leaders(self.scaled.problem)
            self._leaders.add(self.verified)

    def plan_more(self) -> None:
        """End the rounds of ``effort = 1``; the rest of a greater effort follows."""
        self.planned = self.work

    @property
    def starts(self) -> int:
        """Most solves; `effort` times as many once the rounds of ``effort = 1`` are done."""
        more = 1.0 if np.isinf(self.planned) else max(1.0, self.search.effort)
        return round(self.search.starts * more)

    @property
    def least(self) -> float:
        """Least error of all verified designs, sizes."""
        return min(self._errors, default=np.inf)

    @property
    def within_round(self) -> bool:
        """Whether the round may continue."""
        if self.solved >= self.starts:
            return False
        return not self.scaled.exact or self.work > self.planned or not (self.enough or self._fruitless)

    @property
    def ended(self) -> bool:
        """Whether the rounds of ``effort = 1`` (or less) are done."""
        if self.scaled.exact:
            return self.enough or bool(self._no_use)
        share = min(1.0, self.search.effort)
        if not self.scaled.by_descent:
            return bool(self._no_use)
        sure = bool(self.best) and self._reached >= REACHED and self._is_least(self._errors[-1])
        agreeing = 2 - sure if self.search.enough == 1 else AGREEING
        agreed, many = self._came_up >= ceil(agreeing * share), max(1, round(MOST_ROUNDS * share))
        return agreed or len(self._errors) >= many or bool(self._no_use)

    @property
    def why(self) -> str:
        """Why the search ended; for exact designs, only where there are fewer than enough."""
        solves = counted(self.solved, "solve")
        if self.solved <= self.starts:  # more of them continue from designs
            solves = f"{self.solved} of {counted(self.starts, 'solve')}"
        if not self.complete:
            none = "" if self.best else "; no design came up so far"
            return f"the search ended after {solves}: it was stopped{none}"
        if self.scaled.exact:
            reason = self._no_use or self.exhausted
            return "" if self.enough else f"the search ended after {solves}: {reason}"
        if not self.scaled.by_descent:
            return f"the search ended after {solves}: {self._no_use}" if self._no_use else ""
        agreed = f"the best came up in {self._came_up} of {counted(len(self._errors), 'round')}"
        reason = agreed if self.best else "no design came up"
        return f"the search ended after {counted(self.solved, 'solve')}: {reason}"

    @property
    def enough(self) -> bool:
        """Whether there are as many exact designs as requested."""
        return self.scaled.exact and len(self.best) >= self.search.enough

    @property
    def exhaustive(self) -> bool:
        """Whether every existing start was solved."""
        return self.complete and not self.enough and self.solved < self.starts

    @property
    def all_rounds_done(self) -> bool:
        """Whether every round was made, and none was ended as useless."""
        return self.exhaustive and not self._no_use

    @property
    def _came_up(self) -> int:
        """Number of rounds that found the least error."""
        return sum(map(self._is_least, self._errors))

    def _is_least(self, error: float) -> bool:
        return error <= max(self.least * (1 + SAME), EXACT_ERROR)

    @property
    def _no_use(self) -> str:
        """Why further solves are useless, however short the list is; empty where they may help."""
        if self.solved >= self.starts:
            return f"starts = {self.starts} allows no more"
        if self.scaled.exact and self._stale >= STALE * min(1.0, self.search.effort):
            return f"the last {self._stale} rounds of starts brought nothing new"
        return "none of them gave a design" if self.scaled.exact and self._fruitless else ""

    @property
    def _fruitless(self) -> bool:
        return not self.best and self.solved >= FRUITLESS * min(1.0, self.search.effort)

    def _too_far(self, made: Round, start: Proposal) -> bool:
        expected_error = start.expected_error if isinstance(start, Start) else 0.0
        return expected_error > max(made.prune * max(self.least, EXACT_ERROR), self.scaled.of_use)

    def _known(self, made: Round, start: Start, marks: ComplexArray) -> bool:
        near = max(COPY * start.expected_error, 0.0 if made.free else COPY_FLOOR)
        return any(
            other.shape == marks.shape and float(np.abs(other - marks).max()) < near for other in self._begun
        )


def nearest_of_kinds(attempts: Iterable[Attempt]) -> tuple[Attempt, ...]:
    """The few nearest of the rejected designs that miss the same requirements, in their order."""
    kinds: dict[frozenset[str], list[tuple[float, int, Attempt]]] = {}
    for number, one in enumerate(attempts):
        if one.candidate is not None:
            defects = one.candidate.verdict.defects
            kind = kinds.setdefault(frozenset(each.requirement for each in defects), [])
            insort(kind, (sum(each.miss for each in defects), number, one))
            del kind[OF_KIND:]
    kept = sorted((number, one) for kind in kinds.values() for _, number, one in kind)
    return tuple(one for _, one in kept)


def _marks(made: Round, start: Start) -> ComplexArray:
    """Points that distinguish starts: P at all targets, and where limits bind A and B, too."""
    track = start.track[:, np.argsort(start.visit)]
    return track[2:] if made.free else track
