"""Five whole poses and more: up to four dyads meet five of them, and those of more are among these."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from grashof.problems.values.checks import counted
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Round, Start
from grashof.synth.starts.sampled_dyads import joined
from grashof.synth.starts.selection import merits
from grashof.synth.starts.whole_poses import DyadPairs
from grashof.synth.theory.burmester import Displacements, Dyads, polish, radius_error
from grashof.synth.theory.five_poses import five_pose_dyads, five_pose_guides

SUBSETS = 6  # fives of many poses that are tried
NEARLY, EXACT = 1e-4, 1e-9  # radius error in sizes: before and after polishing


@dataclass(frozen=True, slots=True)
class ManyPoses(DyadPairs):
    """Five whole poses and more, which leave no freedom."""

    @staticmethod
    def suits(scaled: ScaledProblem) -> bool:
        """Five whole poses or more, all to be met."""
        return scaled.motion is not None and len(scaled.targets) > 4

    def rounds(self, _enough: int, rng: np.random.Generator, size: int, /) -> Iterator[Round]:
        """One round of all linkages that there are; a second one would hold the same."""
        if size > 1:
            return
        dyads = self.dyads(rng)
        pairs = self.pairs(dyads)
        best_first, objective = (
            np.argsort(-merits(self.scaled, pairs), kind="stable"),
            self.scaled.problem.objective,
        )
        starts = [Start.of_find(pairs, int(index), objective) for index in best_first]
        counts = {"feasible linkages": int(pairs.feasible.sum()), "exact dyads": len(dyads)}
        yield Round([replace(start, settled=True) for start in starts], counts)

    def dyads(self, rng: np.random.Generator) -> Dyads:
        """Dyads of five of the poses that meet all of them; of several fives where there are more."""
        motion = self.motion
        count = len(motion.shift)
        found = Dyads(np.zeros(0, np.complex128), np.zeros(0, np.complex128))
        for number in range(1 if count == 5 else SUBSETS):
            spread = np.round(np.linspace(0, count - 1, 5)).astype(int)
            five = spread if number == 0 else np.concatenate([[0], 1 + rng.permutation(count - 1)[:4]])
            dyads = five_pose_dyads(Displacements(motion.rotation[five], motion.shift[five]))
            if count > 5:
                near = radius_error(motion, dyads) < NEARLY
                dyads = polish(motion, dyads[near])
                dyads = dyads[radius_error(motion, dyads) < EXACT]
            apart = np.abs(dyads.moving[:, None] - found.moving).min(axis=1, initial=np.inf) > 1e-6
            found = joined(found, dyads[apart])
            if len(found) >= 4:
                break
        return found

    def obstacle(self, rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """How many dyads meet the poses."""
        count, dyads = len(self.scaled.targets), self.dyads(rng)
        guides = len(five_pose_guides(self.motion)) if count == 5 else 0
        sliding = f"; {counted(guides, 'dyad')} would have to be a slider" if guides else ""
        if len(dyads) < 2:
            found = "no real dyad" if not len(dyads) else "a single real dyad"
            return f"the {count} poses have {found}, and a linkage needs two{sliding}"
        few = ", so one linkage at most, or its two drivers" if len(dyads) == 2 else ""
        return f"the {count} poses have {len(dyads)} real dyads only{few}{sliding}"
