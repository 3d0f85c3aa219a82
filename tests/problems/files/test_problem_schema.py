"""Problem files: every key reaches its field, and every error names its key path."""

import dataclasses
import math
import re
import tomllib

import numpy as np
import pytest
from refusals import MOTION, POSES, message, problem, rows

from grashof.problems import (
    Box,
    CylinderSpec,
    MotionTask,
    Objective,
    ProblemError,
    Region,
    Requirements,
    Rotatability,
    Search,
)
from grashof.problems.files.problem_schema import RequirementsTable, problem_from
from grashof.problems.values.linkages.mechanism import ONE_LOOP

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

# Limits that need masses, tolerances or a full turn.
EVERY_LIMIT = f"""length_unit = "m"
{MOTION}
closed = true
[requirements]
size = [0, 9]
link_ratios = {{ "r4/r2" = 1, "r3/r2" = [2, 2.5] }}
distances = {{ a-o4 = [1, 9], "p-b" = 2 }}
at = [
    {{ targets = [3], distances = {{ "b-o2" = 3 }}, coupler_angle_deg = [30, 50], coupler_rate = [-1, 2] }},
    {{ targets = [1, 2], a = [1, 2], b = {{ x = [0, 1] }}, transmission_min_deg = 30 }},
]
omega4_max = [0, 9]
point_speed_max = [0, 9]
point_acceleration_max = [0, 9]
output_acceleration_max = [0, 9]
torque_peak = [0, 9]
torque_rms = [0, 9]
torque_deviation = [0, 9]
torque_deviation_max = [0, 9]
joint_force_peak = [0, 9]
coupler_fit_r2 = [0.5, 1]
hausdorff = [0, 9]
frechet = [0, 9]
worst_move = [0, 9]
share_within_made = [0.5, 1]
driver_rotation_deg = [90, 180]
driver_sense = "cw"
a_on_body = {{ x = [0, 1] }}
b_on_body = [1, 2]
mechanical_advantage_min = 0.5
coupler_angle_deg = [-30, 90]
coupler_rate = [-2, 2]
time_ratio = [1.2, 1.6]
output_swing_deg = [40, 60]
offset = [-1, 2]
slide_angle_deg = 30
stroke = [4, 5]
[dynamics]
payload = 1
[torque]
wanted = [[0, 5], [90, -5]]
[manufacturing]
length_tolerance = 0.1
"""


TWO_STROKES = """kind = "stroke"
[[stroke]]
link = 4
swing_deg = 90
[[stroke]]
link = 6
swing_deg = 85
[requirements]
d = [500, 0]
synchrony_error = [0, 0.1]
"""

WITH_CYLINDER = f"""length_unit = "m"
{MOTION}
[driver]
cylinder = {{ closed = [3, 9], ratio_max = 1.5, on = ["output", "driver"], base = {{ x = [0, 4] }} }}
[requirements]
cylinder_angle_min_deg = 30
cylinder_force_max = [0, 9]
cylinder_rate = [0.5, 4]
[dynamics]
payload = 1
"""


def test_every_key_reaches_its_field() -> None:
    every = problem(EVERY_KEY)
    words = (every.name, every.title, every.source, every.length_unit)
    assert words == ("test", "Up and over", "a report", "cm")
    assert isinstance(every.task, MotionTask)
    assert every.task.positions.tolist() == [[5, 4], [3.5, 4], [2, 3], [1, 0]]
    np.testing.assert_allclose(np.degrees(every.task.angles), [0, -5, -5, 0], rtol=1e-15)
    assert every.task.angle_length == 2.0
    assert every.task.body is not None
    assert every.task.body.tolist() == [[0, 0], [1, 0], [1, 1.5]]
    assert [outline.tolist() for outline in every.outlines] == [[[0, 0], [5, 0]], [[1, 1], [2, 2], [3, 1]]]
    boxes = {"o2": Box((-4, 10), (-7, 7)), "o4": Box((1, 1), (2, 2))}
    boxes |= {"a": Box(x=(-math.inf, 3)), "b": Box(y=(0, 5))}
    assert every.requirements == Requirements(**tomllib.loads(EVERY_KEY)["requirements"] | boxes)
    assert every.objective == Objective(2.0, 0.5)
    assert every.search == Search(starts=100, enough=20, seed=4, effort=2.5)


def test_the_examples_above_use_every_requirement() -> None:
    fields = {field.name for field in dataclasses.fields(Requirements)}
    assert set(RequirementsTable.model_fields) == fields
    used: set[str] = set()
    driven, sliding = r"(torque_|joint_force).*\n", r"(offset|slide_angle_deg|stroke) .*\n"
    of_all_kinds = f"mechanism = {[*ONE_LOOP]}\n{EVERY_LIMIT}"
    for text in (
        EVERY_KEY,
        re.sub(sliding, "", EVERY_LIMIT),
        re.sub(driven, "", of_all_kinds),
        WITH_CYLINDER,
        TWO_STROKES,
        'kind = "dwell"\n[dwell]\ndwell_deg = 90\nswing_deg = 45\n[requirements]\nr5 = [1, 2]\nr6 = [2, 3]\n',
    ):
        given, names = problem(text).requirements, set(tomllib.loads(text)["requirements"])
        assert [name for name in names if getattr(given, name) == getattr(Requirements(), name)] == []
        used |= names
    # Those of functions are in test_function_files.
    assert used == {name for name in fields if not name.startswith("structural_error")}


def test_absent_keys_have_the_defaults_of_the_value_types() -> None:
    plain = problem(MOTION + "[scene]\n[requirements]\n[objective]\n[search]\n")
    assert plain.requirements == Requirements()
    assert plain.objective == Objective()
    assert plain.search == Search()
    assert plain.outlines == ()
    assert (plain.title, plain.source, plain.length_unit) == ("", "", "")
    assert plain.task.body is None
    assert plain.task.angle_length == plain.task.size == pytest.approx(math.sqrt(32))


DRIVEN = 'length_unit = "m"\n{}\n[objective]\nmaximise = {}\n[dynamics]\nmass_per_length = 2\n'


@pytest.mark.parametrize(
    ("maximise", "expected"),
    [
        ("'compactness'", Objective(0, 1)),
        ("{ compactness = 3 }", Objective(0, 3)),
        ("'torque'", Objective(0, 0, 1)),
        ("{ torque = 2, compactness = 1 }", Objective(0, 1, 2)),
    ],
)
def test_objective(maximise: str, expected: Objective) -> None:
    assert problem_from(tomllib.loads(DRIVEN.format(MOTION, maximise)), "test").objective == expected


def test_the_torque_as_an_objective_needs_masses_and_a_motion() -> None:
    expected = "dynamics is missing; objective.maximise.torque needs it"
    assert message(f"{MOTION}[objective]\nmaximise = 'torque'") == expected
    text = DRIVEN.format(MOTION, "'torque'") + "[requirements]\nsame_branch = false"
    with pytest.raises(ProblemError, match=r"requirements\.same_branch is false; it must be true when"):
        problem_from(tomllib.loads(text), "test")


def test_errors_of_timing_zones_and_closed_are_reported_together() -> None:
    wrong = MOTION + "timing_deg = [0, 20, 10, 90]\nclosed = 1\nwithin = [-1, 1, 1, 1]\n"
    assert message(wrong).splitlines() == [
        "motion.within[0] is -1; it must be from 3e-12 to 1e+20",
        "motion.timing_deg[2] is 10 after 20; the angles must only grow, or only fall",
        "motion.closed is 1; it must be true or false",
    ]


def test_a_cylinder_is_read_with_all_its_keys() -> None:
    given = problem(WITH_CYLINDER)
    wanted = CylinderSpec(closed=(3, 9), ratio_max=1.5, on=["driver", "output"], base=Box((0, 4)))
    assert given.driver == wanted
    assert given.requirements.rotatability is Rotatability.ANY
    assert problem(f"{MOTION}[driver]\ncylinder = {{}}\n").driver == CylinderSpec()
    fixed = problem(f"{MOTION}[driver]\ncylinder = {{ base = [1, 2] }}\n").driver
    assert fixed == CylinderSpec(base=Box((1, 1), (2, 2)))


BAD_CYLINDERS = """
closed = [9, 3] | driver.cylinder.closed is [9, 3]: lo exceeds hi; it must be [lo, hi] with lo <= hi
closed = [0, 0] | driver.cylinder.closed is [0, 0]; its greatest length must be above zero
ratio_max = 2.5 |
    driver.cylinder.ratio_max is 2.5; it must be above 1 and below 2: a rod is no longer than its cylinder
on = [] | driver.cylinder.on is []; it must be a list of some of driver, coupler, output
on = ["ground"] | driver.cylinder.on[0] is 'ground'; it must be one of driver, coupler, output
base = { x = [3, 1] } | driver.cylinder.base.x is [3, 1]; it must be [lo, hi] with lo <= hi
"""


@pytest.mark.parametrize(("text", "line"), rows(BAD_CYLINDERS))
def test_impossible_cylinders_are_refused_in_a_line(text: str, line: str) -> None:
    assert message(f"{MOTION}[driver]\ncylinder = {{ {text} }}\n") == line


NOT_BY_CYLINDERS = r"""
<DRIVEN>[requirements]\nrotatability = "full-crank" |
    requirements.rotatability is full-crank; it must be any with driver.cylinder, which turns nothing fully
closed = true\n<DRIVEN> | motion.closed is true; it must be false with driver.cylinder, which reverses
<DRIVEN>[requirements]\nsame_branch = false |
    requirements.same_branch is false; it must be true with driver.cylinder
[requirements]\ncylinder_angle_min_deg = 20 |
    driver.cylinder is missing; requirements.cylinder_angle_min_deg needs it
[requirements]\ncylinder_rate = [1, 2] | driver.cylinder is missing; requirements.cylinder_rate needs it
<DRIVEN>[requirements]\ncylinder_rate = [2, 1] |
    requirements.cylinder_rate is [2, 1]: lo exceeds hi; it must be [lo, hi] with lo <= hi
<DRIVEN>[requirements]\ncylinder_rate = [-1, 1] |
    requirements.cylinder_rate is [-1, 1]; lo must be at least 0
[driver] | driver.cylinder is missing
"""


@pytest.mark.parametrize(("text", "said"), rows(NOT_BY_CYLINDERS, DRIVEN="[driver]\ncylinder = {}\n"))
def test_impossible_tasks_of_a_cylinder_are_refused_in_a_line(text: str, said: str) -> None:
    assert message(MOTION + text) == said


def test_a_cylinder_drives_every_kind_but_no_strokes() -> None:
    driven = "[driver]\ncylinder = {}\n"
    kinds = ["four-bar", "slider-crank", "inverted-slider-crank"]
    assert problem(f"mechanism = {kinds}\n{MOTION}{driven}").driver == CylinderSpec()
    stroke = 'kind = "stroke"\n[stroke]\nswing_deg = 80\ntime_ratio = 1.2\n'
    assert message(f"{stroke}{driven}") == (
        "driver.cylinder does not go with stroke, whose driver turns all round"
    )


def test_a_number_for_a_side_is_a_line() -> None:
    def wanted(side: object) -> Requirements:
        motion = {"poses": [[0, 0, 0], [3, 1, 40], [5, 4, 90]]}
        document = {"kind": "motion", "motion": motion, "requirements": {"o4": {"x": side}}}
        return problem_from(document, "line").requirements

    assert wanted(5) == wanted([5, 5]) == wanted(5.0)
    assert wanted(5).o4 == Box(x=(5, 5))
    with pytest.raises(ProblemError, match=r"requirements\.o4\.x is true; it must be \[lo, hi\]"):
        wanted(True)


@pytest.mark.parametrize("name", ["o2", "o4", "a", "b", "a_on_body", "b_on_body"])
def test_a_place_may_be_a_region(name: str) -> None:
    inside = problem(f"{MOTION}[requirements]\n{name} = {{ inside = [[0, 0], [4, 0], [1, 2]] }}\n")
    assert getattr(inside.requirements, name) == Region(inside=[(0, 0), (4, 0), (1, 2)])
    on = problem(f"{MOTION}[requirements]\n{name} = {{ on = [[0, 0], [4, 2]] }}\n").requirements
    assert getattr(on, name) == Region(on=[(0, 0), (4, 2)])
    assert on.ranges(name) == {"x": (0, 4), "y": (0, 2)}


BAD_REGIONS = """
inside = [[0, 0], [4, 4], [4, 0], [0, 4]] |
    requirements.o2.inside crosses or touches itself at (2, 2); it must be a simple polygon
inside = [[0, 0], [1, 1], [2, 2]] | requirements.o2.inside has no area: its corners lie on a straight line
inside = [[0, 0], [1, 1]] | requirements.o2.inside has 2 distinct corners; it must have three or more
inside = [] | requirements.o2.inside is []; it must be a list of corners [x, y]
inside = [[0, 0], [1, "a"], [2, 3]] | requirements.o2.inside[1][1] is 'a'; it must be a number
inside = 3 | requirements.o2.inside is 3; it must be a list of corners [x, y], or a .dxf or .svg file
inside = "wing.svg" | requirements.o2.inside is the file wing.svg; here it must be a list instead
on = [[1, 1], [1, 1]] |
    requirements.o2.on has no length: both ends are the same point; it must be [[x, y], [x, y]]
on = [[0, 0], [1, 1], [2, 0]] |
    requirements.o2.on has 3 ends; it must be [[x, y], [x, y]]
on = [[0, 0], [inf, 1]] | requirements.o2.on[1] is [inf, 1.0]; all numbers must be finite
on = [[0, 0], [1, 1]], x = [0, 1] | requirements.o2.on does not go with x; give one of them
on = [[0, 0], [1, 1]], inside = [[0, 0], [4, 0], [1, 2]] |
    requirements.o2.on does not go with inside; give one of them
"""


@pytest.mark.parametrize(("text", "line"), rows(BAD_REGIONS))
def test_impossible_regions_are_refused_in_a_line(text: str, line: str) -> None:
    assert message(f"{MOTION}[requirements]\no2 = {{ {text} }}\n") == line


def test_a_distance_at_a_target_is_refused_by_its_full_key() -> None:
    at = "at = [{ targets = [1], distances = { a-o4 = [5, 2] } }]"
    assert message(f"{MOTION}[requirements]\n{at}\n") == (
        "requirements.at[0].distances.a-o4 is [5, 2]: lo exceeds hi; it must be [lo, hi] with lo <= hi"
    )


def test_regions_at_single_targets_and_of_cylinders() -> None:
    edge = "{ on = [[0, 0], [4, 2]] }"
    at = problem(f"{MOTION}[requirements]\nat = [{{ targets = [2], a = {edge} }}]\n").requirements.at
    assert at[0].a == Region(on=[(0, 0), (4, 2)])
    driven = f"{MOTION}[driver]\ncylinder = {{ base = {edge} }}\n"
    assert message(driven) == "driver.cylinder.base is a region; it must be a box"
