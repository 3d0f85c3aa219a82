"""Two to four whole poses: infinitely many dyads meet them, and linkages are pairs of these.

Two and three poses leave a dyad free in three and two numbers, which are sampled; four poses leave a
curve of dyads (Burmester), which is traced.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Round
from grashof.synth.starts.parallelograms import parallelogram_starts
from grashof.synth.starts.sampled_dyads import fixed_pivots, sampled_dyads
from grashof.synth.starts.selection import feasible_starts, mended_starts
from grashof.synth.starts.whole_poses import DyadPairs, translate
from grashof.synth.theory.burmester import Dyads, trace_four_pose_curves

LINES, CELL = 800, 0.01  # of the traced curves, in sizes
ON_CURVE = 1e-9  # sizes


@dataclass(frozen=True, slots=True)
class FewPoses(DyadPairs):
    """Two to four whole poses."""

    @staticmethod
    def suits(scaled: ScaledProblem) -> bool:
        """Two to four whole poses, all to be met."""
        return scaled.motion is not None and len(scaled.targets) < 5

    def rounds(self, enough: int, rng: np.random.Generator, _size: int, /) -> Iterator[Round]:
        """One round; of two translated poses parallelogram linkages alternate with the others."""
        scaled = self.scaled
        sideways = parallelogram_starts(scaled, enough, rng) if translate(self.motion) else []
        dyads = self.dyads(rng)
        pairs = self.pairs(dyads)
        feasible = pairs[pairs.feasible]
        starts = feasible_starts(scaled, feasible, enough)
        if len(starts) < enough:
            only_own = len(pairs) > len(feasible)  # nothing but the user's own constraints is violated
            starts += mended_starts(scaled, pairs if only_own else self.near_pairs(dyads), enough)
        alternating = [start for both in zip_longest(sideways, starts) for start in both if start]
        yield Round(alternating, {"feasible linkages": len(feasible), "exact dyads": 0})

    def dyads(self, rng: np.random.Generator) -> Dyads:
        """Dyads all along the curves of four poses; random ones of fewer."""
        scaled, wanted = self.scaled, self.scaled.wanted
        if len(scaled.targets) < 4:
            return sampled_dyads(self.motion, scaled.targets[0], wanted, rng)
        longest = max(limits[1] for limits in wanted.link_lengths)
        _, arm = wanted.coupler_arms or (0.0, np.inf)
        reach = min(1.0 + 1.2 * (arm + longest), 200.0)
        return trace_four_pose_curves(self.motion, reach, LINES, CELL, phase=float(rng.uniform(0.1, 0.9)))

    def obstacle(self, rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """That a fixed ground pivot is not a centre point of four poses; empty where theory says nothing."""
        scaled, dyads = self.scaled, self.dyads(rng)
        for name, pivot in fixed_pivots(scaled.wanted).items():
            apart = float(np.abs(dyads.ground - pivot).min(initial=np.inf))
            if apart > ON_CURVE and len(scaled.targets) == 4:
                x, y = scaled.frame.outward(np.array(pivot))
                return (
                    f"{name} is fixed at ({x:.6g}, {y:.6g}), {apart * scaled.frame.scale:.3g} away from the "
                    "nearest centre point that four poses have"
                )
        return ""
