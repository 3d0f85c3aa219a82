"""What the page, the terminal and run.json say of enclosures."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grashof import synthesize
from grashof.analysis.judge.verdict import Enclosure
from grashof.output.terminal import print_table
from grashof.page.search import search_page
from grashof.problems import load
from grashof.synth import Result
from grashof.wording.proof import enclosure_line, enclosure_record


@pytest.fixture
def found() -> Result:
    return synthesize(load("luggage"), enough=3)


def told(result: Result, *shown: Enclosure) -> None:
    for each, enclosure in zip(result.candidates, shown, strict=False):
        each.values.enclosure = enclosure


def test_all_verified(found: Result, capsys: pytest.CaptureFixture[str]) -> None:
    line = enclosure_line(found)
    assert line == (
        f"Closure and transmission angle of {len(found)} designs verified by intervals of the driver angle, "
        "over their whole motion."
    )
    assert line in search_page(found, {"versions": {"grashof": "0"}, "settings": {}})
    print_table(found)
    assert "intervals" not in capsys.readouterr().out
    record = enclosure_record(found)
    assert record is not None
    assert (record["designs"], record["undecided"], record["contradicted"]) == (len(found), {}, {})
    assert record["intervals"] == sum(each.values.enclosure.intervals for each in found.candidates)


@pytest.mark.parametrize("contradicts", [False, True])
def test_what_is_not_shown_is_named(
    found: Result, capsys: pytest.CaptureFixture[str], contradicts: bool
) -> None:
    told(found, Enclosure(False, (0.1, 0.2), 7, "the box of A", contradicts))
    line, first = enclosure_line(found), found.best.id
    assert f"{first} (the box of A)" in line
    assert ("contradict the judge" in line) == contradicts
    assert (f"{len(found) - 1} of {len(found)} designs" in line) != contradicts
    print_table(found)
    assert line in capsys.readouterr().out
    record = enclosure_record(found)
    assert record is not None
    assert record["contradicted" if contradicts else "undecided"] == {first: "the box of A"}


def test_none_without_designs(found: Result) -> None:
    empty = replace(found, candidates=())
    assert (enclosure_line(empty), enclosure_record(empty)) == ("", None)
