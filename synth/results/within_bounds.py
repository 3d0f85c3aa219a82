"""Where targets may be missed: the best designs by the problem's objective within zones or an error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.synth.programme.merit import same_error
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.results.attempt import Attempt
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.judging import judged_again
from grashof.synth.results.larger_zones import shares
from grashof.synth.results.ledger import Ledger
from grashof.synth.results.ranking import ranked
from grashof.synth.results.search import Run
from grashof.synth.results.trade_offs import Chosen, seeds_of, started_at

NEAR = 1.6  # times the error that is allowed: least-squares designs up to there are begun from
SEEDS = 12  # designs that are begun from


def error_of_use(scaled: ScaledProblem) -> float:
    """Up to which error a design is of use where zones are allowed, root mean square, sizes."""
    if scaled.zones is None:
        return 0.0
    zones = np.where(np.isfinite(scaled.zones), scaled.zones, 0.0)
    turn_weights = np.zeros(zones.shape[1]) if scaled.turn_weights is None else scaled.turn_weights
    square = (scaled.weights * zones[0] ** 2 + turn_weights * zones[1] ** 2).sum()
    return float(np.sqrt(square / len(scaled.targets)))


def best_within_bounds(scaled: ScaledProblem, found: Sequence[Candidate], ledger: Ledger, run: Run) -> Chosen:
    """The best designs by the objective that miss the targets by no more than they may.

    Parameters
    ----------
    scaled : ScaledProblem
        Of the problem with its zones, or its ``error_factor``.
    found : sequence of Candidate
        Designs of the searches without: exact ones, or of least squares.
    ledger : Ledger
        Of the last of them.
    run : Run

    Returns
    -------
    Chosen
    """
    problem, factor = scaled.problem, scaled.problem.requirements.error_factor
    most = np.inf if factor is None else factor * max(ledger.least, same_error(problem))
    allowed = most if factor is not None else max(error_of_use(scaled), ledger.least)
    starts = [
        started_at(scaled, one, problem.objective, most_error=most, zoned=scaled.zones is not None)
        for one in seeds_of(problem, found, NEAR * allowed, round(SEEDS * max(1.0, run.search.effort)))
    ]
    attempts = [] if run.ended() else run.solve(scaled, starts, ledger.solved)
    solved = len(attempts)
    again = [judged_again(scaled, one, most) for one in found]
    good = [one for one in again if one.verdict.ok]
    for one in attempts:
        good += one.verified[:1]
        good += [each for each in one.cognates if judged_again(scaled, each, most).verdict.ok]
    if not good and scaled.zones is not None and not run.ended():  # how large the zones would have to be
        relaxed = [replace(start, relaxed=("within",)) for start in starts]
        lack = min((max(shares(problem, one.verdict)) for one in again), default=1.0)
        larger = replace(scaled, zones=scaled.zones * max(1.0, lack / 2))
        made = run.solve(larger, relaxed, ledger.solved + solved) + [Attempt("", one) for one in again]
        good = [candidate for one in made for candidate in one.verified[:1]]
        attempts, solved = made + attempts, solved + len(starts)
    return Chosen(ranked(problem, good), [one for one in attempts if not one.verified], solved)
