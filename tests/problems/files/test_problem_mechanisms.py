"""Kinds of linkages in problem files, and the limits and goals of each."""

import tomllib
from dataclasses import replace

import pytest
from refusals import refusal, rows

from grashof.problems import Objective, PathTask, Problem, ProblemError, Requirements
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.requirements.all_quantities import QUANTITIES

POINTS = "[path]\npoints = [[0, 0], [1, 0], [2, 1], [3, 0]]\n"
TASK = PathTask([[0, 0], [1, 0], [2, 1], [3, 0]])


def problem(mechanism: str, requirements: str = "") -> Problem:
    head = f"mechanism = {mechanism}\n" if mechanism else ""
    text = f'kind = "path"\n{head}{POINTS}[requirements]\n{requirements}'
    return problem_from(tomllib.loads(text), "test")


def message(mechanism: str, requirements: str = "") -> str:
    return refusal(problem, mechanism, requirements)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("", ("four-bar",)),
        ('["inverted-slider-crank"]', ("inverted-slider-crank",)),
        ('["slider-crank", "four-bar"]', ("slider-crank", "four-bar")),
    ],
)
def test_kinds_come_back(given: str, expected: tuple[str, ...]) -> None:
    made = problem(given)
    assert made.mechanism == expected
    text = problem_toml(made)
    assert problem_of(text, "here", "test").mechanism == expected
    assert ("mechanism" in text) == (given != "")


ANY = "four-bar, slider-crank, inverted-slider-crank, stephenson-3, stephenson-1, watt-1, watt-2 or six-bar"
NO_KINDS = """
"slider-crnk" | mechanism is 'slider-crnk'; did you mean slider-crank?
["four-bar", "foubar"] | mechanism[1] is 'foubar'; did you mean four-bar?
"wheel" | mechanism is 'wheel'; it must be <ANY>
["four-bar", "four-bar"] | mechanism has four-bar 2 times
[] | mechanism is []; it must be <ANY>, or a list of these
[4] | mechanism[0] is 4; it must be <ANY>
"""


@pytest.mark.parametrize(("given", "line"), rows(NO_KINDS, ANY=ANY))
def test_unknown_kinds_are_refused_in_one_line(given: str, line: str) -> None:
    assert message(given) == line


NOT_OF_A_KIND = r"""
"slider-crank" | r4 = [1, 2]\no4 = [0, 0]\nground_angle_deg = 3 |
    requirements.r4 does not go with mechanism slider-crank; only <BARS>\n
    requirements.o4 does not go with mechanism slider-crank; only <BOTH>\n
    requirements.ground_angle_deg does not go with mechanism slider-crank; only <BOTH>
# | stroke = [1, 2] | requirements.stroke does not go with mechanism four-bar; only slider-crank has it
["slider-crank", "inverted-slider-crank"] | rotatability = "crank-rocker" |
    requirements.rotatability = "crank-rocker" does not go with mechanism slider-crank and
    inverted-slider-crank; only <BARS>
"""
SIX = "stephenson-3, stephenson-1, watt-1 and watt-2 have it"
BARS, BOTH = f"four-bar, {SIX}", f"four-bar, inverted-slider-crank, {SIX}"


@pytest.mark.parametrize(("given", "requirements", "lines"), rows(NOT_OF_A_KIND, BOTH=BOTH, BARS=BARS))
def test_requirements_that_no_kind_has_are_refused(given: str, requirements: str, lines: str) -> None:
    assert message(given, requirements) == lines


def test_a_mixed_list_may_limit_what_one_of_its_kinds_has() -> None:
    made = problem(
        '["four-bar", "slider-crank"]', "r4 = [1, 2]\noffset = [-1, 1]\nstroke = [2, 3]\nslide_angle_deg = 20"
    )
    assert (made.requirements.r4, made.requirements.offset) == ((1, 2), (-1, 1))
    assert (made.requirements.stroke, made.requirements.slide_angle_deg) == ((2, 3), 20)


def test_every_column_of_a_linkage_is_a_quantity_of_its_kind() -> None:
    for word, kind in ONE_LOOP.items():
        columns = {*kind.lengths, *(name for row in kind.parameters for name in row.columns)} - {"assembly"}
        listed = {quantity.column: quantity for quantity in QUANTITIES.values()}
        assert columns <= listed.keys()
        assert all(word in listed[name].kinds for name in columns)


def test_a_kind_may_be_a_single_word_in_python() -> None:
    assert Problem(task=TASK, mechanism="slider-crank").mechanism == ("slider-crank",)  # type: ignore[arg-type]
    with pytest.raises(ProblemError, match=r"requirements.offset does not go with mechanism four-bar"):
        Problem(task=TASK, requirements=Requirements(offset=(0, 1)))


def test_a_problem_for_one_kind_keeps_what_the_kind_has() -> None:
    every = Problem(
        task=TASK,
        requirements=Requirements(r2=(1, 2), r4=(1, 2), offset=(0, 1), rotatability="crank-rocker"),  # type: ignore[arg-type]
        objective=Objective(0.0, output_swing=1.0, compactness=0.5),
        mechanism=tuple(ONE_LOOP),
    )
    assert every.for_kind("four-bar").requirements == replace(every.requirements, offset=None)
    assert every.for_kind("four-bar").objective == every.objective
    slider = every.for_kind("slider-crank")
    assert slider.mechanism == ("slider-crank",)
    assert slider.requirements == Requirements(r2=(1, 2), offset=(0, 1))
    assert slider.objective == Objective(0.0, compactness=0.5)
    assert (
        replace(every, objective=Objective(0.0, output_swing=1.0)).for_kind("slider-crank").objective
        == Objective()
    )
