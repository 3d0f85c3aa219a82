"""Dotted keys set in parsed problem files, and tables of points and poses laid over them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from refusals import refusal, rows

from grashof.problems import ProblemError
from grashof.sweep.keys import assigned, key_parts, overlap
from grashof.sweep.target_table import target_rows

PATH = {"kind": "path", "path": {"points": [[0, 0]], "closed": True}, "title": "t"}
MOTION = {"kind": "motion"}


def read(
    tmp_path: Path, text: str, base: dict[str, Any] = PATH
) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    path = tmp_path / "points.csv"
    path.write_text(text, encoding="utf-8-sig")
    return target_rows(path, base)


def test_points(tmp_path: Path) -> None:
    (first, laid), (_, second) = read(tmp_path, "name,x1,y1,x2,y2\na,1,2,3,4\n\n007,5,6\n")
    assert first == {"row": 1, "name": "a", "x1": 1.0, "y1": 2.0, "x2": 3.0, "y2": 4.0}
    assert laid == {"kind": "path", "path": {"points": [[1, 2], [3, 4]], "closed": True}, "title": "t"}
    assert second["path"]["points"] == [[5, 6]]


def test_poses_with_free_parts_and_other_keys(tmp_path: Path) -> None:
    text = "x1,y1,angle1_deg,x2,y2,angle2_deg,requirements.o2.x,requirements.rotatability\n"
    (cells, laid), (_, other) = read(tmp_path, f"{text}1,2,30,4,5,,2.5,any\n1,2,3,,,60,,\n", MOTION)
    assert laid["motion"] == {"poses": [[1, 2, 30], {"x": 4, "y": 5}]}
    assert laid["requirements"] == {"o2": {"x": [2.5, 2.5]}, "rotatability": "any"}
    assert cells["requirements.rotatability"] == "any"
    assert other["motion"]["poses"] == [[1, 2, 3], {"angle": 60}]
    assert "requirements" not in other


WRONG = [
    (PATH, r"""
x1,y1\n1,b\n1,inf\n | line 2: y1 is 'b'; it must be\nline 3: y1 is 'inf'
x1,y1\n1,\n | line 2: y1 is empty
x1,y1\n1,2,3\n | line 2 has 3 cells; it must have 2
x1,y1\n | has no rows
# | has no columns x1,y1
x1,y1,x2\n1,2,3\n | column y2 is missing
x1,y1,x1\n1,2,3\n | has column x1 2 times
x1,y1,colour\n1,2,3\n | column 'colour' is unknown; for a path they are x1,y1,x2,y2
x1,y1,a.b[\n1,2,3\n | column is 'a.b['; it must be a dotted key
"""),
    (MOTION, r"x1,y1\n1,2\n | column angle1_deg is missing"),
    ({}, r'x1,y1\n1,2\n | has no kind = "path" or "motion"'),
]  # fmt: skip


@pytest.mark.parametrize(
    ("base", "text", "lines"), [(base, *row) for base, table in WRONG for row in rows(table)]
)
def test_all_that_is_wrong_is_stated(tmp_path: Path, text: str, base: dict[str, Any], lines: str) -> None:
    stated = refusal(read, tmp_path, text, base).splitlines()
    for line, words in zip(stated, lines.splitlines(), strict=True):
        assert words in line


@pytest.mark.parametrize(
    ("document", "key", "value", "wanted"),
    [
        ({}, "requirements.order", False, {"requirements": {"order": False}}),
        ({"a": [[1, 2], [3, 4]]}, "a[1][0]", 5, {"a": [[1, 2], [5, 4]]}),
        ({"m": {"poses": [[1, 2, 3]]}}, "m.poses[0].angle", 9, {"m": {"poses": [[1, 2, 9]]}}),
        ({"m": {"poses": [{"x": 1}]}}, "m.poses[0].y", 9, {"m": {"poses": [{"x": 1, "y": 9}]}}),
        ({"requirements": {"o2": [1, 2]}}, "requirements.o2.y", 9, {"requirements": {"o2": [1, 9]}}),
        ({}, "requirements.o2.y", [1, 9], {"requirements": {"o2": {"y": [1, 9]}}}),
        ({}, "requirements.o4.x", 2, {"requirements": {"o4": {"x": [2, 2]}}}),
        ({}, "search.seed", 2, {"search": {"seed": 2}}),
    ],
)
def test_a_value_at_a_key(document: dict[str, Any], key: str, value: Any, wanted: dict[str, Any]) -> None:
    before = repr(document)
    assert assigned(document, key_parts(key), value) == wanted
    assert repr(document) == before


@pytest.mark.parametrize(
    ("document", "key", "words"),
    [
        ({"a": [1]}, "a[1]", "a[1] is missing; a ends with [0]"),
        ({"a": [1]}, "a.z", "a.z is missing; a ends with [0]"),
        ({"a": 1}, "a.b", "a.b is missing; a is 1, which is not a table"),
        ({}, "a[0]", "a[0] is missing; a is not a list"),
    ],
)
def test_keys_that_lead_nowhere(document: dict[str, Any], key: str, words: str) -> None:
    assert words in refusal(assigned, document, key_parts(key), 1)


@pytest.mark.parametrize("key", ["", ".", "a.", "a[", "a[x]", "a b", "[0]", "a[-1]"])
def test_text_that_is_not_a_key_is_refused(key: str) -> None:
    with pytest.raises(ProblemError, match="dotted key"):
        key_parts(key)


def test_overlap_of_equal_keys() -> None:
    assert overlap([("a", 0), ("a", 0)])
    assert not overlap([("a", 0), ("a", 1)])
