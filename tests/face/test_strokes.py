"""Strokes on the command line: what is asked, listed, drawn, analysed and refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

Grashof = Callable[..., Any]
STROKE = 'kind = "stroke"\n[stroke]\nswing_deg = {}\ntime_ratio = {}\n'


@pytest.fixture
def stroke(tmp_path: Path) -> Callable[[float, float], str]:
    """A file that asks for a stroke."""

    def stated(swing_deg: float, time_ratio: float) -> str:
        path = tmp_path / "stroke.toml"
        path.write_text(STROKE.format(swing_deg, time_ratio))
        return str(path)

    return stated


@pytest.mark.slow
def test_check_tells_what_is_asked(grashof: Grashof) -> None:
    done = grashof("check", "quick-return")
    assert done.exit_code == 0, done.output
    assert "swing 80 deg, time ratio 1.11111, place and scale free; met within 1e-06" in done.output
    assert "r1: 120 mm" in done.output


@pytest.mark.slow
def test_solve_lists_draws_and_analyses(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("solve", "quick-return", "--drawings", "1")
    assert done.exit_code == 0, done.output
    assert "position error" not in done.output
    assert "37.7 deg at best" in done.output
    folder = tmp_path / "quick-return-designs"
    table = pd.read_csv(folder / "candidates.csv")
    assert table["r2"][0] == pytest.approx(46.67, abs=0.005)
    assert table["output_swing_deg"].to_numpy() == pytest.approx(80)
    assert table["time_ratio"].to_numpy() == pytest.approx(10 / 9)
    page = (folder / "report.html").read_text()
    assert "six-bar" in page
    assert "body at the poses" not in page
    designs = json.loads((folder / "candidates.json").read_text())["designs"]
    assert designs[0]["theta2"] == pytest.approx([0.434062, 3.741002], abs=1e-6)
    done = grashof("analyse", f"{folder / 'candidates.json'}#1")
    assert done.exit_code == 0, done.output
    assert "swing of the output" in done.output


@pytest.mark.parametrize(
    ("swing", "ratio", "line"),
    [
        (200, 1.1, "stroke.swing_deg is 200; it must be from 0.0573 to less than 180, as a rocker swings"),
        (80, 0.9, "stroke.time_ratio is 0.9; it must be at least 1, the slow stroke over the quick one"),
        (80, 9, "stroke.time_ratio is 9; it must be less than 6.2 for a crank-rocker that swings by 80 deg"),
    ],
)
def test_what_no_linkage_does_is_refused_in_a_line(
    grashof: Grashof, stroke: Callable[[float, float], str], swing: float, ratio: float, line: str
) -> None:
    done = grashof("check", stroke(swing, ratio))
    assert done.exit_code == 2
    assert line in done.output.replace("\n", " ")
    assert "Traceback" not in done.output


@pytest.mark.slow
def test_an_empty_list_is_explained(grashof: Grashof, stroke: Callable[[float, float], str]) -> None:
    path = Path(stroke(80, 1.1))
    path.write_text(path.read_text() + "[requirements]\ntransmission_min_deg = 50\n")
    done = grashof("solve", str(path), "--drawings", "0")
    assert done.exit_code == 1
    assert "transmission_min_deg 38.3 instead of 50" in done.output
