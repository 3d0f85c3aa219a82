"""Linkage files: the catalogue, valid files, and errors by name."""

from __future__ import annotations

import json
import os
import tomllib
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from refusals import refusal

from grashof.problems import (
    DynamicsSpec,
    FourBar,
    MotionTask,
    ProblemError,
    linkage_catalogue,
    load_linkage,
    load_linkage_spec,
)
from grashof.problems.files.linkage_file import load_design

ROOT = Path(__file__).parents[3]
SLIDERS = ("engine", "crank-shaper")
SIX_BARS = ("klann", "dwell-six-bar")
PLAIN = "o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_catalogue_is_what_is_shipped() -> None:
    shipped = {path.stem for path in (ROOT / "problems" / "data" / "linkages").glob("*.toml")}
    four_bars = {"pumpjack", "lufkin-c912d", "luggage-report"}
    assert set(linkage_catalogue()) == shipped == {*four_bars, *SLIDERS, *SIX_BARS}
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    assert "data/linkages/*.toml" in settings["package-data"]["*"]


def test_pumpjack_is_that_of_the_report() -> None:
    golden = json.loads((ROOT / "tests" / "data" / "golden.json").read_text())["pumpjack_report_geometry"]
    spec = load_linkage_spec("pumpjack")
    r3 = float(golden["inputs"]["r3"])
    assert spec.linkage.lengths.tolist() == [5.0, 1.1938, r3, 3.048762]
    assert complex(*spec.linkage.coupler_point) == pytest.approx(r3 / 2 * np.exp(0.4j), rel=1e-15)
    assert spec.dynamics is not None
    given = golden["inverse_dynamics"]
    np.testing.assert_allclose(spec.dynamics.masses, np.array(given["masses"], dtype=float), rtol=1e-14)
    np.testing.assert_allclose(spec.dynamics.inertias, np.array(given["inertias"], dtype=float), rtol=1e-14)


def test_real_unit_is_that_of_its_maker() -> None:
    golden = json.loads((ROOT / "tests" / "data" / "golden.json").read_text())[
        "pumpjack_lufkin_C912D_427_144"
    ]
    spec, given = load_linkage_spec("lufkin-c912d"), golden["inputs_in"]
    assert float(spec.linkage.r1) == pytest.approx(float(golden["K_in"]), rel=1e-14)
    assert [float(given[key]) for key in "RPC"] == spec.linkage.lengths[1:].tolist()
    assert spec.output_arm == float(given["A"])


def test_the_ground_by_length_and_angle(tmp_path: Path) -> None:
    text = "o2 = [1, 2]\nr1 = 4\nground_angle_deg = 90\nr2 = 1\nr3 = 4\nr4 = 3\n"
    text += "body_angle_deg = 180\nassembly = -1\n"
    linkage = load_linkage(written(tmp_path, text))
    np.testing.assert_allclose(linkage.o4, [1, 6], rtol=1e-15)
    assert linkage.body_angle == np.pi
    assert linkage.assembly == -1
    without = load_linkage(written(tmp_path, text.replace("ground_angle_deg = 90\n", "")))
    assert without.o4.tolist() == [5, 2]


def test_a_plain_file_and_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path, "\ufeff" + PLAIN)
    monkeypatch.chdir(tmp_path)
    for given in (path, str(path), "mine.toml"):
        spec = load_linkage_spec(given)
        assert spec.linkage == FourBar((0, 0), (4, 0), 1, 4, 3)
        assert (spec.name, spec.dynamics, spec.output_arm) == ("mine", None, None)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PLAIN + "coupler = [1, 1]", "coupler is unknown; did you mean coupler_point?"),
        (PLAIN + "speed_rpm = 3", "speed_rpm is unknown; did you mean dynamics.speed_rpm?"),
        (PLAIN + "[dynamics]\nspeed = 3", "dynamics.speed is unknown; did you mean speed_rpm?"),
        (PLAIN + "[dynamics]\npayload = 3", "length_unit is ''; it must be one of mm"),
        (PLAIN + "dynamics = 3", "dynamics is 3; it must be a table"),
        (PLAIN + "r1 = 4", "r1 is given besides o4"),
        (PLAIN + "assembly = 2", "assembly is 2; it must be +1 or -1"),
        (PLAIN + "output_arm = 0", "output_arm is 0"),
        (PLAIN + "body_angle_deg = nan", "body_angle_deg is nan"),
        (PLAIN + "body_angle_deg = 36001", "body_angle_deg is 36001; it must be from -36000 to 36000"),
        (PLAIN.replace("r2 = 1", "r2 = -1"), "r2 is -1.0; it must be greater than zero"),
        (PLAIN.replace("r2 = 1\n", ""), "r2 is missing"),
        (PLAIN.replace("o4 = [4, 0]\n", ""), "o4 is missing; give it, or r1"),
        (PLAIN.replace("o4 = [4, 0]", "r1 = 0"), "r1 is 0; it must be a number greater than zero"),
        (PLAIN.replace("[4, 0]", "[0, 0]"), "o4 is where o2 is"),
        (PLAIN.replace("[4, 0]", "[4, 0, 0]"), "it must be [x, y]"),
        (PLAIN.replace("[4, 0]", "[1e300, 0]"), "o4 is 1e+300; it must be from -1e+20 to 1e+20"),
        ("r2 = ", "is not TOML"),
        ("kind = 'motion'", "is a problem; solve it, then name a design: mine-designs/candidates.json#1"),
    ],
)  # fmt: skip
def test_bad_files_are_refused(tmp_path: Path, text: str, message: str) -> None:
    answer = refusal(load_linkage, written(tmp_path, text))
    assert message in answer
    assert answer.startswith(str(tmp_path))
    assert "\n" not in answer or "TOML" in message


def test_speed_and_gravity_need_no_masses(tmp_path: Path) -> None:
    for table, expected in {
        "speed_rpm = -3": DynamicsSpec(speed_rpm=-3),
        "gravity = [0, -1]": DynamicsSpec(gravity=(0, -1)),
        "payload = 2": DynamicsSpec(payload=2),
    }.items():
        spec = load_linkage_spec(written(tmp_path, f"length_unit = 'in'\n{PLAIN}[dynamics]\n{table}"))
        assert spec.dynamics == expected


def test_unknown_names() -> None:
    for name, message in [
        ("pumpjak", "did you mean pumpjack?"),
        (
            "luggage",
            "^luggage: is a problem; solve it, then name a design: luggage-designs/candidates.json#1$",
        ),
        (
            "chair",
            "the catalogue has crank-shaper, dwell-six-bar, engine, klann, lufkin-c912d, luggage-report, ",
        ),
        ("d/candidates.csv#3", "is a table; name the design as d/candidates.json#3$"),
        ("d/nearest.csv#1", "is a table of misses; a linkage file with their dimensions can be read$"),
        ("candidates.csv", "is a table; name the design as candidates.json#1$"),
        ("", "neither a linkage of the catalogue nor a file"),
        ("no/such.toml", "there is no such file"),
        ("./", "is a folder"),
        ("candidates.json", "name one of them, such as candidates.json#1"),
        ("a\0/b.toml", "cannot be read"),
    ]:
        with pytest.raises(ProblemError, match=message.replace("?", r"\?")):
            load_linkage(name)


def listed(**changes: Any) -> str:
    linkage = {
        "o2": [0, 0], "o4": [4, 0], "r2": 1.0, "r3": 4.0, "r4": 3.0, "coupler_point": [0.1, 0.3],
        "assembly": -1, "body_angle": 0.25,
    }  # fmt: skip
    design = {"rank": 3, "id": "dabcdef0", "linkage": linkage | changes, "direction": 1}
    return json.dumps({"problem": "p", "title": "P", "length_unit": "m", "designs": [design]})


def test_a_design_of_a_list(tmp_path: Path) -> None:
    folder = tmp_path / "p#designs"
    folder.mkdir()
    path = folder / "candidates.json"
    path.write_text(listed())
    spec = load_linkage_spec(f"{path}#3")
    assert spec.linkage == FourBar((0, 0), (4, 0), 1, 4, 3, (0.1, 0.3), -1, 0.25)
    assert (spec.name, spec.title, spec.length_unit) == ("p#designs-3", "P: design 3", "m")
    assert spec.dynamics == DynamicsSpec()
    assert load_linkage_spec(f"{path}#dabcdef0").name == spec.name
    masses = {"masses": [1, 2, 3], "inertias": [0, 1, 0.1], "speed_rpm": 7}
    content = json.loads(listed()) | {"dynamics": masses}
    content["designs"][0]["direction"] = -1
    path.write_text(json.dumps(content))
    assert load_linkage_spec(f"{path}#3").dynamics == DynamicsSpec(**masses | {"speed_rpm": -7})
    for text, rank, message in [
        (listed(), "4", "has no design 4; name a rank, 1 to 3, or the id of a design"),
        (listed(), "x", "has no design x"),
        (listed(), "", "has no design"),
        (listed(r2=0), "3", "#3: r2 is 0"),
        (listed(r2=[1, 2]), "3", "#3: r2 is .*; it must be a number"),
        (listed(), "9" * 5000, "has no design 9"),
        ("[]", "3", "is not a list of designs"),
        ("{", "3", "is not a list of designs"),
    ]:
        path.write_text(text)
        with pytest.raises(ProblemError, match=message):
            load_linkage(f"{path}#{rank}")


def edited(**changes: Any) -> str:
    """The list with its design, or an entry beside the designs, changed by hand."""
    content = json.loads(listed())
    for key, value in changes.items():
        (content if key in ("title", "length_unit", "dynamics") else content["designs"][0])[key] = value
    return json.dumps(content)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"direction": 0}, "#3: direction is 0; it must be +1 or -1"),
        ({"direction": "x"}, "#3: direction is 'x'; it must be +1 or -1"),
        ({"dynamics": 5}, "#3: dynamics is 5; it must be a table"),
        ({"dynamics": {"masse": [1, 1, 1]}}, "#3: dynamics.masse is unknown; did you mean masses?"),
        ({"dynamics": {"mass_per_length": 1}, "length_unit": "ell"}, "#3: length_unit is 'ell'"),
        (
            {"dynamics": {"speed_rpm": 1e300}},
            "#3: dynamics.speed_rpm is 1e+300; it must be from -1e+20 to 1e+20",
        ),
        ({"length_unit": None}, "#3: length_unit is"),
        ({"rank": float("inf")}, "is not a list of designs"),
        ({"rank": 1.5}, "is not a list of designs"),
        ({"rank": 10**40}, "is not a list of designs"),
        ({"linkage": 5}, "states no linkage"),
    ],
)
def test_a_list_edited_by_hand(tmp_path: Path, changes: dict[str, Any], message: str) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(edited(**changes))
    answer = refusal(load_linkage_spec, f"{path}#3")
    assert message in answer
    assert "\n" not in answer


TARGETS = {"id": "x", "theta2": [0.1, 0.2], "assembly": [1, 1], "position_error": [0.0, None]}


@pytest.mark.parametrize(
    "changes",
    [
        {"theta2": []}, {"theta2": [0.1]}, {"theta2": [0.1, 1e300]}, {"assembly": [1, 0]}, {"assembly": None},
        {"position_error": [10**400, None]}, {"position_error": [0.0, float("nan")]},
        {"angle_error": [0.1, "x"]}, {"angle_error": [0.1]},
    ],
)  # fmt: skip
def test_targets_edited_by_hand(tmp_path: Path, changes: dict[str, Any]) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(edited(**TARGETS))
    assert load_design(path, "3").theta2 == (0.1, 0.2)
    path.write_text(edited(**TARGETS | changes))
    with pytest.raises(ProblemError, match="#3: states no targets"):
        load_design(path, "3")


def test_a_file_name_that_is_not_text(tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"caf\xe9.toml")
    try:
        path.write_text(PLAIN)
    except OSError:
        pytest.skip("this file system takes UTF-8 names only")
    assert load_linkage_spec(path).name == "caf?"


def test_all_errors_are_reported_a_line_each(tmp_path: Path) -> None:
    text = "o2 = [1, 2, 3]\no4 = [1e30, 0]\nr2 = -1\nr3 = 0\nr4 = 'x'\ncoupler = 2\noutput_arm = -1\n"
    path = written(tmp_path, text)
    assert refusal(load_linkage, path).splitlines() == [
        f"{path}: {line}"
        for line in (
            "o2 is [1, 2, 3]; it must be [x, y]",
            "o4 is 1e+30; it must be from -1e+20 to 1e+20",
            "r2 is -1.0; it must be greater than zero",
            "r3 is 0.0; it must be greater than zero",
            "r4 is 'x'; it must be a number",
            "output_arm is -1; it must be a number greater than zero",
            "coupler is unknown; did you mean coupler_point?",
        )
    ]


TASK = '"kind = \\"motion\\"\\n[motion]\\nposes = [[0, 0, 0], [3, 4, 90]]\\nbody = [[0, 0], [1, 1]]"'


def test_a_design_of_a_list_knows_its_problem(tmp_path: Path) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(listed())
    assert load_linkage_spec(f"{path}#3").problem is None  # a list made by hand need not state it
    path.write_text(listed().replace("{", f'{{"grashof": "0.1.0", "problem_toml": {TASK}, ', 1))
    problem = load_linkage_spec(f"{path}#3").problem
    assert problem is not None
    assert isinstance(problem.task, MotionTask)
    assert (problem.name, problem.task.body is not None) == ("p", True)
    path.write_text(edited(title="\ud800 1"))  # no file can hold it
    assert load_linkage_spec(f"{path}#3").title == "? 1: design 3"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('"kind = 3"', "problem_toml: kind is 3; it must be a string"),
        ('"kind = \\"six-bar\\"\\nspeed = 3"', "problem_toml: kind is 'six-bar'; it must be"),
        ('"["', "problem_toml: is not TOML"),
        ("7", "7 is not text"),
    ],
)
def test_a_list_of_another_version_is_refused_in_one_line(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(listed().replace("{", f'{{"grashof": "9.8", "problem_toml": {text}, ', 1))
    text = refusal(load_linkage_spec, f"{path}#3")
    begin = f"{path}: was written by grashof 9.8, and grashof {version('grashof')} cannot read its problem: "
    assert text.startswith(begin + said)
    assert "\n" not in text


@pytest.mark.parametrize("writer", ["9\n9" * 50, 5, "x" * 5000, "\x1b[31m"])
def test_any_writer_of_a_list_is_reported_in_one_line(tmp_path: Path, writer: Any) -> None:
    path = tmp_path / "candidates.json"
    path.write_text(json.dumps(json.loads(listed()) | {"grashof": writer, "problem_toml": 5}))
    said = refusal(load_linkage_spec, f"{path}#3").removeprefix(str(path))
    assert said.startswith(": was written by grashof of unknown version, and grashof ")
    assert said.endswith("cannot read its problem: 5 is not text; solve it again")
    assert said.isprintable()
    assert len(said) < 200
