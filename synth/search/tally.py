"""Counts of a search: what was looked at, and what became of the solves."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, fields

from grashof.synth.search.attempt import Attempt, Outcome

COGNATES, CHOICE, DISTINCT = "cognates verified", "solves for the choice", "verified and distinct"


@dataclass(frozen=True, slots=True)
class Tally:
    """Counts of a search."""

    found: Counter[str] = field(default_factory=Counter)  # by the search for starts, such as "feasible finds"
    outcomes: Counter[Outcome] = field(default_factory=Counter)  # of solves
    totals: Counter[str] = field(default_factory=Counter)  # `COGNATES`, `CHOICE`, `DISTINCT`
    rejected: Counter[str] = field(default_factory=Counter)  # solves by the first requirement missed
    statuses: Counter[str] = field(default_factory=Counter)  # solves by Ipopt's return status

    def add(self, attempts: Iterable[Attempt]) -> None:
        """Count attempts."""
        for one in attempts:
            self.statuses[one.status] += 1
            self.outcomes[one.outcome] += 1
            if one.verified:
                self.totals[COGNATES] += len(one.cognates)
            elif one.candidate is not None:
                self.rejected[one.candidate.verdict.defects[0].requirement] += 1

    def update(self, other: Tally) -> None:
        """Add the counts of another part of the search."""
        for mine in fields(self):
            getattr(self, mine.name).update(getattr(other, mine.name))

    @property
    def general(self) -> dict[str, int]:
        """All but rejections and statuses, by name."""
        ended = {str(each): self.outcomes[each] for each in self.outcomes if each is not Outcome.REJECTED}
        return {**self.found, **ended, **self.totals}

    @property
    def recorded(self) -> dict[str, int]:
        """All counts in one, as ``run.json`` has them."""
        rejected = {f"rejected: {requirement}": n for requirement, n in self.rejected.items()}
        return {**self.general, **rejected, **{f"solver: {status}": n for status, n in self.statuses.items()}}
