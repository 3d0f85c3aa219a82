"""Text of a file stays text wherever it is written: no formula, no tag, no place outside the folder."""

# ruff: noqa: S314

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree as ET

import ezdxf
import numpy as np
import openpyxl
import pandas as pd
import pytest
from command_runs import Grashof
from page_parts import Parts

from grashof.figures.animation import save_animation
from grashof.figures.files import draw_design, draw_motion, save
from grashof.figures.section_plots import section_pictures
from grashof.notebook import html
from grashof.output.analysis_files import print_report, write_report
from grashof.output.run_files import write_run
from grashof.problems import FourBar, LinkageSpec
from grashof.survey import Fact, Plot, Section, report_on
from grashof.synth import Result
from grashof.workshop import plan_parts, write_dxf, write_svg
from grashof.workshop.plates import PlateSizes
from grashof.workshop.workbook import workbook

SCRIPT = "</script></title><script>alert(1)</script><img src=x onerror=alert(1)>"
TEXTS = [
    "=1+1",
    " =HYPERLINK(A1)",
    "mm;=1+1",
    '";=1+1',
    SCRIPT,
    "&lt;b&gt;{{ 7 * 7 }}{% raw %}",
    r"$\frac{1}{",
    "]]>--><![CDATA[",
    "%%c\\P{\\fArial;x}",
]
FORMULA = re.compile(r"\s*[=+\-@＝＋－＠]")
CRANK_ROCKER = FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1))


@pytest.fixture(params=TEXTS)
def spec(request: pytest.FixtureRequest) -> LinkageSpec:
    """A linkage with this text wherever a file may have one."""
    text = request.param
    return LinkageSpec(CRANK_ROCKER, text, text, text, text)


@pytest.fixture
def result(few: Result, spec: LinkageSpec) -> Result:
    text = spec.title
    problem = replace(few.problem, name=text, title=text, source=text, length_unit=text, dynamics=None)
    return replace(
        few, problem=problem, candidates=few.candidates[:2], nearest=few.candidates[2:4], note=text
    )


def cells(folder: Path) -> Iterator[str]:
    """Every text of every table in a folder, as spreadsheets divide its lines: at commas or semicolons."""
    for path in folder.glob("*.csv"):
        for divider in ",;":
            with path.open(encoding="utf-8", newline="") as file:
                for row in csv.reader(file, delimiter=divider):
                    yield from row


def assert_no_formulas(folder: Path) -> None:
    for cell in cells(folder):
        if FORMULA.match(cell):
            float(cell.split(",")[0])  # a number below zero


def assert_plain_page(page: str, scripts: int) -> None:
    parts = Parts(page)
    assert parts.names.count("script") == scripts
    assert not {"img", "iframe", "object", "b"} & set(parts.names)
    assert not [name for _, given in parts.tags for name in given if name.startswith("on")]


@pytest.mark.quick("=1+1", "mm;=1+1", '";=1+1', "]]>--><![CDATA[")
def test_a_run(result: Result, tmp_path: Path) -> None:
    write_run(tmp_path / "out", result, {}, drawings=0, problem_text=result.problem.title)
    assert {path.name for path in tmp_path.iterdir()} == {"out"}
    assert_no_formulas(tmp_path / "out")
    assert_plain_page((tmp_path / "out" / "report.html").read_text(encoding="utf-8"), 2)


@pytest.mark.quick("mm;=1+1")
def test_an_analysis(
    spec: LinkageSpec, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text, theta2 = spec.title, np.arange(361.0)
    plot = Plot("curve", text, text, {text: theta2}, theta2, text, {text: np.ones((1, 2))})
    table = pd.DataFrame({"theta2_deg": [0.0, 1.0], text: [text, text]})
    section = Section("mine", text, (Fact("mine", text, text, text),), {"mine": table}, (plot,), (text,))
    monkeypatch.setattr("grashof.figures.section_plots.plots", lambda _: [])  # they have a test of their own
    report = report_on(spec)
    report = replace(report, sections=(*report.sections, section))
    write_report(tmp_path / "out", report)
    (picture,) = section_pictures(replace(report, sections=(section,)))
    save(picture[1], [tmp_path / "out" / "plot-curve.svg"])
    assert {path.name for path in tmp_path.iterdir()} == {"out"}
    assert_no_formulas(tmp_path / "out")
    assert_plain_page((tmp_path / "out" / "analysis.html").read_text(encoding="utf-8"), 2)
    tags = {str(one.tag).rpartition("}")[2] for one in ET.parse(tmp_path / "out" / "plot-curve.svg").iter()}
    assert not {"script", "image", "img"} & tags
    print_report(report)
    assert text in capsys.readouterr().out


@pytest.mark.quick("]]>--><![CDATA[", "=1+1", " =HYPERLINK(A1)")
def test_a_workbook(spec: LinkageSpec) -> None:
    book = openpyxl.load_workbook(BytesIO(workbook([spec])))
    for page in book:
        for row in page.iter_rows():
            for cell in row:
                assert cell.data_type != "f"
                assert cell.hyperlink is None
                assert not isinstance(cell.value, str) or not FORMULA.match(cell.value) or cell.quotePrefix


@pytest.mark.quick("]]>--><![CDATA[")
def test_drawings_of_the_parts(spec: LinkageSpec, tmp_path: Path) -> None:
    plan = plan_parts(spec.linkage, PlateSizes(), 50.0)
    tags = []
    for title, name in (("plain", "plain"), (spec.title, "mine")):
        write_dxf(tmp_path / f"{name}.dxf", plan, title)
        write_svg(tmp_path / f"{name}.svg", plan, title)
        tags.append([one.tag for one in ET.parse(tmp_path / f"{name}.svg").iter()])
    assert tags[0] == tags[1]
    plain, mine = (ezdxf.readfile(tmp_path / f"{name}.dxf") for name in ("plain", "mine"))
    assert [one.dxftype() for one in mine.modelspace()] == [one.dxftype() for one in plain.modelspace()]
    assert {layer.dxf.name for layer in mine.layers} == {layer.dxf.name for layer in plain.layers}
    assert not mine.audit().has_errors


@pytest.mark.quick("$\\\\frac{1}{")
@pytest.mark.parametrize("text", [SCRIPT, r"$\frac{1}{"])
def test_pictures(few: Result, tmp_path: Path, text: str) -> None:
    problem = replace(few.problem, title=text, length_unit=text, dynamics=None)
    spec = LinkageSpec(CRANK_ROCKER, "x", text, text, text)
    save(draw_design(problem, few.candidates[0], 1), [tmp_path / "design.svg"])
    save_animation(draw_motion(spec, seconds=0.1), tmp_path / "motion.gif")
    tags = {str(one.tag).rpartition("}")[2] for one in ET.parse(tmp_path / "design.svg").iter()}
    assert not {"script", "image", "img"} & tags
    assert_plain_page(html(spec), 0)


@pytest.mark.quick("..")
@pytest.mark.parametrize("name", ["..", "<script>", "~"])
def test_a_file_name_stays_in_the_folder(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr("grashof.figures.section_plots.plots", lambda _: [])
    file = f"{name}.toml"
    (tmp_path / file).write_text("o4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\n", encoding="utf-8")
    done = grashof("analyse", f"./{file}")
    assert done.exit_code == 0, done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {file, f"{name}-analysis"}
    assert_plain_page((tmp_path / f"{name}-analysis" / "analysis.html").read_text(encoding="utf-8"), 2)
