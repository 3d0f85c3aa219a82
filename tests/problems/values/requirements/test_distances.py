"""Limits of distances: their names, and what they refuse."""

from typing import Any

import numpy as np
import pytest

from grashof import load
from grashof.problems import FunctionTask, Problem, ProblemError, Requirements, TargetLimits
from grashof.problems.values.requirements.distances import Distances

NAMES = "it must be a-o4, b-o2, a-p, b-p, o2-p or o4-p"


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, "distances is {}; it must be a table such as { a-o4 = [2, 3] }"),
        ({"a-c": 1}, f"distances has 'a-c'; {NAMES}"),
        ({"a": 1}, f"distances has 'a'; {NAMES}"),
        ({2: 1}, f"distances has 2; {NAMES}"),
        ({"a-a": 1}, f"distances has 'a-a'; {NAMES}"),
        ({"o4-o2": 1}, "distances has 'o4-o2'; limit r1, the length of that link"),
        ({"b-a": 1}, "distances has 'b-a'; limit r3, the length of that link"),
        ({"a-o4": (3, 2)}, "distances.a-o4 is [3, 2]: lo exceeds hi"),
        ({"o4-a": -1}, "distances.o4-a is [-1, -1]; lo must be at least 0"),
        ({"o4-a": 1, "a-o4": 2}, "distances has a-o4 twice; give it once"),
    ],
)
def test_wrong_distances_are_refused_in_a_line(given: Any, line: str) -> None:
    with pytest.raises(ProblemError) as refused:
        Distances.checked(given, "distances")
    assert str(refused.value).startswith(line)
    assert "\n" not in str(refused.value)


def test_either_order_of_the_points_is_the_same_limit() -> None:
    one, other = (Requirements(distances={name: (1, 2)}) for name in ("o4-a", "a-o4"))
    assert one == other
    assert one.ranges("distances") == {"a-o4": (1.0, 2.0)}


def test_distances_that_a_task_or_kind_lacks_are_refused() -> None:
    task = load("luggage").task
    function = FunctionTask(np.radians([0, 20, 40]), np.radians([0, 10, 30]))
    for kind, given, line in (
        ("slider-crank", {"a-o4": 1}, r"requirements\.distances\.a-o4 .* inverted-slider-crank"),
        ("inverted-slider-crank", {"b-p": 1}, r"requirements\.distances\.b-p"),
    ):
        with pytest.raises(ProblemError, match=line):
            Problem(task=task, requirements=Requirements(distances=given), mechanism=kind)
        at = (TargetLimits(targets=[1], distances=given),)
        with pytest.raises(ProblemError, match=r"requirements\.at\[.\]\.distances"):
            Problem(task=task, requirements=Requirements(at=at), mechanism=kind)
    with pytest.raises(ProblemError, match=r"distances.b-p does not apply to a function"):
        Problem(task=function, requirements=Requirements(distances={"b-p": 1, "b-o2": (1, 2)}))


def test_of_a_list_of_kinds_each_keeps_the_distances_that_it_has() -> None:
    both = Requirements(
        distances={"a-o4": (1, 2), "b-o2": (3, 4)}, at=(TargetLimits(targets=[1], distances={"a-o4": 1}),)
    )
    problem = Problem(task=load("luggage").task, requirements=both, mechanism=["four-bar", "slider-crank"])
    alone = problem.for_kind("slider-crank").requirements
    assert alone.distances == Distances.checked({"b-o2": (3, 4)}, "")
    assert alone.at == ()
