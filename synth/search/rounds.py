"""A round of starts, solved batch by batch."""

from __future__ import annotations

from collections.abc import Sequence

from grashof.synth.programme.start import Proposal, Round
from grashof.synth.programme.user_functions import mended
from grashof.synth.search.ledger import Ledger
from grashof.synth.search.run import Run

# Solves between two looks at what is verified, fixed, so that workers change nothing: of exact designs,
# and of least squares, where every look may spare solves.
BATCH, BATCH_LEAST_SQUARES = 16, 8
EARLY = 2  # first solves after which is told what there is; nothing is decided there
LAST = 8  # solves at most of a search that is stopped before it has a design


def solve_round(found: Round, ledger: Ledger, run: Run) -> None:
    """Solve starts batch by batch until enough is found or the search is ended."""
    ledger.begin(found)
    scaled = ledger.scaled
    starts = mended(scaled, found.starts)
    batch = min(BATCH, run.search.enough) if scaled.exact else BATCH_LEAST_SQUARES
    batch = len(starts) if found.together else batch
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
            run.tell(ledger)
        if some:
            solve(some, ledger, run)
        run.tell(ledger)


def solve(starts: Sequence[Proposal], ledger: Ledger, run: Run) -> None:
    """Solve and verify, then rank what is verified."""
    ledger.take(run.solve(ledger.scaled, starts, ledger.solved))
    ledger.rank()
