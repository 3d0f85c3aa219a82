"""The common part of all kinds of search: starts for a programme, or finished designs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened

ROUNDS_DONE = "its rounds are done; an effort above 1 adds more"  # why a search that draws ends


@dataclass(frozen=True)
class Finder(ABC):
    """A kind of search: its way to find starts, and its knowledge of the problems that it suits."""

    scaled: ScaledProblem

    @property
    @abstractmethod
    def beginning(self) -> str:
        """First stage of the search, as shown to users."""

    @property
    def freedom(self) -> bool:
        """Whether targets that are met leave freedom to a programme."""
        return False

    @property
    def cognates(self) -> bool:
        """Whether linkages that move as a design does are judged, too: no start leads to each of them."""
        return False

    @property
    def exhausted(self) -> str:
        """Why a search ends after all its rounds."""
        return "there are no other starts"

    @property
    def patience(self) -> float:
        """Consecutive rounds without a start after which the search ends."""
        return np.inf

    @property
    def searches_near(self) -> float:
        """Most searches for near misses, where these take long, and rounds come near limits by themselves."""
        return np.inf

    @property
    def rounds_a_pass(self) -> int:
        """Rounds after which the search may begin again, with other random numbers."""
        return 1

    def refuse(self) -> None:  # noqa: B027  (the default: impossible tasks are refused where they are stated)
        """Raise `ProblemError` for targets that cannot be searched for."""

    def degenerate(self) -> str:
        """Why the targets need no linkage; empty where they need one."""
        return ""

    def quick_pass(self, _rng: np.random.Generator) -> Round | None:
        """A few starts found at once, where the first round takes long; None elsewhere."""
        return None

    @abstractmethod
    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """One independent round of starts for `enough` designs; None after the last.

        With `size` times the usual draws where that helps.
        """

    def relaxed(self, _rng: np.random.Generator) -> Sequence[Proposal]:
        """Starts that may miss requirements that no linkage meets."""
        return []

    def obstacle(self, _rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """Why theory, or the counts of the rounds, leave no design; empty where they may leave one."""
        return ""


class StartFinder(Finder):
    """A finder from whose starts a programme is solved."""

    @abstractmethod
    def near(self, rng: np.random.Generator, share: float = 1.0, /) -> Screened:
        """Linkages that meet the requirements, or nearly do, by this share of the work for an explanation."""


class DesignFinder(Finder):
    """A finder that proposes finished designs: nothing remains to be solved."""

    def onward(
        self, _designs: Sequence[Candidate], _misses: Sequence[Candidate] = (), /
    ) -> Sequence[Proposal]:
        """Linkages, or starts, that designs and the nearest misses lead to, which are examined last."""
        return []

    @abstractmethod
    def follow(self, design: Candidate) -> Sequence[Proposal]:
        """Linkages near a design of another task that do this one."""

    @abstractmethod
    def closest_to(self, required: ScaledProblem, key: str, rng: np.random.Generator) -> Sequence[Proposal]:
        """Linkages that keep these limits, and miss the additional one of `required` by the least amount."""
