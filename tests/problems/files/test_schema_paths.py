"""Paths in problem files."""

import tomllib

import numpy as np
import pytest

from grashof.problems import PathTask, Problem, ProblemError
from grashof.problems.files.problem_schema import problem_from

POSES = "poses = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]"
HEAD = f'kind = "motion"\n[motion]\n{POSES}\n'


def problem(text: str) -> Problem:
    return problem_from(tomllib.loads(text), "test")


def message(text: str) -> str:
    with pytest.raises(ProblemError) as caught:
        problem(text)
    assert caught.value.__cause__ is None
    return str(caught.value)


LINE = 'kind = "path"\n[path]\npoints = [[20, 20], [20, 25], [21, 30]]\n'


def test_every_key_of_a_path_reaches_its_field() -> None:
    task = problem(LINE + "timing_deg = [0, -20, -45.5]\nclosed = true\n").task
    assert isinstance(task, PathTask)
    assert task.points.tolist() == [[20, 20], [20, 25], [21, 30]]
    assert task.timing is not None
    assert task.timing.tolist() == np.radians([0, -20, -45.5]).tolist()
    assert task.closed
    plain = problem(LINE).task
    assert isinstance(plain, PathTask)
    assert (plain.timing, plain.closed) == (None, False)


@pytest.mark.parametrize(("given", "expected"), [("true", True), ("false", False), (None, None)])
@pytest.mark.parametrize("head", [HEAD, LINE])
def test_exact_is_true_false_or_left_to_the_task(head: str, given: str | None, expected: bool | None) -> None:
    text = head + ("" if given is None else f"[requirements]\nexact = {given}")
    assert problem(text).requirements.exact is expected


PATHS = [
    ('kind = "path"', "path is missing"),
    ('kind = "path"\n[path]', "path.points is missing"),
    (LINE + f"[motion]\n{POSES}", 'motion does not belong to kind = "path"'),
    (HEAD + "[path]\npoints = [[20, 20], [20, 25], [21, 30]]", 'path does not belong to kind = "motion"'),
    (f'kind = "path"\n[motion]\n{POSES}', 'motion does not belong to kind = "path"'),
    ('kind = "path"\n[paht]\npoints = [[1, 2]]', "paht is unknown; did you mean path?"),
    (LINE + "timing = [0, 1, 2]", "path.timing is unknown; did you mean timing_deg?"),
    (LINE + "poses = 3", "path.poses is unknown; did you mean motion.poses?"),
    (
        'kind = "path"\n[path]\npoints = 5',
        "path.points is 5; it must be a list of points [x, y], or a .csv or .xlsx file",
    ),
    ('kind = "path"\n[path]\npoints = [5]', "path.points[0] is 5; it must be a point [x, y]"),
    (
        'kind = "path"\n[path]\npoints = [[1, 2], [3, "4"]]',
        "path.points[1][1] is '4'; it must be a number",
    ),
    (
        'kind = "path"\n[path]\npoints = [[1, 2], [3, 4, 5], [6, 7]]',
        "path.points[1] is [3.0, 4.0, 5.0], 3 numbers; it must be a point [x, y]",
    ),
    (
        'kind = "path"\n[path]\npoints = [[1, 2], [3, 4]]',
        "path.points has 2 points; it must have three or more",
    ),
    (LINE + "closed = 1", "path.closed is 1; it must be true or false"),
    (LINE + "timing_deg = 20", "path.timing_deg is 20; it must be a list of angles"),
    (LINE + "timing_deg = [0, '20', 40]", "path.timing_deg[1] is '20'; it must be a number"),
    (LINE + "timing_deg = [0, 20]", "path.timing_deg has 2 angles for 3 points"),
    (LINE + "timing_deg = [5, 20, 30]", "path.timing_deg[0] is 5; it must be 0, at the first point"),
    (
        LINE + "timing_deg = [0, 20, 10]",
        "path.timing_deg[2] is 10 after 20; the angles must only grow, or only fall",
    ),
]


@pytest.mark.parametrize(("text", "expected"), PATHS)
def test_bad_paths(text: str, expected: str) -> None:
    assert message(text) == expected
