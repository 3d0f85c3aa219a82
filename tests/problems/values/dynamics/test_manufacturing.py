"""How exactly linkages are made: the value type, and its table in a problem file."""

import math
import pickle
import tomllib
from pathlib import Path

import pytest
from refusals import refusal, rows

from grashof.problems import Manufacturing, MotionTask, Problem, ProblemError, load, problem_text
from grashof.problems.files.problem_schema import problem_from

HEAD = 'kind = "motion"\nmotion.poses = [[0, 0, 0], [3, 4, 90]]\n[manufacturing]\n'


def stated(table: str) -> Manufacturing | None:
    return problem_from(tomllib.loads(HEAD + table), "test").manufacturing


def test_a_linkage_is_to_be_as_exact_as_its_parts_by_default() -> None:
    made = Manufacturing(0.3)
    assert (made.length_tolerance, made.band) == (0.3, 0.3)
    assert made.deviation == pytest.approx(0.1)
    assert made == Manufacturing(0.3, 0.3) != Manufacturing(0.3, band=0.5)
    assert pickle.loads(pickle.dumps(made)) == made


def test_nothing_is_made_unless_the_problem_says_so() -> None:
    assert Problem(task=MotionTask.from_degrees([[0, 0, 0], [3, 4, 90]])).manufacturing is None
    assert load("luggage").manufacturing is None


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ("length_tolerance = 0.1", Manufacturing(0.1, 0.1)),
        ("length_tolerance = 1", Manufacturing(1.0, 1.0)),
        ("length_tolerance = 0.1\nband = 0.25", Manufacturing(0.1, 0.25)),
    ],
)
def test_every_key_reaches_its_field(table: str, expected: Manufacturing) -> None:
    assert stated(table) == expected


def test_a_copied_problem_with_the_table_added_comes_back_from_its_file(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    table = "\n[manufacturing]\nlength_tolerance = 0.02\nband = 0.05\n"
    path.write_text(problem_text("luggage") + table, encoding="utf-8")
    assert load(path).manufacturing == Manufacturing(0.02, 0.05)


LENGTH = "it must be greater than zero"
BAD = r"""
# | manufacturing.length_tolerance is missing
band = 0.1 | manufacturing.length_tolerance is missing
length_tolerance = 0 | manufacturing.length_tolerance is 0; <LENGTH>
length_tolerance = -0.1 | manufacturing.length_tolerance is -0.1; <LENGTH>
length_tolerance = '0.1' | manufacturing.length_tolerance is '0.1'; it must be a number
length_tolerance = true | manufacturing.length_tolerance is true; it must be a number
length_tolerance = inf | manufacturing.length_tolerance is inf; it must be a finite number
length_tolerance = nan | manufacturing.length_tolerance is nan; it must be a finite number
length_tolerance = 0.1\nband = 0 | manufacturing.band is 0; <LENGTH>
length_tolerance = 0.1\nband = -2 | manufacturing.band is -2; <LENGTH>
length_tolerance = 0.1\nband = [1, 2] | manufacturing.band is [1, 2]; it must be a number
length_tolerance = 0.1\nsamples = 9 | manufacturing.samples is unknown; the keys are length_tolerance, band
tolerance = 0.1\nlength_tolerance = 0.1 | manufacturing.tolerance is unknown; did you mean length_tolerance?
"""


@pytest.mark.parametrize(("table", "expected"), rows(BAD, LENGTH=LENGTH))
def test_bad_tables(table: str, expected: str) -> None:
    assert refusal(stated, table) == expected


def test_no_table_at_all() -> None:
    text = 'manufacturing = 3\nkind = "motion"\nmotion.poses = [[0, 0, 0], [3, 4, 90]]'
    with pytest.raises(ProblemError, match=r"^manufacturing is 3; it must be a table$"):
        problem_from(tomllib.loads(text), "test")


@pytest.mark.parametrize("value", [0, -1, math.inf, math.nan, "0.1", None, True])
def test_bad_values_from_python(value: object) -> None:
    with pytest.raises(ProblemError, match=r"^manufacturing\.length_tolerance is "):
        Manufacturing(value)  # type: ignore[arg-type]
