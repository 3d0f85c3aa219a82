"""Problem files: every key reaches its field, and every error names its key path."""

import dataclasses
import math
import tomllib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.problems import Box, MotionTask, Objective, PathTask, Problem, ProblemError, Requirements, Search
from grashof.problems.files.problem_schema import RequirementsTable, problem_from

POSES = "poses = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]"
HEAD = f'kind = "motion"\n[motion]\n{POSES}\n'

EVERY_KEY = f"""
kind = "motion"
title = "Up and over"
source = "a report"
length_unit = "cm"

[motion]
{POSES}
angle_length = 2
body = [[0, 0], [1, 0], [1, 1.5]]

[scene]
outlines = [[[0, 0], [5, 0]], [[1, 1], [2, 2], [3, 1]]]

[requirements]
exact = false
tolerance = 1e-7
error_factor = 1.2
rotatability = "crank-rocker"
rotatability_margin = 0.01
order = false
same_branch = false
transmission_min_deg = 15
transmission_over = "cycle"
link_length = [0.3, 8]
r1 = [1, 2]
r2 = [2, 3]
r3 = [3, 4]
r4 = [4, 5]
link_ratio_max = 10
coupler_arms = [0, 6]
o2 = {{ x = [-4, 10], y = [-7, 7] }}
o4 = [1, 2]
a = {{ x = [-inf, 3] }}
b = {{ y = [0, 5] }}
ground_angle_deg = 10
theta2_start_deg = 30
keep_out = [[[0, -9], [0, 0], [5, 0], [5, -9]], [[1, 1], [2, 1], [2, 2.5]]]
keep_out_for = ["o4", "links"]

[objective]
maximise = {{ transmission = 2, compactness = 0.5 }}

[search]
starts = 100
enough = 20
seed = 4
effort = 2.5
"""


def problem(text: str) -> Problem:
    return problem_from(tomllib.loads(text), "test")


def message(text: str) -> str:
    with pytest.raises(ProblemError) as caught:
        problem(text)
    assert caught.value.__cause__ is None
    return str(caught.value)


def test_every_key_reaches_its_field() -> None:
    every = problem(EVERY_KEY)
    assert (every.name, every.title, every.source, every.length_unit) == (
        "test",
        "Up and over",
        "a report",
        "cm",
    )
    assert isinstance(every.task, MotionTask)
    assert every.task.positions.tolist() == [[5, 4], [3.5, 4], [2, 3], [1, 0]]
    np.testing.assert_allclose(np.degrees(every.task.angles), [0, -5, -5, 0], rtol=1e-15)
    assert every.task.angle_length == 2.0
    assert every.task.body is not None
    assert every.task.body.tolist() == [[0, 0], [1, 0], [1, 1.5]]
    assert [outline.tolist() for outline in every.outlines] == [[[0, 0], [5, 0]], [[1, 1], [2, 2], [3, 1]]]
    assert every.requirements == Requirements(
        exact=False,
        tolerance=1e-7,
        error_factor=1.2,
        rotatability="crank-rocker",  # type: ignore[arg-type]
        rotatability_margin=0.01,
        order=False,
        same_branch=False,
        transmission_min_deg=15,
        transmission_over="cycle",  # type: ignore[arg-type]
        link_length=(0.3, 8),
        r1=(1, 2),
        r2=(2, 3),
        r3=(3, 4),
        r4=(4, 5),
        link_ratio_max=10,
        coupler_arms=(0, 6),
        o2=Box((-4, 10), (-7, 7)),
        o4=Box((1, 1), (2, 2)),
        a=Box(x=(-math.inf, 3)),
        b=Box(y=(0, 5)),
        ground_angle_deg=10,
        theta2_start_deg=30,
        keep_out=([[0, -9], [0, 0], [5, 0], [5, -9]], [[1, 1], [2, 1], [2, 2.5]]),  # type: ignore[arg-type]
        keep_out_for=("o4", "links"),
    )
    assert every.objective == Objective(2.0, 0.5)
    assert every.search == Search(starts=100, enough=20, seed=4, effort=2.5)


def test_the_example_above_uses_every_requirement() -> None:
    fields = {field.name for field in dataclasses.fields(Requirements)}
    assert set(tomllib.loads(EVERY_KEY)["requirements"]) == fields
    assert set(RequirementsTable.model_fields) == fields
    given_away = problem(EVERY_KEY).requirements
    assert [name for name in fields if getattr(given_away, name) == getattr(Requirements(), name)] == []


def test_what_is_not_said_has_the_defaults_of_the_value_types() -> None:
    plain = problem(HEAD)
    assert plain.requirements == Requirements()
    assert plain.objective == Objective()
    assert plain.search == Search()
    assert plain.outlines == ()
    assert (plain.title, plain.source, plain.length_unit) == ("", "", "")
    assert plain.task.body is None
    assert plain.task.angle_length == plain.task.size == pytest.approx(math.sqrt(32))


def test_empty_tables_change_nothing() -> None:
    text = HEAD + "[scene]\n[requirements]\n[objective]\n[search]\n"
    assert problem(text).requirements == Requirements()
    assert problem(text).objective == Objective()


@pytest.mark.parametrize(
    ("maximise", "expected"),
    [
        ('"transmission"', Objective(1, 0)),
        ('"compactness"', Objective(0, 1)),
        ("{ compactness = 3 }", Objective(0, 3)),
        ("{ transmission = 0.5 }", Objective(0.5, 0)),
    ],
)
def test_objective(maximise: str, expected: Objective) -> None:
    assert problem(HEAD + f"[objective]\nmaximise = {maximise}").objective == expected


@pytest.mark.parametrize("count", [2, 3, 7])
def test_other_numbers_of_poses_load(count: int) -> None:
    poses = [[n, n * n, 10 * n] for n in range(count)]
    assert len(problem(f'kind = "motion"\n[motion]\nposes = {poses}').task) == count


@given(
    st.lists(
        st.tuples(*[st.floats(-1e6, 1e6) | st.integers(-1000, 1000)] * 3),
        min_size=2,
        max_size=6,
        unique_by=lambda pose: (float(pose[0]), float(pose[1])),
    )
)
def test_poses_come_through_unchanged(poses: list[tuple[float, float, float]]) -> None:
    text = f'kind = "motion"\n[motion]\nposes = {[list(pose) for pose in poses]}'
    task = problem(text).task
    assert task.positions.tolist() == [[x, y] for x, y, _ in poses]
    assert task.angles.tolist() == np.radians([angle for _, _, angle in poses]).tolist()


STRUCTURE = [
    (f"[motion]\n{POSES}", "kind is missing"),
    ('kind = "motion"', "motion is missing"),
    ('kind = "motion"\n[motion]', "motion.poses is missing"),
    ('kind = "motion"\nmotion = 5', "motion is 5; allowed is a table"),
    (f'kind = "dance"\n[motion]\n{POSES}', "kind is 'dance'; allowed is motion or path"),
    (f"kind = 3\n[motion]\n{POSES}", "kind is 3; allowed is a string"),
    ("title = 3\n" + HEAD, "title is 3; allowed is a string"),
    (HEAD + "angle_length = '1'", "motion.angle_length is '1'; allowed is a number"),
    (HEAD + "body = 5", "motion.body is 5; allowed is a list of corners [x, y]"),
    (HEAD + "body = [5]", "motion.body[0] is 5; allowed is a corner [x, y]"),
    (
        HEAD + "[scene]\noutlines = 5",
        "scene.outlines is 5; allowed is a list of outlines, each a list of corners [x, y]",
    ),
    (HEAD + "[[requirements]]\norder = true", "requirements is [{'order': True}]; allowed is a table"),
    (HEAD + "[requirements]\norder = 'yes'", "requirements.order is 'yes'; allowed is true or false"),
    (HEAD + "[requirements]\norder = 1", "requirements.order is 1; allowed is true or false"),
    (HEAD + "[requirements]\ntolerance = '5'", "requirements.tolerance is '5'; allowed is a number"),
    (HEAD + "[requirements]\ntolerance = true", "requirements.tolerance is true; allowed is a number"),
    (HEAD + "[requirements]\nrotatability = true", "requirements.rotatability is true; allowed is a string"),
    (HEAD + "[requirements]\nlink_length = 5", "requirements.link_length is 5; allowed is [lo, hi]"),
    (
        HEAD + "[requirements]\nlink_length = [1, 'a']",
        "requirements.link_length[1] is 'a'; allowed is a number",
    ),
    (
        HEAD + "[requirements]\no2 = 5",
        "requirements.o2 is 5; allowed is [x, y] or { x = [lo, hi], y = [lo, hi] }",
    ),
    (
        HEAD + "[requirements]\no2 = [1, 2, 3]",
        "requirements.o2 is [1, 2, 3]; allowed is [x, y] or { x = [lo, hi], y = [lo, hi] }",
    ),
    (HEAD + "[requirements]\no2 = [1, true]", "requirements.o2[1] is true; allowed is a number"),
    (HEAD + "[requirements]\no2 = { x = 5 }", "requirements.o2.x is 5; allowed is [lo, hi]"),
    (HEAD + "[requirements]\no2 = { x = [1, {}] }", "requirements.o2.x[1] is a table; allowed is a number"),
    (
        HEAD + "[objective]\nmaximise = 3",
        "objective.maximise is 3; allowed is transmission, compactness, torque, another quantity or a "
        "table of weights",
    ),
    (
        HEAD + "[objective]\nmaximise = 'speed'",
        "objective.maximise is 'speed'; allowed is transmission, compactness, torque, another quantity",
    ),
    (
        HEAD + "[objective]\nmaximise = { transmission = true }",
        "objective.maximise.transmission is true; allowed is a number",
    ),
    (HEAD + "[search]\nstarts = 5.0", "search.starts is 5.0; allowed is a whole number"),
    (HEAD + "[search]\nseed = false", "search.seed is false; allowed is a whole number"),
]


@pytest.mark.parametrize(("text", "expected"), STRUCTURE)
def test_wrong_structure(text: str, expected: str) -> None:
    assert message(text) == expected


POSES_TEXT = [
    ("5", "motion.poses is 5; allowed is a list of poses [x, y, angle in degrees]"),
    ("[]", "motion.poses has 0 poses; allowed are two or more"),
    ("[[1, 2, 3]]", "motion.poses has 1 pose; allowed are two or more"),
    ("[[1, 2, 3], 5]", "motion.poses[1] is 5; allowed is a pose [x, y, angle in degrees]"),
    (
        "[[1, 2, 3], [3.5, 4]]",
        "motion.poses[1] is [3.5, 4], 2 numbers; allowed is a pose [x, y, angle in degrees]",
    ),
    ("[[1, 2, 3], [1, 2, '3']]", "motion.poses[1][2] is '3'; allowed is a finite number"),
    ("[[1, 2, 3], [1, 2, true]]", "motion.poses[1][2] is True; allowed is a finite number"),
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
        "motion.poses[1].z is unknown; allowed are x, y, angle",
    ),
    ("[[1, 2, 3], { x = 2 }]", "motion.poses[1] has one of x and y; allowed are both or neither"),
    ("[[1, 2, 3], {}]", "motion.poses[1] has neither position nor angle"),
]


@pytest.mark.parametrize(("poses", "expected"), POSES_TEXT)
def test_bad_poses(poses: str, expected: str) -> None:
    assert message(f'kind = "motion"\n[motion]\nposes = {poses}') == expected


SENSE = [
    (
        "[requirements]\nlink_length = [8, 0.3]",
        "requirements.link_length is [8, 0.3]: lo exceeds hi; allowed is [lo, hi] with lo <= hi",
    ),
    (
        "[requirements]\nlink_length = [1, 2, 3]",
        "requirements.link_length is [1.0, 2.0, 3.0]; allowed is [lo, hi]",
    ),
    ("[requirements]\nr2 = [1, nan]", "requirements.r2[1] is nan; allowed is a finite number"),
    (
        "[requirements]\nrotatability = 'full'",
        "requirements.rotatability is 'full'; allowed is one of full-crank, crank-rocker, double-crank, any",
    ),
    (
        "[requirements]\ntransmission_min_deg = 91",
        "requirements.transmission_min_deg is 91; allowed is 0 to 90",
    ),
    ("[requirements]\ntolerance = inf", "requirements.tolerance is inf; allowed is a finite number"),
    ("[requirements]\no2 = { x = [3, 1] }", "requirements.o2.x is [3, 1]; allowed is [lo, hi] with lo <= hi"),
    ("[requirements]\nb = { y = [3] }", "requirements.b.y is [3.0]; allowed is [lo, hi] with lo <= hi"),
    ("[requirements]\no4 = [0, nan]", "requirements.o4.y is [nan, nan]; allowed is [lo, hi] with lo <= hi"),
    (
        "[objective]\nmaximise = {}",
        "objective.maximise has no weight greater than zero; one at least is needed",
    ),
    (
        "[objective]\nmaximise = { transmission = -1 }",
        "objective.maximise.transmission is -1; allowed is 0 to 1e+09",
    ),
    ("[search]\nstarts = 0", "search.starts is 0; allowed is a whole number from 1"),
    (
        "[scene]\noutlines = [[[0, 0], [1]]]",
        "scene.outlines[0][1] is [1.0], 1 number; allowed is a corner [x, y]",
    ),
    ("[scene]\noutlines = [[]]", "scene.outlines[0] has 0 corners; allowed are two or more"),
    ("angle_length = 0", "motion.angle_length is 0; allowed is a length greater than zero"),
    ("angle_length = 1e300", "motion.angle_length is 1e+300; allowed is 1e-20 to 1e+20"),
    ("body = [[0, 0], [1, 1e21]]", "motion.body[1] is [1.0, 1e+21]; allowed are numbers up to 1e+20"),
    (
        "[scene]\noutlines = [[[0, 0], [1, -1e21]]]",
        "scene.outlines[0][1] is [1.0, -1e+21]; allowed are numbers up to 1e+20",
    ),
    ("[requirements]\nr1 = [1, 1e21]", "requirements.r1 is [1, 1e+21]; allowed is hi up to 1e+20"),
    (
        "[requirements]\ncoupler_arms = [0, 1e300]",
        "requirements.coupler_arms is [0, 1e+300]; allowed is hi up to 1e+20",
    ),
    ("[requirements]\no2 = { x = [0, 1e100] }", "requirements.o2.x is [0, 1e+100]; allowed is up to 1e+20"),
    (
        "[manufacturing]\nlength_tolerance = 1e300",
        "manufacturing.length_tolerance is 1e+300; allowed is a length up to 1e+20",
    ),
    (
        "weights = [1, 1, 1, 1e308]",
        "motion.weights[3] is 1e+308; allowed is a number from 1e-09 to 1e+09",
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
    (HEAD + "[search]\nworkers = 2", "search.workers is unknown; allowed are starts, enough, seed, effort"),
    (HEAD + "[requirements]\no2 = { z = [1, 2] }", "requirements.o2.z is unknown; allowed are x, y"),
    (
        HEAD + "[objective]\nmaximise = { compact = 1 }",
        "objective.maximise.compact is unknown; did you mean compactness?",
    ),
    (HEAD + "title = 'below its table'", "motion.title is unknown; did you mean title?"),
    ("link_length = [1, 2]\n" + HEAD, "link_length is unknown; did you mean requirements.link_length?"),
    (
        HEAD + '"a b\\n" = 1',
        'motion."a b\\n" is unknown; '
        "allowed are poses, weights, angle_length, body, within, angle_within_deg, timing_deg, "
        "closed",
    ),
    (f'kinds = "motion"\n[motion]\n{POSES}', "kinds is unknown; did you mean kind?\nkind is missing"),
]


@pytest.mark.parametrize(("text", "expected"), UNKNOWN)
def test_unknown_keys(text: str, expected: str) -> None:
    assert message(text) == expected


DRIVEN = 'length_unit = "m"\n{}\n[objective]\nmaximise = {}\n[dynamics]\nmass_per_length = 2\n'


@pytest.mark.parametrize(
    ("maximise", "expected"),
    [
        ("'torque'", Objective(0, 0, 1)),
        ("{ transmission = 1, torque = 0.1 }", Objective(1, 0, 0.1)),
        ("{ torque = 2, compactness = 1 }", Objective(0, 1, 2)),
    ],
)
def test_the_torque_is_an_objective(maximise: str, expected: Objective) -> None:
    assert problem_from(tomllib.loads(DRIVEN.format(HEAD, maximise)), "test").objective == expected


@pytest.mark.parametrize("maximise", ["'torque'", "{ transmission = 1, torque = 0.1 }"])
def test_the_torque_as_an_objective_needs_masses(maximise: str) -> None:
    expected = "dynamics is missing; objective.maximise.torque needs it"
    assert message(f"{HEAD}[objective]\nmaximise = {maximise}") == expected


def test_the_torque_as_an_objective_needs_a_motion() -> None:
    text = DRIVEN.format(HEAD, "'torque'") + "[requirements]\nsame_branch = false"
    with pytest.raises(ProblemError, match=r"requirements\.same_branch is false; allowed is true when"):
        problem_from(tomllib.loads(text), "test")


KEEP_OUT = {
    "[[[0, 0], [1, 0]]]": "[0] has 2 distinct corners; allowed are three or more",
    "[[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 0], [2, 0]]]": (
        "[1] has no area: its corners lie on a straight line"
    ),
    "[[[0, 0], [2, 2], [2, 0], [0, 2]]]": (
        "[0] crosses or touches itself at (1, 1); allowed is a simple polygon"
    ),
    "[[[0, 0], [1, nan], [1, 1]]]": "[0][1] is [1.0, nan]; all numbers must be finite",
    "[[[0, 0], [1, 'a'], [1, 1]]]": "[0][1][1] is 'a'; allowed is a number",
    "[[[0, 0], [1, 1]], [[0, 0], [2, 0], [1, 1]], [[0, 0], [1, 0], [2, 0]]]": (
        "[0] has 2 distinct corners; allowed are three or more\n"
        "requirements.keep_out[2] has no area: its corners lie on a straight line"
    ),
    "[[0, 0]]": "[0][0] is 0; allowed is a corner [x, y]\n"
    "requirements.keep_out[0][1] is 0; allowed is a corner [x, y]",
    "3": " is 3; allowed is a list of polygons, each a list of corners [x, y]",
}


@pytest.mark.parametrize("text", KEEP_OUT)
def test_bad_areas_are_named(text: str) -> None:
    assert message(HEAD + f"[requirements]\nkeep_out = {text}") == f"requirements.keep_out{KEEP_OUT[text]}"


def test_what_keeps_out_is_one_of_a_few() -> None:
    allowed = "allowed is a list of o2, o4, a, b, p and links"
    for text, found in (("['o2', 'o3']", "[1] is 'o3'"), ("[]", " is []")):
        said = message(HEAD + f"[requirements]\nkeep_out_for = {text}")
        assert said == f"requirements.keep_out_for{found}; {allowed}"


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


NUMBER_OR_LIST = "allowed is a number, or a list of one for each target"
BAD_ZONES = [
    ("within = '6'", f"motion.within is '6'; {NUMBER_OR_LIST}"),
    ("within = true", f"motion.within is true; {NUMBER_OR_LIST}"),
    ("within = { x = 1 }", f"motion.within is a table; {NUMBER_OR_LIST}"),
    ("within = [1, 2]", "motion.within has 2 numbers for 4 targets; "),
    ("within = []", "motion.within has 0 numbers for 4 targets; "),
    ("within = [1, true, 1, 1]", "motion.within[1] is true; allowed is a number"),
    ("within = [1, [1], 1, 1]", "motion.within[1] is [1]; allowed is a number"),
    ("within = 0", "motion.within is 0; allowed is "),
    ("within = -1", "motion.within is -1; allowed is "),
    ("within = nan", "motion.within is nan; allowed is "),
    ("within = inf", "motion.within is inf; allowed is "),
    ("within = 1e300", "motion.within is 1e+300; allowed is "),
    ("within = [1, 1, 1, 1e-13]", "motion.within[3] is 1e-13; allowed is "),
    ("angle_within_deg = 181", "motion.angle_within_deg is 181; allowed is 1e-10 to 180"),
    ("angle_within_deg = [1, 1, 0, 1]", "motion.angle_within_deg[2] is 0; allowed is 1e-10 to 180"),
    (
        "within = 1\n[requirements]\nexact = true",
        "motion.within does not go with requirements.exact = true; ",
    ),
    (
        "within = 1\n[requirements]\nerror_factor = 2",
        "requirements.error_factor does not go with motion.within; allowed is one of them",
    ),
    ("[requirements]\nerror_factor = 2", "requirements.error_factor needs least squares, exact = false"),
    ("[requirements]\nerror_factor = 0.9", "requirements.error_factor is 0.9; allowed is 1 to 1e+06"),
    ("[search]\neffort = 0.1", "search.effort is 0.1; allowed is 0.2 to 100"),
    ("[search]\neffort = inf", "search.effort is inf; allowed is a finite number"),
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
    assert told[0] == "path.points has 2 points; allowed are three or more"
    assert told[1].startswith("path.within[2] is -3; allowed is ")


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


def test_poses_may_be_timed_and_closed() -> None:
    task = problem(HEAD + "timing_deg = [0, 20, 45.5, 90]\nclosed = true\n").task
    assert task.timing is not None
    assert task.timing.tolist() == np.radians([0, 20, 45.5, 90]).tolist()
    assert task.closed
    plain = problem(HEAD).task
    assert (plain.timing, plain.closed) == (None, False)
    wrong = HEAD + "timing_deg = [0, 20, 10, 90]\nclosed = 1\nwithin = [-1, 1, 1, 1]\n"
    assert message(wrong).splitlines() == [
        "motion.within[0] is -1; allowed is 3e-12 to 1e+20",
        "motion.timing_deg[2] is 10 after 20; allowed are angles that only grow, or only fall",
        "motion.closed is 1; allowed is true or false",
    ]


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
    ('kind = "path"\n[path]\npoints = 5', "path.points is 5; allowed is a list of points [x, y]"),
    ('kind = "path"\n[path]\npoints = [5]', "path.points[0] is 5; allowed is a point [x, y]"),
    (
        'kind = "path"\n[path]\npoints = [[1, 2], [3, "4"]]',
        "path.points[1][1] is '4'; allowed is a number",
    ),
    (
        'kind = "path"\n[path]\npoints = [[1, 2], [3, 4, 5], [6, 7]]',
        "path.points[1] is [3.0, 4.0, 5.0], 3 numbers; allowed is a point [x, y]",
    ),
    (
        'kind = "path"\n[path]\npoints = [[1, 2], [3, 4]]',
        "path.points has 2 points; allowed are three or more",
    ),
    (LINE + "closed = 1", "path.closed is 1; allowed is true or false"),
    (LINE + "timing_deg = 20", "path.timing_deg is 20; allowed is a list of angles"),
    (LINE + "timing_deg = [0, '20', 40]", "path.timing_deg[1] is '20'; allowed is a number"),
    (LINE + "timing_deg = [0, 20]", "path.timing_deg has 2 angles for 3 points"),
    (LINE + "timing_deg = [5, 20, 30]", "path.timing_deg[0] is 5; allowed is 0, at the first point"),
    (
        LINE + "timing_deg = [0, 20, 10]",
        "path.timing_deg[2] is 10 after 20; allowed are angles that only grow, or only fall",
    ),
]


@pytest.mark.parametrize(("text", "expected"), PATHS)
def test_bad_paths(text: str, expected: str) -> None:
    assert message(text) == expected


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


def test_all_errors_are_told_a_line_each() -> None:
    assert message(SEVERAL).splitlines() == [
        "title has control character U+0007; allowed is plain text",
        "motion.poses[1] is [1, 2], 2 numbers; allowed is a pose [x, y, angle in degrees]",
        "motion.poses[2].angel is unknown; did you mean angle?",
        "motion.poses[3] is [1, 2, nan]; all numbers must be finite",
        "motion.weights[1] is 0.0; allowed is a number from 1e-09 to 1e+09",
        "motion.angle_length is -1; allowed is a length greater than zero",
        "motion.body has 1 corner; allowed are two or more",
        "scene.outlines[0] has 1 corner; allowed are two or more",
        "scene.outlines[2][1] is [1.0, inf]; all numbers must be finite",
        "requirements.tolerance is '1'; allowed is a number",
        "requirements.order is 1; allowed is true or false",
        "requirements.r1 is [3, 2]: lo exceeds hi; allowed is [lo, hi] with lo <= hi",
        "requirements.link_ratio_max is 0; allowed is 1 to 1e+06",
        "requirements.o2.x is [2, 1]; allowed is [lo, hi] with lo <= hi",
        "requirements.o2.y is [4, 3]; allowed is [lo, hi] with lo <= hi",
        "requirements.keep_out_for[0] is 'o3'; allowed is a list of o2, o4, a, b, p and links",
        "objective.maximise.compactness is 10000000000; allowed is 0 to 1e+09",
        "objective.maximise.torque is -1; allowed is 0 to 1e+09",
        "dynamics.masses[1] is -2; allowed is a number from zero",
        "dynamics.payload is -1; allowed is a number from zero",
        "manufacturing.band is 0; allowed is a length greater than zero",
        "search.starts is 0; allowed is a whole number from 1",
        "search.seed is -1; allowed is a whole number from 0",
        "titles is unknown; did you mean title?",
        "manufacturing.length_tolerance is missing",
        'motion does not belong to kind = "path"',
        "length_unit is 'ell'; with dynamics allowed are mm, cm, m, in, ft",
    ]


def test_long_values_are_shortened_and_stay_on_one_line() -> None:
    text = message("title = [" + "1, " * 500 + "]\n" + HEAD)
    assert text.startswith("title is [1, 1, 1,")
    assert len(text) < 100
    assert "\n" not in message(HEAD + '[requirements]\ntolerance = """a\nb"""')


@pytest.mark.parametrize("key", ["title", "source", "length_unit"])
def test_control_characters_are_refused(key: str) -> None:
    said = f"{key} has control character U+001B; allowed is plain text"
    assert message(f'{key} = "red \\u001b[31m"\n{HEAD}') == said


def test_tables_that_do_not_go_together_are_all_told() -> None:
    text = (
        HEAD
        + "[dynamics]\nspeed_rpm = -1\n[objective]\nmaximise = 'torque'\n[requirements]\nsame_branch = false"
    )
    assert message("length_unit = 'm'\n" + text).splitlines() == [
        "dynamics.speed_rpm is -1; allowed are numbers greater than zero",
        "dynamics has no mass; mass_per_length is needed, masses and inertias, or payload",
        "requirements.same_branch is false; allowed is true when objective.maximise.torque is given",
    ]
