"""Dotted keys set in parsed problem files."""

from __future__ import annotations

from typing import Any

import pytest

from grashof.problems import ProblemError
from grashof.sweep.keys import assigned, key_parts, overlap


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
    with pytest.raises(ProblemError) as refused:
        assigned(document, key_parts(key), 1)
    assert words in str(refused.value)


@pytest.mark.parametrize("key", ["", ".", "a.", "a[", "a[x]", "a b", "[0]", "a[-1]"])
def test_text_that_is_not_a_key_is_refused(key: str) -> None:
    with pytest.raises(ProblemError, match="dotted key"):
        key_parts(key)


def test_overlap_of_equal_keys() -> None:
    assert overlap([("a", 0), ("a", 0)])
    assert not overlap([("a", 0), ("a", 1)])
