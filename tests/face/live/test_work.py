"""What a solver tells of its designs: their keys stay while a search goes on."""

from __future__ import annotations

import json
from typing import Any

import pytest

from grashof import load, synthesize
from grashof.live.jobs import Job, Line
from grashof.live.work import ABSENT, TRACKED, Shown, lines
from grashof.problems import problem_text
from grashof.problems.files.toml_file import document_of
from grashof.synth import Result


@pytest.fixture(scope="module")
def result() -> Result:
    return synthesize(load("luggage")).top(50)


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return document_of(problem_text("luggage"), "luggage")


def told(job: Job) -> tuple[list[dict[str, Any]], bytes]:
    """Lists that a job tells of, and what the page has in the end."""
    every: list[Line] = []
    lines(job, lambda: False, every.append)
    lists = [json.loads(line.text) for line in every if line.shown is not None]
    return lists, [line.shown for line in every if line.shown is not None][-1]


def keys(found: dict[str, Any]) -> list[int]:
    return [design["key"] for design in found["designs"]]


@pytest.mark.slow
def test_a_design_that_comes_back_keeps_its_key(result: Result) -> None:
    designs = result.candidates
    before = Shown().matched(designs[:12], result)
    partial = before.matched(designs[3:4]).matched(designs[20:22])
    assert list(partial.designs) == [13, 14]
    after = partial.matched([designs[2], designs[20], designs[30]], result)
    assert list(after.designs) == [3, 13, 15]
    assert not after.absent
    assert list(after.matched([designs[0]]).designs) == [16]


@pytest.mark.slow
def test_few_that_are_absent_are_kept(result: Result) -> None:
    shown = Shown()
    for k, design in enumerate(result.candidates * 5):
        shown = Shown({k: design}, shown.absent, next_key=k + 1).matched(())
    assert len(shown.absent) == ABSENT


@pytest.mark.study
def test_designs_that_are_not_followed_keep_their_keys_too(document: dict[str, Any]) -> None:
    (*_, found), shown = told(Job("search", document, "luggage"))
    assert len(keys(found)) > TRACKED
    (followed,), shown = told(Job("track", document, "luggage", shown=shown))
    assert keys(followed) == keys(found)[:TRACKED]
    (*_, again), _ = told(Job("search", document, "luggage", shown=shown))
    assert keys(again) == keys(found)


@pytest.mark.study
def test_the_keys_of_misses_are_not_those_of_designs_to_come(document: dict[str, Any]) -> None:
    limits = {**document.get("requirements", {}), "transmission_min_deg": 60}
    (*_, found), shown = told(Job("search", {**document, "requirements": limits}, "luggage"))
    assert not found["found"]
    assert keys(found)
    (*_, again), _ = told(Job("search", document, "luggage", shown=shown))
    assert again["found"]
    assert not set(keys(again)) & set(keys(found))
