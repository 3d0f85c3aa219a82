"""A search in chunks: rounds of starts with all that comes of them, none of which depends on another one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from grashof.problems import Search
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import finder_for
from grashof.synth.search.ledger import Chunk, Ledger
from grashof.synth.search.recorded_designs import is_true_chunk
from grashof.synth.search.rounds import solve_round
from grashof.synth.search.run import Run
from grashof.synth.search.workers import CrashError, Here, Work, screen
from grashof.synth.theory.stopping import raise_if_stopped, stop_requested

CHUNK = "chunk"  # kind of step
CHUNKS = 4  # that a search of effort 1 has in shards: each has so great a share of its solves
AHEAD = 3  # chunks begun for each process before it is known that they are wanted


def chunk(scaled: ScaledProblem, number: int, enough: int, seed: int, starts: int) -> Chunk:
    """One chunk of at most `starts` solves, a function of its arguments; `StopRequested` if asked to end."""
    return _made_by(Here(), scaled, number, enough, seed, starts)


def _made_by(work: Work, scaled: ScaledProblem, number: int, enough: int, seed: int, starts: int) -> Chunk:
    search = Search(starts=starts, enough=enough, seed=seed)
    ledger = Ledger(scaled, search, "")
    ledger.plan_more()  # nothing but the number of starts ends it
    effort, of_pass = divmod(number, finder_for(scaled).rounds_a_pass)
    found = work.made(screen, scaled, effort, of_pass, enough, seed)
    if found is not None:
        solve_round(found, ledger, Run(search, work, stop_requested))
    raise_if_stopped()
    return ledger.chunk


def chunks(scaled: ScaledProblem, run: Run, numbers: Sequence[int], starts: int) -> Iterator[Chunk]:
    """Chunks of at most `starts` solves by number, several at a time; `StopRequested` if asked to end."""
    rest = which(run.search, starts)
    for place, number in enumerate(numbers):
        if not run.journal.recorded:
            first, *later = numbers[place : place + AHEAD * run.work.width]
            anew = run.work.begin(chunk, scaled, first, *rest)  # at the beginning, or after a loss
            for each in later if anew else later[-1:]:
                run.work.begin(chunk, scaled, each, *rest)
        make = partial(_made, run.work, scaled, number, *rest)
        yield run.step(CHUNK, (number, *rest), scaled, make, partial(is_true_chunk, scaled))


def begin_chunks(scaled: ScaledProblem, run: Run, numbers: Sequence[int], starts: int) -> None:
    """Begin some that will be wanted, one for each process, while there is little else to do."""
    if not run.journal.recorded:
        for number in numbers[: run.work.width]:
            run.work.begin(chunk, scaled, number, *which(run.search, starts))


def starts_of_chunk(search: Search) -> int:
    """Most solves of a chunk."""
    return max(1, search.starts // CHUNKS)


def which(search: Search, starts: int) -> tuple[int, int, int]:
    """All that `chunk` is given but the problem and the number."""
    return search.enough, search.seed, starts


def _made(work: Work, scaled: ScaledProblem, *given: Any) -> Chunk:
    """A chunk; solve by solve where it ends the process that makes it, so that one start alone is lost."""
    try:
        return work.made(chunk, scaled, *given)
    except CrashError:
        return _made_by(work, scaled, *given)
