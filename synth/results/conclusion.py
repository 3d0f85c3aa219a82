"""The result of a search: its ranked list or why that is empty, proof, counts and history."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace

from grashof.problems import Problem
from grashof.problems.values.requirements.quantities import Needs
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.families import listed
from grashof.synth.proof.claims.bounds import Bounds
from grashof.synth.proof.claims.proof import best_listed, proof_of
from grashof.synth.proof.poses.atlas import Atlas
from grashof.synth.proof.poses.five_poses import Certified, proof_of_all
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.choice import choose, least_error, why_ended
from grashof.synth.results.result import Result
from grashof.synth.results.trade_offs import Chosen
from grashof.synth.search.finder import finder_for
from grashof.synth.search.history import RunHistory, StopCondition, now
from grashof.synth.search.ledger import CHOICE, LISTED, Ledger
from grashof.synth.search.run import Run

_LOG = logging.getLogger(__name__)


def conclude(
    scaled: ScaledProblem,
    ledgers: list[Ledger],
    run: Run,
    stop_condition: StopCondition,
    bounds: Bounds | Certified | None = None,
    atlas: Atlas | None = None,
) -> Result:
    """The ranked list of one or two searches, or why it is empty, with the proof from bounds."""
    chosen = choose(scaled, ledgers, run)
    _LOG.info("choice: %d designs, %d solves for it", len(chosen.designs), chosen.solved)
    found, nearest, note = _explained(scaled, ledgers[-1], chosen, run)
    if note:
        _LOG.info("explanation: %s", note)
    problem, ledger = scaled.problem, ledgers[-1]
    designs = _with_parts(listed(problem, found))
    note = note or _advice(problem, designs)
    run.ended()
    if atlas is not None:
        regions = atlas.regions_of(scaled, designs)
        designs = tuple(replace(each, region=one) for each, one in zip(designs, regions, strict=True))
    ledger.tally.totals.update({CHOICE: chosen.solved, LISTED: len(designs)})
    history = RunHistory(
        begun=stop_condition.begun,
        ended=now(),
        ending=stop_condition.ending,
        resumed=run.journal.resumed,
        steps_recorded=run.journal.taken,
        record_lost=run.journal.lost,
        processes_lost=run.work.lost,
        starts_crashed=tuple(run.crashed),
    )
    none = isinstance(bounds, Bounds) and bounds.none
    ended, seconds = "" if none else why_ended(scaled, ledger), run.times
    if ended and designs and not chosen.designs:
        ended += "; those listed were found while looking for the reason"
    why = f"; {ended}" if ended else ""
    _LOG.info("ended after %.1f s, %s: %d designs%s", seconds["total"], history.ending, len(designs), why)
    proof = None
    if isinstance(bounds, Certified):
        proof = proof_of_all(problem, bounds, designs, whole=ledger.exhaustive)
    elif bounds is not None:
        proof = proof_of(problem, bounds, best_listed(problem, designs), run.proving.gap)
    elif scaled.exact and problem.task.only_points:
        from grashof.synth.proof.points.followed import proof_of_points

        proof = proof_of_points(
            scaled,
            designs,
            ledger.tally.found,
            stopped=not ledger.complete,
            whole=ledger.all_rounds_done,
            enough=ledger.enough,
        )
    if proof is not None and atlas is not None:
        proof = replace(proof, regions=atlas.count, region_size=atlas.size)
    return Result(
        problem=problem,
        candidates=designs,
        nearest=nearest,
        tally=ledger.tally,
        seconds=seconds,
        note=note,
        complete=ledger.complete,
        ended=ended,
        least_error=least_error(scaled, ledger),
        history=history,
        proof=proof,
        loci=None if atlas is None else atlas.loci,
    )


def _explained(
    scaled: ScaledProblem, ledger: Ledger, chosen: Chosen, run: Run
) -> tuple[Sequence[Candidate], tuple[Candidate, ...], str]:
    """Designs to list, the closest misses, and a note."""
    if chosen.designs:
        return chosen.designs, (), ""
    from grashof.synth.results.explain import explain

    found = explain(scaled, ledger, chosen, run)
    return found.designs, found.nearest, found.note


def _with_parts(designs: tuple[Candidate, ...]) -> tuple[Candidate, ...]:
    """The designs; the first of them have struts and springs where the problem states an effort."""
    if not designs or not designs[0].problem.states(Needs.EFFORT):
        return designs
    from grashof.synth.designs.efforts import with_best_parts

    return with_best_parts(designs)


def _advice(problem: Problem, designs: tuple[Candidate, ...]) -> str:
    """A note on a list: why its strokes transmit badly, or why its designs have no struts."""
    if designs and problem.states(Needs.EFFORT):
        from grashof.synth.designs.efforts import why_without

        return why_without(designs)
    if not designs or not problem.task.at_limits:
        return ""
    from grashof.synth.results.explain import advice

    return advice(problem)


def needless(scaled: ScaledProblem, stop_condition: StopCondition) -> Result:
    """The empty list of targets that need no linkage."""
    history = RunHistory(begun=stop_condition.begun, ended=now(), ending=stop_condition.ending)
    note = f"no design: {finder_for(scaled).degenerate()}"
    return Result(scaled.problem, seconds={"total": 0.0}, note=note, history=history)
