"""The complete problem, and its search."""

import re
from typing import Any

import pytest
from refusals import refusal

from grashof.problems import FourBar, LinkageSpec, MotionTask, PathTask, Problem, ProblemError, Search
from grashof.problems.values.specs import problem

TASK = MotionTask.from_degrees([[0, 0, 0], [3, 4, 90]])


def test_outlines_become_read_only_arrays_of_their_own_length() -> None:
    outlines = Problem(task=TASK, outlines=([[0, 0], [1, 0]], [[0, 0], [1, 1], [2, 0]])).outlines  # type: ignore[arg-type]
    assert [outline.tolist() for outline in outlines] == [[[0, 0], [1, 0]], [[0, 0], [1, 1], [2, 0]]]
    with pytest.raises(ValueError, match="read-only"):
        outlines[0][0] = 1


PLAIN = (Problem, LinkageSpec)  # their words are plain text
WORDS = ("name", "title", "source", "length_unit")
FOUR_BAR = FourBar((0, 0), (4, 0), 1, 4, 3)
BAD: list[tuple[Any, dict[str, Any], str]] = [
    (Search, {"enough": 2.5}, "search.enough is 2.5; it must be a whole number from 1"),
    (Search, {"seed": 10**300}, r"search.* is .*; it must be a whole number from 0, of up to 300 digits"),
    (Search, {"starts": 16**5000}, r"search.* is .*; it must be a whole number from 1, of up to 300 digits"),
    (Problem, {"task": 5}, r"problem.task is 5; it must be MotionTask or PathTask or StrokeTask or Tan.*"),
    (Problem, {"requirements": None}, r"problem.requirements is None; it must be Requirements"),
    (Problem, {"manufacturing": 0.1}, r"problem.manufacturing is 0.1; it must be Manufacturing or None"),
    (Problem, {"dynamics": 7}, r"problem.dynamics is 7; it must be DynamicsSpec or None"),
    (Problem, {"name": 3}, r"problem.name is 3; it must be str"),
    (Problem, {"outlines": None}, r"scene.outlines is None; it must be a list of outlines"),
    *((made, {name: "bell \a"}, rf"{name} has .* U\+0007; .*") for name in WORDS for made in PLAIN),
]  # fmt: skip


@pytest.mark.parametrize(("make", "given", "said"), BAD)
def test_wrong_parts_are_refused(make: Any, given: dict[str, Any], said: str) -> None:
    rest = {Problem: {"task": TASK}, LinkageSpec: {"linkage": FOUR_BAR, "name": "n"}}.get(make, {})
    assert re.fullmatch(said, refusal(make, **rest | given))


def test_the_number_of_targets_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    assert problem.MOST_TARGETS == 10_000
    monkeypatch.setattr(problem, "MOST_TARGETS", 3)
    points = [[0, 0], [1, 0], [2, 1], [3, 3]]
    assert len(Problem(task=PathTask(points[1:])).task) == 3
    with pytest.raises(ProblemError, match=r"^the task has 4 targets; it must have at most 3$"):
        Problem(task=PathTask(points))
