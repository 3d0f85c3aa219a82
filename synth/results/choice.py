"""Which searches a problem takes, and what is chosen from their designs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems import Problem
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.results.ledger import EXACT_ERROR, Ledger
from grashof.synth.results.search import Run, search_designs
from grashof.synth.results.trade_offs import Chosen, trade_offs
from grashof.synth.results.within_bounds import best_within_bounds, error_of_use
from grashof.synth.starts.finder import asked_first

FEW = 8  # exact designs: with fewer, zones are filled from those of least squares, too


def searches(scaled: ScaledProblem, run: Run) -> list[Ledger]:
    """The search as it is asked; where targets may be missed, one or two without.

    First with all of them met, where that can be expected; then by least squares, where few do. Two
    poses leave least squares nothing to make small.
    """

    def search(problem: Problem) -> Ledger:
        asked = ScaledProblem.of(problem, scaled.constraints)
        return search_designs(replace(asked, of_use=error_of_use(scaled)), run)

    first = search(asked_first(scaled.problem))
    met_by_few = first.scaled.exact and len(first.best) < FEW
    if scaled.bounded and met_by_few and first.complete and len(scaled.targets) > 2:
        return [first, search(scaled.problem.without_zones())]
    return [first]


def choose(scaled: ScaledProblem, ledgers: list[Ledger], run: Run) -> Chosen:
    """All exact designs, a choice about the least error, or the best where targets may be missed."""
    ledger = ledgers[-1]
    with run.timed("choosing"):
        if scaled.bounded:
            found = [candidate for each in ledgers for candidate in each.verified]
            return best_within_bounds(scaled, found, ledger, run)
        if not scaled.exact and ledger.best:
            return trade_offs(scaled, ledger, run)
    return Chosen(ledger.best, ledger.rejected, 0)


def least_error(scaled: ScaledProblem, ledger: Ledger) -> float:
    """The least error that a search found, length; NaN for exact designs, and where zones allow errors."""
    fitted = not ledger.scaled.exact and scaled.zones is None and bool(ledger.best)
    return ledger.least * scaled.problem.task.size if fitted else np.nan


def why_ended(scaled: ScaledProblem, ledger: Ledger) -> str:
    """Why the search ended, and that exact designs could be asked for where least squares are."""
    fitted = not np.isnan(least_error(scaled, ledger)) and ledger.least <= EXACT_ERROR
    if not (fitted and scaled.problem.task.exact_by_default):
        return ledger.why
    more = "every target can be met, and without exact = false more such designs are looked for"
    return f"{ledger.why}; {more}"
