"""A search in shards, which share nothing but a folder: for batch clusters."""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path

from grashof.problems import Problem, Search
from grashof.problems.files.on_disk import write_whole
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.errors import wrong_value
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.chunks import CHUNKS, chunks, starts_of_chunk
from grashof.synth.search.finder import finder_for, search_of
from grashof.synth.search.history import StopCondition
from grashof.synth.search.journal import Journal, head_of
from grashof.synth.search.ledger import Ledger
from grashof.synth.search.run import Progress, Run
from grashof.synth.search.searches import problems_in_turn
from grashof.synth.search.workers import working
from grashof.synth.theory.stopping import StopRequested, stopping

_LOG = logging.getLogger(__name__)
SHARDS = "shards"  # their folder
PROBLEM = "problem.toml"
MOST = 100_000  # shards of a search


@dataclass(frozen=True, slots=True)
class Shard:
    """Part `number` of a search divided into `of`; the first is 1."""

    number: int
    of: int

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.of <= MOST:
            raise wrong_value("--shard", str(self), f"I/N with I from 1 to N, and N up to {MOST}")

    @classmethod
    def stated(cls, text: str) -> Shard:
        """The shard that a text such as 7/200 states."""
        number, _, of = text.partition("/")
        if not (number.isdecimal() and of.isdecimal() and len(text) < 2 * len(str(MOST)) + 2):
            raise wrong_value("--shard", text, "I/N, such as 7/200")
        return cls(int(number), int(of))

    @classmethod
    def named(cls, name: str) -> Shard:
        """The shard whose folder has a name; `ValueError` for any other name."""
        number, of = name.split("-of-")
        shard = cls(int(number), int(of))
        if shard.folder != name:
            raise ValueError(name)
        return shard

    def __str__(self) -> str:
        return f"{self.number}/{self.of}"

    @property
    def folder(self) -> str:
        """Name of its folder."""
        return f"{self.number:04}-of-{self.of:04}"


@dataclass(frozen=True, slots=True)
class ShardOutcome:
    """The outcome of a shard."""

    chunks: int  # that are done
    of: int  # chunks in all
    solved: int
    designs: int  # distinct and verified
    complete: bool  # no work is left


@dataclass(frozen=True, slots=True)
class Plan:
    """All chunks of a search: `count` of each of its problems."""

    problem: Problem
    stated: tuple[ScaledProblem, ...]  # for each kind of linkage
    searched: tuple[tuple[ScaledProblem, ...], ...]  # for each kind; empty where the targets need no linkage
    search: Search

    @classmethod
    def of(cls, problem: Problem, search: Search) -> Plan:
        """The plan of a search."""
        stated = tuple(ScaledProblem.of(problem.for_kind(kind)) for kind in problem.mechanism)
        needed = not finder_for(stated[0]).degenerate()
        return cls(problem, stated, tuple(map(problems_in_turn, stated)) if needed else (), search)

    @property
    def problems(self) -> tuple[ScaledProblem, ...]:
        """All problems that are searched, one after another."""
        return tuple(chain.from_iterable(self.searched))

    def ledger(self, scaled: ScaledProblem, chunks: int) -> Ledger:
        """The ledger of `chunks` chunks of a problem, without an early end."""
        search = replace(self.search, starts=max(1, chunks * self.starts), effort=1.0)
        ledger = Ledger(scaled, search, "all its chunks are done")
        ledger.plan_more()
        return ledger

    @property
    def count(self) -> int:
        """Chunks of each problem."""
        return max(1, round(CHUNKS * self.search.effort))

    @property
    def starts(self) -> int:
        """Most solves of a chunk."""
        return starts_of_chunk(self.search)

    def numbers(self, shard: Shard) -> list[range]:
        """Numbers of the chunks of a shard, for each problem: every `shard.of`-th of all."""
        begins = [shard.number - 1 - turn * self.count for turn in range(len(self.problems))]
        return [range(begin % shard.of, self.count, shard.of) for begin in begins]


def solve_shard(
    problem: Problem,
    shard: Shard,
    folder: Path,
    *,
    text: str | None = None,
    starts: int | None = None,
    enough: int | None = None,
    seed: int | None = None,
    effort: float | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    time_limit: float | None = None,
    progress: Callable[[Progress], object] | None = None,
    stop: Callable[[], bool] | None = None,
) -> ShardOutcome:
    """Make all chunks of a shard and leave them in a folder, for `merge_shards`.

    Recorded chunks are not repeated. The search has four chunks for each unit of effort: rounds of starts
    that do not depend on each other, none of which ends it early. `folder` is the same for all shards, `text`
    is the problem file; the others are as in `synthesize`, `starts`, `enough`, `seed` and `effort` the same
    for all shards. ProblemError where the problem, or another argument, is invalid, or the folder has this
    shard of another search; SolverError where a worker process or the executor was lost.
    """
    stop_condition = StopCondition.of(time_limit, stop)
    search = search_of(problem, workers, starts=starts, enough=enough, seed=seed, effort=effort)
    plan, own = Plan.of(problem, search), folder / SHARDS / shard.folder
    numbers = plan.numbers(shard)
    head = head_of(problem, search, name=problem.name, shard=str(shard))
    journal = Journal(own, head, needed=True)  # refuses another search
    own.mkdir(parents=True, exist_ok=True)
    write_whole(own / PROBLEM, problem_toml(problem) if text is None else text)
    journal.begin()
    done = 0
    ledgers = [plan.ledger(*each) for each in zip(plan.problems, map(len, numbers), strict=True)]
    with stopping(stop_condition), working(workers, executor) as work:
        run = Run(search, work, stop_condition, journal, progress)
        try:
            for ledger, mine in zip(ledgers, numbers, strict=True):
                for one in chunks(ledger.scaled, run, mine, plan.starts):
                    ledger.absorb(one)
                    done += 1
                    run.report(ledger)
                    counts = done, ledger.solved, len(ledger.best)
                    _LOG.info("shard %s: %d chunks, %d solves, %d designs", shard, *counts)
        except StopRequested:
            journal.close()
        complete = journal.is_open
        if complete:
            journal.finish()
        journal.close()
    solved, designs = (sum(each.solved for each in ledgers), sum(len(each.best) for each in ledgers))
    return ShardOutcome(done, sum(map(len, numbers)), solved, designs, complete)
