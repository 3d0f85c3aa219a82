"""Zones and areas kept out in problem files."""

import tomllib

import numpy as np
import pytest

from grashof.problems import MotionTask, PathTask, Problem, ProblemError
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


KEEP_OUT = {
    "[[[0, 0], [1, 0]]]": "[0] has 2 distinct corners; it must have three or more",
    "[[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 0], [2, 0]]]": (
        "[1] has no area: its corners lie on a straight line"
    ),
    "[[[0, 0], [2, 2], [2, 0], [0, 2]]]": (
        "[0] crosses or touches itself at (1, 1); it must be a simple polygon"
    ),
    "[[[0, 0], [1, nan], [1, 1]]]": "[0][1] is [1.0, nan]; all numbers must be finite",
    "[[[0, 0], [1, 'a'], [1, 1]]]": "[0][1][1] is 'a'; it must be a number",
    "[[[0, 0], [1, 1]], [[0, 0], [2, 0], [1, 1]], [[0, 0], [1, 0], [2, 0]]]": (
        "[0] has 2 distinct corners; it must have three or more\n"
        "requirements.keep_out[2] has no area: its corners lie on a straight line"
    ),
    "[[0, 0], [2, 0], [1, 1]]": (
        " is [[0, 0], [2, 0], [1, 1]]; it must be a list of polygons, such as [[[0, 0], [1, 0], [1, 1]]]"
    ),
    "3": " is 3; it must be a list of polygons, each a list of corners [x, y], or a .dxf or .svg file",
}


@pytest.mark.parametrize("text", KEEP_OUT)
def test_bad_areas_are_named(text: str) -> None:
    assert message(HEAD + f"[requirements]\nkeep_out = {text}") == f"requirements.keep_out{KEEP_OUT[text]}"


def test_what_keeps_out_is_one_of_a_few() -> None:
    for text, found in (
        ("['o2', 'o3']", "[1] is 'o3'; it must be one of o2, o4, a, b, p, links, body"),
        ("[]", " is []; it must be a list of o2, o4, a, b, p, links and body"),
    ):
        reported = message(HEAD + f"[requirements]\nkeep_out_for = {text}")
        assert reported == f"requirements.keep_out_for{found}"


LINE = 'kind = "path"\n[path]\npoints = [[20, 20], [20, 25], [21, 30]]\n'
ZONES = HEAD + "within = [1, 2, 3, 4]\n"


def test_zones_reach_their_fields() -> None:
    motion = problem(ZONES + "angle_within_deg = 1.5\n[objective]\nmaximise = 'compactness'").task
    assert isinstance(motion, MotionTask)
    assert motion.within is not None
    assert motion.angle_within is not None
    assert motion.within.tolist() == [1, 2, 3, 4]
    assert motion.angle_within.tolist() == [np.radians(1.5)] * 4
    path = problem(LINE + "within = 2").task
    assert isinstance(path, PathTask)
    assert path.within is not None
    assert path.within.tolist() == [2, 2, 2]


NUMBER_OR_LIST = "it must be a number, or a list of one for each target"
BAD_ZONES = [
    ("within = '6'", f"motion.within is '6'; {NUMBER_OR_LIST}"),
    ("within = true", f"motion.within is true; {NUMBER_OR_LIST}"),
    ("within = { x = 1 }", f"motion.within is a table; {NUMBER_OR_LIST}"),
    ("within = [1, 2]", "motion.within has 2 numbers for 4 targets; "),
    ("within = []", "motion.within has 0 numbers for 4 targets; "),
    ("within = [1, true, 1, 1]", "motion.within[1] is true; it must be a number"),
    ("within = [1, [1], 1, 1]", "motion.within[1] is [1]; it must be a number"),
    ("within = 0", "motion.within is 0; it must be "),
    ("within = -1", "motion.within is -1; it must be "),
    ("within = nan", "motion.within is nan; it must be "),
    ("within = inf", "motion.within is inf; it must be "),
    ("within = 1e300", "motion.within is 1e+300; it must be "),
    ("within = [1, 1, 1, 1e-13]", "motion.within[3] is 1e-13; it must be "),
    ("angle_within_deg = 181", "motion.angle_within_deg is 181; it must be from 1e-10 to 180"),
    ("angle_within_deg = [1, 1, 0, 1]", "motion.angle_within_deg[2] is 0; it must be from 1e-10 to 180"),
    (
        "within = 1\n[requirements]\nexact = true",
        "motion.within does not go with requirements.exact = true; ",
    ),
    (
        "within = 1\n[requirements]\nerror_factor = 2",
        "requirements.error_factor does not go with motion.within; give one of them",
    ),
    ("[requirements]\nerror_factor = 2", "requirements.error_factor needs least squares, exact = false"),
    ("[requirements]\nerror_factor = 0.9", "requirements.error_factor is 0.9; it must be from 1 to 1e+06"),
    ("[search]\neffort = 0.1", "search.effort is 0.1; it must be from 0.2 to 10000"),
    ("[search]\neffort = inf", "search.effort is inf; it must be a finite number"),
    (
        "[requirements]\nexact = false\n[objective]\nmaximise = 'transmission'",
        "objective is of no effect in least squares; ",
    ),
]


@pytest.mark.parametrize(("text", "said"), BAD_ZONES)
def test_bad_zones_are_one_line(text: str, said: str) -> None:
    told = message(HEAD + text)
    assert told.startswith(said)
    assert "\n" not in told


def test_zones_of_a_path_are_told_beside_other_errors() -> None:
    told = message('kind = "path"\n[path]\npoints = [[0, 0], [1, 0]]\nwithin = [1, 2, -3]\n').splitlines()
    assert told[0] == "path.points has 2 points; it must have three or more"
    assert told[1].startswith("path.within[2] is -3; it must be ")
