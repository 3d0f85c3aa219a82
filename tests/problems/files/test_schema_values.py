"""Problem files with wrong structure, unknown keys or senseless values: one line names the key."""

import tomllib

import pytest

from grashof.problems import Problem, ProblemError
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml

POSES = "poses = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]"
HEAD = f'kind = "motion"\n[motion]\n{POSES}\n'


def problem(text: str) -> Problem:
    return problem_from(tomllib.loads(text), "test")


def message(text: str) -> str:
    with pytest.raises(ProblemError) as caught:
        problem(text)
    assert caught.value.__cause__ is None
    return str(caught.value)


STRUCTURE = [
    (f"[motion]\n{POSES}", "kind is missing"),
    ('kind = "motion"', "motion is missing"),
    ('kind = "motion"\n[motion]', "motion.poses is missing"),
    ('kind = "motion"\nmotion = 5', "motion is 5; it must be a table"),
    (f'kind = "dance"\n[motion]\n{POSES}', "kind is 'dance'; it must be motion, path, stroke or function"),
    (f"kind = 3\n[motion]\n{POSES}", "kind is 3; it must be a string"),
    ("title = 3\n" + HEAD, "title is 3; it must be a string"),
    (HEAD + "angle_length = '1'", "motion.angle_length is '1'; it must be a number"),
    (HEAD + "body = 5", "motion.body is 5; it must be a list of corners [x, y], or a .dxf or .svg file"),
    (HEAD + "body = [5]", "motion.body[0] is 5; it must be a corner [x, y]"),
    (
        HEAD + "[scene]\noutlines = 5",
        "scene.outlines is 5; it must be a list of outlines, each a list of corners [x, y], "
        "or a .dxf or .svg file",
    ),
    (HEAD + "[[requirements]]\norder = true", "requirements is [{'order': True}]; it must be a table"),
    (HEAD + "[requirements]\norder = 'yes'", "requirements.order is 'yes'; it must be true or false"),
    (HEAD + "[requirements]\norder = 1", "requirements.order is 1; it must be true or false"),
    (HEAD + "[requirements]\ntolerance = '5'", "requirements.tolerance is '5'; it must be a number"),
    (HEAD + "[requirements]\ntolerance = true", "requirements.tolerance is true; it must be a number"),
    (HEAD + "[requirements]\nrotatability = true", "requirements.rotatability is true; it must be a string"),
    (HEAD + "[requirements]\nlink_length = 5", "requirements.link_length is 5; it must be [lo, hi]"),
    (
        HEAD + "[requirements]\nground_angle_deg = 'up'",
        "requirements.ground_angle_deg is 'up'; it must be a number or [lo, hi]",
    ),
    (
        HEAD + "[requirements]\nground_angle_deg = [1]",
        "requirements.ground_angle_deg is [1.0]; it must be [lo, hi]",
    ),
    (
        HEAD + "[requirements]\nground_angle_deg = [20, 10]",
        "requirements.ground_angle_deg is [20, 10]: lo exceeds hi; it must be [lo, hi] with lo <= hi",
    ),
    (
        'kind = "stroke"\nmechanism = "slider-crank"\n[stroke]\nstroke = 4\ntime_ratio = 1.2\n'
        "[requirements]\nslide_angle_deg = [0, 9]",
        "requirements.slide_angle_deg is a range; of a stroke it must be a single angle",
    ),
    (
        HEAD + "[requirements]\nlink_length = [1, 'a']",
        "requirements.link_length[1] is 'a'; it must be a number",
    ),
    (
        HEAD + "[requirements]\no2 = 5",
        "requirements.o2 is 5; it must be [x, y] or { x = [lo, hi], y = [lo, hi] }",
    ),
    (
        HEAD + "[requirements]\no2 = [1, 2, 3]",
        "requirements.o2 is [1, 2, 3]; it must be [x, y] or { x = [lo, hi], y = [lo, hi] }",
    ),
    (HEAD + "[requirements]\no2 = [1, true]", "requirements.o2[1] is true; it must be a number"),
    (HEAD + "[requirements]\no2 = { x = '5' }", "requirements.o2.x is '5'; it must be [lo, hi]"),
    (HEAD + "[requirements]\no2 = { x = [1, {}] }", "requirements.o2.x[1] is a table; it must be a number"),
    (
        HEAD + "[objective]\nmaximise = 3",
        "objective.maximise is 3; it must be transmission, compactness, torque, another quantity or a "
        "table of weights",
    ),
    (
        HEAD + "[objective]\nmaximise = 'speed'",
        "objective.maximise is 'speed'; it must be transmission, compactness, torque, another quantity",
    ),
    (
        HEAD + "[objective]\nmaximise = { transmission = true }",
        "objective.maximise.transmission is true; it must be a number",
    ),
    (HEAD + "[search]\nstarts = 5.0", "search.starts is 5.0; it must be a whole number"),
    (HEAD + "[search]\nseed = false", "search.seed is false; it must be a whole number"),
]


@pytest.mark.parametrize(("text", "expected"), STRUCTURE)
def test_wrong_structure(text: str, expected: str) -> None:
    assert message(text) == expected


POSES_TEXT = [
    ("5", "motion.poses is 5; it must be a list of poses [x, y, angle in degrees], or a .csv or .xlsx file"),
    ("[]", "motion.poses has 0 poses; it must have two or more"),
    ("[[1, 2, 3]]", "motion.poses has 1 pose; it must have two or more"),
    ("[[1, 2, 3], 5]", "motion.poses[1] is 5; it must be a pose [x, y, angle in degrees]"),
    (
        "[[1, 2, 3], [3.5, 4]]",
        "motion.poses[1] is [3.5, 4], 2 numbers; it must be a pose [x, y, angle in degrees]",
    ),
    ("[[1, 2, 3], [1, 2, '3']]", "motion.poses[1][2] is '3'; it must be a finite number"),
    ("[[1, 2, 3], [1, 2, true]]", "motion.poses[1][2] is True; it must be a finite number"),
    ("[[1, nan, 3], [1, 2, 3]]", "motion.poses[0] is [1, nan, 3]; all numbers must be finite"),
    ("[[1, 2, 3], [1, 2, -inf]]", "motion.poses[1] is [1, 2, -inf]; all numbers must be finite"),
    (
        "[[1, 2, 3], [1, 2, 363]]",
        "motion.poses[0] and motion.poses[1] are equal; consecutive poses must differ",
    ),
    (
        "[[1, 2, 3], [1, 2, 9]]",
        "motion.angle_length is missing: poses at a single place have no size to take it from",
    ),
    (
        "[[1, 2, 3], { x = 2, z = 3 }]",
        "motion.poses[1].z is unknown; the keys are x, y, angle",
    ),
    ("[[1, 2, 3], { x = 2 }]", "motion.poses[1] has one of x and y; it must have both or neither"),
    ("[[1, 2, 3], {}]", "motion.poses[1] has neither position nor angle"),
]


@pytest.mark.parametrize(("poses", "expected"), POSES_TEXT)
def test_bad_poses(poses: str, expected: str) -> None:
    assert message(f'kind = "motion"\n[motion]\nposes = {poses}') == expected


SENSE = [
    (
        "[requirements]\nlink_length = [8, 0.3]",
        "requirements.link_length is [8, 0.3]: lo exceeds hi; it must be [lo, hi] with lo <= hi",
    ),
    (
        "[requirements]\nlink_length = [1, 2, 3]",
        "requirements.link_length is [1.0, 2.0, 3.0]; it must be [lo, hi]",
    ),
    ("[requirements]\nr2 = [1, nan]", "requirements.r2[1] is nan; it must be a finite number"),
    (
        "[requirements]\nrotatability = 'full'",
        "requirements.rotatability is 'full'; it must be one of full-crank, crank-rocker, double-crank, any",
    ),
    (
        "[requirements]\ntransmission_min_deg = 91",
        "requirements.transmission_min_deg is 91; it must be from 0 to 90",
    ),
    ("[requirements]\ntolerance = inf", "requirements.tolerance is inf; it must be a finite number"),
    ("[requirements]\no2 = { x = [3, 1] }", "requirements.o2.x is [3, 1]; it must be [lo, hi] with lo <= hi"),
    ("[requirements]\nb = { y = [3] }", "requirements.b.y is [3.0]; it must be [lo, hi] with lo <= hi"),
    ("[requirements]\no4 = [0, nan]", "requirements.o4.y is [nan, nan]; it must be [lo, hi] with lo <= hi"),
    (
        "[objective]\nmaximise = {}",
        "objective.maximise has no weight greater than zero; one at least is needed",
    ),
    (
        "[objective]\nmaximise = { transmission = -1 }",
        "objective.maximise.transmission is -1; it must be from 0 to 1e+09",
    ),
    ("[search]\nstarts = 0", "search.starts is 0; it must be a whole number from 1"),
    (
        "[scene]\noutlines = [[[0, 0], [1]]]",
        "scene.outlines[0][1] is [1.0], 1 number; it must be a corner [x, y]",
    ),
    ("[scene]\noutlines = [[]]", "scene.outlines[0] has 0 corners; it must have two or more"),
    ("angle_length = 0", "motion.angle_length is 0; it must be greater than zero"),
    ("angle_length = 1e300", "motion.angle_length is 1e+300; it must be from 1e-20 to 1e+20"),
    ("body = [[0, 0], [1, 1e21]]", "motion.body[1] is [1.0, 1e+21]; its numbers must be at most 1e+20"),
    (
        "[scene]\noutlines = [[[0, 0], [1, -1e21]]]",
        "scene.outlines[0][1] is [1.0, -1e+21]; its numbers must be at most 1e+20",
    ),
    ("[requirements]\nr1 = [1, 1e21]", "requirements.r1 is [1, 1e+21]; hi must be at most 1e+20"),
    (
        "[requirements]\ncoupler_arms = [0, 1e300]",
        "requirements.coupler_arms is [0, 1e+300]; hi must be at most 1e+20",
    ),
    (
        "[requirements]\no2 = { x = [0, 1e100] }",
        "requirements.o2.x is [0, 1e+100]; its sides must be at most 1e+20",
    ),
    (
        "[manufacturing]\nlength_tolerance = 1e300",
        "manufacturing.length_tolerance is 1e+300; it must be at most 1e+20",
    ),
    (
        "weights = [1, 1, 1, 1e308]",
        "motion.weights[3] is 1e+308; it must be a number from 1e-09 to 1e+09",
    ),
    ("body = [[0, 0], [1, inf]]", "motion.body[1] is [1.0, inf]; all numbers must be finite"),
]


@pytest.mark.parametrize(("text", "expected"), SENSE)
def test_values_without_sense(text: str, expected: str) -> None:
    assert message(HEAD + text) == expected


UNKNOWN = [
    (
        HEAD + "[requirements]\nlink_lenght = [1, 2]",
        "requirements.link_lenght is unknown; did you mean link_length?",
    ),
    (HEAD + "[requirements]\nO2 = [1, 2]", "requirements.O2 is unknown; did you mean o2?"),
    (HEAD + "[requirement]\nr1 = [1, 2]", "requirement is unknown; did you mean requirements?"),
    (HEAD + "[search]\nworkers = 2", "search.workers is unknown; the keys are starts, enough, seed, effort"),
    (HEAD + "[requirements]\no2 = { z = [1, 2] }", "requirements.o2.z is unknown; the keys are x, y"),
    (
        HEAD + "[objective]\nmaximise = { compact = 1 }",
        "objective.maximise.compact is unknown; did you mean compactness?",
    ),
    (HEAD + "title = 'below its table'", "motion.title is unknown; did you mean title?"),
    ("link_length = [1, 2]\n" + HEAD, "link_length is unknown; did you mean requirements.link_length?"),
    (
        HEAD + '"a b\\n" = 1',
        'motion."a b\\n" is unknown; '
        "the keys are poses, weights, angle_length, body, within, angle_within_deg, timing_deg, "
        "closed",
    ),
    (f'kinds = "motion"\n[motion]\n{POSES}', "kinds is unknown; did you mean kind?\nkind is missing"),
]


@pytest.mark.parametrize(("text", "expected"), UNKNOWN)
def test_unknown_keys(text: str, expected: str) -> None:
    assert message(text) == expected


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "[requirements]\nlink_ratio_max = 0x{}",
            "requirements.link_ratio_max is a whole number of about 6021 digits",
        ),
        (
            "[search]\nstarts = [0x{}]",
            "search.starts is [a whole number of about 6021 digits]; it must be a whole",
        ),
        ("[requirements]\nr1 = [0, 0x{}]", "requirements.r1"),
        ("title = 0x{}", "motion.title is unknown"),
    ],
)
def test_numbers_of_thousands_of_digits(text: str, said: str) -> None:
    assert message(HEAD + text.format("f" * 5000)).startswith(said)


@pytest.mark.parametrize(
    "text",
    [
        "weights = {}".format(["a"] * 5000),
        f"weights = {[[1]] * 5000}",
        f"timing_deg = {[0] * 5000}",
        f"within = {'9' * 4000}",
        f"[requirements]\nlink_length = {[1] * 5000}",
        f"[requirements]\nrotatability = '{'x' * 100_000}'",
        f"[requirements]\n{'x' * 100_000} = 1",
        f"[requirements.o2]\n{'x' * 100_000} = 1",
        f"{'y' * 100_000} = 1",
    ],
)
def test_a_message_is_short_whatever_it_is_about(text: str) -> None:
    assert max(map(len, message(HEAD + text).splitlines())) < 1500


def test_a_direction_is_an_angle_or_a_range_that_comes_back_from_a_file() -> None:
    for stated, value in (("30", 30.0), ("[30, 30]", 30.0), ("[350, 380]", (350.0, 380.0))):
        made = problem(HEAD + f"[requirements]\nground_angle_deg = {stated}")
        assert made.requirements.ground_angle_deg == value
        assert problem(problem_toml(made)).requirements.ground_angle_deg == value
