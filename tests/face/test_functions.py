"""Functions from the command line: list, page, drawings, analysis."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from grashof import load
from grashof.figures import plot_task
from grashof.problems import catalogue, load_linkage_spec
from grashof.sections.output import function_section
from grashof.study.asked import Asked
from grashof.study.study import LinkageStudy

Grashof = Callable[..., Any]
EXAMPLES = ("function-five-pairs", "function-log10", "function-sin", "function-dosing-slide")


@pytest.mark.slow
def test_a_function_is_solved_and_analysed(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("solve", "function-five-pairs", "--drawings", "1")
    assert done.exit_code == 0, done.output
    assert "structural error from" in done.output
    folder = tmp_path / "function-five-pairs-designs"
    table = pd.read_csv(folder / "candidates.csv")
    assert table[["error", "error_max", "error_rms", "error_sse"]].isna().all(axis=None)
    assert (table["structural_error_max_deg"] >= table["structural_error_rms_deg"]).all()
    assert table["structural_error_at_deg"].between(0, 90).all()
    designs = json.loads((folder / "candidates.json").read_text())["designs"]
    assert max(max(design["output_error"]) for design in designs) < 1e-6
    assert (folder / "design-01.png").stat().st_size > 10_000
    page = (folder / "report.html").read_text()
    for word in ("output rotation", "Structural error", "generated"):
        assert word in page
    spec = load_linkage_spec(f"{folder / 'candidates.json'}#1")
    section = function_section(LinkageStudy.of(spec, Asked()))
    assert section is not None
    assert {plot.key for plot in section.plots} == {"function-output", "structural-error"}
    assert section.tables["function"]["error_deg"].abs().max() < 1e-6
    worst = next(fact.value for fact in section.facts if fact.key == "structural_error_max_deg")
    assert worst == pytest.approx(table["structural_error_max_deg"][0])
    done = grashof("analyse", f"{folder / 'candidates.json'}#1")
    assert done.exit_code == 0, done.output


@pytest.mark.study
def test_a_slide_is_told_in_its_unit_of_length(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("solve", "function-dosing-slide", "--drawings", "1")
    assert done.exit_code == 0, done.output
    assert " mm. Lengths in mm" in done.output
    folder = tmp_path / "function-dosing-slide-designs"
    table = pd.read_csv(folder / "candidates.csv")
    assert table[["structural_error_max_deg", "structural_error_rms_deg"]].isna().all(axis=None)
    assert (table["structural_error_max"] >= table["structural_error_rms"]).all()
    assert table["structural_error_at_deg"].between(0, 120).all()
    page = (folder / "report.html").read_text()
    assert '"title":"travel of the slide","unit":"mm"' in page.replace(": ", ":").replace(", ", ",")
    spec = load_linkage_spec(f"{folder / 'candidates.json'}#1")
    section = function_section(LinkageStudy.of(spec, Asked()))
    assert section is not None
    assert {plot.unit for plot in section.plots} == {"mm"}
    pairs = section.tables["function"]
    assert (pairs["generated"] - pairs["wanted"] - pairs["error"]).abs().max() < 1e-9
    facts = {fact.key: fact.value for fact in section.facts}
    assert facts["structural_error_max"] == pytest.approx(table["structural_error_max"][0])
    assert pairs["error"].abs().max() == pytest.approx(facts["structural_error_max"], rel=1e-3)


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_catalogue_has_functions(grashof: Grashof, name: str) -> None:
    assert name in catalogue()
    done = grashof("check", name)
    assert done.exit_code == 0, done.output
    assert "coupler arm" not in done.output
    assert plot_task(load(name)).get_xlabel() == "driver rotation from the first pair (deg)"
