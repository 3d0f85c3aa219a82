"""A round of starts, solved batch by batch, and chunks: rounds that do not depend on each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from grashof.problems import Search
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.programme.user_functions import mended
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import finder_for
from grashof.synth.search.ledger import Chunk, Ledger
from grashof.synth.search.recorded_designs import is_true_chunk
from grashof.synth.search.run import Run
from grashof.synth.search.workers import CrashError, Work, screen
from grashof.synth.theory.stopping import raise_if_stopped, stop_requested

CHUNK = "chunk"  # kind of step
CHUNKS = 4  # of a search of effort 1 in shards, among which its solves are divided
AHEAD = 3  # chunks begun for each process before they are known to be needed
# Solves between two checks of the verified designs, fixed, so that workers change nothing: of exact designs,
# and of least squares, where every check may save solves.
BATCH, BATCH_LEAST_SQUARES = 16, 8
EARLY = 2  # first solves after which progress is reported; nothing is decided there
LAST = 8  # solves at most of a search that is stopped before it has a design


def chunk(scaled: ScaledProblem, number: int, enough: int, seed: int, starts: int) -> Chunk:
    """One chunk of at most `starts` solves, a function of its arguments; may raise `StopRequested`."""
    return _made_by(Work(), scaled, number, enough, seed, starts)


def _made_by(work: Work, scaled: ScaledProblem, number: int, enough: int, seed: int, starts: int) -> Chunk:
    search = Search(starts=starts, enough=enough, seed=seed)
    ledger = Ledger(scaled, search, "")
    ledger.plan_more()  # only the number of starts ends it
    effort, of_pass = divmod(number, finder_for(scaled).rounds_a_pass)
    found = work.made(screen, scaled, effort, of_pass, enough, seed)
    if found is not None:
        solve_round(found, ledger, Run(search, work, stop_requested))
    raise_if_stopped()
    return ledger.chunk


def chunks(scaled: ScaledProblem, run: Run, numbers: Sequence[int], starts: int) -> Iterator[Chunk]:
    """Chunks of at most `starts` solves by number, several at a time; may raise `StopRequested`."""
    rest = arguments(run.search, starts)
    for place, number in enumerate(numbers):
        if not run.journal.recorded:
            first, *later = numbers[place : place + AHEAD * run.work.width]
            anew = run.work.begin(chunk, scaled, first, *rest)  # at the beginning, or after a loss
            for each in later if anew else later[-1:]:
                run.work.begin(chunk, scaled, each, *rest)
        make = partial(_made, run.work, scaled, number, *rest)
        yield run.step(CHUNK, (number, *rest), scaled, make, partial(is_true_chunk, scaled))


def begin_chunks(scaled: ScaledProblem, run: Run, numbers: Sequence[int], starts: int) -> None:
    """Begin some that will be needed, one for each process, while there is little else to do."""
    if not run.journal.recorded:
        for number in numbers[: run.work.width]:
            run.work.begin(chunk, scaled, number, *arguments(run.search, starts))


def starts_of_chunk(search: Search) -> int:
    """Most solves of a chunk."""
    return max(1, search.starts // CHUNKS)


def arguments(search: Search, starts: int) -> tuple[int, int, int]:
    """Arguments of `chunk` besides the problem and the number."""
    return search.enough, search.seed, starts


def _made(work: Work, scaled: ScaledProblem, *given: Any) -> Chunk:
    """A chunk; solve by solve where it ends the process that makes it, so that a single start is lost."""
    try:
        return work.made(chunk, scaled, *given)
    except CrashError:
        return _made_by(work, scaled, *given)


def solve_round(found: Round, ledger: Ledger, run: Run) -> None:
    """Solve starts batch by batch until enough is found or the search is ended."""
    ledger.begin(found)
    scaled = ledger.scaled
    starts = mended(scaled, found.starts)
    batch = min(BATCH, run.search.enough) if scaled.exact else BATCH_LEAST_SQUARES
    batch = max(1, len(starts)) if found.together else batch
    for begin in range(0, len(starts), batch):
        ended = run.ended()
        if not ledger.within_round or (ended and (ledger.best or begin)):
            return
        some = [
            *ledger.worthwhile(found, starts[begin : begin + (LAST if ended else batch)], first=begin == 0)
        ]
        run.begin(scaled, some + ledger.promising(found, starts[begin + batch :]))
        some = some[: ledger.starts - ledger.solved]
        if not ledger.solved and len(some) > EARLY:
            early, some = some[:EARLY], some[EARLY:]
            solve(early, ledger, run)
            run.report(ledger)
        if some:
            solve(some, ledger, run)
        run.report(ledger)


def solve(starts: Sequence[Proposal], ledger: Ledger, run: Run) -> None:
    """Solve and verify, then rank the verified designs."""
    ledger.take(run.solve(ledger.scaled, starts, ledger.solved))
    ledger.rank()
