"""Linkage files and lists of every kind come back; keys of other kinds are refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from refusals import refusal, rows

from grashof.problems import (
    FourBar,
    InvertedSliderCrank,
    Linkage,
    ProblemError,
    SixBar,
    SliderCrank,
    load_linkage,
    load_linkage_spec,
)
from grashof.problems.files.linkage_schema import as_document
from grashof.problems.files.problem_writing import _value as toml
from grashof.problems.values.linkages.mechanism import MECHANISMS, ONE_LOOP, Mechanism
from grashof.problems.values.linkages.mechanisms import linkage_of

SLIDER = 'mechanism = "slider-crank"\nr2 = 1\nr3 = 4\n'
INVERTED = 'mechanism = "inverted-slider-crank"\no4 = [2, 0]\nr2 = 1\n'
BOTH = "four-bar and inverted-slider-crank have it"
SLIDES = "slider-crank and inverted-slider-crank have it"
KINDS = "four-bar, slider-crank, inverted-slider-crank, stephenson-3, stephenson-1, watt-1 or watt-2"
# Every row, and each link that may carry P.
EVERY = [(row, 2 + index % 5 if len(row.dyads) > 1 else row.carries) for index, row in enumerate(MECHANISMS)]


def named(value: Any) -> str:
    return (
        f"{value.word}-{value.dyads[-1].kind}-{value.dyads[-1].hosts}" if isinstance(value, Mechanism) else ""
    )


def any_linkage(row: Mechanism, point_link: int = 5) -> Linkage:
    """One of a row, with numbers of which no digit may be lost."""
    rng = np.random.default_rng(7)
    sizes = {each.name: rng.uniform(0.5, 2.0, 2 if each.paired else ()) for each in row.parameters}
    signs = {each.name: -1 for each in row.parameters if each.kind == "sign"}
    choices = {"hosts": row.dyads[1].hosts, "point_link": point_link} if len(row.dyads) > 1 else {}
    return linkage_of(row.word, sizes | signs | choices)


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
    return "\n".join(
        [f'mechanism = "{linkage.mechanism.word}"', *keys, *(["[dyad]", *inner] if inner else [])]
    )


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def message(folder: Path, text: str) -> list[str]:
    path = written(folder, text)
    return [line.removeprefix(f"{path}: ") for line in refusal(load_linkage, path).splitlines()]


def test_absent_keys_have_their_defaults(tmp_path: Path) -> None:
    assert load_linkage(written(tmp_path, SLIDER)) == SliderCrank((0, 0), 1, 4)
    assert load_linkage(written(tmp_path, INVERTED)) == InvertedSliderCrank((0, 0), (2, 0), 1)
    plain = 'mechanism = "four-bar"\no4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n'
    assert load_linkage(written(tmp_path, plain)) == FourBar((0, 0), (4, 0), 1, 4, 3)


@pytest.mark.parametrize(("row", "point_link"), EVERY, ids=named)
def test_a_file_gives_the_linkage_that_it_states(tmp_path: Path, row: Mechanism, point_link: int) -> None:
    wanted = any_linkage(row, point_link)
    found = load_linkage(written(tmp_path, text_of(wanted)))
    assert type(found) is type(wanted)
    assert found.mechanism == wanted.mechanism == Mechanism(row.word, row.dyads, point_link)
    for each, one, other in zip(row.parameters, wanted.parameters, found.parameters, strict=True):
        np.testing.assert_allclose(one, other, rtol=4e-16 if each.kind == "angle" else 0)


def test_an_inverted_slider_crank_by_length_and_angle_of_the_ground(tmp_path: Path) -> None:
    text = INVERTED.replace("o4 = [2, 0]", "o2 = [1, 1]\nr1 = 2\nground_angle_deg = 90")
    found = load_linkage(written(tmp_path, text))
    assert isinstance(found, InvertedSliderCrank)
    np.testing.assert_allclose(found.o4, [1, 3], rtol=1e-15)


BAD = r"""
<SLIDER>r4 = 3 | r4 does not go with mechanism slider-crank; only four-bar has it
<SLIDER>o4 = [1, 1] | o4 does not go with mechanism slider-crank; only <BOTH>
o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\noffset = 1 | offset does not go with mechanism four-bar; only <SLIDES>
<INVERTED>slide_angle_deg = 3 |
    slide_angle_deg does not go with mechanism inverted-slider-crank; only slider-crank has it
mechanism = "slider-crank"\nr2 = 1\n | r3 is missing
mechanism = "inverted-slider-crank"\nr2 = 1\n | o4 is missing; give it, or r1 with ground_angle_deg
mechanism = "inverted-slider-crank"\no4 = [0, 0]\nr2 = 1\n |
    o4 is where o2 is; the ground pivots must be distinct
<SLIDER>offset = 1e21 | offset is 1e+21; it must be from -1e+20 to 1e+20
<SLIDER>slide_angle_deg = inf | slide_angle_deg is inf; it must be a finite number
<SLIDER>output_arm = 3 | output_arm does not go with mechanism slider-crank; only <BOTH>
mechanism = 3\nr2 = 1\nr3 = 4\n | mechanism is 3; it must be <KINDS>
mechanism = "slider-crank"\nr2 = -1\nr3 = 4\nr1 = 2\nassembly = 0 |
    r1 does not go with mechanism slider-crank; only <BOTH>\n
    r2 is -1.0; it must be greater than zero\nassembly is 0; it must be +1 or -1
"""


@pytest.mark.parametrize(
    ("text", "lines"), rows(BAD, SLIDER=SLIDER, INVERTED=INVERTED, KINDS=KINDS, BOTH=BOTH, SLIDES=SLIDES)
)
def test_bad_files_are_refused(tmp_path: Path, text: str, lines: str) -> None:
    assert message(tmp_path, text) == lines.splitlines()


def listed(linkage: Linkage, **changes: Any) -> str:
    design = {"rank": 3, "id": "d0", "mechanism": linkage.mechanism.word, "direction": -1}
    design["linkage"] = linkage.stated | {key: given for key, given in changes.items() if key != "mechanism"}
    design |= {key: given for key, given in changes.items() if key == "mechanism"}
    return json.dumps({"problem": "p", "title": "", "length_unit": "mm", "designs": [design]})


@pytest.mark.parametrize(("row", "point_link"), EVERY, ids=named)
def test_a_list_gives_every_digit_back(tmp_path: Path, row: Mechanism, point_link: int) -> None:
    path, wanted = tmp_path / "candidates.json", any_linkage(row, point_link)
    path.write_text(listed(wanted))
    found = load_linkage_spec(f"{path}#3")
    assert found.linkage == wanted
    assert found.linkage.mechanism == wanted.mechanism
    assert found.dynamics is not None
    assert found.dynamics.speed_rpm < 0


def test_a_list_without_kinds_is_of_four_bars(tmp_path: Path) -> None:
    path, wanted = tmp_path / "candidates.json", any_linkage(ONE_LOOP["four-bar"])
    content = json.loads(listed(wanted))
    del content["designs"][0]["mechanism"]
    path.write_text(json.dumps(content))
    assert load_linkage(f"{path}#3") == wanted


ENGINE = any_linkage(ONE_LOOP["slider-crank"])
LEG = SixBar((0, 0), (4, 0), 1, 4, 3, c=(5, 1), d=(6, 2), r5=3, r6=2, hosts=(3, 1))
CHANGED = [
    (ENGINE, {"mechanism": "wheel"}, "#3: mechanism is 'wheel'; it must be four-bar"),
    (ENGINE, {"mechanism": 7}, "#3: mechanism is 7; it must be four-bar"),
    (
        ENGINE,
        {"mechanism": "four-bar"},
        "#3: states no linkage and direction; the keys are o2, o4, r2, r3, r4",
    ),
    (ENGINE, {"slide_angle": None}, "#3: slide_angle is None; it must be"),
    (ENGINE, {"offset": "x"}, "#3: offset is 'x'; it must be a number"),
    (LEG, {"r5": "x"}, "#3: dyad.r5 is 'x'; it must be a number"),
    (LEG, {"hosts": [2, 4]}, "#3: dyad.hosts is [2, 4], which makes a stephenson-1; it must be [3, 1] with"),
    (LEG, {"hosts": 3}, "#3: dyad.hosts is 3; it must be two numbers of links"),
    (LEG, {"point_link": 1}, "#3: point_link is 1; it must be the number of a moving link, 2 to 6"),
    (LEG, {"d": None}, "#3: dyad.d is missing"),
    (LEG, {"body_angle": None}, "#3: body_angle is None; it must be a finite number"),
    (LEG, {"mechanism": "watt-1"}, "#3: dyad.hosts is [3, 1], which makes a stephenson-3; it must be [2, 3]"),
]


@pytest.mark.parametrize(("linkage", "changes", "said"), CHANGED)
def test_lists_changed_by_hand(tmp_path: Path, linkage: Linkage, changes: dict[str, Any], said: str) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(listed(linkage, **changes))
    text = refusal(load_linkage, f"{path}#3")
    assert said in text
    assert "\n" not in text


@pytest.mark.parametrize("absent", ["hosts", "r6", "point_link", "assembly_2"])
def test_a_list_without_a_part_of_a_six_bar_is_refused(tmp_path: Path, absent: str) -> None:
    path, content = tmp_path / "candidates.json", json.loads(listed(LEG))
    del content["designs"][0]["linkage"][absent]
    path.write_text(json.dumps(content))
    with pytest.raises(ProblemError, match=r"states no linkage and direction; the keys are o2, .*hosts, poi"):
        load_linkage(f"{path}#3")


def test_the_sliders_of_the_catalogue() -> None:
    engine, shaper = load_linkage("engine"), load_linkage("crank-shaper")
    assert isinstance(engine, SliderCrank)
    assert (float(engine.r2), float(engine.r3), float(engine.offset)) == (40, 120, -20)
    assert isinstance(shaper, InvertedSliderCrank)
    assert float(shaper.r2 / shaper.r1) == pytest.approx(np.sin(np.radians(60 / 2)), rel=1e-15)
