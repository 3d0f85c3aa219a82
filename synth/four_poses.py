"""Starts for motion generation through four exact poses: both dyad curves, all their pairs."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from grashof.problems import MotionTask, ProblemError
from grashof.synth.burmester import Displacements, Dyads, trace_four_pose_curves
from grashof.synth.choose import feasible_starts, mended_starts
from grashof.synth.choose import relaxed_starts as relaxed
from grashof.synth.screen import near_misses, screen
from grashof.synth.setup import Setup
from grashof.synth.start import Round, Start

LINES, CELL = 800, 0.01  # of the traced curves, in sizes
PAIRS, NEAR_PAIRS = 1_000_000, 150_000  # judged


def refuse_equal_poses(task: MotionTask) -> None:
    """Raise `ProblemError` when two of the poses are equal: fewer than four are asked for then."""
    turned = np.exp(1j * task.angles)
    for i, j in combinations(range(len(task)), 2):
        moved = np.abs(task.positions[i] - task.positions[j]).max() / task.size
        if moved + abs(turned[i] - turned[j]) < 1e-12:
            raise ProblemError(
                f"motion.poses[{i}] and motion.poses[{j}] are equal; "
                "this version synthesises four distinct poses"
            )


def degenerate(setup: Setup) -> str:
    """Why four poses have no dyad curves; empty when they have."""
    motion = _motion(setup)
    turn = motion.rotation[1:] - 1
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


def rounds(setup: Setup, enough: int, rng: np.random.Generator) -> Iterator[Round]:
    """The one round of starts that there is, with the number of feasible pairs of dyads.

    Parameters
    ----------
    setup : Setup
    enough : int
        Distinct designs wanted.
    rng : numpy.random.Generator

    Yields
    ------
    Round
    """
    motion, body, dyads = _motion(setup), setup.targets[0], _dyads(setup, rng)
    feasible = screen(motion, body, dyads, setup.wanted, PAIRS)
    starts = feasible_starts(setup, feasible, enough)
    if len(starts) < enough:
        near = near_misses(motion, body, dyads, setup.wanted, NEAR_PAIRS)
        starts += mended_starts(setup, near, enough)
    yield Round(starts, {"feasible finds": len(feasible)})


def relaxed_starts(setup: Setup, rng: np.random.Generator) -> list[Start]:
    """Starts that may miss what stands in the way."""
    pairs = near_misses(_motion(setup), setup.targets[0], _dyads(setup, rng), setup.wanted, NEAR_PAIRS)
    return relaxed(setup, pairs)


def _dyads(setup: Setup, rng: np.random.Generator) -> Dyads:
    longest = max(limits[1] for limits in setup.wanted.link_lengths)
    arms = setup.wanted.coupler_arms or (0.0, np.inf)
    reach = min(1.0 + 1.2 * (arms[1] + longest), 200.0)
    return trace_four_pose_curves(_motion(setup), reach, LINES, CELL, phase=float(rng.uniform(0.1, 0.9)))


def _motion(setup: Setup) -> Displacements:
    if setup.motion is None:
        raise TypeError("a path has no poses")
    return setup.motion
