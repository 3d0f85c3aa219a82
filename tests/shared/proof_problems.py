"""Problems for tests of proofs: luggage and bonnet under other limits, random poses, planted ones."""

from dataclasses import replace
from typing import Any

import numpy as np

from grashof import load
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, MotionTask, Problem, Requirements
from grashof.problems.values.arrays import Limits

STAIRS = np.array([[0, -9], [0, 0], [5, 0], [5, 4], [9, 4], [9, -9]], dtype=np.float64)
BRACKET, PLATE = Box((-60, 350), (-260, -60)), Box((0, 350), (-100, -10))
INSIDE = 1e-6  # sizes, by which planted limits hold their linkage


def luggage(**requirements: Any) -> Problem:
    """The luggage problem under other limits."""
    problem = load("luggage")
    wanted = {"transmission_min_deg": 0.0, **requirements}
    return replace(problem, requirements=replace(problem.requirements, **wanted))


def with_links(longest: float, shortest: float = 0.3, **requirements: Any) -> Problem:
    """The luggage problem with limits of links and arms, m."""
    limits = (shortest, longest)
    return luggage(**{"link_length": limits, "coupler_arms": limits, **requirements})


def of_three(problem: Problem) -> Problem:
    """A problem of four poses without the third one."""
    task = problem.task
    kept = MotionTask(task.positions[[0, 1, 3]], task.angles[[0, 1, 3]])
    return replace(problem, task=kept)


def bonnet(**requirements: Any) -> Problem:
    """The gallery's bonnet hinge."""
    limits = {"o2": BRACKET, "o4": BRACKET, "a_on_body": PLATE, "b_on_body": PLATE}
    wanted: dict[str, Any] = {"rotatability": "any", "link_length": (60, 260), **limits, **requirements}
    task = MotionTask.from_degrees([[0, 0, 0], [20, 33, 10], [76, 10, 50]])
    return Problem(length_unit="mm", task=task, requirements=Requirements(**wanted))


def random_poses(
    seed: int, poses: int, turned: float = 180.0, low: float = 0.0, mechanism: str = "four-bar", **wanted: Any
) -> Problem:
    """Poses from `low` to `low` + 1, turned by at most `turned` degrees either way."""
    rng = np.random.default_rng(seed)
    rows = np.column_stack([rng.uniform(low, low + 1, (poses, 2)), rng.uniform(-turned, turned, poses)])
    task = MotionTask.from_degrees(rows)
    return Problem(task=task, mechanism=mechanism, requirements=Requirements(**wanted))


def planted(seed: int, poses: int = 4, mechanism: str = "four-bar", **wanted: Any) -> Problem:
    """Poses of a random linkage that turns fully."""
    task, _ = planted_motion(np.random.default_rng(seed), poses, mechanism=mechanism)
    return Problem(task=task, mechanism=mechanism, requirements=Requirements(**wanted))


def planted_limits(seed: int, poses: int) -> tuple[MotionTask, dict[str, Limits], dict[str, Box]]:
    """A planted task, and limits of the lengths and boxes of the pivots that just hold its linkage."""
    task, linkage = planted_motion(np.random.default_rng(seed), poses)
    room, margin = 0.02 * float(task.size), INSIDE * float(task.size)
    lengths = {
        name: (float(length) - room, float(length) + margin)
        for name, length in zip(("r1", "r2", "r3", "r4"), linkage.lengths, strict=True)
    }
    boxes = {
        name: Box((float(x) - room, float(x) + margin), (float(y) - margin, float(y) + room))
        for name, (x, y) in (("o2", linkage.o2), ("o4", linkage.o4))
    }
    return task, lengths, boxes


def rotation(*angles: float) -> MotionTask:
    """Poses, at angles in rad, that are a rotation about one point."""
    return MotionTask.from_degrees([(np.cos(t), np.sin(t), np.degrees(t)) for t in angles])


TRANSLATIONS = [(0, 0, 0), (1, 0, 0), (2, 1, 0), (1, 3, 0)]
