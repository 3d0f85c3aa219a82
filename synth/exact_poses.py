"""Starts for motion generation through whole poses, met exactly: dyads by theory, all their pairs.

Two and three poses leave a dyad free in three and two numbers, which are sampled; four poses leave a
curve of dyads (Burmester), which is traced; five leave up to four dyads. What meets more poses is
among the dyads of five of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from grashof.problems import Box, MotionTask, ProblemError
from grashof.problems.checks import ComplexArray, Limits, counted
from grashof.synth.burmester import (
    Displacements,
    Dyads,
    polish,
    radius_error,
    trace_four_pose_curves,
)
from grashof.synth.choose import feasible_starts, mended_starts, merits
from grashof.synth.choose import relaxed_starts as relaxed
from grashof.synth.finds import Finds
from grashof.synth.five_poses import five_pose_dyads, five_pose_guides
from grashof.synth.own import screened
from grashof.synth.screen import near_misses, screen
from grashof.synth.setup import Setup
from grashof.synth.start import Round, Start
from grashof.synth.three_poses import (
    bisector_dyads,
    bisector_dyads_of_ground,
    circle_dyads,
    circle_dyads_of_ground,
)

LINES, CELL = 800, 0.01  # of the traced curves, in sizes
SAMPLES = 4000  # dyads, where they are free in two or three numbers
PAIRS, SAMPLED_PAIRS, NEAR_PAIRS = 1_000_000, 200_000, 150_000  # judged
SUBSETS = 6  # fives of many poses that are tried
NEARLY, EXACT = 1e-4, 1e-9  # radius error in sizes: before and after polishing


def refuse_equal_poses(task: MotionTask) -> None:
    """Raise `ProblemError` when two of the poses are equal: fewer are asked for then."""
    turned = np.exp(1j * task.angles)
    for i, j in combinations(range(len(task)), 2):
        moved = np.abs(task.positions[i] - task.positions[j]).max() / task.size
        if moved + abs(turned[i] - turned[j]) < 1e-12:
            raise ProblemError(
                f"motion.poses[{i}] and motion.poses[{j}] are equal; "
                "allowed are distinct poses, or requirements.exact = false"
            )


def degenerate(setup: Setup) -> str:
    """Why three poses or more have no usable dyads; empty when they may have."""
    motion = _motion(setup)
    turn = motion.rotation[1:] - 1
    if len(turn) == 1:
        return ""
    if np.abs(turn).max() < 1e-9:
        return (
            "the poses are pure translations of each other: only parallelogram linkages, "
            "which have a change point, could carry the body through them"
        )
    widest = 1 + int(np.argmax(np.abs(turn)))
    pole = motion.shift[widest] / (1 - motion.rotation[widest])
    if np.abs(motion.apply(np.array([pole]))[0] - pole).max() < 1e-9:
        x, y = setup.frame.outward(np.array(pole))
        return f"the poses are a pure rotation about ({x:.6g}, {y:.6g}): a single pivot there does the job"
    return ""


def rounds(setup: Setup, enough: int, rng: np.random.Generator, size: int = 1) -> Iterator[Round]:
    """The one round of starts that there is, with the number of feasible pairs of dyads.

    Parameters
    ----------
    setup : Setup
    enough : int
        Distinct designs wanted.
    rng : numpy.random.Generator
    size : int
        Above 1 for more of the same; where the poses leave no freedom, there is none.

    Yields
    ------
    Round
    """
    settled = len(setup.targets) > 4
    if settled and size > 1:
        return
    motion, body, dyads = _motion(setup), setup.targets[0], _dyads(setup, rng)
    most = SAMPLED_PAIRS if len(setup.targets) < 4 else PAIRS
    pairs = screened(setup, screen(motion, body, dyads, setup.wanted, most))
    feasible = pairs[pairs.feasible]
    if settled:
        chosen = np.argsort(-merits(setup, pairs), kind="stable")
        starts = [Start.of_find(pairs, int(index), setup.problem.objective) for index in chosen]
    else:
        starts = feasible_starts(setup, feasible, enough)
        if len(starts) < enough:
            miss_own = len(pairs) > len(feasible)
            near = pairs if miss_own else near_misses(motion, body, dyads, setup.wanted, NEAR_PAIRS)
            starts += mended_starts(setup, near, enough)
    counts = {"feasible finds": len(feasible), "exact dyads": len(dyads) if settled else 0}
    yield Round([replace(start, settled=settled) for start in starts], counts)


def relaxed_starts(setup: Setup, rng: np.random.Generator) -> list[Start]:
    """Starts that may miss what stands in the way."""
    pairs = near_misses(_motion(setup), setup.targets[0], _dyads(setup, rng), setup.wanted, NEAR_PAIRS)
    settled = len(setup.targets) > 4
    return [replace(start, settled=settled) for start in relaxed(setup, pairs)]


def finds(setup: Setup, rng: np.random.Generator) -> Finds:
    """Pairs of dyads that meet all requirements; with what they lack where none does."""
    motion, body, dyads = _motion(setup), setup.targets[0], _dyads(setup, rng)
    most = SAMPLED_PAIRS if len(setup.targets) < 4 else PAIRS
    pairs = screened(setup, screen(motion, body, dyads, setup.wanted, most))
    if pairs.feasible.any():
        return pairs[pairs.feasible]
    return screened(setup, near_misses(motion, body, dyads, setup.wanted, NEAR_PAIRS))


def obstacle(setup: Setup, rng: np.random.Generator) -> str:
    """What theory says of poses without a design; empty where it says nothing."""
    count, dyads = len(setup.targets), _dyads(setup, rng)
    if count > 4:
        guides = len(five_pose_guides(_motion(setup))) if count == 5 else 0
        sliding = f"; {counted(guides, 'dyad')} would have to be a slider" if guides else ""
        if len(dyads) < 2:
            found = "no real dyad" if not len(dyads) else "a single real dyad"
            return f"the {count} poses have {found}, and a linkage needs two{sliding}"
        few = ", so one linkage at most, or its two drivers" if len(dyads) == 2 else ""
        return f"the {count} poses have {len(dyads)} real dyads only{few}{sliding}"
    if count < 4:
        return ""
    for name, pivot in _fixed_pivots(setup):
        apart = float(np.abs(dyads.ground - pivot).min(initial=np.inf)) * setup.frame.scale
        x, y = setup.frame.outward(np.array(pivot))
        if apart > EXACT * setup.frame.scale:
            return (
                f"{name} is fixed at ({x:.6g}, {y:.6g}), {apart:.3g} away from the nearest centre point that "
                "four poses have"
            )
    return ""


def _dyads(setup: Setup, rng: np.random.Generator) -> Dyads:
    motion, count = _motion(setup), len(setup.targets)
    longest = max(limits[1] for limits in setup.wanted.link_lengths)
    arms = setup.wanted.coupler_arms or (0.0, np.inf)
    if count == 4:
        reach = min(1.0 + 1.2 * (arms[1] + longest), 200.0)
        return trace_four_pose_curves(motion, reach, LINES, CELL, phase=float(rng.uniform(0.1, 0.9)))
    if count > 4:
        return _dyads_of_fives(motion, rng)
    return _sampled(setup, motion, arms, longest, rng)


def _sampled(
    setup: Setup, motion: Displacements, arms: Limits, longest: float, rng: np.random.Generator
) -> Dyads:
    """Random dyads of two or three poses: half of them by the joint, half by the pivot."""
    low, high = max(arms[0], 0.01), min(max(arms[1], 0.02), 100.0)
    radius = np.exp(rng.uniform(np.log(low), np.log(high), SAMPLES))
    moving = setup.targets[0] + radius * np.exp(1j * rng.uniform(-np.pi, np.pi, SAMPLES))
    ground = np.concatenate([_pivots(box, longest, rng) for box in (setup.wanted.o2, setup.wanted.o4)])
    if len(setup.targets) == 3:
        halves = circle_dyads(motion, moving), circle_dyads_of_ground(motion, ground)
    else:
        halves = (
            bisector_dyads(motion, moving, rng.normal(0, min(longest, 3.0), len(moving))),
            bisector_dyads_of_ground(motion, ground, rng.normal(0, min(longest, 3.0), len(ground))),
        )
    both = _joined(*halves)
    return both[np.isfinite(both.moving) & np.isfinite(both.ground)]


def _joined(first: Dyads, second: Dyads) -> Dyads:
    return Dyads(np.concatenate([first.moving, second.moving]), np.concatenate([first.ground, second.ground]))


def _pivots(box: Box | None, longest: float, rng: np.random.Generator) -> ComplexArray:
    """Random places of a ground pivot inside its box, within reach of the task."""
    reach = min(3.0 + longest, 100.0)
    x, y = (
        (max(low, -reach), min(high, reach)) if low < reach and high > -reach else (low, high)
        for low, high in (((box or Box()).x), ((box or Box()).y))
    )
    count = SAMPLES // 2 if x[0] < x[1] or y[0] < y[1] else SAMPLES // 20
    wide = rng.uniform(*x, count) + 1j * rng.uniform(*y, count)
    near = np.clip(rng.normal(0, 1.5, count), *x) + 1j * np.clip(rng.normal(0, 1.5, count), *y)
    return np.where(rng.random(count) < 0.5, wide, near)


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
        found = _joined(found, dyads[apart])
        if len(found) >= 4:
            break
    return found


def _fixed_pivots(setup: Setup) -> list[tuple[str, complex]]:
    return [
        (name, complex(box.x[0], box.y[0]))
        for name, box in (("O2", setup.wanted.o2), ("O4", setup.wanted.o4))
        if box is not None and box.x[0] == box.x[1] and box.y[0] == box.y[1]
    ]


def _motion(setup: Setup) -> Displacements:
    if setup.motion is None:
        raise TypeError("a path has no poses")
    return setup.motion
