"""A problem with a cylinder from the command line, to list, page, drawings and analysis."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest
from command_runs import Grashof
from matplotlib.figure import Figure
from refusals import refusal
from typer.testing import CliRunner

from grashof.cli import app
from grashof.figures import plot_linkage
from grashof.figures.animation import animate
from grashof.problems import load_linkage_spec

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def searched(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("searched") / "out"
    options = ("--starts", "12", "--out", str(folder), "--top", "2")
    assert CliRunner().invoke(app, ["solve", "lifting-arm", *options]).exit_code == 0
    return folder


@pytest.fixture
def solved(searched: Path, tmp_path: Path) -> Path:
    return copytree(searched, tmp_path / "out")


def test_check_states_the_cylinder(grashof: Grashof) -> None:
    text = grashof("check", "lifting-arm").stdout
    assert "driven by a cylinder on driver or coupler or output; closed 300 to 700 mm" in text
    assert "rotatability any" in text


@pytest.mark.study
def test_lists_page_and_analysis_have_it(grashof: Grashof, solved: Path) -> None:
    with (solved / "candidates.csv").open(encoding="utf-8") as file:
        row = next(csv.DictReader(file))
    design = json.loads((solved / "candidates.json").read_text(encoding="utf-8"))["designs"][0]
    cylinder = design["cylinder"]
    assert [row["cylinder_on"], *(float(row[f"cylinder_base_{axis}"]) for axis in "xy")] == [
        cylinder["on"],
        *cylinder["base"],
    ]
    lengths = np.array(cylinder["length"])
    assert min(lengths) == pytest.approx(float(row["cylinder_closed"]), rel=1e-9)
    assert np.ptp(lengths) == pytest.approx(float(row["cylinder_stroke"]), rel=1e-9)
    assert (np.diff(lengths) > 0).all() or (np.diff(lengths) < 0).all()
    assert max(map(abs, cylinder["force"])) <= float(row["cylinder_force_max"]) * (1 + 1e-9)
    assert '"cylinder":' in (solved / "report.html").read_text(encoding="utf-8")

    name = f"{solved}/candidates.json#1"
    assert grashof("analyse", name, "--out", "about").exit_code == 0
    folder = solved.parent / "about"
    rows = list(csv.DictReader((folder / "table-cylinder.csv").read_text(encoding="utf-8").splitlines()))
    found = {key: np.array([float(each[key]) for each in rows]) for key in rows[0]}
    slope = np.gradient(found["length"], np.radians(found["theta2_deg"]))
    np.testing.assert_allclose(found["rate"][1:-1], slope[1:-1], rtol=2e-3)
    assert np.abs(found["output_rate"]).min() == pytest.approx(float(row["cylinder_rate_min"]), rel=1e-3)
    assert np.abs(found["output_rate"]).max() <= float(row["cylinder_rate_max"]) * (1 + 1e-9)
    assert found["angle_deg"].min() == pytest.approx(float(row["cylinder_angle_min_deg"]), abs=0.01)
    assert np.abs(found["force"]).max() <= float(row["cylinder_force_max"]) * (1 + 1e-9)
    targets = (folder / "table-cylinder-at-targets.csv").read_text(encoding="utf-8").splitlines()
    assert len(targets) == 5
    assert '"cylinder":' in (folder / "analysis.html").read_text(encoding="utf-8")


def test_drawings_show_body_and_rod_where_they_are(solved: Path) -> None:
    spec = load_linkage_spec(f"{solved}/candidates.json#1")
    assert spec.cylinder is not None
    axes = plot_linkage(spec, ax=Figure().subplots())
    (body,) = (line for line in axes.lines if line.get_label() == "cylinder")
    np.testing.assert_allclose(np.asarray(body.get_xydata())[0], spec.cylinder.base)
    moving = animate(spec, seconds=1, fps=10, ax=Figure().subplots())
    moving._draw_was_started = True  # else matplotlib warns that it was never seen
    first, later = (
        [np.array(artist.get_xydata()) for artist in moving._func(k) if hasattr(artist, "get_xydata")]  # type: ignore[attr-defined]
        for k in (0, 3)
    )
    assert any(np.allclose(a[0], spec.cylinder.base) and len(a) == 2 for a in later)
    assert len(first) == len(later)


def test_a_list_that_was_damaged_is_refused_in_a_line(solved: Path) -> None:
    path = solved / "candidates.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    for damaged, words in (
        ({"on": "ground", "base": [0, 0], "point": [1, 1]}, "cylinder.on is 'ground'; it must be one of"),
        ({"on": "driver", "base": [0], "point": [1, 1]}, "cylinder.base has 1 entry; it must have 2 numbers"),
        ({"on": "driver"}, "cylinder is"),
        (["driver"], "cylinder is"),
    ):
        content["designs"][0]["cylinder"] = damaged
        path.write_text(json.dumps(content), encoding="utf-8")
        (line,) = refusal(load_linkage_spec, f"{path}#1").splitlines()
        assert words in line
