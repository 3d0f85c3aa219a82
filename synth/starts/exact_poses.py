"""Whole poses, met exactly: dyads by theory, and all their pairs; parallelograms for pure translations.

Dyads of two and three poses are sampled, those of four traced on their curve (Burmester); five have up to
four, and those of more poses are among the dyads of five of them.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from itertools import zip_longest
from typing import ClassVar

import numpy as np

from grashof.problems import ProblemError
from grashof.problems.values.arrays import ComplexArray
from grashof.problems.values.text import counted
from grashof.synth.programme.start import Round, Start
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.coupler_search import searched_round
from grashof.synth.starts.deviation_descent import nearer_to_torque, seeks_torque
from grashof.synth.starts.dyad_pairs import near_misses, screen
from grashof.synth.starts.finder import StartFinder
from grashof.synth.starts.parallelograms import parallelogram_obstacle, parallelogram_starts, parallelograms
from grashof.synth.starts.sampled_dyads import (
    SAMPLES,
    fixed_pivots,
    joined,
    sampled_dyads,
    stated_dyads,
    with_stated_joints,
)
from grashof.synth.starts.selection import (
    FEW,
    feasible_starts,
    mended_starts,
    relaxed_starts,
    scores,
    starts_of,
)
from grashof.synth.theory.burmester import (
    Displacements,
    Dyads,
    polish,
    radius_error,
    trace_four_pose_curves,
)
from grashof.synth.theory.distinct import best_first
from grashof.synth.theory.five_poses import five_pose_dyads, five_pose_guides

LINES, CELL = 800, 0.01  # of the traced curves, in sizes
PAIRS, SAMPLED_PAIRS, NEAR_PAIRS = 1_000_000, 200_000, 150_000  # judged
# Judged, and followed along the motion, where near ones are enough.
SOME_PAIRS, FEWEST_PAIRS, FOLLOWED = 300_000, 10_000, 12_000
QUICK_LINES, QUICK_SAMPLES, QUICK_PAIRS = 100, 400, 10_000  # of a first quick pass, a twentieth of the time
QUICK_STARTS = 2
SEARCHES = 3  # rounds of the search for points after that of sampled dyads
SUBSETS = 6  # fives of many poses that are tried
NEARLY, EXACT = 1e-4, 1e-9  # radius error in sizes: before and after polishing
STILL = 1e-9  # sizes: a point that moves less stands still
EQUAL = 1e-12  # sizes and unit rotations: poses closer are the same one
AT_ONCE = 1024  # poses compared with all others


class ExactPoses(StartFinder):
    """Poses with position and angle, all of them to be met."""

    beginning: ClassVar[str] = "tracing dyads and judging pairs"

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
        """Raise `ProblemError` when two of the poses are equal: fewer are required then."""
        refuse_equal(self.scaled, self.motion)

    def degenerate(self) -> str:
        """Why a pure rotation needs no linkage; empty for other poses."""
        return pure_rotation(self.scaled, self.motion)


def refuse_equal(scaled: ScaledProblem, motion: Displacements) -> None:
    """Raise `ProblemError` when two of the poses are equal."""
    equal = first_equal(scaled.targets, motion.rotation)
    if equal is not None:
        i, j = equal
        raise ProblemError(
            f"motion.poses[{i}] and motion.poses[{j}] are equal; "
            "they must be distinct, or requirements.exact = false"
        )


def pure_rotation(scaled: ScaledProblem, motion: Displacements) -> str:
    """Why a pure rotation needs no linkage; empty for other poses."""
    pole = motion.pole(STILL) if len(scaled.targets) > 2 else None
    if pole is None:
        return ""
    x, y = scaled.frame.outward(np.array(pole))
    return f"the poses are a pure rotation about ({x:.6g}, {y:.6g}): a single pivot there does the job"


class Parallelograms(ExactPoses):
    """Three poses or more that are pure translations of each other."""

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """A single round."""
        if number or not (self.freedom or size == 1):
            return None
        starts = parallelogram_starts(self.scaled, enough, rng)
        return Round(starts, {"feasible finds": len(starts)})

    def near(self, rng: np.random.Generator, _share: float = 1.0, /) -> Screened:
        """Parallelogram linkages, feasible or not."""
        return parallelograms(self.scaled, rng)

    def relaxed(self, rng: np.random.Generator) -> list[Start]:
        """Starts that may miss what no linkage meets."""
        return relaxed_starts(self.scaled, self.near(rng))

    def obstacle(self, _rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """Why parallelogram linkages are impossible; empty where they may exist."""
        return parallelogram_obstacle(self.scaled)


class DyadPairs(ExactPoses):
    """Poses whose linkages are pairs of dyads that theory gives."""

    @abstractmethod
    def dyads(self, rng: np.random.Generator) -> Dyads:
        """Dyads that meet the poses."""

    def pairs(self, dyads: Dyads, most: int | None = None, looked: int = PAIRS) -> Screened:
        """Pairs that meet all requirements but, perhaps, the user's constraints; of at most `most`.

        Motions of at most `looked` of them are followed, where areas or limits along them are stated.
        """
        scaled = self.scaled
        most = most or (SAMPLED_PAIRS if len(scaled.targets) < 4 else PAIRS)
        dyads = with_stated_joints(scaled, dyads)
        pairs = screen(self.motion, scaled.targets[0], dyads, scaled.wanted, most)
        return fully_screened(scaled, pairs[:: -(-len(pairs) // looked) or 1])

    def near_pairs(self, dyads: Dyads, most: int | None = None) -> Screened:
        """Pairs, feasible or not, and the violations of each, except of the user's own requirements."""
        return near_misses(self.motion, self.scaled.targets[0], dyads, self.scaled.wanted, most or NEAR_PAIRS)

    def near(self, rng: np.random.Generator, share: float = 1.0, /) -> Screened:
        """Pairs that meet all requirements; near misses where none does."""
        dyads, most = self.dyads(rng), max(FEWEST_PAIRS, int(share * SOME_PAIRS))
        pairs = self.pairs(dyads, most, max(1, int(share * FOLLOWED)))
        if pairs.feasible.any():
            return pairs[pairs.feasible]
        return fully_screened(self.scaled, self.near_pairs(dyads, most))

    def relaxed(self, rng: np.random.Generator) -> list[Start]:
        """Starts that may miss what no linkage meets."""
        starts = relaxed_starts(self.scaled, self.near_pairs(self.dyads(rng)))
        return [start.under(settled=not self.freedom) for start in starts]


class FewPoses(DyadPairs):
    """Two to four whole poses."""

    def quick_pass(self, rng: np.random.Generator) -> Round | None:
        """The best of far fewer dyads."""
        if self.motion.translates:
            return None
        pairs = self.pairs(self.dyads(rng, QUICK_LINES, QUICK_SAMPLES), QUICK_PAIRS)
        starts = feasible_starts(self.scaled, pairs[pairs.feasible], QUICK_STARTS)
        return Round(starts[:QUICK_STARTS], {}, size=0)

    def round(self, number: int, enough: int, rng: np.random.Generator, _size: int, /) -> Round | None:
        """A round of dyads; where these are samples, of two or three poses, the search for points follows."""
        if number:
            last = SEARCHES if len(self.scaled.targets) < 4 else 0
            return searched_round(self.scaled, enough, rng) if number <= last else None
        scaled = self.scaled
        sideways = parallelogram_starts(scaled, enough, rng) if self.motion.translates else []
        dyads = self.dyads(rng)
        pairs = self.pairs(dyads)
        if seeks_torque(scaled) and len(scaled.targets) < 4:
            pairs = Screened.joined([nearer_to_torque(scaled, self.motion, pairs), pairs])
        feasible = pairs[pairs.feasible]
        starts = feasible_starts(scaled, feasible, enough)
        if len(starts) < enough:
            only_own = len(pairs) > len(feasible)  # nothing but the user's own constraints is violated
            starts += mended_starts(scaled, pairs if only_own else self.near_pairs(dyads), enough)
        # of two translated poses parallelogram linkages alternate with the others
        alternating = [start for both in zip_longest(sideways, starts) for start in both if start]
        return Round(alternating, {"feasible finds": len(feasible), "exact dyads": 0})

    def dyads(self, rng: np.random.Generator, lines: int = LINES, samples: int = SAMPLES) -> Dyads:
        """Dyads all along the curves of four poses; random ones of fewer."""
        scaled, wanted = self.scaled, self.scaled.wanted
        if len(scaled.targets) < 4:
            return sampled_dyads(scaled, self.motion, rng, samples)
        longest = max(limits[1] for limits in wanted.link_lengths)
        _, arm = wanted.coupler_arms or (0.0, np.inf)
        reach = min(1.0 + 1.2 * (arm + longest), 200.0)
        phase = float(rng.uniform(0.1, 0.9))
        traced = trace_four_pose_curves(self.motion, reach, lines, CELL, phase=phase)
        return joined(stated_dyads(scaled, self.motion), traced)

    def obstacle(self, rng: np.random.Generator, _counts: Mapping[str, int], /) -> str:
        """A note that a fixed ground pivot is not a centre point of four poses; empty where it may be one."""
        scaled, dyads = self.scaled, self.dyads(rng)
        for name, pivot in fixed_pivots(scaled.wanted).items():
            apart = float(np.abs(dyads.ground - pivot).min(initial=np.inf))
            if apart > EXACT and len(scaled.targets) == 4:
                x, y = scaled.frame.outward(np.array(pivot))
                return (
                    f"{name} is fixed at ({x:.6g}, {y:.6g}), {apart * scaled.frame.scale:.3g} away from the "
                    "nearest centre point that four poses have"
                )
        return ""


class ManyPoses(DyadPairs):
    """Five whole poses and more, which leave no freedom."""

    def round(self, number: int, _enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """A single round of all linkages; a second one would be the same."""
        if number or size > 1:
            return None
        dyads = self.dyads(rng)
        pairs = self.pairs(dyads)
        starts = starts_of(self.scaled, pairs, best_first(scores(self.scaled, pairs)))
        counts = {"feasible finds": int(pairs.feasible.sum()), "exact dyads": len(dyads)}
        return Round([start.under(settled=True) for start in starts], counts)

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
        """The number of dyads that meet the poses, in words."""
        count, dyads = len(self.scaled.targets), self.dyads(rng)
        guides = len(five_pose_guides(self.motion)) if count == 5 else 0
        sliding = f"; {counted(guides, 'dyad')} would have to be a slider" if guides else ""
        if len(dyads) < 2:
            found = "no real dyad" if not len(dyads) else "a single real dyad"
            return f"the {count} poses have {found}, and a linkage needs two{sliding}"
        few = ", so one linkage at most, or its two drivers" if len(dyads) == 2 else ""
        return f"the {count} poses have {len(dyads)} real dyads only{few}{sliding}"


def first_equal(positions: ComplexArray, rotations: ComplexArray) -> tuple[int, int] | None:
    """The first pose that a later one equals, and the first such later one; None where all differ.

    Positions in sizes and rotations of absolute value 1, each (n,).
    """
    if len(positions) <= FEW:
        moved = sum(np.abs(each[:, None] - each) for each in (positions, rotations))
        equal = np.argwhere(np.triu(moved < EQUAL, k=1))
        return (int(equal[0, 0]), int(equal[0, 1])) if len(equal) else None
    from scipy.spatial import cKDTree  # takes longer to import than many a search

    numbers = np.stack([positions.real, positions.imag, rotations.real, rotations.imag], axis=1)
    tree = cKDTree(numbers)  # in place of all pairs
    for begin in range(0, len(numbers), AT_ONCE):
        some = numbers[begin : begin + AT_ONCE]
        apart = np.asarray(tree.query(some, k=2, distance_upper_bound=2 * EQUAL)[0])[:, 1]
        for i in (begin + np.flatnonzero(np.isfinite(apart))).tolist():
            later = [j for j in sorted(tree.query_ball_point(numbers[i], 2 * EQUAL)) if j > i]
            moved = np.abs(positions[later] - positions[i]) + np.abs(rotations[later] - rotations[i])
            if (moved < EQUAL).any():
                return i, later[int(np.argmax(moved < EQUAL))]
    return None
