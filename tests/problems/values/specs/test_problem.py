"""The complete problem, and its search."""

from typing import Any

import pytest

from grashof.problems import FourBar, LinkageSpec, MotionTask, PathTask, Problem, ProblemError, Search
from grashof.problems.values.specs import problem

TASK = MotionTask.from_degrees([[0, 0, 0], [3, 4, 90]])


def test_outlines_become_read_only_arrays_of_their_own_length() -> None:
    outlines = Problem(task=TASK, outlines=([[0, 0], [1, 0]], [[0, 0], [1, 1], [2, 0]])).outlines  # type: ignore[arg-type]
    assert [outline.tolist() for outline in outlines] == [[[0, 0], [1, 0]], [[0, 0], [1, 1], [2, 0]]]
    with pytest.raises(ValueError, match="read-only"):
        outlines[0][0] = 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"enough": 2.5}, "search.enough is 2.5; it must be a whole number from 1"),
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


def test_the_number_of_targets_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    assert problem.MOST_TARGETS == 10_000
    monkeypatch.setattr(problem, "MOST_TARGETS", 3)
    points = [[0, 0], [1, 0], [2, 1], [3, 3]]
    assert len(Problem(task=PathTask(points[1:])).task) == 3
    with pytest.raises(ProblemError, match=r"^the task has 4 targets; it must have at most 3$"):
        Problem(task=PathTask(points))
