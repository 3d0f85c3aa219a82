"""Linkage files and lists of every kind: what they state comes back, what other kinds have is refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grashof.problems import (
    FourBar,
    InvertedSliderCrank,
    Linkage,
    ProblemError,
    SliderCrank,
    load_linkage,
    load_linkage_spec,
)
from grashof.problems.values.linkages.mechanism import ONE_LOOP

SLIDER = 'mechanism = "slider-crank"\nr2 = 1\nr3 = 4\n'
INVERTED = 'mechanism = "inverted-slider-crank"\no4 = [2, 0]\nr2 = 1\n'
BOTH = "four-bar and inverted-slider-crank have it"
SLIDES = "slider-crank and inverted-slider-crank have it"
KINDS = "four-bar, slider-crank, inverted-slider-crank, stephenson-3, stephenson-1, watt-1 or watt-2"
# Numbers of which no digit may be lost.
EVERY: dict[str, Linkage] = {
    "four-bar": FourBar((0.1, 1 / 3), (4, 0.7), 1, 4, 3, (0.1 + 0.2, -0.3), -1, 0.7),
    "slider-crank": SliderCrank((0.1, 1 / 3), 1, np.pi, -0.25, 0.7, (0.1 + 0.2, -0.3), -1, 1 / 7),
    "inverted-slider-crank": InvertedSliderCrank((0.1, 1 / 3), (4, 0.7), 1 / 3, -0.5, (0.3, 2), -1, 1e-3),
}


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def message(folder: Path, text: str) -> list[str]:
    path = written(folder, text)
    with pytest.raises(ProblemError) as refused:
        load_linkage(path)
    return [line.removeprefix(f"{path}: ") for line in str(refused.value).splitlines()]


def test_what_is_not_said_is_usual(tmp_path: Path) -> None:
    assert load_linkage(written(tmp_path, SLIDER)) == SliderCrank((0, 0), 1, 4)
    assert load_linkage(written(tmp_path, INVERTED)) == InvertedSliderCrank((0, 0), (2, 0), 1)
    plain = 'mechanism = "four-bar"\no4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n'
    assert load_linkage(written(tmp_path, plain)) == FourBar((0, 0), (4, 0), 1, 4, 3)


@pytest.mark.parametrize("kind", ONE_LOOP)
def test_what_a_file_says_is_what_it_states(tmp_path: Path, kind: str) -> None:
    wanted = EVERY[kind]
    lines = [f'mechanism = "{kind}"']
    for row in wanted.mechanism.parameters:
        number = wanted.stated[row.name]
        lines.append(f"{row.key} = {float(np.degrees(number)) if row.kind == 'angle' else number!r}")
    found = load_linkage(written(tmp_path, "\n".join(lines)))
    assert type(found) is type(wanted)
    for row, one, other in zip(wanted.mechanism.parameters, wanted.parameters, found.parameters, strict=True):
        np.testing.assert_allclose(one, other, rtol=4e-16 if row.kind == "angle" else 0)


def test_an_inverted_slider_crank_by_length_and_angle_of_the_ground(tmp_path: Path) -> None:
    text = INVERTED.replace("o4 = [2, 0]", "o2 = [1, 1]\nr1 = 2\nground_angle_deg = 90")
    found = load_linkage(written(tmp_path, text))
    assert isinstance(found, InvertedSliderCrank)
    np.testing.assert_allclose(found.o4, [1, 3], rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (SLIDER + "r4 = 3", ["r4 does not go with mechanism slider-crank; only four-bar has it"]),
        (
            SLIDER + "o4 = [1, 1]",
            ["o4 does not go with mechanism slider-crank; only four-bar and inverted-slider-crank have it"],
        ),
        (
            "o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\noffset = 1",
            [f"offset does not go with mechanism four-bar; only {SLIDES}"],
        ),
        (INVERTED + "slide_angle_deg = 3", [
            "slide_angle_deg does not go with mechanism inverted-slider-crank; only slider-crank has it"
        ]),
        (SLIDER.replace("r3 = 4\n", ""), ["r3 is missing"]),
        (INVERTED.replace("o4 = [2, 0]\n", ""), ["o4 is missing; give it, or r1 with ground_angle_deg"]),
        (INVERTED.replace("[2, 0]", "[0, 0]"), ["o4 is where o2 is; the ground pivots must be distinct"]),
        (SLIDER + "ofset = 1", ["ofset is unknown; did you mean offset?"]),
        (SLIDER + "offset = nan", ["offset is nan; all numbers must be finite"]),
        (SLIDER + "offset = 1e21", ["offset is 1e+21; it must be from -1e+20 to 1e+20"]),
        (SLIDER + "slide_angle_deg = inf", ["slide_angle_deg is inf; it must be a finite number"]),
        (SLIDER + "output_arm = 3", [
            f"output_arm does not go with mechanism slider-crank; only {BOTH}"
        ]),
        (SLIDER.replace("slider-crank", "slidercrank"), [
            "mechanism is 'slidercrank'; did you mean slider-crank?"
        ]),
        (SLIDER.replace('"slider-crank"', "3"), [
            f"mechanism is 3; it must be {KINDS}"
        ]),
        (SLIDER.replace('"slider-crank"', '["slider-crank"]'), [
            f"mechanism is ['slider-crank']; it must be {KINDS}"
        ]),
        (SLIDER.replace("r2 = 1", "r2 = -1") + "r1 = 2\nassembly = 0", [
            "r1 does not go with mechanism slider-crank; only four-bar and inverted-slider-crank have it",
            "r2 is -1.0; it must be greater than zero",
            "assembly is 0; it must be +1 or -1",
        ]),
    ],
)  # fmt: skip
def test_what_a_file_may_not_say(tmp_path: Path, text: str, lines: list[str]) -> None:
    assert message(tmp_path, text) == lines


def listed(kind: str, **changes: Any) -> str:
    design = {
        "rank": 3,
        "id": "d0",
        "mechanism": kind,
        "linkage": EVERY[kind].stated,
        "direction": -1,
    }
    return json.dumps({"problem": "p", "title": "", "length_unit": "mm", "designs": [design | changes]})


@pytest.mark.parametrize("kind", ONE_LOOP)
def test_a_list_gives_every_digit_back(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(listed(kind))
    spec = load_linkage_spec(f"{path}#3")
    assert spec.linkage == EVERY[kind]
    assert spec.linkage.mechanism is ONE_LOOP[kind]
    assert spec.dynamics is not None
    assert spec.dynamics.speed_rpm < 0


def test_a_list_without_kinds_is_of_four_bars(tmp_path: Path) -> None:
    path = tmp_path / "candidates.json"
    content = json.loads(listed("four-bar"))
    del content["designs"][0]["mechanism"]
    path.write_text(json.dumps(content))
    assert load_linkage(f"{path}#3") == EVERY["four-bar"]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"mechanism": "wheel"}, "#3: mechanism is 'wheel'; it must be four-bar"),
        ({"mechanism": 7}, "#3: mechanism is 7; it must be four-bar"),
        ({"mechanism": "four-bar"}, "#3: states no linkage and direction; the keys are o2, o4, r2, r3, r4"),
        (
            {"linkage": EVERY["slider-crank"].stated | {"slide_angle": None}},
            "#3: slide_angle is None; it must be",
        ),
        (
            {"linkage": EVERY["slider-crank"].stated | {"offset": "x"}},
            "#3: offset is 'x'; it must be a number",
        ),
    ],
)
def test_lists_changed_by_hand(tmp_path: Path, changes: dict[str, Any], said: str) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(listed("slider-crank", **changes))
    with pytest.raises(ProblemError) as refused:
        load_linkage(f"{path}#3")
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_the_sliders_of_the_catalogue() -> None:
    engine, shaper = load_linkage("engine"), load_linkage("crank-shaper")
    assert isinstance(engine, SliderCrank)
    assert (float(engine.r2), float(engine.r3), float(engine.offset)) == (40, 120, -20)
    assert isinstance(shaper, InvertedSliderCrank)
    assert float(shaper.r2 / shaper.r1) == pytest.approx(np.sin(np.radians(60 / 2)), rel=1e-15)
