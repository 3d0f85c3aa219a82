"""Enclosures on the page, in the terminal and in run.json."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grashof.analysis.judge.verdict import Enclosure
from grashof.output.terminal import print_table
from grashof.page.search import search_page
from grashof.synth import Result
from grashof.wording.proof import enclosure_line, enclosure_record


def test_all_verified(proven: Result, capsys: pytest.CaptureFixture[str]) -> None:
    line = enclosure_line(proven)
    assert line == (
        f"Closure and transmission angle of {len(proven)} designs verified by intervals of the driver angle, "
        "over their full motion."
    )
    assert line in search_page(proven, {"versions": {"grashof": "0"}, "settings": {}})
    print_table(proven)
    assert "intervals" not in capsys.readouterr().out
    record = enclosure_record(proven)
    assert record is not None
    assert (record["designs"], record["undecided"], record["contradicted"]) == (len(proven), {}, {})
    assert record["intervals"] == sum(each.values.enclosure.intervals for each in proven.candidates)
    empty = replace(proven, candidates=())
    assert (enclosure_line(empty), enclosure_record(empty)) == ("", None)


@pytest.mark.parametrize("contradicts", [False, True])
def test_an_undecided_design_is_named(
    proven: Result, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, contradicts: bool
) -> None:
    undecided = Enclosure(False, (0.1, 0.2), 7, "the box of A", contradicts)
    monkeypatch.setattr(proven.best.values, "enclosure", undecided)
    line, first = enclosure_line(proven), proven.best.id
    assert f"{first} (the box of A)" in line
    assert ("contradict the judge" in line) == contradicts
    assert (f"{len(proven) - 1} of {len(proven)} designs" in line) != contradicts
    print_table(proven)
    assert line in capsys.readouterr().out
    record = enclosure_record(proven)
    assert record is not None
    assert record["contradicted" if contradicts else "undecided"] == {first: "the box of A"}
