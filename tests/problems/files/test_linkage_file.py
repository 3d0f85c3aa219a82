"""Linkage files of every kind: how they are named, what they state, and their errors, a line each."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from linkages_of_rows import linkage_of_row, row_name
from refusals import refusal, rows

from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    LinkageSpec,
    SixBar,
    SliderCrank,
    load_linkage,
    load_linkage_spec,
)
from grashof.problems.files.linkage_schema import as_document, linkage_from
from grashof.problems.files.problem_writing import toml_value as toml
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism

PLAIN = "o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n"
RODS = "r2 = 1\nr3 = 4\n"
SHAPER = "o4 = [2, 0]\nr2 = 1\n"
DYAD = "[dyad]\nc = [5, 1]\nd = [6, 2]\nr5 = 3\nr6 = 2\n"
SLIDE = '[dyad]\nkind = "RRP"\nc = [5, 1]\nr5 = 3\n'
SIX_BARS = [row for row in MECHANISMS if len(row.dyads) > 1]


def read(word: str, text: str) -> LinkageSpec:
    """A file of a kind of linkage, in metres."""
    head = f'mechanism = "{word}"\nlength_unit = "m"\n' if word else ""
    return linkage_from(tomllib.loads(head + text), "mine")


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_plain_file_and_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path, "\ufeff" + PLAIN)
    monkeypatch.chdir(tmp_path)
    for given in (path, str(path), "mine.toml"):
        spec = load_linkage_spec(given)
        assert spec.linkage == FourBar((0, 0), (4, 0), 1, 4, 3)
        assert (spec.name, spec.dynamics, spec.output_arm) == ("mine", None, None)


def test_a_file_name_that_is_not_text(tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"caf\xe9.toml")
    try:
        path.write_text(PLAIN)
    except OSError:
        pytest.skip("this file system takes UTF-8 names only")
    assert load_linkage_spec(path).name == "caf?"


UNKNOWN = r"""
pumpjak | 'pumpjak' is neither a linkage of the catalogue nor a file; did you mean pumpjack?
luggage | luggage: is a problem; solve it, then name a design: luggage-designs/candidates.json#1
chair | 'chair' is neither a linkage of the catalogue nor a file; the catalogue has crank-shaper,
    dwell-six-bar, engine, klann, lufkin-c912d, luggage-report, pumpjack
d/candidates.csv#3 | d/candidates.csv#3: is a table; name the design as d/candidates.json#3
d/nearest.csv#1 |
    d/nearest.csv#1: is a table of misses; a linkage file with their dimensions can be read
candidates.csv | candidates.csv: is a table; name the design as candidates.json#1
# | '' is neither a linkage of the catalogue nor a file;
no/such.toml | no/such.toml: there is no such file
./ | .: is a folder
candidates.json | candidates.json: is a list of designs; name one of them, such as candidates.json#1
"""


@pytest.mark.parametrize(
    ("name", "said"), [*rows(UNKNOWN), ("a\0/b.toml", r"'a\x00/b.toml': cannot be read")]
)
def test_unknown_names_are_refused(name: str, said: str) -> None:
    assert refusal(load_linkage, name).startswith(said)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("r2 = ", "is not TOML"),
        ("kind = 'motion'", "is a problem; solve it, then name a design: mine-designs/candidates.json#1"),
        (PLAIN + "r1 = -1\noutput_arm = 0", "r1 is -1; it must be a number greater than zero"),
    ],
)
def test_every_line_about_a_file_begins_with_its_name(tmp_path: Path, text: str, said: str) -> None:
    path = written(tmp_path, text)
    lines = refusal(load_linkage, path).splitlines()
    assert lines[0].startswith(f"{path}: {said}")
    assert all(line.startswith(f"{path}: ") for line in lines)


FIRST: Any = ((0, 0), (4, 0), 1, 4, 3)
DEFAULTS = [
    ("four-bar", PLAIN, FourBar(*FIRST)),
    ("slider-crank", RODS, SliderCrank((0, 0), 1, 4)),
    ("inverted-slider-crank", SHAPER, InvertedSliderCrank((0, 0), (2, 0), 1)),
    ("stephenson-3", PLAIN + DYAD, SixBar(*FIRST, c=(5, 1), d=(6, 2), r5=3, r6=2, hosts=(3, 1))),
    ("stephenson-3", PLAIN + SLIDE, SixBar(*FIRST, c=(5, 1), r5=3, slide_angle_2=0, hosts=(3, 1))),
]  # fmt: skip


@pytest.mark.parametrize(("word", "text", "linkage"), DEFAULTS)
def test_absent_keys_have_their_defaults(word: str, text: str, linkage: Linkage) -> None:
    assert read(word, text).linkage == linkage


def test_the_ground_by_length_and_angle() -> None:
    ground = "o2 = [1, 2]\nr1 = 4\nground_angle_deg = 90\n"
    for word, text in (
        ("four-bar", PLAIN),
        ("inverted-slider-crank", SHAPER),
        ("stephenson-3", PLAIN + DYAD),
    ):
        rest = text.partition("\n")[2]
        np.testing.assert_allclose(read(word, ground + rest).linkage.o4, [1, 6], rtol=1e-15)
        assert read(word, "o2 = [1, 2]\nr1 = 4\n" + rest).linkage.o4.tolist() == [5, 2]


@pytest.mark.parametrize(
    ("row", "point_link"), [(row, 2 + index % 5) for index, row in enumerate(MECHANISMS)], ids=row_name
)
def test_a_file_gives_the_linkage_that_it_states(row: Mechanism, point_link: int) -> None:
    wanted = linkage_of_row(row, point_link)
    found = read("", text_of(wanted)).linkage
    carries = point_link if len(row.dyads) > 1 else row.carries
    assert found.mechanism == wanted.mechanism == Mechanism(row.word, row.dyads, carries)
    for each, one, other in zip(row.parameters, wanted.parameters, found.parameters, strict=True):
        np.testing.assert_allclose(one, other, rtol=4e-16 if each.kind == "angle" else 0)


def text_of(linkage: Linkage) -> str:
    """A linkage as its file."""
    document = as_document(linkage.stated)
    dyad = document.pop("dyad", {})
    for table, key, name in ((document, each.key, each.name) for each in linkage.mechanism.parameters):
        if key != name and name in table:
            table[key] = float(np.degrees(table.pop(name)))
    if "slide_angle_deg" in dyad:
        dyad["slide_angle_deg"] = float(np.degrees(dyad["slide_angle_deg"]))
    keys, inner = ([f"{key} = {toml(value)}" for key, value in table.items()] for table in (document, dyad))
    head = f'mechanism = "{linkage.mechanism.word}"'
    return "\n".join([head, *keys, *(["[dyad]", *inner] if inner else [])])


@pytest.mark.parametrize("row", SIX_BARS, ids=row_name)
def test_hosts_are_needed_where_there_are_several(row: Mechanism) -> None:
    text = PLAIN + (SLIDE if row.dyads[1].slides else DYAD)
    alike = [each for each in SIX_BARS if (each.word, each.dyads[1].kind) == (row.word, row.dyads[1].kind)]
    if alike == [row]:
        assert read(row.word, text).linkage.mechanism == row
    else:
        pairs = {"watt-1": "[2, 3] or [3, 4]", "watt-2": "[2, 1] or [4, 1]"}[row.word]
        said = f"dyad.hosts is missing; it must be {pairs} with mechanism {row.word}"
        assert refusal(read, row.word, text) == said


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ("speed_rpm = -3", DynamicsSpec(speed_rpm=-3)),
        ("gravity = [0, -1]", DynamicsSpec(gravity=(0, -1))),
        ("payload = 2", DynamicsSpec(payload=2)),
    ],
)
def test_speed_and_gravity_need_no_masses(table: str, expected: DynamicsSpec) -> None:
    assert read("four-bar", f"{PLAIN}[dynamics]\n{table}").dynamics == expected


TEXTS = {
    "PLAIN": PLAIN,
    "LINKS": PLAIN.removeprefix("o4 = [4, 0]\n"),
    "RODS": RODS,
    "SHAPER": SHAPER,
    "DYAD": DYAD,
    "PINS": PLAIN + DYAD,
    "BLOCK": PLAIN + SLIDE,
    "BOTH": "four-bar and inverted-slider-crank have it",
    "SLIDES": "slider-crank and inverted-slider-crank have it",
    "KINDS": "four-bar, slider-crank, inverted-slider-crank, stephenson-3, stephenson-1, watt-1 or watt-2",
    "SIX_BARS": "stephenson-3, stephenson-1, watt-1 and watt-2 have it",
    "ZEROS": "0" * 5000,
}
BAD = r"""
four-bar | <PLAIN>coupler = [1, 1] | coupler is unknown; did you mean coupler_point?
four-bar | <PLAIN>speed_rpm = 3 | speed_rpm is unknown; did you mean dynamics.speed_rpm?
four-bar | <PLAIN>[dynamics]\nspeed = 3 | dynamics.speed is unknown; did you mean speed_rpm?
# | <PLAIN>[dynamics]\npayload = 3 | length_unit is ''; it must be one of mm, cm, m, in, ft with dynamics
four-bar | <PLAIN>dynamics = 3 | dynamics is 3; it must be a table
four-bar | <PLAIN>r1 = 4 | r1 is given besides o4; give one of them
four-bar | <PLAIN>assembly = 2 | assembly is 2; it must be +1 or -1
four-bar | <PLAIN>output_arm = 0 | output_arm is 0; it must be a number greater than zero
four-bar | <PLAIN>body_angle_deg = nan | body_angle_deg is nan; it must be a finite number
four-bar | <PLAIN>body_angle_deg = 36001 | body_angle_deg is 36001; it must be from -36000 to 36000
four-bar | <PLAIN>offset = 1 | offset does not go with mechanism four-bar; only <SLIDES>
four-bar | <LINKS> | o4 is missing; give it, or r1 with ground_angle_deg
four-bar | r1 = 0\n<LINKS> | r1 is 0; it must be a number greater than zero
four-bar | o4 = [0, 0]\n<LINKS> | o4 is where o2 is; the ground pivots must be distinct
four-bar | o4 = [4, 0, 0]\n<LINKS> | o4 is [4, 0, 0]; it must be [x, y]
four-bar | o4 = [1e300, 0]\n<LINKS> | o4 is 1e+300; it must be from -1e+20 to 1e+20
four-bar | o2 = [1, 2, 3]\no4 = [1e30, 0]\nr2 = -1\nr3 = 0\nr4 = 'x'\ncoupler = 2\noutput_arm = -1\n |
    o2 is [1, 2, 3]; it must be [x, y]\no4 is 1e+30; it must be from -1e+20 to 1e+20\n
    r2 is -1.0; it must be greater than zero\nr3 is 0.0; it must be greater than zero\n
    r4 is 'x'; it must be a number\noutput_arm is -1; it must be a number greater than zero\n
    coupler is unknown; did you mean coupler_point?
slider-crank | <RODS>r4 = 3 | r4 does not go with mechanism slider-crank; only four-bar has it
slider-crank | <RODS>o4 = [1, 1] | o4 does not go with mechanism slider-crank; only <BOTH>
slider-crank | <RODS>offset = 1e21 | offset is 1e+21; it must be from -1e+20 to 1e+20
slider-crank | <RODS>slide_angle_deg = inf | slide_angle_deg is inf; it must be a finite number
slider-crank | <RODS>output_arm = 3 | output_arm does not go with mechanism slider-crank; only <BOTH>
slider-crank | r2 = 1\n | r3 is missing
slider-crank | r2 = -1\nr3 = 4\nr1 = 2\nassembly = 0 |
    r1 does not go with mechanism slider-crank; only <BOTH>\n
    r2 is -1.0; it must be greater than zero\nassembly is 0; it must be +1 or -1
inverted-slider-crank | <SHAPER>slide_angle_deg = 3 |
    slide_angle_deg does not go with mechanism inverted-slider-crank; only slider-crank has it
inverted-slider-crank | r2 = 1\n | o4 is missing; give it, or r1 with ground_angle_deg
inverted-slider-crank | o4 = [0, 0]\nr2 = 1\n | o4 is where o2 is; the ground pivots must be distinct
# | mechanism = 3\n<RODS> | mechanism is 3; it must be <KINDS>
stephenson-3 | <PINS>kind = "RPR" | dyad.kind is 'RPR'; it must be RRR or RRP
watt-1 | <PINS>hosts = [3, 1] |
    dyad.hosts is [3, 1], which makes a stephenson-3; it must be [2, 3] or [3, 4] with mechanism watt-1
stephenson-3 | <PINS>hosts = [1, 3] | dyad.hosts is [1, 3]; it must be [3, 1] with mechanism stephenson-3
watt-2 | <PINS>hosts = 4 | dyad.hosts is 4; it must be two numbers of links
watt-2 | <PINS>hosts = [4, true] | dyad.hosts[1] is true; it must be a whole number
stephenson-3 | <PINS>offset = 1 | dyad.offset does not go with kind RRR; only RRP has it
stephenson-3 | <PINS>slide_angle_deg = 1 | dyad.slide_angle_deg does not go with kind RRR; only RRP has it
stephenson-3 | <PINS>r4 = 3 | dyad.r4 is unknown; did you mean r4?
stephenson-3 | <BLOCK>hosts = [3, 4] |
    dyad.hosts is [3, 4]; a slide lies on the ground, so it must be [3, 1] with mechanism stephenson-3
stephenson-3 | <BLOCK>r6 = 1 | dyad.r6 does not go with kind RRP; only RRR has it
stephenson-3 | <BLOCK>slide_angle_deg = 36001 | dyad.slide_angle_deg is 36001; it must be from -36000 to 36000
stephenson-3 | <PLAIN> | dyad is missing
four-bar | <PINS> | dyad does not go with mechanism four-bar; only <SIX_BARS>
watt-1 | <BLOCK> | dyad.kind is 'RRP'; a slide lies on the ground, so it must be RRR with mechanism watt-1
stephenson-1 | <BLOCK>hosts = [2, 4] |
    dyad.kind is 'RRP'; a slide lies on the ground, so it must be RRR with mechanism stephenson-1
stephenson-3 | <PINS>hosts = [3, 0x1<ZEROS>] |
    dyad.hosts is [3, a whole number of about 6021 digits]; it must be [3, 1] with mechanism stephenson-3
stephenson-3 | <PLAIN>[dyad]\nc = [5, 1]\nd = [6, 2]\nr5 = 3\n | dyad.r6 is missing
stephenson-3 | <PLAIN>[dyad]\nc = [5, 1]\nr5 = 3\nr6 = 2\n | dyad.d is missing
stephenson-3 | <PLAIN>[dyad]\nc = [5, 1]\nd = 6\nr5 = 3\nr6 = 2\n | dyad.d is 6; it must be [u, v]
stephenson-3 | <PLAIN>[dyad]\nc = [5, 1]\nd = [6, nan]\nr5 = 3\nr6 = 2\n |
    dyad.d is [6.0, nan]; all numbers must be finite
stephenson-3 | <PLAIN>[dyad]\nc = [5, 1]\nd = [6, 2]\nr5 = 0\nr6 = 2\n |
    dyad.r5 is 0.0; it must be greater than zero
stephenson-3 | <PLAIN>r5 = 3\n<DYAD> | r5 is unknown; did you mean dyad.r5?
stephenson-3 | <PLAIN>output_arm = 3\n<DYAD> |
    output_arm does not go with mechanism stephenson-3; only four-bar and inverted-slider-crank have it
stephenson-3 | <PINS>[pumping_unit]\nrod_load = 2 |
    pumping_unit does not go with mechanism stephenson-3; only four-bar has it
stephenson-3 | <PLAIN>point_link = 1\n<DYAD> |
    point_link is 1; it must be the number of a moving link, 2 to 6
stephenson-3 | o4 = [0, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n<DYAD> |
    o4 is where o2 is; the ground pivots must be distinct
stephenson-3 | <PINS>[dynamics]\nmasses = [1, 2, 3]\ninertias = [1, 2, 3, 4, 5] |
    dynamics.masses has 3 entries; it must have 5 numbers
stephenson-3 | <PINS>[[loads]]\nlink = 7\nmoment = 1 | loads[0].link is 7; it must be 2, 3, 4, 5 or 6
stephenson-3 | <PINS>[[dampers]]\nbetween = [{ link = 2 }, { link = 9 }]\ndamping = 1 |
    dampers[0].between[1].link is 9; it must be 1, 2, 3, 4, 5 or 6
stephenson-3 | <PINS>[friction]\nviscous = [1, 2] |
    friction.viscous is [1, 2]; it must be a number, or seven: in O2, A, B, O4, C, E, D
stephenson-3 | output_arm = 1\no4 = [4, 0]\nr2 = -1\nr3 = 4\nr4 = 3\n
    [dyad]\nc = [5, 1]\nd = [6, 2]\nr5 = -3\nr6 = 2\nassembly = 0 |
    output_arm does not go with mechanism stephenson-3; only four-bar and inverted-slider-crank have it\n
    r2 is -1.0; it must be greater than zero\n
    dyad.r5 is -3.0; it must be greater than zero\n
    dyad.assembly is 0; it must be +1 or -1
stephenson-3 | <PLAIN>[dyad]\nkind = "RRP"\nc = [5, 1]\nr5 = 3\nr6 = 2\nd = [1, 2] |
    dyad.d does not go with kind RRP; only RRR has it\n
    dyad.r6 does not go with kind RRP; only RRR has it
"""


@pytest.mark.parametrize(("word", "text", "lines"), rows(BAD, **TEXTS))
def test_bad_files_are_refused(word: str, text: str, lines: str) -> None:
    assert refusal(read, word, text) == lines


ACTING = """
[dynamics]
masses = [1, 2, 3, 4, 5]
inertias = [1, 2, 3, 4, 5]
centres = [[0, 0], [1, 0], [1, 0], [1, 0], [1, 0]]
[[loads]]
link = 6
at = [1, 0]
force = [0, -9]
[[loads]]
link = 5
over = "theta6"
table = "load.csv"
[[springs]]
between = [{ link = 1, at = [0, 2] }, { link = 5 }]
stiffness = 500
[[torsion_springs]]
between = [5, 3]
stiffness = 7
free_angle_deg = 30
[friction]
viscous = [1, 2, 3, 4, 5, 6, 7]
"""


def test_loads_on_every_link_are_read(tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_text("theta6_deg,moment_nm\n0,1\n90,2\n360,1\n", encoding="utf-8")
    head = 'mechanism = "stephenson-3"\nlength_unit = "m"\n'
    found = load_linkage_spec(written(tmp_path, head + PLAIN + DYAD + ACTING)).dynamics
    assert found is not None
    assert found.masses == (1, 2, 3, 4, 5)
    assert found.centres == ((0, 0), *[(1, 0)] * 4)
    assert found.loads[1].values == ((0, 1), (90, 2), (360, 1))
    assert found.springs[0].between[1].link == 5
    assert (found.torsion_springs[0].between, found.torsion_springs[0].free_angle_deg) == ((3, 5), -30)
    assert found.friction is not None
    assert found.friction.viscous == (1, 2, 3, 4, 5, 6, 7)
