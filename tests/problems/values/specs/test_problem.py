"""Objective, search and the whole problem."""

import math
from typing import Any

import numpy as np
import pytest

from grashof.problems import (
    FourBar,
    LinkageSpec,
    MotionTask,
    Objective,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    Search,
)

TASK = MotionTask.from_degrees([[0, 0, 0], [3, 4, 90]])


def test_defaults() -> None:
    problem = Problem(task=TASK)
    assert problem.objective == Objective(transmission=1.0, compactness=0.0)
    assert problem.search == Search(starts=200, enough=50, seed=0)
    assert problem.requirements == Requirements()
    assert (problem.name, problem.title, problem.source, problem.length_unit) == ("problem", "", "", "")
    assert problem.outlines == ()


def test_outlines_become_read_only_arrays_of_their_own_length() -> None:
    problem = Problem(task=TASK, outlines=([[0, 0], [1, 0]], [[0, 0], [1, 1], [2, 0]]))  # type: ignore[arg-type]
    assert [outline.tolist() for outline in problem.outlines] == [[[0, 0], [1, 0]], [[0, 0], [1, 1], [2, 0]]]
    with pytest.raises(ValueError, match="read-only"):
        problem.outlines[0][0] = 1


@pytest.mark.parametrize(
    ("outlines", "message"),
    [
        (
            [[[0, 0], [1, 0]], [[0, 0], [1, 0, 0]]],
            r"scene.outlines\[1\]\[1\] is \[1, 0, 0\], 3 numbers; it must be a corner",
        ),
        ([[[0, 0], [math.inf, 0]]], r"scene.outlines\[0\]\[1\] is \[inf, 0\]; all numbers must be finite"),
        ([[[0, 0]]], r"scene.outlines\[0\] has 1 corner; it must have two or more"),
    ],
)
def test_bad_outlines(outlines: list[list[list[float]]], message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}"):
        Problem(task=TASK, outlines=tuple(outlines))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        ((-1, 2), r"objective.maximise.transmission is -1; it must be from 0 to 1e\+09"),
        ((1, 1e300), r"objective.maximise.compactness is 1e\+300; it must be from 0 to 1e\+09"),
        ((1, -0.5), r"objective.maximise.compactness is -0.5; it must be from 0 to 1e\+09"),
        ((1, math.nan), "objective.maximise.compactness is nan; it must be a finite number"),
        ((1, 0, -1), r"objective.maximise.torque is -1; it must be from 0 to 1e\+09"),
        ((0, 0), "objective.maximise has no weight greater than zero; one at least is needed"),
    ],
)
def test_bad_weights(weights: tuple[float, ...], message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}$"):
        Objective(*weights)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"starts": 0}, "search.starts is 0; it must be a whole number from 1"),
        ({"enough": 2.5}, "search.enough is 2.5; it must be a whole number from 1"),
        ({"seed": -1}, "search.seed is -1; it must be a whole number from 0"),
        ({"seed": 10**300}, r"search.* is .*; it must be a whole number from 0, of up to 300 digits"),
        ({"starts": 16**5000}, r"search.* is .*; it must be a whole number from 1, of up to 300 digits"),
    ],
)
def test_bad_search(change: dict[str, int], message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}$"):
        Search(**change)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"task": 5}, r"problem.task is 5; it must be MotionTask or PathTask or StrokeTask or FunctionTask"),
        ({"requirements": None}, r"problem.requirements is None; it must be Requirements"),
        ({"manufacturing": 0.1}, r"problem.manufacturing is 0.1; it must be Manufacturing or None"),
        ({"name": 3}, r"problem.name is 3; it must be str"),
        ({"outlines": None}, r"scene.outlines is None; it must be a list of outlines"),
    ],
)
def test_parts_of_another_kind_are_refused(parts: dict[str, Any], message: str) -> None:
    with pytest.raises(ProblemError, match=f"^{message}$"):
        Problem(**{"task": TASK, **parts})


@pytest.mark.parametrize("key", ["order", "same_branch", "exact"])
def test_words_are_no_truths(key: str) -> None:
    with pytest.raises(ProblemError, match=f"^requirements.{key} is 'no'; it must be true or false$"):
        Requirements(**{key: "no"})  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["name", "title", "source", "length_unit"])
def test_words_are_plain_text(name: str) -> None:
    for kind, rest in (
        (Problem, {"task": TASK}),
        (LinkageSpec, {"linkage": FourBar((0, 0), (4, 0), 1, 4, 3)}),
    ):
        given: dict[str, Any] = {"name": "n", **rest, name: "bell \a"}
        with pytest.raises(
            ProblemError, match=rf"^{name} has control character U\+0007; it must be plain text$"
        ):
            kind(**given)


def test_a_task_has_ten_thousand_targets_at_most() -> None:
    turn = np.linspace(0, 6, 10_001)
    points = np.column_stack([np.cos(turn), np.sin(turn)])
    assert len(Problem(task=PathTask(points[1:])).task) == 10_000
    with pytest.raises(ProblemError, match=r"^the task has 10001 targets; it must have at most 10000$"):
        Problem(task=PathTask(points))
