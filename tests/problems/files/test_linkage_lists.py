"""Designs out of lists of candidates: every digit comes back; lists changed by hand are refused in a line."""

from __future__ import annotations

import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from linkages_of_rows import linkage_of_row, row_name
from refusals import refusal

from grashof.problems import (
    DynamicsSpec,
    FourBar,
    Linkage,
    MotionTask,
    ProblemError,
    SixBar,
    load_linkage_spec,
)
from grashof.problems.files.linkage_file import load_design
from grashof.problems.values.linkages.mechanism import MECHANISMS, ONE_LOOP, Mechanism

PLAIN = FourBar((0, 0), (4, 0), 1, 4, 3, (0.1, 0.3), -1, 0.25)
ENGINE = linkage_of_row(ONE_LOOP["slider-crank"])
LEG = SixBar((0, 0), (4, 0), 1, 4, 3, c=(5, 1), d=(6, 2), r5=3, r6=2, hosts=(3, 1))
TASK = 'kind = "motion"\n[motion]\nposes = [[0, 0, 0], [3, 4, 90]]\nbody = [[0, 0], [1, 1]]'


def given(entries: dict[str, Any], changes: dict[str, Any] | None) -> dict[str, Any]:
    return {key: entry for key, entry in (entries | (changes or {})).items() if entry is not ...}


def listed(
    folder: Path, one: Linkage = PLAIN, design: Any = None, linkage: Any = None, **entries: Any
) -> str:
    """A list of one design, of rank 3: entries of it, its linkage and the list changed, or `...` left out."""
    stated = {"rank": 3, "id": "dabcdef0", "mechanism": one.mechanism.word, "direction": 1}
    stated["linkage"] = given(one.stated, linkage)
    designs = [given(stated, design)]
    path = folder / "candidates.json"
    path.write_text(
        json.dumps({"problem": "p", "title": "P", "length_unit": "m", "designs": designs} | entries)
    )
    return f"{path}#3"


def test_a_design_of_a_list(tmp_path: Path) -> None:
    folder = tmp_path / "p#designs"
    folder.mkdir()
    where = listed(folder)
    spec = load_linkage_spec(where)
    assert spec.linkage == PLAIN
    assert (spec.name, spec.title, spec.length_unit) == ("p#designs-3", "P: design 3", "m")
    assert (spec.dynamics, spec.problem) == (DynamicsSpec(), None)  # a list made by hand need not state it
    assert load_linkage_spec(where.replace("#3", "#dabcdef0")).name == spec.name
    masses = {"masses": [1, 2, 3], "inertias": [0, 1, 0.1], "speed_rpm": 7}
    turned = load_linkage_spec(listed(folder, design={"direction": -1}, dynamics=masses))
    assert turned.dynamics == DynamicsSpec(**masses | {"speed_rpm": -7})
    assert load_linkage_spec(listed(folder, title="\ud800 1")).title == "? 1: design 3"  # no file can hold it


@pytest.mark.parametrize(
    ("row", "point_link"), [(row, 2 + k % 5) for k, row in enumerate(MECHANISMS)], ids=row_name
)
def test_a_list_gives_every_digit_back(tmp_path: Path, row: Mechanism, point_link: int) -> None:
    wanted = linkage_of_row(row, point_link)
    found = load_linkage_spec(listed(tmp_path, wanted)).linkage
    assert found == wanted
    assert found.mechanism == wanted.mechanism


def test_a_list_without_kinds_is_of_four_bars(tmp_path: Path) -> None:
    assert load_linkage_spec(listed(tmp_path, design={"mechanism": ...})).linkage == PLAIN


NO_LIST = "is not a list of designs; it must be a candidates.json of grashof solve"
NO_LINKAGE = "#3: states no linkage and direction; the keys are o2, "
CHANGED: list[tuple[Linkage, dict[str, Any], str]] = [
    (PLAIN, {"linkage": {"r2": 0}}, "#3: r2 is 0"),
    (PLAIN, {"linkage": {"r2": [1, 2]}}, "#3: r2 is [1, 2]; it must be a number"),
    (PLAIN, {"design": {"direction": 0}}, "#3: direction is 0; it must be +1 or -1"),
    (PLAIN, {"design": {"direction": "x"}}, "#3: direction is 'x'; it must be +1 or -1"),
    (PLAIN, {"dynamics": 5}, "#3: dynamics is 5; it must be a table"),
    (PLAIN, {"dynamics": {"masse": [1, 1, 1]}}, "#3: dynamics.masse is unknown; did you mean masses?"),
    (PLAIN, {"dynamics": {"mass_per_length": 1}, "length_unit": "ell"}, "#3: length_unit is 'ell'"),
    (PLAIN, {"dynamics": {"speed_rpm": 1e300}}, "#3: dynamics.speed_rpm is 1e+300; it must be from -1e+20"),
    (PLAIN, {"length_unit": None}, "#3: length_unit is"),
    (PLAIN, {"design": {"rank": float("inf")}}, NO_LIST),
    (PLAIN, {"design": {"rank": 1.5}}, NO_LIST),
    (PLAIN, {"design": {"rank": 10**40}}, NO_LIST),
    (PLAIN, {"design": {"linkage": 5}}, NO_LINKAGE),
    (PLAIN, {"design": {"cylinder": {"on": [3], "base": [0, 0], "point": [1, 0]}}}, "#3: cylinder.on is "),
    (ENGINE, {"design": {"mechanism": "wheel"}}, "#3: mechanism is 'wheel'; it must be four-bar"),
    (ENGINE, {"design": {"mechanism": 7}}, "#3: mechanism is 7; it must be four-bar"),
    (ENGINE, {"design": {"mechanism": "four-bar"}}, f"{NO_LINKAGE}o4, r2, r3, r4"),
    (ENGINE, {"linkage": {"slide_angle": None}}, "#3: slide_angle is None; it must be"),
    (ENGINE, {"linkage": {"offset": "x"}}, "#3: offset is 'x'; it must be a number"),
    (LEG, {"linkage": {"r5": "x"}}, "#3: dyad.r5 is 'x'; it must be a number"),
    (LEG, {"linkage": {"hosts": [2, 4]}}, "#3: dyad.hosts is [2, 4], which makes a stephenson-1; it"),
    (LEG, {"linkage": {"hosts": 3}}, "#3: dyad.hosts is 3; it must be two numbers of links"),
    (LEG, {"linkage": {"point_link": 1}}, "#3: point_link is 1; it must be the number of a moving link"),
    (LEG, {"linkage": {"d": None}}, "#3: dyad.d is missing"),
    (LEG, {"linkage": {"body_angle": None}}, "#3: body_angle is None; it must be a finite number"),
    (LEG, {"design": {"mechanism": "watt-1"}}, "#3: dyad.hosts is [3, 1], which makes a stephenson-3"),
    *((LEG, {"linkage": {key: ...}}, NO_LINKAGE) for key in ("hosts", "r6", "point_link", "assembly_2")),
]  # fmt: skip


@pytest.mark.parametrize(("one", "changes", "said"), CHANGED)
def test_lists_changed_by_hand(tmp_path: Path, one: Linkage, changes: dict[str, Any], said: str) -> None:
    answer = refusal(load_linkage_spec, listed(tmp_path, one, **changes))
    assert said in answer
    assert "\n" not in answer


@pytest.mark.parametrize(
    ("text", "rank", "said"),
    [
        (None, "4", "has no design 4; name a rank, 1 to 3, or the id of a design"),
        (None, "x", "has no design x"),
        (None, "", "has no design"),
        (None, "9" * 5000, "has no design 9"),
        ("[]", "3", NO_LIST),
        ("{", "3", NO_LIST),
    ],
)
def test_lists_without_the_design(tmp_path: Path, text: str | None, rank: str, said: str) -> None:
    path = Path(listed(tmp_path).removesuffix("#3"))
    path.write_text(path.read_text() if text is None else text)
    assert said in refusal(load_linkage_spec, f"{path}#{rank}")


TARGETS = {"id": "x", "theta2": [0.1, 0.2], "assembly": [1, 1], "position_error": [0.0, None]}


@pytest.mark.parametrize(
    "changes",
    [
        {"theta2": []}, {"theta2": [0.1]}, {"theta2": [0.1, 1e300]}, {"assembly": [1, 0]}, {"assembly": None},
        {"position_error": [10**400, None]}, {"position_error": [0.0, float("nan")]},
        {"angle_error": [0.1, "x"]}, {"angle_error": [0.1]},
    ],
)  # fmt: skip
def test_targets_changed_by_hand(tmp_path: Path, changes: dict[str, Any]) -> None:
    path = Path(listed(tmp_path, design=TARGETS).removesuffix("#3"))
    assert load_design(path, "3").theta2 == (0.1, 0.2)
    listed(tmp_path, design=TARGETS | changes)
    with pytest.raises(ProblemError, match="#3: states no targets"):
        load_design(path, "3")


def test_a_design_of_a_list_knows_its_problem(tmp_path: Path) -> None:
    problem = load_linkage_spec(listed(tmp_path, grashof="0.1.0", problem_toml=TASK)).problem
    assert problem is not None
    assert isinstance(problem.task, MotionTask)
    assert (problem.name, problem.task.body is not None) == ("p", True)


NO_TEXT = "5 is not text; solve it again"


@pytest.mark.parametrize(
    ("writer", "text", "said"),
    [
        ("9.8", "kind = 3", "9.8, problem_toml: kind is 3; it must be a string"),
        ("9.8", 'kind = "six-bar"\nspeed = 3', "9.8, problem_toml: kind is 'six-bar'; it must be"),
        ("9.8", "[", "9.8, problem_toml: is not TOML"),
        *((writer, 5, f"of unknown version, {NO_TEXT}") for writer in ("9\n9" * 9, 5, "x" * 500, "\x1b[31m")),
    ],
)  # fmt: skip
def test_a_list_of_another_version_is_refused_in_one_line(
    tmp_path: Path, writer: Any, text: Any, said: str
) -> None:
    where = listed(tmp_path, grashof=writer, problem_toml=text)
    answer = refusal(load_linkage_spec, where)
    name, why = said.split(", ", maxsplit=1)
    by = f"{where.removesuffix('#3')}: was written by grashof {name}, and grashof {version('grashof')}"
    assert answer.startswith(f"{by} cannot read its problem: {why}")
    assert answer.isprintable()
    assert len(answer.removeprefix(by)) < 200
