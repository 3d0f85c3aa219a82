"""Paths, zones, areas kept out and strokes in problem files: read, refused, written."""

import tomllib

import pytest
from refusals import MOTION, PATH, POSES, message, rows

from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml

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
    path.points is 5; it must be a list of points [x, y], or a .csv, .xlsx, .dxf or .svg file
kind = "path"\n[path]\npoints = [[1, 2], [3, 4, 5], [6, 7]] |
    path.points[1] is [3.0, 4.0, 5.0], 3 numbers; it must be a point [x, y]
kind = "path"\n[path]\npoints = [[1, 2], [3, 4]] | path.points has 2 points; it must have three or more
kind = "path"\n[path]\npoints = [[0, 0], [1, 0]]\nwithin = [1, 2, -3] |
    path.points has 2 points; it must have three or more\n
    path.within[2] is -3; it must be from 2e-12 to 1e+20
<PATH>[requirements]\nstructural_error_max_deg = [0, 1] |
    path states no output; kind = "function" does; requirements.structural_error_max_deg needs it
kind = "path"\n[path]\npoints = [[0, 0], [1, 0], [1, 1]]\nlength_ratio_max = 1.1 |
    path.length_ratio_max goes with path.closed = true; remove it
kind = "path"\n[path]\npoints = [[0, 0], [1, 0], [1, 1]]\nclosed = true\nlength_ratio_max = 0.9 |
    path.length_ratio_max is 0.9; it must be from 1 to 1e+06
<PATH>[stroke]\nswing_deg = 80\ntime_ratio = 1.1 | stroke does not belong to kind = "path"
kind = "stroke" | stroke is missing
<STROKE>time_ratio = 1.1\n[path]\npoints = [[0, 0], [1, 1], [2, 0]] | path does not belong to kind = "stroke"
<STROKE> | stroke.time_ratio is missing
kind = "stroke"\n[stroke]\nstroke = 100\ntime_ratio = 1.2 |
    stroke.stroke is of a slide; a four-bar has a swing, stroke.swing_deg
kind = "stroke"\n[stroke]\nswing_deg = 'wide'\ntime_ratio = 1.2 |
    stroke.swing_deg is 'wide'; it must be a number
kind = "stroke"\n[stroke]\nswing_deg = 200\ntime_ratio = 0.5 |
    stroke.swing_deg is 200; it must be from 0.0573 to less than 180, as a rocker swings\n
    stroke.time_ratio is 0.5; it must be at least 1, the slow stroke over the quick one
"""
STROKE = 'kind = "stroke"\n[stroke]\nswing_deg = 80\n'


@pytest.mark.parametrize(
    ("text", "expected"), rows(PATHS, MOTION=MOTION, PATH=PATH, POSES=POSES, STROKE=STROKE)
)
def test_bad_paths_and_strokes(text: str, expected: str) -> None:
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


@pytest.mark.parametrize("swing", [0.1 + 0.2, 179.99])
def test_written_and_read_again_it_is_the_same(swing: float) -> None:
    stated = problem_from({"kind": "stroke", "stroke": {"swing_deg": swing, "time_ratio": 1.0}}, "wiper")
    text = problem_toml(stated)
    document = tomllib.loads(text)
    assert document["stroke"] == {"swing_deg": swing, "time_ratio": 1.0}
    assert problem_toml(problem_from(document, "wiper")) == text


def test_a_length_ratio_of_a_closed_path_is_kept() -> None:
    ring = 'kind = "path"\n[path]\npoints = [[0, 0], [1, 0], [1, 1]]\nclosed = true\nlength_ratio_max = 1.5\n'
    made = problem_from(tomllib.loads(ring), "ring")
    assert made.task.length_ratio_max == 1.5
    assert problem_from(tomllib.loads(problem_toml(made)), "ring").task.length_ratio_max == 1.5
