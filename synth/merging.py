"""Shards merged: the list of the complete search."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, fields
from itertools import chain
from pathlib import Path

from grashof.problems import Problem, ProblemError, Search
from grashof.problems.files.on_disk import file_text
from grashof.problems.files.problem_file import problem_of
from grashof.problems.values.checks import located
from grashof.problems.values.text import plain_text
from grashof.synth.proof.provers import bounds_after, bounds_before
from grashof.synth.results.conclusion import conclude, needless
from grashof.synth.results.lists import one_list
from grashof.synth.results.result import Result
from grashof.synth.search.chunks import CHUNK, arguments
from grashof.synth.search.history import StopCondition
from grashof.synth.search.journal import (
    COMPLETE,
    HEAD,
    head_of,
    read_head,
    recorded_steps,
    refuse_other,
    step_name,
)
from grashof.synth.search.ledger import Chunk, Ledger
from grashof.synth.search.plain import restored
from grashof.synth.search.recorded_designs import agrees, is_complete_chunk
from grashof.synth.search.run import Progress, Run
from grashof.synth.search.searches import finished, found_few
from grashof.synth.search.workers import working
from grashof.synth.shards import PROBLEM, SHARDS, Plan, Shard
from grashof.synth.theory.stopping import stopping

NAMED = 12  # shards that a message names


@dataclass(frozen=True, slots=True)
class Shards:
    """The shards in a folder."""

    folder: Path
    of: int  # shards of the search
    done: tuple[Shard, ...]  # the complete ones
    problem: Problem
    text: str  # the problem file
    search: Search

    @classmethod
    def found(cls, folder: Path) -> Shards:
        """The shards in a folder; ProblemError without any, or if not of one search with these versions."""
        there = sorted(_named(folder), key=lambda shard: (shard.of, shard.number))
        if not there:
            raise ProblemError(
                f"{folder}: has no shards; grashof solve PROBLEM --shard I/N --out {folder} makes them"
            )
        if there[0].of != there[-1].of:
            both = f"{there[0].of} and of {there[-1].of}"
            raise ProblemError(f"{folder / SHARDS}: has shards of {both}; they must be of one search")
        first = folder / SHARDS / there[0].folder
        problem, text, search = _of_shard(first)
        done = []
        for shard in there:
            own = folder / SHARDS / shard.folder
            refuse_other(own, head_of(problem, search, name=problem.name, shard=str(shard)))
            if read_head(own).get(COMPLETE) is True:
                done.append(shard)
        return cls(folder, there[0].of, tuple(done), problem, text, search)

    @property
    def lacking(self) -> str:
        """The shards not done, in words; empty where all are done."""
        done = {shard.number for shard in self.done}
        numbers = [str(number) for number in range(1, self.of + 1) if number not in done]
        if not numbers:
            return ""
        more = f" and {len(numbers) - NAMED} more" if len(numbers) > NAMED else ""
        several = "s" if len(numbers) > 1 else ""
        return f"shard{several} {', '.join(numbers[:NAMED])}{more} of {self.of}"

    def chunks(self, ledgers: list[Ledger], plan: Plan) -> Iterator[tuple[Ledger, Chunk]]:
        """All chunks in their order, each with the ledger of its problem."""
        steps = {shard.number: recorded_steps(self.folder / SHARDS / shard.folder) for shard in self.done}
        for turn, ledger in enumerate(ledgers):
            for number in range(plan.count):
                shard = Shard((turn * plan.count + number) % self.of + 1, self.of)
                if shard.number not in steps:
                    continue
                name = step_name(CHUNK, (number, *arguments(self.search, plan.starts)))
                step = next(steps[shard.number], {})
                try:
                    if step["step"] != name:
                        raise ValueError(name)
                    chunk = restored(step["result"], ledger.scaled.problem)
                    if not isinstance(chunk, Chunk) or not is_complete_chunk(ledger.scaled, chunk):
                        raise ValueError(name)
                except (ValueError, KeyError, TypeError):
                    raise _damaged(self.folder / SHARDS / shard.folder) from None
                yield ledger, chunk


def merge_shards(
    folder: Path,
    *,
    partial: bool = False,
    workers: int = 1,
    progress: Callable[[Progress], object] | None = None,
    stop: Callable[[], bool] | None = None,
) -> Result:
    """The list of a search whose shards, of any number, are in a folder.

    `partial` accepts that some are not done; `workers`, `progress` and `stop` are as in `synthesize`.
    ProblemError where shards are missing or not done, or not of one search made with these versions.

    >>> import tempfile
    >>> from grashof import load
    >>> from grashof.synth.shards import solve_shard
    >>> with tempfile.TemporaryDirectory() as name:
    ...     made = solve_shard(load("luggage"), Shard(1, 2), Path(name), starts=8)
    ...     merge_shards(Path(name), partial=True).best.verdict.ok
    True
    """
    stop_condition, shards = StopCondition.of(None, stop), Shards.found(folder)
    if shards.lacking and not partial:
        raise ProblemError(f"{folder}: {shards.lacking} to be done; --partial merges the others")
    if not shards.done:
        raise ProblemError(f"{folder}: none of its shards is done; the command that began one continues it")
    plan = Plan.of(shards.problem, shards.search)
    if not plan.problems:
        return needless(plan.stated[0], stop_condition)
    with stopping(stop_condition), working(workers, None) as work:
        run = Run(shards.search, work, stop_condition, progress=progress)
        ledgers = [[plan.ledger(scaled, plan.count) for scaled in each] for each in plan.searched]
        every = list(chain.from_iterable(ledgers))
        with run.timed("merging"):
            for ledger, chunk in shards.chunks(every, plan):
                ledger.absorb(chunk)
                run.report(ledger)
            for ledger in every:
                _refuse_unverified(folder, ledger)
        found = []
        for scaled, (first, *second) in zip(plan.stated, ledgers, strict=True):
            used = [first, *second] if found_few(first) else [first]
            done = [finished(ledger, run) for ledger in used]
            bounds = bounds_before(scaled, run.proving)
            bounds = bounds_after(scaled, run.proving, bounds, [each for one in done for each in one.best])
            found.append(conclude(scaled, done, run, stop_condition, bounds))
        return one_list(plan.problem, found)


def _named(folder: Path) -> Iterator[Shard]:
    """Shards that have a folder."""
    for path in (folder / SHARDS).glob("*-of-*"):
        with suppress(ValueError):  # not ours
            yield Shard.named(path.name)


def _of_shard(own: Path) -> tuple[Problem, str, Search]:
    """The problem of a shard, the file that states it, and its search options."""
    head, path = read_head(own), own / PROBLEM
    if path.exists() and not path.is_file():  # a pipe or a device may never end
        raise ProblemError(f"{path}: is not a problem file; delete {own}, and run the shard again")
    text = file_text(path, "a problem file", "")
    try:
        name = plain_text(head.get("name"), "name")  # type: ignore[arg-type]  # refused there
        search = Search(**{field.name: head.get(field.name) for field in fields(Search)})  # type: ignore[arg-type]
    except ProblemError as error:
        raise located(error, str(own / HEAD)) from None
    return problem_of(text, str(path), name), text, search


def _refuse_unverified(folder: Path, ledger: Ledger) -> None:
    """Judge again the designs of a list, or the misses of an empty one: a file may contain anything."""
    misses = [one.candidate for one in ledger.rejected if one.candidate is not None]
    for one in ledger.best or misses:
        if not agrees(ledger.scaled, one):
            raise _damaged(folder / SHARDS)


def _damaged(path: Path) -> ProblemError:
    return ProblemError(f"{path}: is damaged; delete it, and run the shard again")
