"""Dynamics of slider kinds in linkage and problem files: what they state, what is wrong, and back again."""

from pathlib import Path

import pytest

from grashof.problems import ProblemError, load_linkage_spec
from grashof.problems.files.linkage_schema import linkage_from
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.files.toml_file import document_of
from grashof.problems.values.dynamics.acting import FrictionSpec, LoadSpec

ENGINE = 'length_unit = "mm"\nmechanism = "slider-crank"\nr2 = 40\nr3 = 120\n'
DYNAMICS = """
[dynamics]
masses = [0.5, 0.8, 0.6]
inertias = [200, 900, 0]
centres = [[0, 0], [40, 0], [0, 0]]
speed_rpm = 3000

[[loads]]
link = 4
over = "travel"
values = [[80, -4000, 0], [120, -900, 0], [160, -100, 0]]

[friction]
slide_mu = 0.08
slide_length = 60
slide_viscous = 2
slide_force = 5
"""


def test_what_a_file_of_a_slider_crank_states() -> None:
    spec = linkage_from(document_of(ENGINE + DYNAMICS, "mine"), "mine")
    assert spec.dynamics is not None
    values = ((80, -4000, 0), (120, -900, 0), (160, -100, 0))
    assert spec.dynamics.loads == (LoadSpec(4, values=values, over="travel"),)
    friction = FrictionSpec(slide_mu=0.08, slide_length=60, slide_viscous=2, slide_force=5)
    assert spec.dynamics.friction == friction
    assert friction.of_slide


def test_problem_files_state_them_too() -> None:
    head = 'kind = "path"\nmechanism = "slider-crank"\nlength_unit = "mm"\n[path]\n'
    text = head + "points = [[0, 0], [30, 10], [60, 0]]\n" + DYNAMICS
    problem = problem_of(text, "mine.toml", "mine")
    assert problem.dynamics is not None
    assert problem.dynamics.friction == FrictionSpec(
        slide_mu=0.08, slide_length=60, slide_viscous=2, slide_force=5
    )
    assert problem_of(problem_toml(problem), "mine.toml", "mine").dynamics == problem.dynamics


def test_a_table_over_travel(tmp_path: Path) -> None:
    (tmp_path / "gas.csv").write_text("travel,fx_n,fy_n\n80,-4000,0\n160,-100,0\n", encoding="utf-8")
    text = f'{ENGINE}[[loads]]\nlink = 4\nover = "travel"\ntable = "gas.csv"\n'
    (tmp_path / "engine.toml").write_text(text, encoding="utf-8")
    spec = load_linkage_spec(tmp_path / "engine.toml")
    assert spec.dynamics is not None
    assert spec.dynamics.loads[0].values == ((80, -4000, 0), (160, -100, 0))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[friction]\nslide_mu = -1", "friction.slide_mu is -1"),
        (
            "[friction]\nslide_length = 3",
            "friction.slide_mu is missing; slide_length is of no use without it",
        ),
        ("[friction]\nslide_m = 1", "friction.slide_m is unknown; did you mean slide_mu?"),
        (
            '[[loads]]\nlink = 4\nover = "theta4"\nvalues = [[0, 1], [360, 1]]',
            "loads[0].over is 'theta4'; the slider of a slider-crank does not turn",
        ),
        ("[[torsion_springs]]\nbetween = [1, 4]\nstiffness = 2", "torsion_springs[0].between is [1, 4]; a"),
        ("[friction]\nviscous = [0, 0, 0, 1]", "friction.viscous[3] is 1, in O4; a slider-crank has a slide"),
        (
            '[[loads]]\nlink = 4\nover = "travel"\nvalues = [[3, 1], [2, 1]]',
            "loads[0].values[1] has travel 2",
        ),
    ],
)
def test_what_is_wrong_is_one_clear_line(text: str, expected: str) -> None:
    with pytest.raises(ProblemError) as told:
        linkage_from(document_of(ENGINE + text, "mine"), "mine")
    assert str(told.value).startswith(expected)
    assert len(str(told.value).splitlines()) == 1
