"""Targets that put P or the body into an area kept out are refused before any search."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof.problems import MotionTask, PathTask, Problem, ProblemError, Requirements, Task

AREA = [[2.5, 2.0], [6.0, 2.0], [6.0, 6.0], [2.5, 6.0]]
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
POSES = MotionTask([[0, 0], [2, 1.5], [3, 3]], np.radians([0, 25, 90]), body=SQUARE)
POINTS = PathTask([[0, 0], [2, 1.5], [3, 3]])


def stated(task: Task, *parts: str, **others: Any) -> Problem:
    return Problem(task=task, requirements=Requirements(keep_out=[AREA], keep_out_for=parts, **others))


@pytest.mark.parametrize(
    ("task", "parts", "line"),
    [
        (POSES, ("p",), r"requirements.keep_out: motion.poses\[2\] puts P 0.5 deep inside an area"),
        (POSES, ("links",), r"motion.poses\[2\] puts P 0.5 deep"),
        (POINTS, ("p", "o2"), r"requirements.keep_out: path.points\[2\] puts P 0.5 deep inside an area"),
        (POSES, ("body",), r"motion.poses\[2\] puts the body 0.5 deep"),
    ],
)
def test_targets_inside_an_area_are_named(task: Task, parts: tuple[str, ...], line: str) -> None:
    with pytest.raises(ProblemError, match=line):
        stated(task, *parts)


def test_a_side_that_only_cuts_an_area_counts() -> None:
    thin = [[2.6, 1.9], [2.65, 1.9], [2.65, 5.0], [2.6, 5.0]]
    problem = Requirements(keep_out=[thin], keep_out_for=("body",))
    with pytest.raises(ProblemError, match=r"motion.poses\[1\] puts the body 0.025 deep"):
        Problem(task=POSES, requirements=problem)


def test_a_boundary_may_be_touched_and_targets_that_may_be_missed_are_free() -> None:
    touching = MotionTask([[0, 0], [2, 1.5], [2.5, 3]], np.radians([0, 25, 90]), body=SQUARE)
    only_touching = replace(touching, positions=touching.positions * [1, 0.4])
    stated(only_touching, "p")
    stated(POSES, "o2", "o4", "a", "b")
    stated(POSES, "p", "body", exact=False)
    stated(replace(POSES, within=np.full(3, 1.0)), "p", "body")
