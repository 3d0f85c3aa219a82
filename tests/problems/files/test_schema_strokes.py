"""Strokes in problem files: read, refused, written."""

import tomllib
from typing import Any

import pytest

from grashof.problems import Problem, ProblemError, StrokeTask, load
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml


def stated(**stroke: Any) -> Problem:
    return problem_from({"kind": "stroke", "stroke": stroke}, "wiper")


def test_a_stroke_is_read() -> None:
    task = stated(swing_deg=80, time_ratio=1.25).task
    assert isinstance(task, StrokeTask)
    assert (round(task.swing, 6), task.time_ratio) == (1.396263, 1.25)


@pytest.mark.parametrize(
    ("stroke", "messages"),
    [
        ({"swing_deg": 200, "time_ratio": 0.5}, ["stroke.swing_deg is 200; ", "stroke.time_ratio is 0.5; "]),
        ({"swing_deg": 80, "stroke": 1, "time_ratio": 1.1}, ["stroke has both swing_deg and stroke; "]),
        ({"time_ratio": 1.1}, ["stroke has neither swing_deg nor stroke; "]),
        ({"swing_deg": 80}, ["stroke.time_ratio is missing"]),
        ({"swing_deg": 80, "time_ratio": 7}, ["stroke.time_ratio is 7; it must be less than 6.2 "]),
        ({"stroke": 100, "time_ratio": 1.2}, ["stroke.stroke is of a slide; a four-bar has a swing"]),
        ({"swing": 80, "time_ratio": 1.2}, ["stroke.swing is unknown; did you mean swing_deg?"]),
        ({"swing_deg": "wide", "time_ratio": 1.2}, ["stroke.swing_deg is 'wide'; it must be a number"]),
        ({"swing_deg": 80, "time_ratio": True}, ["stroke.time_ratio is True; it must be a number"]),
    ],
)
def test_each_error_is_a_line(stroke: dict[str, Any], messages: list[str]) -> None:
    with pytest.raises(ProblemError) as error:
        stated(**stroke)
    lines = str(error.value).splitlines()
    assert len(lines) == len(messages)
    assert all(
        line.lower().startswith(message.lower()) for line, message in zip(lines, messages, strict=True)
    )


def test_other_tables_do_not_belong() -> None:
    path = {"points": [[0, 0], [1, 1], [2, 0]]}
    for document in (
        {"kind": "stroke", "stroke": {"swing_deg": 80, "time_ratio": 1.1}, "path": path},
        {"kind": "path", "path": path, "stroke": {"swing_deg": 80, "time_ratio": 1.1}},
    ):
        with pytest.raises(ProblemError, match=r'^(path|stroke) does not belong to kind = "(stroke|path)"$'):
            problem_from(document, "both")
    with pytest.raises(ProblemError, match=r"^stroke is missing$"):
        problem_from({"kind": "stroke"}, "none")


@pytest.mark.parametrize("swing", [80.0, 0.1 + 0.2, 33.3, 179.99])
def test_written_and_read_again_it_is_the_same(swing: float) -> None:
    text = problem_toml(stated(swing_deg=swing, time_ratio=1.0))
    document = tomllib.loads(text)
    assert document["stroke"] == {"swing_deg": swing, "time_ratio": 1.0}
    assert problem_toml(problem_from(document, "wiper")) == text


def test_the_catalogue_has_a_quick_return() -> None:
    task = load("quick-return").task
    assert isinstance(task, StrokeTask)
    assert task.size == 120
