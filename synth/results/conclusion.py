"""What a search comes to: what is chosen of its designs, or why there is none."""

from __future__ import annotations

from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.results.choice import choose, least_error, why_ended
from grashof.synth.results.explain import explain
from grashof.synth.results.families import listed
from grashof.synth.results.ledger import Ledger
from grashof.synth.results.result import Result
from grashof.synth.results.run import Run
from grashof.synth.results.tally import CHOICE, DISTINCT


def conclude(scaled: ScaledProblem, ledgers: list[Ledger], run: Run) -> Result:
    """The ranked list of what one or two searches found, or why it is empty."""
    chosen = choose(scaled, ledgers, run)
    explanation = explain(scaled, ledgers[-1], chosen, run)
    run.ended()
    problem, ledger = scaled.problem, ledgers[-1]
    designs = listed(problem, chosen.designs or explanation.designs)
    ledger.tally.totals.update({CHOICE: chosen.solved, DISTINCT: len(designs)})
    return Result(
        problem=problem,
        candidates=designs,
        nearest=explanation.nearest,
        tally=ledger.tally,
        seconds=run.times,
        note=explanation.note,
        complete=ledger.complete,
        ended=why_ended(scaled, ledger),
        least_error=least_error(scaled, ledger),
    )
