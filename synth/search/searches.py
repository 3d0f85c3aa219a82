"""One search: rounds of starts, solved until the ledger has enough, then chunks that more effort adds."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import chain
from math import ceil

import numpy as np

from grashof.synth.programme.nonlinear_programme import MOST_ITERATIONS
from grashof.synth.programme.start import Round, Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.chunks import begin_chunks, chunks, solve, solve_round, starts_of_chunk
from grashof.synth.search.finder import asked_first, finder_for, rounds
from grashof.synth.search.ledger import SAME, Ledger
from grashof.synth.search.run import Run
from grashof.synth.search.workers import LARGER
from grashof.synth.starts.finder import Finder
from grashof.synth.theory.stopping import StopRequested

_LOG = logging.getLogger(__name__)
MANY = 64  # starts below which none is spent on a first quick pass
FEW = 8  # exact designs: with fewer, zones are filled from those of least squares, too
CONTINUED = 3  # times at most that the solve of the least error is continued


def searches(scaled: ScaledProblem, run: Run, known: Round | None = None) -> list[Ledger]:
    """The search for a problem; where targets may be missed, one or two without that."""
    first, *second = problems_in_turn(scaled)
    ledger = search_designs(first, run, known)
    if second and ledger.complete and found_few(ledger):  # least squares, where few meet all targets
        return [ledger, search_designs(second[0], run)]
    return [ledger]


def problems_in_turn(scaled: ScaledProblem) -> tuple[ScaledProblem, ...]:
    """The problems that are searched: as stated, or without zones, and then, perhaps, by least squares."""
    problems = [asked_first(scaled.problem)]
    first = scaled.of_problem(problems[0])
    if scaled.bounded and first.exact and len(scaled.targets) > 2:  # two leave no error to minimise
        problems.append(scaled.problem.without_zones())
    return tuple(replace(scaled.of_problem(each), of_use=error_of_use(scaled)) for each in problems)


def found_few(ledger: Ledger) -> bool:
    """Whether exact designs are so few that least squares is tried, too, where it may be."""
    return len(ledger.best) < FEW


def nothing_to_search(scaled: ScaledProblem, run: Run) -> list[Ledger]:
    """The empty ledger of a problem that is proven to have no design."""
    first = problems_in_turn(scaled)[0]
    return [Ledger(first, run.search, finder_for(first).exhausted)]


def search_designs(scaled: ScaledProblem, run: Run, known: Round | None = None) -> Ledger:
    """Find starts, solve from them, and keep verified designs, round by round until there are enough."""
    finder = finder_for(scaled)
    ledger = Ledger(scaled, run.search, finder.exhausted)
    _LOG.info("search begun: %s, %d targets", type(finder).__name__, len(scaled.targets))
    _begin_more(finder, ledger, run)
    # they make the first round; where these are enough, nothing else is looked for
    given = [known] if known is not None and known.starts else []
    for number, found in enumerate(chain(given, _rounds(finder, ledger, run)), start=1):
        with run.timed("solving"):
            solve_round(found, ledger, run)
        _log(f"round {number}", len(found.starts), ledger)
        if run.ended() and (ledger.best or found.size):
            ledger.complete = ledger.ended
            break
        if ledger.ended:
            break
    if ledger.complete and not run.ended() and not (given and ledger.enough):
        _do_more(finder, ledger, run)
    return finished(ledger, run)


def finished(ledger: Ledger, run: Run) -> Ledger:
    """The ledger of a search after its last solves, which continue from the best designs."""
    if ledger.scaled.by_descent:
        _continue_best(ledger, run)
    elif ledger.complete and not run.ended():
        with run.timed("solving"):
            _look_onward(ledger, run)
        if not ledger.scaled.exact and ledger.scaled.problem.task.in_plane:
            _continue_best(ledger, run)
    return ledger


def _look_onward(ledger: Ledger, run: Run) -> None:
    """Judge linkages that the designs of a search lead to; designs stay where that is cut short."""
    try:
        more = run.onward(ledger)
    except StopRequested:
        ledger.complete = False
        return
    if more:
        solve(more, ledger, run)
        run.report(ledger)


def _begin_more(finder: Finder, ledger: Ledger, run: Run) -> None:
    """Begin chunks that more effort will need."""
    surely = ceil((run.search.effort - 1) / (1 if ledger.scaled.exact else LARGER))
    first = finder.rounds_a_pass
    begin_chunks(ledger.scaled, run, range(first, first + max(0, surely)), starts_of_chunk(run.search))


def _do_more(finder: Finder, ledger: Ledger, run: Run) -> None:
    """The work of more effort: the same work `effort` - 1 times more, in chunks."""
    more = run.search.effort - 1
    size = 1 if ledger.scaled.exact else LARGER
    count = ceil(more * ledger.work / size) if more > 0 and ledger.solved else 0
    ledger.plan_more()
    if not count:
        return
    starts = max(1, min(starts_of_chunk(run.search), round(more * run.search.starts / count)))
    numbers = range(finder.rounds_a_pass, finder.rounds_a_pass + count)
    with run.timed("more effort"):
        try:
            for number, one in enumerate(chunks(ledger.scaled, run, numbers, starts), start=1):
                ledger.absorb(one)
                run.report(ledger)
                _log(f"chunk {number} of {count}", one.solved, ledger)
        except StopRequested:
            pass  # the usual effort is done


def _log(what: str, starts: int, ledger: Ledger) -> None:
    error = "" if ledger.scaled.exact else f", least error {ledger.least:.3g} sizes"
    counts = starts, ledger.solved, ledger.starts, len(ledger.best)
    _LOG.info("%s: %d starts; %d of %d solves, %d designs%s", what, *counts, error)


def _rounds(finder: Finder, ledger: Ledger, run: Run) -> Iterator[Round]:
    """The quick pass, where a finder has one and starts are not few, and the rounds."""
    quick_pass = None
    if ledger.starts >= MANY:
        with run.timed("screening"), suppress(StopRequested):
            quick_pass = run.quick_pass(ledger.scaled)
    if quick_pass is not None:
        yield quick_pass
    yield from rounds(finder, partial(_timed_round, ledger, run))


def _timed_round(ledger: Ledger, run: Run, number: int) -> Round | None:
    """One round; none where it was stopped before it had any start."""
    with run.timed("screening"):
        try:
            return run.screened(ledger.scaled, number)
        except StopRequested:
            ledger.complete = False
            return None


def _continue_best(ledger: Ledger, run: Run) -> None:
    """Continue from the least error where its solve ran out of iterations."""
    scaled = ledger.scaled
    for _ in range(CONTINUED):
        best = min(ledger.verified, key=lambda one: one.error(scaled.problem), default=None)
        if best is None or best.iterations < MOST_ITERATIONS or run.ended():
            return
        before = ledger.least
        solve([Start.of_linkage(scaled, best.linkage, best.verdict)], ledger, run)
        run.report(ledger)
        if ledger.least > before * (1 - SAME):
            return


def error_of_use(scaled: ScaledProblem) -> float:
    """Greatest error of a useful design where zones are allowed, root mean square, sizes."""
    if scaled.zones is None:
        return 0.0
    zones, task = np.where(np.isfinite(scaled.zones), scaled.zones, 0.0), scaled.problem.task
    square = task.weights @ (zones[0] ** 2 + (task.angle_length / scaled.frame.scale * zones[1]) ** 2)
    return float(np.sqrt(square / len(task)))
