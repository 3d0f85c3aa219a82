"""In notebooks linkages, designs and results show themselves, and no text of the user becomes markup."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

from grashof.problems import FourBar, LinkageSpec, load_linkage_spec
from grashof.synth import Result

SVG = "{http://www.w3.org/2000/svg}svg"
EVIL = "<script>alert('&')</script>"


def parsed(value: Any) -> ET.Element:
    """The HTML of a value, which is well-formed XML, too."""
    text = value._repr_html_()
    assert plt.get_fignums() == []
    return ET.fromstring(f"<body>{text.replace('<br>', '<br/>')}</body>")  # noqa: S314


def cells(page: ET.Element) -> list[list[str]]:
    return [["".join(cell.itertext()) for cell in row] for row in page.iter("tr")]


def test_a_linkage_shows_its_lengths_and_a_drawing() -> None:
    page = parsed(FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1)))
    facts = dict(row for row in cells(page))  # type: ignore[misc]
    assert [facts[name] for name in ("r1", "r2", "r3", "r4")] == ["4", "1", "4", "3"]
    assert facts["P (u, v)"] == "2, 1"
    assert facts["Grashof class"] == "crank-rocker"
    (drawing,) = page.iter(SVG)
    assert {"O2", "O4", "A", "B", "P"} <= set(drawing.itertext())


def test_a_batch_shows_the_first_dozen_and_an_open_linkage_why_it_is_not_drawn() -> None:
    page = parsed(FourBar((0, 0), (4, 0), np.linspace(1, 2, 30), 4, 3))
    assert len(cells(page)) == 13
    assert "batch of 30 linkages, shape (30,), the first 12" in "".join(page.itertext())
    assert not list(page.iter(SVG))
    page = parsed(FourBar((0, 0), (9, 0), 1, 1, 1))
    assert "closes at no driver angle" in "".join(page.itertext())


def test_a_result_shows_the_best_designs_as_the_terminal_does(few: Result) -> None:
    page = parsed(few)
    head, *rows = cells(page)
    table = few.to_frame()
    assert len(rows) == min(len(few), 12)
    column = {name: index for index, name in enumerate(head)}
    for row, (_, expected) in zip(rows, table.iterrows(), strict=False):
        assert row[0].strip("* ") == str(expected["rank"])
        assert ("*" in row[0]) == expected["pareto"]
        assert float(row[column["r2"]]) == pytest.approx(expected["r2"], rel=1e-3)
        mu = expected["transmission_min_task_deg"]
        assert float(row[column["mu task (deg)"]]) == pytest.approx(mu, abs=0.051)
    assert f"{len(few)} distinct verified" in "".join(page.itertext())
    assert len(list(page.iter(SVG))) == 1


def test_a_result_without_designs_states_the_reason(few: Result) -> None:
    page = parsed(replace(few, candidates=(), note=f"no design: {EVIL} is in the way"))
    assert "".join(page.itertext()) == f"No design: {EVIL} is in the way."


def test_a_design_shows_its_verdict(few: Result) -> None:
    facts = dict(row for row in cells(parsed(few.best)))  # type: ignore[misc]
    assert facts["design"] == few.best.id
    assert facts["defects"] == "none"
    worst = np.degrees(few.best.verdict.transmission_min_task)
    assert facts["worst transmission angle"].startswith(f"{worst:.1f} deg over the task")


def test_text_of_the_user_is_text(few: Result) -> None:
    spec = LinkageSpec(load_linkage_spec("pumpjack").linkage, EVIL, EVIL, EVIL, EVIL)
    page = parsed(spec)
    assert not list(page.iter("script"))
    facts = dict(row for row in cells(page))  # type: ignore[misc]
    assert facts["title"] == facts["source"] == facts["length unit"] == EVIL
    assert f"x ({EVIL})" in set(next(page.iter(SVG)).itertext())
    problem = replace(few.problem, title=EVIL, length_unit=EVIL, dynamics=None)
    assert not list(parsed(replace(few, problem=problem)).iter("script"))


@pytest.mark.extra
def test_a_notebook_shows_it() -> None:
    interactive = pytest.importorskip("IPython.core.interactiveshell").InteractiveShell
    shell = interactive.instance()
    try:
        done = shell.run_cell("from grashof.problems import load_linkage_spec\nload_linkage_spec('pumpjack')")
        shown, _ = shell.display_formatter.format(done.result)
        assert shown["text/html"] == load_linkage_spec("pumpjack")._repr_html_()
        assert shown["text/plain"].startswith("LinkageSpec(")
    finally:
        interactive.clear_instance()
