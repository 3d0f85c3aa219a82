"""What searches through whole poses, met exactly, have in common; pairs of dyads above all."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from itertools import combinations
from typing import ClassVar

import numpy as np

from grashof.problems import ProblemError
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import Screened
from grashof.synth.programme.start import Start
from grashof.synth.programme.user_constraints import screened
from grashof.synth.starts.dyad_pairs import near_misses, screen
from grashof.synth.starts.selection import relaxed_starts
from grashof.synth.theory.burmester import Displacements, Dyads

PAIRS, SAMPLED_PAIRS, NEAR_PAIRS = 1_000_000, 200_000, 150_000  # judged
NOT_TURNED = 1e-9  # of unit rotations


@dataclass(frozen=True, slots=True)
class WholePoses:
    """Poses with position and angle, all of them to be met."""

    scaled: ScaledProblem

    beginning: ClassVar[str] = "tracing dyads and judging pairs"
    cognates: ClassVar[bool] = False

    @property
    def motion(self) -> Displacements:
        """Displacements of the body from the first pose."""
        if self.scaled.motion is None:
            raise TypeError("only whole poses that are met exactly are displacements of the body")
        return self.scaled.motion

    @property
    def freedom(self) -> bool:
        """Up to four poses leave some: a curve of dyads, or more."""
        return len(self.scaled.targets) < 5

    @property
    def exhausted(self) -> str:
        """All starts are in one round."""
        return "there are no other starts" if self.freedom else "the poses leave no freedom"

    def refuse(self) -> None:
        """Raise `ProblemError` when two of the poses are equal: fewer are asked for then."""
        motion = self.motion
        for i, j in combinations(range(len(motion.shift)), 2):
            moved = abs(self.scaled.targets[i] - self.scaled.targets[j])
            if moved + abs(motion.rotation[i] - motion.rotation[j]) < 1e-12:
                raise ProblemError(
                    f"motion.poses[{i}] and motion.poses[{j}] are equal; "
                    "allowed are distinct poses, or requirements.exact = false"
                )

    def degenerate(self) -> str:
        """Why a pure rotation needs no linkage; empty for other poses."""
        motion = self.motion
        turn = motion.rotation[1:] - 1
        if len(turn) == 1 or translate(motion):
            return ""
        widest = 1 + int(np.argmax(np.abs(turn)))
        pole = motion.shift[widest] / (1 - motion.rotation[widest])
        if np.abs(motion.apply(np.array([pole]))[0] - pole).max() >= 1e-9:
            return ""
        x, y = self.scaled.frame.outward(np.array(pole))
        return f"the poses are a pure rotation about ({x:.6g}, {y:.6g}): a single pivot there does the job"


@dataclass(frozen=True, slots=True)
class DyadPairs(WholePoses, ABC):
    """Poses whose linkages are pairs of dyads that theory gives."""

    @abstractmethod
    def dyads(self, rng: np.random.Generator) -> Dyads:
        """Dyads that meet the poses."""

    def pairs(self, dyads: Dyads) -> Screened:
        """Pairs that meet all requirements but, perhaps, the user's own constraints."""
        scaled = self.scaled
        most = SAMPLED_PAIRS if len(scaled.targets) < 4 else PAIRS
        return screened(scaled, screen(self.motion, scaled.targets[0], dyads, scaled.wanted, most))

    def near_pairs(self, dyads: Dyads) -> Screened:
        """Pairs, feasible or not, and how far each violates all requirements but the user's own."""
        return near_misses(self.motion, self.scaled.targets[0], dyads, self.scaled.wanted, NEAR_PAIRS)

    def near(self, rng: np.random.Generator) -> Screened:
        """Pairs that meet all requirements; near misses where none does."""
        dyads = self.dyads(rng)
        pairs = self.pairs(dyads)
        return (
            pairs[pairs.feasible] if pairs.feasible.any() else screened(self.scaled, self.near_pairs(dyads))
        )

    def relaxed(self, rng: np.random.Generator) -> list[Start]:
        """Starts that may miss what stands in the way."""
        starts = relaxed_starts(self.scaled, self.near_pairs(self.dyads(rng)))
        return [replace(start, settled=not self.freedom) for start in starts]


def translate(motion: Displacements) -> bool:
    """Whether all poses are pure translations of the first."""
    return bool(np.abs(motion.rotation - 1).max() < NOT_TURNED)
