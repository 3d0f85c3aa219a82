"""The choice from the designs of a search: all, trade-offs, or the best where targets may be missed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.problems import Problem
from grashof.synth.designs.candidate import Candidate, same_error
from grashof.synth.designs.judging import judged_in_time
from grashof.synth.designs.ranking import ranked
from grashof.synth.proof.claims.proof import quantity_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.larger_zones import nearest_zones
from grashof.synth.results.lists import within_factor
from grashof.synth.results.trade_offs import LEAST, Chosen, seeds_of, started_at, trade_offs
from grashof.synth.search.ledger import EXACT_ERROR, Ledger
from grashof.synth.search.run import Run
from grashof.synth.search.searches import error_of_use

NEAR = 1.6  # times the error that is allowed: solves begin from least-squares designs up to it
SAME_LEAST, NO_ERROR = 1.001, 1e-9  # times the least error, or errors, that count as the least one
LEVEL, AT = 5.0, 0.01  # deg of transmission: steps of lists, and the tolerance of designs to them
LOCAL = "least error nearby"
SEEDS, SEEDS_OF_SIX_BARS = 12, 6  # designs from which solves begin


def choose(scaled: ScaledProblem, ledgers: list[Ledger], run: Run) -> Chosen:
    """All exact designs, a choice about the least error, or the best where targets may be missed."""
    ledger = ledgers[-1]
    with run.timed("choosing"):
        if not (scaled.has_programme or scaled.exact) or not (
            scaled.one_loop or scaled.exact or scaled.bounded
        ):
            problem, every = scaled.problem, ledger.best
            if scaled.bounded and problem.task.in_plane:  # found without zones
                again = judged_in_time(scaled, [each for one in ledgers for each in one.verified])
                every = ranked(problem, [one for one in again if one.verdict.ok])
            found = within_factor(problem, every, ledger.least)
            named = tuple(replace(one, best_at=best_at(problem, one, ledger.least)) for one in found)
            return Chosen(named, ledger.rejected, 0)
        if scaled.bounded:
            found = [candidate for each in ledgers for candidate in each.verified]
            return _best_within_bounds(scaled, found, ledger, run)
        if not scaled.exact and ledger.best:
            if run.search.enough == 1:  # nothing to choose from
                least = min(ledger.best, key=lambda one: (one.error(scaled.problem), one.id))
                return Chosen((replace(least, best_at=LEAST),), ledger.rejected, 0)
            return trade_offs(scaled, ledger, run)
    return Chosen(ledger.best, ledger.rejected, 0)


def _best_within_bounds(
    scaled: ScaledProblem, found: Sequence[Candidate], ledger: Ledger, run: Run
) -> Chosen:
    """The best designs by the objective that miss targets by no more than they may; `ledger` is the last."""
    problem, factor = scaled.problem, scaled.problem.requirements.error_factor
    most = np.inf if factor is None else factor * max(ledger.least, same_error(problem))
    seeds = SEEDS if scaled.one_loop else SEEDS_OF_SIX_BARS
    allowed = most if factor is not None else max(error_of_use(scaled), ledger.least)
    # from designs found without zones or error_factor: exact ones, or of least squares
    starts = [
        started_at(scaled, one, scaled.objective, most_error=most, zoned=scaled.zones is not None)
        for one in seeds_of(problem, found, NEAR * allowed, round(seeds * max(1.0, run.search.effort)))
    ]
    attempts = [] if run.ended() else run.solve(scaled, starts, ledger.solved)
    solved = len(attempts)
    again = judged_in_time(scaled, found, most)
    good = [one for one in again if one.verdict.ok]
    for one in attempts:
        good += one.verified
    if not good and scaled.zones is not None:
        near, more = nearest_zones(scaled, starts, again, ledger.solved + solved, run)
        good = [candidate for one in near for candidate in one.verified[:1]]
        attempts, solved = near + attempts, solved + more
    return Chosen(ranked(problem, good), [one for one in attempts if not one.verified], solved)


def best_at(problem: Problem, one: Candidate, least: float) -> str:
    """The words for a design: least error, least error for its transmission angle, or least error nearby."""
    if one.error(problem) <= max(least * SAME_LEAST, NO_ERROR):
        return LEAST
    transmission = float(np.degrees(one.values[quantity_of(problem).key]))
    level = LEVEL * round(transmission / LEVEL)
    asked = problem.requirements.transmission_min_deg
    return f"transmission from {level:g} deg" if abs(transmission - level) < AT and level > asked else LOCAL


def least_error(scaled: ScaledProblem, ledger: Ledger) -> float:
    """The least error of a search, length; NaN for exact designs, and where zones allow errors."""
    fitted = not ledger.scaled.exact and scaled.zones is None and bool(ledger.best)
    return ledger.least * scaled.problem.task.error_unit if fitted else np.nan


def why_ended(scaled: ScaledProblem, ledger: Ledger) -> str:
    """Why the search ended, and a hint where exact designs could be requested in place of least squares."""
    fitted = not np.isnan(least_error(scaled, ledger)) and ledger.least <= EXACT_ERROR
    if not (fitted and scaled.problem.task.exact_by_default):
        return ledger.why
    more = "every target can be met, and without exact = false the search is for more such designs"
    return f"{ledger.why}; {more}" if ledger.why else more
