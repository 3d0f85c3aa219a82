"""What a search has found so far: the list of one that failed."""

from __future__ import annotations

from dataclasses import replace

from grashof.analysis import verify
from grashof.problems import Problem
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.families import listed
from grashof.synth.results.mixed import within_factor
from grashof.synth.results.result import Result
from grashof.synth.search.history import RunHistory, StopReason, now
from grashof.synth.search.run import Progress


class SoFar:
    """The designs that a search last reported of each kind of linkage."""

    def __init__(self, problem: Problem) -> None:
        self._problem, self._begun = problem, now()
        self._designs: dict[tuple[str, ...], tuple[Candidate, ...]] = {}

    def note(self, step: Progress) -> None:
        """Keep the designs of one report."""
        if step.designs:
            self._designs[tuple(step.designs[0].problem.mechanism)] = step.designs

    def result(self) -> Result:
        """The list of those that meet the problem as it is stated, each judged again."""
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
        """The verdict under the requirements as they were stated, with the same cylinder."""
        of = self._problem.for_kind(one.linkage.mechanism.word)
        cylinder = one.verdict.cylinder
        verdict = verify(one.linkage, of.task, of.requirements, problem=of, cylinder=cylinder)
        return replace(one, verdict=verdict, problem=self._problem)
