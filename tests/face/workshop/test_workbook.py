"""The Excel workbook, opened again: the list is candidates.csv, the sheets are the designs."""

from __future__ import annotations

import csv
import json
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pandas as pd
import pytest
from command_runs import Grashof

from grashof.analysis import driver_ranges, solve_position, transmission_angle
from grashof.output.run_files import write_run
from grashof.problems import FourBar, LinkageSpec, ProblemError, load_linkage_spec
from grashof.problems.files.linkage_file import load_design
from grashof.synth import Result
from grashof.workshop import write_xlsx
from grashof.workshop.workbook import listed_candidates, workbook


@pytest.fixture
def designs(few: Result, tmp_path: Path) -> Path:
    """The files of a run."""
    write_run(tmp_path / "designs", few, {}, drawings=0)
    return tmp_path / "designs" / "candidates.json"


def facts(page: Any) -> dict[str, Any]:
    return {row[0].value: row[1].value for row in page.iter_rows(max_row=17, max_col=2)}


def same(value: Any, text: str) -> bool:
    """Whether a cell of the sheet says what one of the CSV file says, numbers to 16 digits."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(text) == pytest.approx(value, rel=1e-15, abs=0)
    return text == ("" if value is None else str(value))


def test_the_list_is_the_csv(designs: Path, grashof: Grashof) -> None:
    done = grashof("export", f"{designs}#1,3", "--xlsx", "list.xlsx")
    assert done.exit_code == 0, done.stderr
    book = openpyxl.load_workbook("list.xlsx")
    assert book.sheetnames == ["candidates", "design 1", "design 3"]
    page = book["candidates"]
    head, units, *rows = page.iter_rows(values_only=True)
    with designs.with_name("candidates.csv").open(newline="") as file:
        names, *expected = csv.reader(file)
    assert list(head) == names
    assert len(rows) == len(expected) > 3
    for row, texts in zip(rows, expected, strict=True):
        for value, text in zip(row, texts, strict=True):
            assert same(value, text), (value, text)
    assert page.freeze_panes == "C3"
    assert page.auto_filter.ref == f"A2:{page.cell(2, len(head)).column_letter}{len(rows) + 2}"
    unit = dict(zip(head, units, strict=True))
    assert (unit["r2"], unit["error_max"], unit["transmission_min_task_deg"]) == ("m", "m", "deg")
    assert not unit["rank"]
    shown = {name: page.cell(3, column).number_format for column, name in enumerate(head, start=1)}
    assert (shown["r2"], shown["transmission_min_task_deg"], shown["rank"]) == (
        "0.00000",
        "0.0000",
        "General",
    )
    assert {"mechanism", "family", "best_at"} <= set(head)
    assert page.column_dimensions["F"].width > len("grashof_class")


def test_a_design_has_its_targets_and_transmission(designs: Path, few: Result) -> None:
    design = load_design(designs, "2")
    book = openpyxl.load_workbook(BytesIO(workbook([design])))
    page = book["design 2"]
    candidate = few.candidates[1]
    found = facts(page)
    assert [found[f"r{i}"] for i in range(1, 5)] == pytest.approx(
        candidate.linkage.lengths.tolist(), rel=1e-15
    )
    assert found["title"] == "Luggage over a staircase: four poses: design 2"
    assert found["grashof_class"] == "crank-rocker"
    start = next(row for row in range(1, 40) if page.cell(row, 1).value == "target")
    state = solve_position(candidate.linkage, candidate.verdict.theta2)
    for i, expected in enumerate(np.column_stack([state.a, state.b, state.p])):
        row = [cell.value for cell in page[start + 1 + i][:11]]
        assert row[:3] == [i + 1, pytest.approx(np.degrees(candidate.verdict.theta2[i])), 1]
        assert row[3:9] == pytest.approx(expected.tolist(), rel=1e-12)
        assert row[9] == pytest.approx(candidate.verdict.position_error[i], abs=1e-12)
        assert row[10] == pytest.approx(0, abs=1e-9)
    table = [row for row in page.iter_rows(2, min_col=13, max_col=15, values_only=True) if row[0] is not None]
    angles, mu, _ = np.array(table).T
    np.testing.assert_allclose(mu, np.degrees(transmission_angle(candidate.linkage, np.radians(angles))))
    assert len(table) >= 361
    worst = np.degrees(candidate.verdict.transmission_min_cycle)
    assert min(row[2] for row in table) == pytest.approx(worst, abs=0.02)
    assert len(page._charts) == 1


def test_two_ranges_are_two_lines() -> None:
    linkage = FourBar((0, 0), (4, 0), 3, 1, 3)
    page = openpyxl.load_workbook(BytesIO(workbook([LinkageSpec(linkage, "rocker")])))["linkage"]
    angles = [row[0] for row in page.iter_rows(2, min_col=13, max_col=13, values_only=True)]
    while angles[-1] is None:
        angles.pop()
    assert angles.count(None) == 1
    ends = np.degrees(driver_ranges(linkage)).ravel()
    gap = angles.index(None)
    assert [angles[0], angles[gap - 1], angles[gap + 1], angles[-1]] == pytest.approx(ends.tolist())


@pytest.mark.parametrize("title", ["+cmd|' /C calc'!A0", "@SUM(A1)"])
def test_text_of_the_user_is_no_formula(title: str) -> None:
    spec = LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3), "one", title=title, source="=c")
    page = openpyxl.load_workbook(BytesIO(workbook([spec])))["linkage"]
    cell = page["B1"]
    assert (cell.value, cell.data_type, cell.quotePrefix) == (title, "s", True)
    assert (page["B2"].value, page["B2"].data_type) == ("=c", "s")


def test_the_same_bytes_every_time_and_none_of_the_clock(tmp_path: Path) -> None:
    spec = load_linkage_spec("pumpjack")
    write_xlsx(tmp_path / "one.xlsx", [spec])
    content = (tmp_path / "one.xlsx").read_bytes()
    assert content == workbook([spec])
    book = openpyxl.load_workbook(BytesIO(content))
    assert book.properties.modified == book.properties.created
    assert book.properties.created.year == 2000


def test_infinity_is_text_and_nan_an_empty_cell() -> None:
    frame = pd.DataFrame({"rank": [1], "id": ["d1"], "omega4_max": [np.inf], "torque_peak": [np.nan]})
    spec = LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3), "one")
    page = openpyxl.load_workbook(BytesIO(workbook([spec], frame)))["candidates"]
    assert [cell.value for cell in page[3]] == [1, "d1", "inf", None]


def test_a_list_beside_that_is_not_its_own(designs: Path) -> None:
    chosen = [load_design(designs, "1")]
    table = designs.with_name("candidates.csv")
    text = table.read_text()
    for broken, message in [
        (text.replace(chosen[0].id, "dother"), "does not list design 1 of candidates.json"),
        ("a,b\n1,2\n", "is not a table of designs"),
        ("", "does not list design 1"),
        ("rank,id\n1,d,2\n", "is not a table of designs"),
        (None, "cannot be read"),
    ]:
        table.unlink() if broken is None else table.write_text(broken)
        with pytest.raises(ProblemError, match=message):
            listed_candidates(designs, chosen)


def test_a_design_without_targets_is_refused(designs: Path) -> None:
    content = json.loads(designs.read_text())
    del content["designs"][0]["theta2"]
    designs.write_text(json.dumps(content))
    with pytest.raises(ProblemError, match="#1: states no targets"):
        load_design(designs, "1")
