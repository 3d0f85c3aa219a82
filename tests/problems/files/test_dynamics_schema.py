"""Loads, springs, friction, motor and sections in files: their values and errors."""

from fnmatch import fnmatchcase
from pathlib import Path

import pytest
from refusals import refusal, rows

from grashof.problems import LinkageSpec, ProblemError, load, load_linkage_spec
from grashof.problems.files import spreadsheet
from grashof.problems.files.linkage_schema import linkage_from
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.dynamics import load_specs
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.dynamics.strength import SectionSpec

BARE = 'length_unit = "m"\no4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n'
PROBLEM = 'kind = "motion"\nlength_unit = "m"\n[motion]\nposes = [[0, 0, 0], [3, 4, 9]]\n'
COMPLETE = """
[dynamics]
density = 7850
speed_rpm = 20
gravity = [0, -9.81]

[[loads]]
link = 4
at = [4.5, 0]
force = [0, -1000]

[[loads]]
link = 3
moment = 12

[[loads]]
link = 3
over = "theta4"
frame = "link"
values = [[0, 1, 2], [180, 3, 4], [360, 1, 2]]

[[loads]]
link = 2
over = "time"
values = [[0, 5], [10, 6]]

[[springs]]
between = [{ link = 1, at = [0, 2] }, { link = 4, at = [1, 0] }]
stiffness = 500
free_length = 1.2

[[dampers]]
between = [{ link = 2 }, { link = 4, at = [1, 0] }]
damping = 5

[[torsion_springs]]
between = [4, 3]
stiffness = 7
free_angle_deg = 30

[[counterweights]]
link = 2
mass = 900
at = [-1.0, 0]

[friction]
coulomb = 0.1
pin_radius = [0.05, 0.05, 0.05, 0.1]
viscous = 2

[motor]
profile = "trapezoid"
ramp = 0.25
gear_ratio = 30
gear_efficiency = 0.9
inertia = 0.02

[section]
width = 0.2
height = 0.1
"""
EXPECTED = DynamicsSpec(
    density=7850,
    speed_rpm=20,
    gravity=(0, -9.81),
    loads=(
        load_specs.LoadSpec(4, (4.5, 0), force=(0, -1000)),
        load_specs.LoadSpec(3, moment=12),
        load_specs.LoadSpec(3, values=((0, 1, 2), (180, 3, 4), (360, 1, 2)), over="theta4", frame="link"),
        load_specs.LoadSpec(2, values=((0, 5), (10, 6)), over="time"),
    ),
    springs=(load_specs.SpringSpec((load_specs.Place(1, (0, 2)), load_specs.Place(4, (1, 0))), 500, 1.2),),
    dampers=(load_specs.DamperSpec((load_specs.Place(2), load_specs.Place(4, (1, 0))), 5),),
    torsion_springs=(
        load_specs.TorsionSpringSpec((3, 4), 7, -30),
    ),  # of 4 less 3, where the file has 3 less 4
    counterweights=(load_specs.CounterweightSpec(2, 900, (-1, 0)),),
    friction=load_specs.FrictionSpec(0.1, (0.05, 0.05, 0.05, 0.1), viscous=2),
    motor=MotorSpec("trapezoid", 0.25, gear_ratio=30, gear_efficiency=0.9, inertia=0.02),
    section=SectionSpec(0.2, 0.1),
)


def linkage(text: str, folder: Path | None = None, head: str = BARE) -> LinkageSpec:
    return linkage_from(document_of(head + text, "mine.toml"), "mine", folder)


@pytest.mark.parametrize("head", ["theta2_deg,fx,fy", "over, fx, fy", "theta2,fx_N,fy_N"])
def test_a_table_is_read_beside_its_file(tmp_path: Path, head: str) -> None:
    (tmp_path / "rods").mkdir()
    (tmp_path / "rods" / "load.csv").write_text(f"{head}\n0,0,-9\n\n90, 0,-20\n360,0,-9\n", encoding="utf-8")
    text = '[[loads]]\nlink = 4\nat = [2, 0]\ntable = "rods/load.csv"\n'
    expected = load_specs.LoadSpec(4, (2, 0), values=((0, 0, -9), (90, 0, -20), (360, 0, -9)))
    for name, content, load_it in (("l", BARE, load_linkage_spec), ("p", PROBLEM, load)):
        path = tmp_path / f"{name}.toml"
        path.write_text(content + text, encoding="utf-8")
        dynamics = load_it(path).dynamics  # type: ignore[operator]
        assert dynamics is not None
        assert dynamics.loads == (expected,)
        assert "load.csv" not in str(dynamics.tables)  # written again, it needs no other file


def test_a_measured_profile_is_read(tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_text("time,angle\n0,0\n1,20\n2,90\n", encoding="utf-8")
    spec = linkage('[motor]\nprofile = "m.csv"\n', tmp_path)
    assert spec.dynamics is not None
    assert spec.dynamics.motor == MotorSpec(values=((0, 0), (1, 20), (2, 90)))
    assert spec.dynamics.turn_time == 2
    said = "motor.profile is given besides values; give one of them"
    assert refusal(linkage, '[motor]\nprofile = "m.csv"\nvalues = [[0, 0], [1, 9]]', tmp_path) == said


ENGINE = 'length_unit = "mm"\nmechanism = "slider-crank"\nr2 = 40\nr3 = 120\n'
OF_ENGINE = """
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


EXPECTED_OF_ENGINE = DynamicsSpec(
    masses=(0.5, 0.8, 0.6),
    inertias=(200, 900, 0),
    centres=((0, 0), (40, 0), (0, 0)),
    speed_rpm=3000,
    loads=(load_specs.LoadSpec(4, values=((80, -4000, 0), (120, -900, 0), (160, -100, 0)), over="travel"),),
    friction=load_specs.FrictionSpec(slide_mu=0.08, slide_length=60, slide_viscous=2, slide_force=5),
)


@pytest.mark.parametrize(
    ("head", "text", "expected"),
    [(BARE, COMPLETE, EXPECTED), (ENGINE, OF_ENGINE, EXPECTED_OF_ENGINE)],
    ids=["four-bar", "engine"],
)
def test_linkage_and_problem_files_state_the_same_and_come_back(
    head: str, text: str, expected: DynamicsSpec
) -> None:
    assert linkage(text, head=head).dynamics == expected
    kind = 'mechanism = "slider-crank"\n' if head is ENGINE else ""
    problem = problem_of(kind + PROBLEM + text, "mine.toml", "mine")
    again = problem_of(problem_toml(problem), "again.toml", "mine")
    assert problem.dynamics == again.dynamics == expected
    assert problem_toml(again) == problem_toml(problem)


LOAD = "[[loads]]\nlink = 4\n"
BAD = r"""
<LOAD> | loads[0].force is given by nothing; it must be by one of force, moment, values, table
<LOAD>force = [0, 1]\nmoment = 2 |
    loads[0].force is given by force and moment; it must be by one of force, moment, values, table
[[loads]]\nlink = 5\nmoment = 1 | loads[0].link is 5; it must be 2, 3 or 4
<LOAD>force = [0, 1, 2] | loads[0].force has 3 entries; it must have 2 numbers
<LOAD>moment = nan | loads[0].moment is nan; it must be a finite number
<LOAD>moment = 1\nover = "time" | loads[0].over does not go with a constant load
<LOAD>moment = 1\nat = [1, 0] | loads[0].at does not go with a moment
<LOAD>force = [1, 2]\nframe = "links" | loads[0].frame is 'links'; it must be one of global, link
<LOAD>values = [[0, 1], [1, 2]]\nover = "theta3" |
    loads[0].over is 'theta3'; it must be theta2, theta4, travel or time
<LOAD>values = [[0, 1], [350, 1]] |
    loads[0].values cover theta2 0 to 350 deg; they must cover a turn, as 0 to 360
<LOAD>values = [[0, 1], [360, 2]] | loads[0].values end otherwise than they begin; a turn ends as it begins
<LOAD>values = [[0, 1], [200, 2], [100, 2], [360, 1]] |
    loads[0].values[2] has theta2 100; it must rise from row to row
<LOAD>values = [[0, 1]] | loads[0].values has 1 rows; it must have two or more
<LOAD>values = [[0]] | loads[0].values[0] is [0.0]; it must be [theta2, fx, fy] or [theta2, moment]
<LOAD>table = "none.csv" | loads[0].table is the file none.csv; here it must be values instead
[[springs]]\nbetween = [{ link = 2 }, { link = 2, at = [1, 0] }]\nstiffness = 1 |
    springs[0].between joins link 2 to itself; it must be places of two different links
[[springs]]\nbetween = [{ link = 2 }]\nstiffness = 1 | springs[0].between is
[[springs]]\nbetween = [{ link = 2 }, { link = 3 }] | springs[0].stiffness is missing
[[springs]]\nbetween = [{ link = 2 }, { at = [0, 1] }]\nstiffness = 1 | springs[0].between[1].link is missing
[[springs]]\nbetween = [{ link = 2 }, { link = 3 }]\nstiffness = -1 |
    springs[0].stiffness is -1; it must be a number from zero
[[torsion_springs]]\nbetween = [2, 2]\nstiffness = 1 |
    torsion_springs[0].between joins link 2 to itself; it must be two links of a joint
[[torsion_springs]]\nbetween = [2, 4]\nstiffness = 1 |
    torsion_springs[0].between is [2, 4]; it must be two links of a joint: [1, 2], [2, 3], [3, 4] or [1, 4]
[[counterweights]]\nlink = 2\nat = [1, 0]\nmass = -1 |
    counterweights[0].mass is -1; it must be a number from zero
[friction]\ncoulomb = 0.1 | friction.pin_radius is missing; coulomb and pin_radius are needed together
[friction]\nviscous = [1, 2] | friction.viscous is [1, 2]; it must be a number, or four: in O2, A, B, O4
[motor]\nprofile = "sine" | motor.profile is 'sine'; it must be constant, trapezoid, cycloid, or the name
[motor]\nramp = 0.2 | motor.ramp does not go with this profile; it needs profile = "trapezoid"
[motor]\ngear_efficiency = 1.2 | motor.gear_efficiency is 1.2; it must be from 0.01 to 1
[dynamics]\ndensity = 7850 | section is missing; dynamics.density needs it
[dynamics]\ncentres = [[0, 0], [1, 0], [0, 0]] | dynamics.masses is missing; centres are those of given masses
[dynamics]\nmass_per_length = 2\ndensity = 7850 |
    dynamics.mass_per_length does not go with density; give one or the other
"""


@pytest.mark.parametrize(("text", "expected"), rows(BAD, LOAD=LOAD))
def test_errors_are_one_clear_line(text: str, expected: str) -> None:
    for said in (refusal(linkage, text), refusal(problem_of, PROBLEM + text, "mine.toml", "mine")):
        line = said.removeprefix("mine.toml: ")
        assert line.startswith(expected)
        assert "\n" not in line


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("loads = 3", "loads is 3; it must be a list of tables"),
        ("springs = { between = 2 }", "springs is a table; it must be a list of tables"),
        ("[[loads]]\nlink = 3\nmoment = 1\n" * 101, "loads is *; it must be a list of at most 100 entries"),
    ],
    ids=["a number", "a table", "too many"],
)
def test_they_are_lists_of_a_hundred_tables_at_most(text: str, expected: str) -> None:
    said = refusal(linkage, text)
    assert fnmatchcase(said, expected)
    assert len(said) < 400


TABLES = [
    ("", "is empty; its first line must be theta2_deg,fx_n,fy_n or theta2_deg,moment_nm"),
    ("theta4_deg,fx,fy\n0,1,2\n", "has the columns 'theta4_deg,fx,fy'; its first line must be theta2_deg"),
    ("over,fx,fy\n0,1\n", "row 1 has 2 cells; it must have 3"),
    ("over,fx,fy\n0,1,2\n360,x,2\n", "row 2 is '360,x,2'; it must be numbers"),
    ("over,fx,fy\n0,1,inf\n360,1,2\n", "row 1 is inf; it must be a finite number"),
]


@pytest.mark.parametrize(("content", "expected"), TABLES)
def test_errors_of_a_csv_file_name_it(tmp_path: Path, content: str, expected: str) -> None:
    (tmp_path / "rod.csv").write_text(content, encoding="utf-8")
    said = refusal(linkage, LOAD + 'table = "rod.csv"', tmp_path)
    assert said.startswith(f"loads[0].table: {tmp_path / 'rod.csv'}: {expected}")


def test_the_rows_of_a_table_are_limited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert spreadsheet._MOST_ROWS == 10_000
    monkeypatch.setattr(spreadsheet, "_MOST_ROWS", 3)
    table = "theta2_deg,fx_n,fy_n\n0,0,-9\n90,0,-9\n360,0,-9\n"
    (tmp_path / "rod.csv").write_text(table, encoding="utf-8")
    assert linkage(LOAD + 'table = "rod.csv"', tmp_path).dynamics is not None
    (tmp_path / "rod.csv").write_text(table + "370,0,-9\n", encoding="utf-8")
    with pytest.raises(ProblemError, match="has 4 rows; it must have at most 3"):
        linkage(LOAD + 'table = "rod.csv"', tmp_path)


def test_a_load_over_time_must_last_for_a_turn() -> None:
    load_text = '[[loads]]\nlink = 2\nover = "time"\nvalues = [[0, 1], [5, 2]]\n'
    text = "[dynamics]\nspeed_rpm = 10\nmass_per_length = 1\n" + load_text
    with pytest.raises(
        ProblemError, match=r"loads\[0\] covers 0 to 5 s; it must cover 0 to 6 s, a turn of the driver"
    ):
        problem_of(PROBLEM + text, "mine.toml", "mine")
