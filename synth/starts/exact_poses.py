"""Starts for motion generation through whole poses, met exactly: dyads by theory, all their pairs.

Pure translations have parallelogram linkages. Else two and three poses leave a dyad free in three and
two numbers, which are sampled; four poses leave a curve of dyads (Burmester), which is traced; five leave
up to four dyads. What meets more poses is among the dyads of five of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations, zip_longest

import numpy as np

from grashof.problems import ProblemError, Task
from grashof.problems.values.checks import counted
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import Screened
from grashof.synth.programme.start import Round, Start
from grashof.synth.programme.user_constraints import screened
from grashof.synth.starts import parallelograms
from grashof.synth.starts.dyad_pairs import near_misses, screen
from grashof.synth.starts.parallelograms import translates
from grashof.synth.starts.sampled_dyads import joined, sampled_dyads
from grashof.synth.starts.selection import feasible_starts, mended_starts, merits
from grashof.synth.starts.selection import relaxed_starts as relaxed
from grashof.synth.theory.burmester import Displacements, Dyads, polish, radius_error, trace_four_pose_curves
from grashof.synth.theory.five_poses import five_pose_dyads, five_pose_guides

LINES, CELL = 800, 0.01  # of the traced curves, in sizes
PAIRS, SAMPLED_PAIRS, NEAR_PAIRS = 1_000_000, 200_000, 150_000  # judged
SUBSETS = 6  # fives of many poses that are tried
NEARLY, EXACT = 1e-4, 1e-9  # radius error in sizes: before and after polishing


def refuse_equal_poses(task: Task) -> None:
    """Raise `ProblemError` when two of the poses are equal: fewer are asked for then."""
    turned = np.exp(1j * task.angles)
    for i, j in combinations(range(len(task)), 2):
        moved = np.abs(task.positions[i] - task.positions[j]).max() / task.size
        if moved + abs(turned[i] - turned[j]) < 1e-12:
            raise ProblemError(
                f"motion.poses[{i}] and motion.poses[{j}] are equal; "
                "allowed are distinct poses, or requirements.exact = false"
            )


def degenerate(scaled: ScaledProblem) -> str:
    """Why three poses or more have no usable dyads; empty when they may have."""
    motion = _motion(scaled)
    turn = motion.rotation[1:] - 1
    if len(turn) == 1:
        return ""
    if translates(motion):
        return ""
    widest = 1 + int(np.argmax(np.abs(turn)))
    pole = motion.shift[widest] / (1 - motion.rotation[widest])
    if np.abs(motion.apply(np.array([pole]))[0] - pole).max() < 1e-9:
        x, y = scaled.frame.outward(np.array(pole))
        return f"the poses are a pure rotation about ({x:.6g}, {y:.6g}): a single pivot there does the job"
    return ""


def rounds(scaled: ScaledProblem, enough: int, rng: np.random.Generator, size: int = 1) -> Iterator[Round]:
    """The one round of starts that there is, with the number of feasible pairs of dyads.

    Parameters
    ----------
    scaled : ScaledProblem
    enough : int
        Distinct designs wanted.
    rng : numpy.random.Generator
    size : int
        Above 1 for more of the same; where the poses leave no freedom, there is none.

    Yields
    ------
    Round
    """
    motion, body, settled = _motion(scaled), scaled.targets[0], len(scaled.targets) > 4
    if settled and size > 1:
        return
    sideways = parallelograms.starts(scaled, enough, rng) if translates(motion) else []
    if translates(motion) and len(scaled.targets) > 2:
        yield Round(sideways, {"feasible linkages": len(sideways)})
        return
    dyads = _dyads(scaled, rng)
    most = SAMPLED_PAIRS if len(scaled.targets) < 4 else PAIRS
    pairs = screened(scaled, screen(motion, body, dyads, scaled.wanted, most))
    feasible = pairs[pairs.feasible]
    if settled:
        chosen = np.argsort(-merits(scaled, pairs), kind="stable")
        starts = [Start.of_find(pairs, int(index), scaled.problem.objective) for index in chosen]
    else:
        starts = feasible_starts(scaled, feasible, enough)
        if len(starts) < enough:
            miss_own = len(pairs) > len(feasible)
            near = pairs if miss_own else near_misses(motion, body, dyads, scaled.wanted, NEAR_PAIRS)
            starts += mended_starts(scaled, near, enough)
    counts = {"feasible linkages": len(feasible), "exact dyads": len(dyads) if settled else 0}
    starts = [replace(start, settled=settled) for start in starts]
    yield Round([start for pair in zip_longest(sideways, starts) for start in pair if start], counts)


def relaxed_starts(scaled: ScaledProblem, rng: np.random.Generator) -> list[Start]:
    """Starts that may miss what stands in the way."""
    if translates(_motion(scaled)) and len(scaled.targets) > 2:
        return relaxed(scaled, finds(scaled, rng))
    pairs = near_misses(_motion(scaled), scaled.targets[0], _dyads(scaled, rng), scaled.wanted, NEAR_PAIRS)
    settled = len(scaled.targets) > 4
    return [replace(start, settled=settled) for start in relaxed(scaled, pairs)]


def finds(scaled: ScaledProblem, rng: np.random.Generator) -> Screened:
    """Pairs of dyads that meet all requirements; near misses where none does."""
    motion, body = _motion(scaled), scaled.targets[0]
    if translates(motion) and len(scaled.targets) > 2:
        return parallelograms.finds(scaled, rng)
    dyads = _dyads(scaled, rng)
    most = SAMPLED_PAIRS if len(scaled.targets) < 4 else PAIRS
    pairs = screened(scaled, screen(motion, body, dyads, scaled.wanted, most))
    if pairs.feasible.any():
        return pairs[pairs.feasible]
    return screened(scaled, near_misses(motion, body, dyads, scaled.wanted, NEAR_PAIRS))


def obstacle(scaled: ScaledProblem, rng: np.random.Generator) -> str:
    """What theory says of poses without a design; empty where it says nothing."""
    count = len(scaled.targets)
    if translates(_motion(scaled)) and count > 2:
        return parallelograms.obstacle(scaled)
    dyads = _dyads(scaled, rng)
    if count > 4:
        guides = len(five_pose_guides(_motion(scaled))) if count == 5 else 0
        sliding = f"; {counted(guides, 'dyad')} would have to be a slider" if guides else ""
        if len(dyads) < 2:
            found = "no real dyad" if not len(dyads) else "a single real dyad"
            return f"the {count} poses have {found}, and a linkage needs two{sliding}"
        few = ", so one linkage at most, or its two drivers" if len(dyads) == 2 else ""
        return f"the {count} poses have {len(dyads)} real dyads only{few}{sliding}"
    if count < 4:
        return ""
    for name, pivot in _fixed_pivots(scaled):
        apart = float(np.abs(dyads.ground - pivot).min(initial=np.inf)) * scaled.frame.scale
        x, y = scaled.frame.outward(np.array(pivot))
        if apart > EXACT * scaled.frame.scale:
            return (
                f"{name} is fixed at ({x:.6g}, {y:.6g}), {apart:.3g} away from the nearest centre point that "
                "four poses have"
            )
    return ""


def _dyads(scaled: ScaledProblem, rng: np.random.Generator) -> Dyads:
    motion, count = _motion(scaled), len(scaled.targets)
    longest = max(limits[1] for limits in scaled.wanted.link_lengths)
    arms = scaled.wanted.coupler_arms or (0.0, np.inf)
    if count == 4:
        reach = min(1.0 + 1.2 * (arms[1] + longest), 200.0)
        return trace_four_pose_curves(motion, reach, LINES, CELL, phase=float(rng.uniform(0.1, 0.9)))
    if count > 4:
        return _dyads_of_fives(motion, rng)
    return sampled_dyads(motion, scaled.targets[0], scaled.wanted, rng)


def _dyads_of_fives(motion: Displacements, rng: np.random.Generator) -> Dyads:
    """Dyads of five of the poses that meet all of them; of several fives where there are more."""
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


def _fixed_pivots(scaled: ScaledProblem) -> list[tuple[str, complex]]:
    return [
        (name, complex(box.x[0], box.y[0]))
        for name, box in (("O2", scaled.wanted.o2), ("O4", scaled.wanted.o4))
        if box is not None and box.x[0] == box.x[1] and box.y[0] == box.y[1]
    ]


def _motion(scaled: ScaledProblem) -> Displacements:
    if scaled.motion is None:
        raise TypeError("a path has no poses")
    return scaled.motion
