"""Linkage files and lists of six-bars come back; errors are one clear line."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from refusals import refusal, rows

from grashof.problems import Linkage, LinkageSpec, SixBar, load_linkage, load_linkage_spec
from grashof.problems.files.linkage_schema import linkage_from
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism

ROWS = [row for row in MECHANISMS if len(row.dyads) > 1]
FOUR_BAR = "o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n"
DYAD = "[dyad]\nc = [5, 1]\nd = [6, 2]\nr5 = 3\nr6 = 2\n"
SLIDE = '[dyad]\nkind = "RRP"\nc = [5, 1]\nr5 = 3\n'
PLAIN = SixBar((0, 0), (4, 0), 1, 4, 3, c=(5, 1), d=(6, 2), r5=3, r6=2, hosts=(3, 1))


def named(row: Mechanism) -> str:
    return f"{row.word}-{row.dyads[1].kind}-{row.dyads[1].hosts}"


def read(text: str, word: str = "stephenson-3") -> LinkageSpec:
    head = "" if "mechanism =" in text else f'mechanism = "{word}"\nlength_unit = "m"\n'
    return linkage_from(tomllib.loads(head + text), "mine")


def refused(text: str, word: str = "stephenson-3") -> list[str]:
    return refusal(read, text, word).splitlines()


def test_absent_keys_have_their_defaults() -> None:
    assert read(FOUR_BAR + DYAD).linkage == PLAIN
    slider = SixBar((0, 0), (4, 0), 1, 4, 3, c=(5, 1), r5=3, slide_angle_2=0, hosts=(3, 1))
    assert read(FOUR_BAR + SLIDE).linkage == slider
    assert read(FOUR_BAR.replace("o4 = [4, 0]", "r1 = 4") + DYAD).linkage == PLAIN


@pytest.mark.parametrize("row", ROWS, ids=named)
def test_hosts_are_needed_where_there_are_several(row: Mechanism) -> None:
    text = SLIDE if row.dyads[1].slides else DYAD
    alone = [each for each in ROWS if (each.word, each.dyads[1].kind) == (row.word, row.dyads[1].kind)] == [
        row
    ]
    if alone:
        assert read(FOUR_BAR + text, row.word).linkage.mechanism == row
    else:
        pairs = {"watt-1": "[2, 3] or [3, 4]", "watt-2": "[2, 1] or [4, 1]"}[row.word]
        line = f"dyad.hosts is missing; it must be {pairs} with mechanism {row.word}"
        assert refused(FOUR_BAR + text, row.word) == [line]


TEXTS = {
    "FOUR_BAR": FOUR_BAR,
    "DYAD": DYAD,
    "SLIDE": SLIDE,
    "PINS": FOUR_BAR + DYAD,
    "BLOCK": FOUR_BAR + SLIDE,
    "ONLY": "only stephenson-3 and stephenson-1 and watt-1 and watt-2 have it",
    "ZEROS": "0" * 5000,
}
BAD = r"""
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
stephenson-3 | <FOUR_BAR> | dyad is missing
four-bar | <PINS> | dyad does not go with mechanism four-bar; <ONLY>
watt-1 | <BLOCK> | dyad.kind is 'RRP'; a slide lies on the ground, so it must be RRR with mechanism watt-1
stephenson-1 | <BLOCK>hosts = [2, 4] |
    dyad.kind is 'RRP'; a slide lies on the ground, so it must be RRR with mechanism stephenson-1
stephenson-3 | <PINS>hosts = [3, 0x1<ZEROS>] |
    dyad.hosts is [3, a whole number of about 6021 digits]; it must be [3, 1] with mechanism stephenson-3
stephenson-3 | <FOUR_BAR>[dyad]\nc = [5, 1]\nd = [6, 2]\nr5 = 3\n | dyad.r6 is missing
stephenson-3 | <FOUR_BAR>[dyad]\nc = [5, 1]\nr5 = 3\nr6 = 2\n | dyad.d is missing
stephenson-3 | <FOUR_BAR>[dyad]\nc = [5, 1]\nd = 6\nr5 = 3\nr6 = 2\n | dyad.d is 6; it must be [u, v]
stephenson-3 | <FOUR_BAR>[dyad]\nc = [5, 1]\nd = [6, nan]\nr5 = 3\nr6 = 2\n |
    dyad.d is [6.0, nan]; all numbers must be finite
stephenson-3 | <FOUR_BAR>[dyad]\nc = [5, 1]\nd = [6, 2]\nr5 = 0\nr6 = 2\n |
    dyad.r5 is 0.0; it must be greater than zero
stephenson-3 | <FOUR_BAR>r5 = 3\n<DYAD> | r5 is unknown; did you mean dyad.r5?
stephenson-3 | <FOUR_BAR>output_arm = 3\n<DYAD> |
    output_arm does not go with mechanism stephenson-3; only four-bar and inverted-slider-crank have it
stephenson-3 | <PINS>[pumping_unit]\nrod_load = 2 |
    pumping_unit does not go with mechanism stephenson-3; only four-bar has it
stephenson-3 | <FOUR_BAR>point_link = 1\n<DYAD> |
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
stephenson-3 | <FOUR_BAR>[dyad]\nkind = "RRP"\nc = [5, 1]\nr5 = 3\nr6 = 2\nd = [1, 2] |
    dyad.d does not go with kind RRP; only RRR has it\n
    dyad.r6 does not go with kind RRP; only RRR has it
"""


@pytest.mark.parametrize(("word", "text", "lines"), rows(BAD, **TEXTS))
def test_bad_files_are_refused(word: str, text: str, lines: str) -> None:
    assert refused(text, word) == lines.splitlines()


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
    (tmp_path / "mine.toml").write_text(head + FOUR_BAR + DYAD + ACTING, encoding="utf-8")
    found = load_linkage_spec(tmp_path / "mine.toml").dynamics
    assert found is not None
    assert found.masses == (1, 2, 3, 4, 5)
    assert found.centres == ((0, 0), *[(1, 0)] * 4)
    assert found.loads[1].values == ((0, 1), (90, 2), (360, 1))
    assert found.springs[0].between[1].link == 5
    assert (found.torsion_springs[0].between, found.torsion_springs[0].free_angle_deg) == ((3, 5), -30)
    assert found.friction is not None
    assert found.friction.viscous == (1, 2, 3, 4, 5, 6, 7)


def meeting(p: Any, r: float, q: Any, s: float, side: int) -> Any:
    """The point at r from p and at s from q, on the left of p -> q (+1) or on its right."""
    way = q - p
    along = (abs(way) ** 2 + r**2 - s**2) / (2 * abs(way))
    return p + (along + 1j * side * np.sqrt(r**2 - along**2)) * way / abs(way)


TURN = np.exp(2j * np.pi * np.arange(3600) / 3600)


def carried_point(linkage: Linkage) -> tuple[Any, Any, Any]:
    """C, E and P of a Stephenson III of the catalogue over a turn, by two meetings of circles."""
    assert isinstance(linkage, SixBar)
    o2, o4, c, d, p = (complex(*getattr(linkage, x)) for x in ("o2", "o4", "c", "d", "coupler_point"))
    a = o2 + float(linkage.r2) * TURN
    b = meeting(a, float(linkage.r3), o4, float(linkage.r4), int(linkage.assembly))
    at_c = a + c * (b - a) / float(linkage.r3)
    e = meeting(at_c, float(linkage.r5), d, float(linkage.r6), int(linkage.assembly_2))
    return at_c, e, at_c + p * (e - at_c) / float(linkage.r5)


def test_klanns_leg_is_that_of_the_patent() -> None:
    leg = load_linkage("klann")
    assert isinstance(leg, SixBar)
    r3, c, foot = float(leg.r3), complex(*leg.c), complex(*leg.coupler_point)
    assert [abs(c), abs(c - r3)] == pytest.approx([1.1051, 0.5221], rel=1e-12)  # 35 from 29 and from 27
    assert [abs(foot), abs(foot - float(leg.r5))] == pytest.approx([0.8966, 1.732], rel=1e-12)
    _, _, way = carried_point(leg)
    assert np.ptp(way.real) == pytest.approx(1.0087, abs=5e-5)
    assert np.ptp(way.imag) == pytest.approx(0.5273, abs=5e-5)
    assert np.mean(way.imag < way.imag.min() + 0.02 * np.ptp(way.imag)) == pytest.approx(0.085, abs=1e-3)


def test_the_dwell_of_the_course_project() -> None:
    linkage = load_linkage("dwell-six-bar")
    assert abs(complex(*linkage.c)) == pytest.approx(62.89)  # type: ignore[attr-defined]
    assert np.degrees(np.angle(complex(*linkage.c))) == pytest.approx(21.89)  # type: ignore[attr-defined]
    _, e, _ = carried_point(linkage)
    theta6 = np.degrees(np.unwrap(np.angle(e - complex(*linkage.d))))  # type: ignore[attr-defined]
    assert np.ptp(theta6) == pytest.approx(15.83, abs=5e-3)
    turns = np.concatenate([theta6, theta6])
    spans = np.lib.stride_tricks.sliding_window_view(turns, 1386)  # steps of 0.1 deg, 138.5 deg long
    assert 0.498 < np.ptp(spans, axis=1).min() < 0.5
