"""The lists of several kinds of linkage as one; the list of a search that failed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.analysis import verify
from grashof.problems import Problem
from grashof.synth.designs.candidate import Candidate, same_error
from grashof.synth.designs.families import listed
from grashof.synth.results.result import Result
from grashof.synth.search.history import RunHistory, StopReason, now
from grashof.synth.search.ledger import LISTED, Tally
from grashof.synth.search.run import Progress


def one_list(problem: Problem, found: Sequence[Result]) -> Result:
    """One ranked list from those for each kind of linkage of a problem, in their order.

    The last ones may be missing. With ``error_factor`` the least error of all kinds counts.
    """
    if len(problem.mechanism) == 1 and found:
        return found[0]
    known = [not np.isnan(one.least_error) for one in found]
    least = float(np.min([one.least_error for one in found], initial=np.inf, where=known))
    designs = [replace(each, problem=problem) for one in found for each in one.candidates]
    chosen = listed(problem, within_factor(problem, designs, least / problem.task.error_unit))
    tally = Tally()
    for one in found:
        tally.update(one.tally)
    tally.totals[LISTED] = len(chosen)
    return Result(
        problem=problem,
        candidates=chosen,
        nearest=() if chosen else tuple(each for one in found for each in one.nearest),
        tally=tally,
        seconds=found[-1].seconds if found else {},
        note="" if chosen else _by_kind(found, "note"),
        complete=len(found) == len(problem.mechanism) and all(one.complete for one in found),
        ended=_by_kind(found, "ended"),
        least_error=least if np.isfinite(least) else np.nan,
        history=_history([one.history for one in found if one.history is not None]),
        proof=next((one.proof for one in found if one.proof is not None), None),
    )


def within_factor(problem: Problem, designs: Sequence[Candidate], least: float) -> list[Candidate]:
    """Designs whose error ``error_factor`` allows, by the least error of all, sizes."""
    factor = problem.requirements.error_factor
    most = np.inf if factor is None else factor * max(least, same_error(problem))
    return [each for each in designs if each.error(problem) <= most * (1 + 1e-9)]


def _by_kind(found: Sequence[Result], name: str) -> str:
    """The notes of several lists, each with its kind."""
    said = [(one.problem.mechanism[0], getattr(one, name)) for one in found]
    return "; ".join(f"{kind}: {text}" for kind, text in said if text)


def _history(parts: Sequence[RunHistory]) -> RunHistory | None:
    if not parts:
        return None
    endings = [part.ending for part in parts if part.ending is not StopReason.COMPLETE]
    ending = endings[0] if endings else StopReason.COMPLETE
    return replace(parts[-1], begun=parts[0].begun, ending=ending)


class ReportedDesigns:
    """The designs that a search last reported of each kind of linkage, listed if it fails."""

    def __init__(self, problem: Problem) -> None:
        self._problem, self._begun = problem, now()
        self._designs: dict[tuple[str, ...], tuple[Candidate, ...]] = {}

    def note(self, step: Progress) -> None:
        """Keep the designs of a report."""
        if step.designs:
            self._designs[tuple(step.designs[0].problem.mechanism)] = step.designs

    def result(self) -> Result:
        """The list of those that meet the problem as stated, each judged again."""
        found = [each for one in self._designs.values() for each in one]
        judged = [each for each in map(self._judged, found) if each.verdict.ok]
        least = min((each.error(self._problem) for each in judged), default=0.0)
        return Result(
            self._problem,
            listed(self._problem, within_factor(self._problem, judged, least)),
            complete=False,
            note="the search failed; listed is what was verified until then",
            history=RunHistory(begun=self._begun, ended=now(), ending=StopReason.FAILED),
        )

    def _judged(self, one: Candidate) -> Candidate:
        """A design judged by the requirements as stated, with the same cylinder."""
        of = self._problem.for_kind(one.linkage.mechanism.word)
        cylinder = one.verdict.cylinder
        verdict = verify(one.linkage, of.task, of.requirements, problem=of, cylinder=cylinder)
        return replace(one, verdict=verdict, problem=self._problem)
