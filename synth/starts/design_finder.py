"""Finders that propose finished designs: nothing remains to be solved."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from grashof.problems import Linkage
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import Round, Start
from grashof.synth.quantities.scaled_problem import ScaledProblem


@dataclass(frozen=True)
class DesignFinder(ABC):
    """The common part of these finders; see `Finder`."""

    scaled: ScaledProblem

    freedom: ClassVar[bool] = False
    cognates: ClassVar[bool] = False
    patience: ClassVar[float] = np.inf

    def quick_pass(self, _rng: np.random.Generator) -> Round | None:
        """None: a round takes little time."""
        return None

    def refuse(self) -> None:  # noqa: B027  (most have nothing to refuse)
        """Nothing: impossible tasks are refused where they are stated."""

    def degenerate(self) -> str:
        """Empty: every such task needs a linkage."""
        return ""

    def relaxed(self, _rng: np.random.Generator) -> Sequence[Start | Linkage]:
        """None but those that are closest anyway."""
        return []

    def obstacle(self, _rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """Nothing but limits."""
        return ""

    def onward(self, _designs: Sequence[Candidate]) -> Sequence[Linkage]:
        """Linkages that designs lead to, which are examined last."""
        return []

    @property
    @abstractmethod
    def beginning(self) -> str:
        """The first step of the search, in words."""

    @property
    @abstractmethod
    def exhausted(self) -> str:
        """Why the list has ended."""

    @property
    @abstractmethod
    def rounds_a_pass(self) -> int:
        """Number of rounds after which they may begin again."""

    @abstractmethod
    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """One round of designs."""

    @abstractmethod
    def follow(self, design: Candidate) -> Sequence[Start | Linkage]:
        """Linkages near a design of another task that do this one."""

    @abstractmethod
    def closest_to(
        self, required: ScaledProblem, key: str, rng: np.random.Generator
    ) -> Sequence[Start | Linkage]:
        """Linkages that keep these limits, and miss the additional one of `required` by the least amount."""
