"""Problem files with wrong structure, unknown keys or invalid values: one line names the key."""

import pytest
from refusals import MOTION, POSES, message, problem, rows

from grashof.problems.files.problem_writing import problem_toml

# A table, a line of it, and the message.
WRONG = """
motion | angle_length = '1' | motion.angle_length is '1'; it must be a number
motion | body = 5 | motion.body is 5; it must be a list of corners [x, y], or a .dxf or .svg file
motion | angle_length = 0 | motion.angle_length is 0; it must be a number greater than zero
motion | angle_length = 1e300 | motion.angle_length is 1e+300; it must be from 1e-20 to 1e+20
motion | body = [[0, 0], [1, 1e21]] | motion.body[1] is [1.0, 1e+21]; its numbers must be at most 1e+20
motion | weights = [1, 1, 1, 'heavy'] | motion.weights[3] is 'heavy'; it must be a number
motion | title = 'below its table' | motion.title is unknown; did you mean title?
scene | outlines = 5 |
    scene.outlines is 5; it must be a list of outlines, each a list of corners [x, y], or a .dxf or .svg
    file
scene | outlines = [[[0, 0], [1]]] | scene.outlines[0][1] is [1.0], 1 number; it must be a corner [x, y]
scene | outlines = [[]] | scene.outlines[0] has 0 corners; it must have two or more
requirements | order = 'yes' | requirements.order is 'yes'; it must be true or false
requirements | tolerance = true | requirements.tolerance is true; it must be a number
requirements | rotatability = true | requirements.rotatability is true; it must be a string
requirements | link_length = 5 | requirements.link_length is 5; it must be [lo, hi]
requirements | ground_angle_deg = 'up' |
    requirements.ground_angle_deg is 'up'; it must be a number or [lo, hi]
requirements | ground_angle_deg = [1] | requirements.ground_angle_deg is [1.0]; it must be [lo, hi]
requirements | ground_angle_deg = [20, 10] |
    requirements.ground_angle_deg is [20, 10]: lo exceeds hi; it must be [lo, hi] with lo <= hi
requirements | o2 = 5 |
    requirements.o2 is 5; it must be [x, y], <PLACE>
requirements | o2 = [1, 2, 3] |
    requirements.o2 is [1, 2, 3]; it must be [x, y], <PLACE>
requirements | o2 = [1, true] | requirements.o2[1] is true; it must be a number
requirements | o2 = { x = '5' } | requirements.o2.x is '5'; it must be [lo, hi]
requirements | link_length = [8, 0.3] |
    requirements.link_length is [8, 0.3]: lo exceeds hi; it must be [lo, hi] with lo <= hi
requirements | r2 = [1, nan] | requirements.r2[1] is nan; it must be a finite number
requirements | rotatability = 'full' |
    requirements.rotatability is 'full'; it must be one of full-crank, crank-rocker, double-crank, any
requirements | transmission_min_deg = 91 | requirements.transmission_min_deg is 91; it must be from 0 to 90
requirements | tolerance = inf | requirements.tolerance is inf; it must be a finite number
requirements | o2 = { x = [3, 1] } | requirements.o2.x is [3, 1]; it must be [lo, hi] with lo <= hi
requirements | o4 = [0, nan] | requirements.o4.y is [nan, nan]; it must be [lo, hi] with lo <= hi
requirements | r1 = [1, 1e21] | requirements.r1 is [1, 1e+21]; hi must be at most 1e+20
requirements | o2 = { x = [0, 1e100] } | requirements.o2.x is [0, 1e+100]; its sides must be at most 1e+20
requirements | link_lenght = [1, 2] | requirements.link_lenght is unknown; did you mean link_length?
requirements | o2 = { z = [1, 2] } | requirements.o2.z is unknown; the keys are x, y, inside, on
objective | maximise = 3 |
    objective.maximise is 3; it must be transmission, compactness, torque, another quantity or a table of
    weights
objective | maximise = 'speed' |
    objective.maximise is 'speed'; it must be transmission, compactness, torque, another quantity
objective | maximise = { transmission = true } | objective.maximise.transmission is true; it must be a number
objective | maximise = {} | objective.maximise has no weight greater than zero; one at least is needed
objective | maximise = { compact = 1 } | objective.maximise.compact is unknown; did you mean compactness?
search | starts = 5.0 | search.starts is 5.0; it must be a whole number
search | starts = 0 | search.starts is 0; it must be a whole number from 1
search | workers = 2 | search.workers is unknown; the keys are starts, enough, seed, effort
manufacturing | length_tolerance = 1e300 |
    manufacturing.length_tolerance is 1e+300; it must be from 0 to 1e+20
"""
UNKNOWN = (
    "motion",
    '"a b\\n" = 1',
    'motion."a b\\n" is unknown; the keys are poses, weights, angle_length, body, within, angle_within_deg, '
    "timing_deg, closed",
)


PLACE = "{ x = [lo, hi], y = [lo, hi] }, { inside = corners } or { on = ends }"


@pytest.mark.parametrize(("table", "line", "said"), [*rows(WRONG, PLACE=PLACE), UNKNOWN])
def test_a_wrong_value_names_its_key(table: str, line: str, said: str) -> None:
    text = line if table == "motion" else f"[{table}]\n{line}"
    assert message(MOTION + text) == said


OTHERS = r"""
[motion]\n<POSES> | kind is missing
kind = "motion" | motion is missing
kind = "motion"\n[motion] | motion.poses is missing
kind = "motion"\nmotion = 5 | motion is 5; it must be a table
kind = "dance"\n[motion]\n<POSES> | kind is 'dance'; it must be motion, path, stroke, function or dwell
kind = 3\n[motion]\n<POSES> | kind is 3; it must be a string
<MOTION>[[requirements]]\norder = true | requirements is [{'order': True}]; it must be a table
kind = "stroke"\nmechanism = "slider-crank"\n[stroke]\nstroke = 4\ntime_ratio = 1.2\n
    [requirements]\nslide_angle_deg = [0, 9] |
    requirements.slide_angle_deg is a range; of a stroke it must be a single angle
<MOTION>[requirements]\nkeep_out_for = ['o2', 'o3'] |
    requirements.keep_out_for[1] is 'o3'; it must be one of o2, o4, a, b, p, links, body
<MOTION>[requirements]\nkeep_out_for = [] |
    requirements.keep_out_for is []; it must be a list of o2, o4, a, b, p, links and body
<MOTION>[requirement]\nr1 = [1, 2] | requirement is unknown; did you mean requirements?
link_length = [1, 2]\n<MOTION> | link_length is unknown; did you mean requirements.link_length?
kinds = "motion"\n[motion]\n<POSES> | kinds is unknown; did you mean kind?\nkind is missing
"""


@pytest.mark.parametrize(("text", "expected"), rows(OTHERS, MOTION=MOTION, POSES=POSES))
def test_bad_files(text: str, expected: str) -> None:
    assert message(text) == expected


POSES_TEXT = """
5 | motion.poses is 5; it must be a list of poses [x, y, angle in degrees], or a .csv or .xlsx file
[] | motion.poses has 0 poses; it must have two or more
[[1, 2, 3]] | motion.poses has 1 pose; it must have two or more
[[1, 2, 3], 5] | motion.poses[1] is 5; it must be a pose [x, y, angle in degrees]
[[1, 2, 3], [3.5, 4]] | motion.poses[1] is [3.5, 4], 2 numbers; it must be a pose [x, y, angle in degrees]
[[1, 2, 3], [1, 2, '3']] | motion.poses[1][2] is '3'; it must be a finite number
[[1, nan, 3], [1, 2, 3]] | motion.poses[0] is [1, nan, 3]; all numbers must be finite
[[1, 2, 3], [1, 2, 363]] | motion.poses[0] and motion.poses[1] are equal; consecutive poses must differ
[[1, 2, 3], [1, 2, 9]] | motion.angle_length is missing: poses at a single place have no size to take it from
[[1, 2, 3], { x = 2, z = 3 }] | motion.poses[1].z is unknown; the keys are x, y, angle
[[1, 2, 3], {}] | motion.poses[1] has neither position nor angle
"""


@pytest.mark.parametrize(("poses", "expected"), rows(POSES_TEXT))
def test_bad_poses(poses: str, expected: str) -> None:
    assert message(f'kind = "motion"\n[motion]\nposes = {poses}') == expected


@pytest.mark.parametrize(
    "text",
    [
        "weights = {}".format(["a"] * 5000),
        f"within = {'9' * 4000}",
        f"[requirements]\nrotatability = '{'x' * 9_000}'",
        f"[requirements]\n{'x' * 9_000} = 1",
        f"[requirements]\nr1 = [0, 0x{'f' * 5000}]",
        f"[search]\nstarts = [0x{'f' * 5000}]",
        f"title = {[1] * 500}",
        '[requirements]\ntolerance = """a\nb"""',
    ],
)
def test_a_message_is_short_whatever_it_is_about(text: str) -> None:
    lines = message(MOTION + text).splitlines()
    assert max(map(len, lines)) < 1500
    assert len(lines) == text.count("'a'") or len(lines) == 1


def test_a_direction_is_an_angle_or_a_range_that_comes_back_from_a_file() -> None:
    for stated, value in (("30", 30.0), ("[30, 30]", 30.0), ("[350, 380]", (350.0, 380.0))):
        made = problem(MOTION + f"[requirements]\nground_angle_deg = {stated}")
        assert made.requirements.ground_angle_deg == value
        assert problem(problem_toml(made)).requirements.ground_angle_deg == value


SEVERAL = """
kind = "path"
title = "a\\u0007"
length_unit = "ell"
titles = "red"
[motion]
poses = [[0, 0, 0], [1, 2], { x = 1, angel = 3 }, [1, 2, nan]]
weights = [1, 0, 1]
angle_length = -1
body = [[0, 0]]
[scene]
outlines = [[[0, 0]], [[0, 0], [1, 1]], [[0, 0], [1, inf]]]
[requirements]
tolerance = "1"
order = 1
link_ratio_max = 0
r1 = [3, 2]
o2 = { x = [2, 1], y = [4, 3] }
keep_out_for = ["o3"]
[objective]
maximise = { torque = -1, compactness = 1e10 }
[dynamics]
masses = [1, -2, 3]
payload = -1
[manufacturing]
band = 0
[search]
starts = 0
seed = -1
"""


def test_all_errors_are_reported_a_line_each() -> None:
    assert message(SEVERAL).splitlines() == [
        "title has control character U+0007; it must be plain text",
        "motion.poses[1] is [1, 2], 2 numbers; it must be a pose [x, y, angle in degrees]",
        "motion.poses[2].angel is unknown; did you mean angle?",
        "motion.poses[3] is [1, 2, nan]; all numbers must be finite",
        "motion.weights[1] is 0.0; it must be a number from 1e-09 to 1e+09",
        "motion.angle_length is -1; it must be a number greater than zero",
        "motion.body has 1 corner; it must have two or more",
        "scene.outlines[0] has 1 corner; it must have two or more",
        "scene.outlines[2][1] is [1.0, inf]; all numbers must be finite",
        "requirements.tolerance is '1'; it must be a number",
        "requirements.order is 1; it must be true or false",
        "requirements.r1 is [3, 2]: lo exceeds hi; it must be [lo, hi] with lo <= hi",
        "requirements.link_ratio_max is 0; it must be from 1 to 1e+06",
        "requirements.o2.x is [2, 1]; it must be [lo, hi] with lo <= hi",
        "requirements.o2.y is [4, 3]; it must be [lo, hi] with lo <= hi",
        "requirements.keep_out_for[0] is 'o3'; it must be one of o2, o4, a, b, p, links, body",
        "objective.maximise.compactness is 10000000000; it must be from 0 to 1e+09",
        "objective.maximise.torque is -1; it must be from 0 to 1e+09",
        "dynamics.masses[1] is -2; it must be a number from zero",
        "dynamics.payload is -1; it must be a number from zero",
        "manufacturing.band is 0; it must be a number greater than zero",
        "search.starts is 0; it must be a whole number from 1",
        "search.seed is -1; it must be a whole number from 0",
        "titles is unknown; did you mean title?",
        "manufacturing.length_tolerance is missing",
        'motion does not belong to kind = "path"',
        "length_unit is 'ell'; it must be one of mm, cm, m, in, ft with dynamics",
    ]


@pytest.mark.parametrize("key", ["title", "source", "length_unit"])
def test_control_characters_are_refused(key: str) -> None:
    said = f"{key} has control character U+001B; it must be plain text"
    assert message(f'{key} = "red \\u001b[31m"\n{MOTION}') == said


def test_all_tables_that_do_not_go_together_are_reported() -> None:
    text = (
        MOTION
        + "[dynamics]\nspeed_rpm = -1\n[objective]\nmaximise = 'torque'\n[requirements]\nsame_branch = false"
    )
    assert message("length_unit = 'm'\n" + text).splitlines() == [
        "dynamics.speed_rpm is -1; it must be a number greater than zero",
        "dynamics has no mass; mass_per_length is needed, masses and inertias, density or payload, "
        "or else loads, springs or friction",
        "requirements.same_branch is false; it must be true when objective.maximise.torque is given",
    ]
