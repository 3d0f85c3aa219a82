"""The distinct designs of a search, best first, kept up to date as designs come in."""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.ranking import ranking_key
from grashof.synth.theory.distinct import DISTINCT, apart, signature


@dataclass(slots=True)
class Leaders:
    """What `ranked` makes of all designs added so far; each is valued and compared with the others once.

    Parameters
    ----------
    problem : Problem
    """

    problem: Problem
    _every: list[Candidate] = field(default_factory=list)
    _order: list[tuple[tuple[float, ...], int]] = field(default_factory=list)  # keys and numbers, best first
    _alike: list[list[int]] = field(default_factory=list)  # numbers of those not distinct from each
    _signatures: FloatArray = field(default_factory=lambda: np.empty((16, 9)))

    def __len__(self) -> int:
        return len(self._every)

    def add(self, candidates: Iterable[Candidate]) -> None:
        """Take designs in."""
        origin = self.problem.task.middle
        for candidate in candidates:
            number, numbers = len(self._every), signature(candidate.linkage, origin)
            if number == len(self._signatures):
                self._signatures = np.concatenate([self._signatures, np.empty_like(self._signatures)])
            near = np.flatnonzero(~(apart(numbers, self._signatures[:number]) > DISTINCT)).tolist()
            self._signatures[number] = numbers
            self._every.append(candidate)
            self._alike.append(near)
            for other in near:
                self._alike[other].append(number)
            insort(self._order, (ranking_key(self.problem, candidate), number))

    @property
    def distinct(self) -> tuple[Candidate, ...]:
        """Distinct designs, best first; of two that are not distinct the better one."""
        out, chosen = bytearray(len(self._every)), list[Candidate]()
        for _, number in self._order:
            if not out[number]:
                chosen.append(self._every[number])
                for other in self._alike[number]:
                    out[other] = 1
        return tuple(chosen)
