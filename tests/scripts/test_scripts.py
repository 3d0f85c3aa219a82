"""The scripts run as a user would run them, and say the truth."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np
import pandas as pd
import pytest

from grashof import load, synthesize

SCRIPTS = Path(__file__).parents[2] / "scripts"


def run(script: str, *arguments: str, cwd: Path) -> str:
    """The output of a script in a process of its own."""
    command = [sys.executable, str(SCRIPTS / script), *arguments]
    return subprocess.run(command, cwd=cwd, check=True, capture_output=True, text=True).stdout


Script = Callable[[str], ModuleType]


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.slow
def test_luggage_states_the_shipped_problem(
    script: Script, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = partial(synthesize, starts=16, enough=16)
    monkeypatch.setattr(script("luggage"), "synthesize", few)
    assert script("luggage").main(["results"]) == 0
    said = capsys.readouterr().out
    table = pd.read_csv(tmp_path / "results" / "luggage.csv")
    shipped = few(load("luggage")).to_frame()
    np.testing.assert_array_equal(table[["r1", "r2", "r3", "r4"]], shipped[["r1", "r2", "r3", "r4"]])
    np.testing.assert_allclose(table["torque_peak"], shipped["torque_peak"], rtol=1e-12)
    assert f"{len(table)} designs" in said
    assert (tmp_path / "results" / "luggage-3.svg").exists()


@pytest.mark.study
def test_own_task_holds_its_own_constraints(tmp_path: Path) -> None:
    """In a process of its own, as a user runs it."""
    said = run("own_task.py", "mine.csv", cwd=tmp_path)
    table = pd.read_csv(tmp_path / "mine.csv")
    assert len(table) >= 10
    assert (np.abs(table["o2_y"] - table["o4_y"]) <= 0.1 + 1e-8).all()
    assert (table["r2"] <= table["r3"] / 3 + 1e-8).all()
    assert (table["transmission_min_task_deg"] >= 30 - 1e-6).all()
    assert table[["r1", "r2", "r3", "r4"]].min(axis=None) >= 0.2 - 1e-8
    assert table[["r1", "r2", "r3", "r4"]].max(axis=None) <= 10 + 1e-8
    assert (table["error_max"] < 1e-9).all()
    assert len(said.splitlines()) == 11  # a heading and the ten best
    # The poses again, from the numbers of the table alone: A and B stay on their circles.
    turn = np.radians([0, 20, 50])[:, None] - np.radians(table["body_angle_deg"].to_numpy())
    coupler, p = np.exp(1j * turn), np.array([0, 2 + 1j, 3 + 3j])[:, None]
    a = p - (table["p_u"] + 1j * table["p_v"]).to_numpy() * coupler
    b = a + table["r3"].to_numpy() * coupler
    for places, side, length in ((a, "o2", "r2"), (b, "o4", "r4")):
        pivot = (table[f"{side}_x"] + 1j * table[f"{side}_y"]).to_numpy()
        np.testing.assert_allclose(np.abs(places - pivot), np.tile(table[length], (3, 1)), atol=1e-9)


def test_an_analysis_module_beside_the_script_does_no_harm(tmp_path: Path) -> None:
    (tmp_path / "analysis.py").write_text("raise RuntimeError('not this one')\n")
    (tmp_path / "mine.py").write_text(
        "from importlib.util import find_spec\nprint(find_spec('grashof.analysis').origin)\n"
    )
    done = subprocess.run(
        [sys.executable, "mine.py"], cwd=tmp_path, check=True, capture_output=True, text=True
    )
    assert done.stdout.strip() == import_module("grashof.analysis").__file__


@pytest.mark.study
def test_pictures_of_the_pages_are_made(
    script: Script, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pictures = script("pictures")
    a_moment = partial(pictures.draw_motion, seconds=0.4)
    study = replace(pictures.load_study(pictures.DOCS / "longer-links.toml"), vary={"search.starts": [2, 4]})
    monkeypatch.setattr(pictures, "load_study", lambda _: study)
    monkeypatch.setattr(pictures, "draw_motion", lambda design, problem, **_: a_moment(design, problem))
    assert pictures.main(["made"]) == 0
    made = {path.name for path in (tmp_path / "made").glob("*.*")}
    assert (tmp_path / "made" / "tutorials" / "gripper.png").stat().st_size > 10_000
    pages = [path.read_text(encoding="utf-8") for path in (SCRIPTS.parent / "docs").glob("*/*.md")]
    shown = {name for page in pages for name in re.findall(r"\]\(\.\./([\w.-]+)\)", page)}
    assert {"luggage.png", "luggage.gif", "design-space.png"} < made <= shown
    assert (SCRIPTS.parent / "docs" / "luggage.gif").stat().st_size < 600_000


@pytest.mark.study
@pytest.mark.skipif(
    not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))),
    reason="no Chromium on this machine: the picture of the page is not made",
)
def test_picture_of_the_page_is_made(tmp_path: Path) -> None:
    run("report_picture.py", "docs/report.png", cwd=tmp_path)  # Playwright allows one event loop a process
    assert (tmp_path / "docs" / "report.png").read_bytes().startswith(b"\x89PNG")
