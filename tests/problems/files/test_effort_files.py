"""The effort as files state it, and tables of struts and springs; a clear line for each error."""

import math
import tomllib
from pathlib import Path

import pytest
from refusals import refusal

from grashof.problems import LinkageSpec, Region, load, load_linkage_spec
from grashof.problems.files.effort_schema import usual_sizes
from grashof.problems.files.linkage_schema import linkage_from
from grashof.problems.files.linkage_writing import linkage_toml
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.dynamics.struts import KINDS

HEAD = """
length_unit = "{unit}"
o4 = [4, 0]
r2 = 2
r3 = 2.5
r4 = 3
[dynamics]
payload = 5
"""
EFFORT = '[effort]\non = { link = "body", at = [1, 2] }\nband = [-10, 20]\ntravel_deg = [10, 60]\n'
PART = '[[effort.parts]]\nkind = "gas"\n'
BETWEEN = "between = [{ link = 1, at = { x = [0, 2], y = -1 } }, { link = 3, at = [1, 0] }]\n"
SIZE = "sizes = [{ extended = 273, stroke = 100, force_extended = 50, force_compressed = 64 }]\n"
TABLE = "stroke_cm,name,extended_mm,force_compressed_n,force_extended_n\n10,a,273,64,50\n12,b,313,130,100\n"


def linkage(text: str, folder: Path | None = None, unit: str = "mm") -> LinkageSpec:
    return linkage_from(tomllib.loads(HEAD.format(unit=unit) + text), "test", folder)


def test_a_table_is_read_by_its_columns_and_units(tmp_path: Path) -> None:
    (tmp_path / "s.csv").write_text(TABLE)
    spec = linkage(EFFORT + PART + BETWEEN + 'table = "s.csv"\n', tmp_path, "cm")
    assert spec.dynamics is not None
    assert spec.dynamics.effort is not None
    sizes = spec.dynamics.effort.parts[0].sizes
    assert [size.name for size in sizes] == ["a", "b"]
    assert [size.stroke for size in sizes] == [10, 12]
    assert sizes[0].extended == pytest.approx(27.3)
    assert (sizes[1].force_extended, sizes[1].force_compressed, sizes[1].friction) == (100, 130, 0)


@pytest.mark.parametrize("kind", KINDS)
def test_usual_sizes_are_sound_in_every_unit(kind: str) -> None:
    inches, metres = usual_sizes(kind, "in"), usual_sizes(kind, "m")
    assert len({size.name for size in inches}) == len(inches) >= 30
    for one, other in zip(inches, metres, strict=True):
        assert one.extended * 0.0254 == pytest.approx(other.extended, rel=1e-12)
    if kind == "gas":  # of any gas strut the rod is shorter than the rest
        assert all(1.2 < size.force_compressed / size.force_extended < 1.6 for size in metres)
        assert all(size.extended > 2 * size.stroke for size in metres)


def test_usual_compression_springs_are_those_of_their_wire() -> None:
    """By EN 13906-1 and the least tensile strength of wire SM in EN 10270-1, from the diameters in the names.

    The rate is that of the coil, the least length leaves the clearance between coils, and the stress when
    solid is the permissible one, but for a free length in half millimetres.
    """
    strength = {1: 1980, 1.2: 1920, 1.6: 1830, 2: 1760, 2.5: 1690, 3.2: 1610, 4: 1530, 5: 1460, 6: 1400}
    strength |= {8: 1310, 10: 1240}
    for size in usual_sizes("compression", "mm"):
        wire, mean, coils = map(float, size.name.split("-"))
        rate = 81500 * wire**4 / (8 * mean**3 * coils)
        assert size.force_extended == 0
        assert size.force_compressed == pytest.approx(rate * size.stroke, abs=0.06)
        solid = (coils + 2) * wire
        clearance = coils * (0.0015 * mean**2 / wire + 0.1 * wire)
        assert -1e-9 < size.compressed - solid - clearance < 0.1
        stresses = [
            8 * mean * rate * (free - solid) / (math.pi * wire**3)
            for free in (size.extended, size.extended + 0.5)
        ]
        assert stresses[0] <= 0.56 * strength[wire] < stresses[1]


@pytest.mark.parametrize(
    "parts",
    ["", PART + BETWEEN, PART + BETWEEN + SIZE + "count = 2\n", PART.replace("gas", "tension") + BETWEEN,
     '[[effort.parts]]\nkind = "torsion"\nbetween = [1, 4]\nfree_angle_deg = [-30, 20]\n'],
)  # fmt: skip
def test_files_are_read_back_as_they_are_written(parts: str) -> None:
    wanted = (
        EFFORT + 'direction = [0, 1]\nover = "driver"\nstays_deg = [20, 50]\ntemperatures_c = [-10, 40]\n'
    )
    spec = linkage(wanted + parts)
    text = linkage_toml(spec)
    assert linkage_from(tomllib.loads(text), "test").dynamics == spec.dynamics
    assert ("sizes" in text) == ("sizes" in parts)  # the usual ones are not written out
    motion = 'kind = "motion"\nlength_unit = "mm"\n[motion]\nposes = [[0, 0, 0], [3, 1, 40], [5, 4, 90]]\n'
    loads = "[dynamics]\npayload = 5\n" + wanted.replace("travel_deg = [10, 60]\n", "") + parts
    problem = problem_from(tomllib.loads(motion + loads), "test")
    assert problem_from(tomllib.loads(problem_toml(problem)), "test").dynamics == problem.dynamics


@pytest.mark.parametrize("at", ["on = [[0, 0], [1, 2]]", "inside = [[0, 0], [1, 0], [1, 1]]"])
def test_an_end_may_be_on_a_segment_or_in_a_polygon(at: str) -> None:
    spec = linkage(EFFORT + PART + BETWEEN.replace("x = [0, 2], y = -1", at))
    assert linkage_from(tomllib.loads(linkage_toml(spec)), "test").dynamics == spec.dynamics


def test_the_polygon_of_an_end_may_be_drawn(tmp_path: Path) -> None:
    drawing = '<svg xmlns="http://www.w3.org/2000/svg"><path id="plate" d="M0 0 L4 0 L4 -2 Z"/></svg>'
    (tmp_path / "lid.svg").write_text(drawing)
    drawn = BETWEEN.replace("x = [0, 2], y = -1", 'inside = "lid.svg#plate"')
    (tmp_path / "lid.toml").write_text(HEAD.format(unit="mm") + EFFORT + PART + drawn)
    spec = load_linkage_spec(str(tmp_path / "lid.toml"))
    assert spec.dynamics is not None
    assert spec.dynamics.effort is not None
    area = spec.dynamics.effort.parts[0].places[0].at
    assert isinstance(area, Region)
    assert set(area.inside or ()) == {(0.0, 0.0), (4.0, 0.0), (4.0, 2.0)}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (EFFORT.replace("band = [-10, 20]", ""),
         "effort wants nothing; it must have wanted, band, stays_deg or closes_below_deg"),
        (EFFORT + "wanted = [[0, 1], [9, 2]]\n", "effort.band is given besides wanted; give one of them"),
        (EFFORT.replace("band = [-10, 20]", "wanted = [[9, 1], [0, 2]]"),
         "effort.wanted is [[9.0, 1.0], [0.0, 2.0]]; "
         "it must be two rows [deg, N] or more, their angles rising from 0"),
        (EFFORT + "stays_deg = [80, 20]\n",
         "effort.stays_deg is [80, 20]: lo exceeds hi; it must be [lo, hi] with lo <= hi"),
        (EFFORT + "stays_deg = [20, 80]\ncloses_below_deg = 30\n",
         "effort.closes_below_deg is 30; it must be at most 20, from where it stays"),
        (EFFORT + "temperatures_c = [-300]\n",
         "effort.temperatures_c[0] is -300; it must be from -273.15 to 10000"),
        (EFFORT + 'direction = "up"\n', "effort.direction is 'up'; it must be \"square\" or [x, y]"),
        (EFFORT.replace('"body"', "1"),
         "effort.on is no point of a moving link, such as { link = 3, at = [u, v] }"),
        (EFFORT.replace('"body"', "7"), "effort.on.link is 7; it must be 2, 3 or 4"),
        (EFFORT + PART.replace("gas", "steam") + BETWEEN + SIZE,
         "effort.parts[0].kind is 'steam'; it must be one of gas, compression, tension, torsion"),
        (EFFORT + PART + BETWEEN.replace("link = 3", "link = 9"),
         "effort.parts[0].between[1].link is 9; it must be 1, 2, 3 or 4"),
        (EFFORT + PART + BETWEEN.replace("link = 3", "link = 1"),
         "effort.parts[0].between joins link 1 to itself; it must be places of two links"),
        (EFFORT + PART + BETWEEN.replace("[0, 2]", "[2, 0]"),
         "effort.parts[0].between[0].at.x is [2, 0]; it must be [lo, hi] with lo <= hi"),
        (EFFORT + PART + BETWEEN.replace(", y = -1", ""),
         "effort.parts[0].between[0].at has an open side; "
         "it must be { x = …, y = … }, each a number or [lo, hi]"),
        (EFFORT + PART.replace("gas", "torsion") + "between = [1, 4]\n",
         "effort.parts[0].free_angle_deg is missing; a torsion spring needs it"),
        (EFFORT + PART.replace("gas", "torsion") + BETWEEN,
         "effort.parts[0].between has places; of a torsion spring it must be two links, such as [1, 4]"),
        (EFFORT + PART + BETWEEN + SIZE.replace("stroke = 100", "stroke = 300"),
         "effort.parts[0].sizes[0].stroke is 300; it must be less than extended, 273"),
        (EFFORT + 3 * (PART + BETWEEN + SIZE), "effort.parts is [{"),
        (EFFORT + PART + BETWEEN + 'table = "s.csv"\n',
         "effort.parts[0].table is the file s.csv; here it must be sizes instead"),
    ],
)  # fmt: skip
def test_each_error_is_one_line(text: str, expected: str) -> None:
    line = refusal(linkage, text)
    assert "\n" not in line
    assert line.startswith(expected) if expected.endswith("{") else line == expected


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (TABLE.replace("stroke_cm", "stroke"), "column stroke has no unit; it must be such as stroke_mm"),
        (
            TABLE.replace("stroke_cm", "hub_cm"),
            "column 'hub_cm' is unknown; the columns are name, extended_mm",
        ),
        (
            TABLE.replace("stroke_cm", "extended_cm"),
            "column extended_mm is twice; the columns are name, extended_mm",
        ),
        (
            "name,extended_mm\na,1\n",
            "column stroke_mm is missing; the columns are name, extended_mm, stroke_mm",
        ),
        (TABLE.replace("313", "long"), "row 2: extended is 'long'; it must be a number"),
        (TABLE.replace("12,b", "b"), "row 2 has 4 cells; it must have 5"),
        (TABLE.splitlines()[0], "has 0 rows; it must have from 1 to 2000"),
    ],
)
def test_each_error_of_a_table_is_one_line(tmp_path: Path, table: str, expected: str) -> None:
    (tmp_path / "s.csv").write_text(table)
    line = refusal(linkage, EFFORT + PART + BETWEEN + 'table = "s.csv"\n', tmp_path)
    assert "\n" not in line
    assert line.startswith("effort.parts[0].table")
    assert expected in line


def test_the_travel_of_a_problem_is_that_of_its_task(tmp_path: Path) -> None:
    motion = 'kind = "motion"\nlength_unit = "mm"\n[motion]\nposes = [[0, 0, 0], [3, 1, 40], [5, 4, 90]]\n'
    (tmp_path / "p.toml").write_text(motion + "[dynamics]\npayload = 5\n" + EFFORT)
    assert "effort.travel_deg does not go with a problem" in refusal(load, str(tmp_path / "p.toml"))
