"""Results: verified designs, ranked, and counts of the others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from grashof.problems import NoSolutionError, Problem
from grashof.problems.values.text import counted
from grashof.problems.values.value_bases import Displayed
from grashof.synth.designs.candidate import Candidate, same_error
from grashof.synth.proof.claims.proof import Proof
from grashof.synth.proof.poses.atlas import Loci
from grashof.synth.search.history import RunHistory
from grashof.synth.search.ledger import Tally

if TYPE_CHECKING:
    import pandas as pd

WOULD, BETWEEN = " alone would do", "; "  # in notes that name requirements


@dataclass(frozen=True, slots=True, repr=False)
class Result(Displayed):
    """A ranked list of verified, distinct designs, best first; `nearest` when there is none.

    Parameters
    ----------
    problem : Problem
    candidates : tuple of Candidate
        The best design of each family, best first, then all the others, best first.
    nearest : tuple of Candidate
        For an empty list: designs that miss one requirement, each as little as possible.
    tally : Tally
        Counts of the search: `counts` has all of them by name.
    seconds : mapping of str to float
        Time by stage.
    note : str
        Why the list is empty or was cut short, or that no linkage does this task well; else empty.
    complete : bool
        False when the search was interrupted.
    ended : str
        Why the search ended: of exact designs, before it had as many as requested; else empty.
    least_error : float, length
        Least squares: the least error found, as in `Candidate.error` (of functions rad); NaN otherwise.
    history : RunHistory, optional
        The course of the search.
    proof : Proof, optional
        Proof about the list.
    loci : Loci, optional
        Places of the joints, where all linkages are enclosed.
    """

    problem: Problem
    candidates: tuple[Candidate, ...] = ()
    nearest: tuple[Candidate, ...] = ()
    tally: Tally = field(default_factory=Tally)
    seconds: Mapping[str, float] = field(default_factory=dict)
    note: str = ""
    complete: bool = True
    ended: str = ""
    least_error: float = np.nan
    history: RunHistory | None = field(default=None, compare=False)
    proof: Proof | None = field(default=None, compare=False)
    loci: Loci | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        for name in ("candidates", "nearest"):
            designs = (each.asked_by(self.problem) for each in getattr(self, name))
            object.__setattr__(self, name, tuple(designs))

    def __repr__(self) -> str:
        best = f"best {self.best._words}" if self.candidates else self.note
        return f"<Result of {self.problem.name}: {counted(len(self), 'design')}; {best}>"

    @property
    def best(self) -> Candidate:
        """The first design; `NoSolutionError` states why when there is none."""
        if not self.candidates:
            raise NoSolutionError(self.note)
        return self.candidates[0]

    @property
    def counts(self) -> dict[str, int]:
        """Solves by outcome, and other counts of the search, by their names in ``run.json``."""
        return self.tally.recorded

    @property
    def most_error(self) -> float:
        """Greatest error within which the objective decides, length, by ``error_factor``; NaN without one."""
        factor = self.problem.requirements.error_factor
        if factor is None or np.isnan(self.least_error):
            return np.nan
        return factor * max(self.least_error, same_error(self.problem) * self.problem.task.error_unit)

    @property
    def families(self) -> tuple[tuple[Candidate, ...], ...]:
        """Similar designs, best first; the families in the order of their best designs."""
        members: dict[str, list[Candidate]] = {}
        for candidate in self.candidates:
            members.setdefault(candidate.family or candidate.id, []).append(candidate)
        return tuple(tuple(family) for family in members.values())

    def top(self, families: int) -> Result:
        """The result with `families` families only, each with all its members: see `first_of_each`."""
        every = self.families
        kept = {each.id for k in self.first_of_each(families) for each in every[k]}
        return replace(self, candidates=tuple(each for each in self.candidates if each.id in kept))

    def first_of_each(self, most: int) -> list[int]:
        """Numbers of `most` families: the first ones, with an equal share for each kind of linkage.

        A share that a kind cannot fill goes to the first of the others.
        """
        numbers: dict[str, list[int]] = {}
        for k, family in enumerate(self.families):
            numbers.setdefault(family[0].linkage.mechanism.word, []).append(k)
        share = most // len(numbers) if numbers else 0
        shared = [k for each in numbers.values() for k in each[:share]]
        others = sorted(k for each in numbers.values() for k in each[share:])
        return sorted(shared + others[: most - len(shared)])

    def __len__(self) -> int:
        return len(self.candidates)

    def to_frame(self) -> pd.DataFrame:
        """One verified design a row, best first; columns as `docs/reference/columns.md` lists them."""
        from grashof.synth.designs.table import to_frame  # pandas takes half a second to import

        return to_frame(self.problem, self.candidates)

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write `to_frame` with floats in full precision."""
        self.to_frame().to_csv(path, index=False, lineterminator="\n")


def note_parts(note: str) -> tuple[str, list[str]]:
    """The reason in a note, and the requirements that it names one by one.

    >>> note_parts("no design; each of these alone would do: r 3 instead of 2; order = false")
    ('no design; each of these alone would do', ['r 3 instead of 2', 'order = false'])
    >>> note_parts("no design: the search found none")
    ('no design: the search found none', [])
    """
    said, found, ways = note.partition(f"{WOULD}: ")
    return (f"{said}{WOULD}", ways.split(BETWEEN)) if found else (note, [])
