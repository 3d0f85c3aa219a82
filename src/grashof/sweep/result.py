"""The results of a sweep, combination by combination."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grashof.problems.values.text import counted
from grashof.sweep.combinations import Combination
from grashof.sweep.study import Study
from grashof.sweep.task import INVALID

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True)
class Step:
    """A combination that is finished.

    Parameters
    ----------
    done, total : int
        Combinations.
    combination : Combination
    result : mapping
        Of `grashof.sweep.task.solve_task`.
    """

    done: int
    total: int
    combination: Combination
    result: Mapping[str, Any]

    def __str__(self) -> str:
        status, note = self.result["status"], self.result["note"]
        found = counted(self.result["found"], "design") if self.result["found"] else note or status
        return f"{self.done} of {self.total}: {self.combination.label}: {found}"


@dataclass(frozen=True, slots=True, repr=False)
class Sweep:
    """The results of the combinations of a study.

    Parameters
    ----------
    study : Study
    combinations : tuple of Combination
    results : mapping of int to mapping
        Of `grashof.sweep.task.solve_task`, by the place of the combination; those finished.
    seconds : float
        Of this run.
    """

    study: Study
    combinations: tuple[Combination, ...]
    results: Mapping[int, Mapping[str, Any]]
    seconds: float = 0.0

    def __repr__(self) -> str:
        return f"<Sweep of {self.study.name}: {self.headline}>"

    @property
    def complete(self) -> bool:
        """Whether every combination is finished."""
        return len(self.results) == len(self.combinations)

    @property
    def with_designs(self) -> int:
        """Combinations that have designs."""
        return sum(result["found"] > 0 for result in self.results.values())

    @property
    def invalid(self) -> int:
        """Combinations that state no problem."""
        return sum(result["status"] == INVALID for result in self.results.values())

    @property
    def headline(self) -> str:
        """Number of combinations, and how many have designs or are invalid."""
        done, total = len(self.results), len(self.combinations)
        text = counted(total, "combination") if self.complete else f"{done} of {total} combinations done"
        text += f", {self.with_designs} with designs"
        return f"{text}, {self.invalid} invalid" if self.invalid else text

    @property
    def best_place(self) -> int | None:
        """Place of the combination with the best design; None where they are not decided by the same."""
        solved = {number: one for number, one in sorted(self.results.items()) if one["designs"]}
        if len({(one["decides"]["column"], one["decides"]["label"]) for one in solved.values()}) != 1:
            return None
        decides = next(iter(solved.values()))["decides"]
        values = {number: one["designs"][0].get(decides["column"]) for number, one in solved.items()}
        # Six digits: a search leaves smaller differences open, and the first decides.
        known = {number: float(f"{float(x):.6g}") for number, x in values.items() if x is not None}
        return max(known, key=lambda each: decides["better"] * known[each], default=None)

    @property
    def best(self) -> str:
        """Which combination has the best design, in words; empty where they are not decided by the same."""
        if (place := self.best_place) is None:
            return ""
        one = self.results[place]
        value = one["designs"][0][one["decides"]["column"]]
        return f"{self.combinations[place].label}: {one['decides']['label']} {value:.4g}"

    def to_frame(self) -> pd.DataFrame:
        """A row for each combination and listed design; the columns are those of ``sweep.csv``."""
        from grashof.sweep.table import sweep_frame  # pandas takes half a second to import

        return sweep_frame(self.combinations, self.results)
