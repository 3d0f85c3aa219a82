"""Finders that propose whole designs: nothing is left to solve."""

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
    """What these finders share; see `Finder`."""

    scaled: ScaledProblem

    freedom: ClassVar[bool] = False
    cognates: ClassVar[bool] = False
    patience: ClassVar[float] = np.inf

    def quick_pass(self, _rng: np.random.Generator) -> Round | None:
        """None: a round takes little time."""
        return None

    def refuse(self) -> None:  # noqa: B027  (most have nothing to refuse)
        """What cannot be is refused where the problem is stated."""

    def degenerate(self) -> str:
        """No such task is without a linkage."""
        return ""

    def relaxed(self, _rng: np.random.Generator) -> Sequence[Start | Linkage]:
        """None but those that are closest anyway."""
        return []

    def obstacle(self, _rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """Nothing but limits."""
        return ""

    def onward(self, _designs: Sequence[Candidate]) -> Sequence[Linkage]:
        """Linkages that designs lead to, which are looked at last."""
        return []

    @property
    @abstractmethod
    def beginning(self) -> str:
        """What the search begins with."""

    @property
    @abstractmethod
    def exhausted(self) -> str:
        """Why there are no others."""

    @property
    @abstractmethod
    def rounds_a_pass(self) -> int:
        """After so many rounds they may begin again."""

    @abstractmethod
    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """One round of designs."""

    @abstractmethod
    def follow(self, design: Candidate) -> Sequence[Start | Linkage]:
        """What does the task near a design of another one; none where nothing does."""

    @abstractmethod
    def closest_to(
        self, asked: ScaledProblem, key: str, rng: np.random.Generator
    ) -> Sequence[Start | Linkage]:
        """Without a requirement: linkages that miss it least as it is `asked`, and the other limits not."""
