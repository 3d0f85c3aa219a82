"""Paths, zones, areas kept out and strokes in problem files: read, refused, written."""

import tomllib
from typing import Any

import numpy as np
import pytest
from refusals import MOTION, PATH, POSES, message, problem, refusal, rows

from grashof.problems import MotionTask, PathTask, Problem, ProblemError, StrokeTask
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml


def test_every_key_of_a_path_reaches_its_field() -> None:
    task = problem(PATH + "timing_deg = [0, -20, -45.5]\nclosed = true\n").task
    assert isinstance(task, PathTask)
    assert task.points.tolist() == [[20, 20], [20, 25], [21, 30]]
    assert task.timing is not None
    assert task.timing.tolist() == np.radians([0, -20, -45.5]).tolist()
    assert task.closed
    plain = problem(PATH).task
    assert isinstance(plain, PathTask)
    assert (plain.timing, plain.closed) == (None, False)


PATHS = r"""
<PATH>poses = 3 | path.poses is unknown; did you mean motion.poses?
<PATH>timing_deg = 20 | path.timing_deg is 20; it must be a list of angles
<PATH>timing_deg = [0, '20', 40] | path.timing_deg[1] is '20'; it must be a number
kind = "path" | path is missing
kind = "path"\n[path] | path.points is missing
<PATH>[motion]\n<POSES> | motion does not belong to kind = "path"
<MOTION>[path]\npoints = [[20, 20], [20, 25], [21, 30]] | path does not belong to kind = "motion"
kind = "path"\n[motion]\n<POSES> | motion does not belong to kind = "path"
kind = "path"\n[paht]\npoints = [[1, 2]] | paht is unknown; did you mean path?
kind = "path"\n[path]\npoints = 5 |
    path.points is 5; it must be a list of points [x, y], or a .csv or .xlsx file
kind = "path"\n[path]\npoints = [[1, 2], [3, 4, 5], [6, 7]] |
    path.points[1] is [3.0, 4.0, 5.0], 3 numbers; it must be a point [x, y]
kind = "path"\n[path]\npoints = [[1, 2], [3, 4]] | path.points has 2 points; it must have three or more
"""


@pytest.mark.parametrize(("text", "expected"), rows(PATHS, MOTION=MOTION, PATH=PATH, POSES=POSES))
def test_bad_paths(text: str, expected: str) -> None:
    assert message(text) == expected


KEEP_OUT = r"""
[[[0, 0], [1, 0]]] | requirements.keep_out[0] has 2 distinct corners; it must have three or more
[[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 0], [2, 0]]] |
    requirements.keep_out[1] has no area: its corners lie on a straight line
[[[0, 0], [2, 2], [2, 0], [0, 2]]] |
    requirements.keep_out[0] crosses or touches itself at (1, 1); it must be a simple polygon
[[[0, 0], [2, 0], [2, 2], [1, 0], [0, 2]]] |
    requirements.keep_out[0] crosses or touches itself at (1, 0); it must be a simple polygon
[[[0, 0], [1, nan], [1, 1]]] | requirements.keep_out[0][1] is [1.0, nan]; all numbers must be finite
[[[0, 0], [1, 1]], [[0, 0], [2, 0], [1, 1]], [[0, 0], [1, 0], [2, 0]]] |
    requirements.keep_out[0] has 2 distinct corners; it must have three or more\n
    requirements.keep_out[2] has no area: its corners lie on a straight line
[[0, 0], [2, 0], [1, 1]] |
    requirements.keep_out is [[0, 0], [2, 0], [1, 1]]; it must be a list of polygons, such as
    [[[0, 0], [1, 0], [1, 1]]]
3 | requirements.keep_out is 3;
    it must be a list of polygons, each a list of corners [x, y], or a .dxf or .svg file
"""


@pytest.mark.parametrize(("text", "said"), rows(KEEP_OUT))
def test_bad_areas_are_named(text: str, said: str) -> None:
    assert message(MOTION + f"[requirements]\nkeep_out = {text}") == said


ZONES = MOTION + "within = [1, 2, 3, 4]\n"


def test_zones_reach_their_fields() -> None:
    motion = problem(ZONES + "angle_within_deg = 1.5\n[objective]\nmaximise = 'compactness'").task
    assert isinstance(motion, MotionTask)
    assert motion.within is not None
    assert motion.angle_within is not None
    assert motion.within.tolist() == [1, 2, 3, 4]
    assert motion.angle_within.tolist() == [np.radians(1.5)] * 4
    path = problem(PATH + "within = 2").task
    assert isinstance(path, PathTask)
    assert path.within is not None
    assert path.within.tolist() == [2, 2, 2]


NUMBER_OR_LIST = "it must be a number, or a list of one for each target"
BAD_ZONES = r"""
within = '6' | motion.within is '6'; <NUMBER_OR_LIST>
within = true | motion.within is true; <NUMBER_OR_LIST>
within = [1, 2] | motion.within has 2 numbers for 4 targets;
within = [1, true, 1, 1] | motion.within[1] is true; it must be a number
within = [1, [1], 1, 1] | motion.within[1] is [1]; it must be a number
within = 0 | motion.within is 0; it must be
within = 1e300 | motion.within is 1e+300; it must be
within = [1, 1, 1, 1e-13] | motion.within[3] is 1e-13; it must be
angle_within_deg = 181 | motion.angle_within_deg is 181; it must be from 1e-10 to 180
angle_within_deg = [1, 1, 0, 1] | motion.angle_within_deg[2] is 0; it must be from 1e-10 to 180
within = 1\n[requirements]\nexact = true | motion.within does not go with requirements.exact = true;
within = 1\n[requirements]\nerror_factor = 2 |
    requirements.error_factor does not go with motion.within; give one of them
[requirements]\nerror_factor = 2 | requirements.error_factor needs least squares, exact = false
[requirements]\nerror_factor = 0.9 | requirements.error_factor is 0.9; it must be from 1 to 1e+06
[search]\neffort = 0.1 | search.effort is 0.1; it must be from 0.2 to 10000
[requirements]\nexact = false\n[objective]\nmaximise = 'transmission' |
    objective is of no effect in least squares;
"""


@pytest.mark.parametrize(("text", "said"), rows(BAD_ZONES, NUMBER_OR_LIST=NUMBER_OR_LIST))
def test_bad_zones_are_one_line(text: str, said: str) -> None:
    found = message(MOTION + text)
    assert found.startswith(said)
    assert "\n" not in found


def test_zones_of_a_path_are_reported_with_other_errors() -> None:
    found = message('kind = "path"\n[path]\npoints = [[0, 0], [1, 0]]\nwithin = [1, 2, -3]\n').splitlines()
    assert found[0] == "path.points has 2 points; it must have three or more"
    assert found[1].startswith("path.within[2] is -3; it must be ")


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
        ({"swing_deg": 80}, ["stroke.time_ratio is missing"]),
        ({"stroke": 100, "time_ratio": 1.2}, ["stroke.stroke is of a slide; a four-bar has a swing"]),
        ({"swing_deg": "wide", "time_ratio": 1.2}, ["stroke.swing_deg is 'wide'; it must be a number"]),
    ],
)
def test_each_error_is_a_line(stroke: dict[str, Any], messages: list[str]) -> None:
    lines = refusal(stated, **stroke).splitlines()
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


@pytest.mark.parametrize("swing", [0.1 + 0.2, 179.99])
def test_written_and_read_again_it_is_the_same(swing: float) -> None:
    text = problem_toml(stated(swing_deg=swing, time_ratio=1.0))
    document = tomllib.loads(text)
    assert document["stroke"] == {"swing_deg": swing, "time_ratio": 1.0}
    assert problem_toml(problem_from(document, "wiper")) == text
