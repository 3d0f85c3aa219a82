"""Two outputs from one crank, from the file to the drawing of the parts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pandas as pd
import pytest
from command_runs import Grashof

from grashof.live.requests import Job, Line
from grashof.live.work import lines
from grashof.page.columns import columns_of
from grashof.problems import load, problem_text
from grashof.problems.files.on_disk import document_of
from grashof.sweep.keys import assigned, key_parts
from grashof.synth.designs.table import rows_of

NAME = "tandem-wiper"


def test_check_states_both_outputs(grashof: Grashof) -> None:
    done = grashof("check", NAME)
    assert done.exit_code == 0
    for line in (
        "  two outputs: swing 90 deg of link 4 and swing 85 deg of link 6, place and scale free; "
        "met within 1e-06 (rad, and as a share)",
        "  mechanism watt-2",
        "  place of D: x 560, y 0 mm",
        "  best: smallest output acceleration",
    ):
        assert line in done.output.splitlines()


@pytest.mark.slow
def test_from_the_file_to_the_drawing(grashof: Grashof) -> None:
    done = grashof("solve", NAME)
    assert done.exit_code == 0, done.output
    folder = Path(f"{NAME}-designs")
    table = pd.read_csv(folder / "candidates.csv")
    assert len(table) >= 10
    assert f"{len(table)} distinct verified watt-2 designs in " in done.output
    np.testing.assert_allclose(table[["swing_4_deg", "swing_6_deg"]], [[90, 85]] * len(table), atol=1e-4)
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "swing 90 deg of link 4 and swing 85 deg of link 6" in page
    header = next(line for line in done.output.splitlines() if "mu turn" in line)
    assert "output acceleration" in header
    for rank in (1, 2):
        design = f"{folder}/candidates.json#{rank}"
        done = grashof("export", design, "--dxf", "parts.dxf")
        assert done.exit_code == 0, done.output
        assert len(ezdxf.readfile("parts.dxf").modelspace().query("LWPOLYLINE[layer=='CUT']")) >= 5
        done = grashof("judge", design, NAME)
        assert "meets the requirements of tandem-wiper" in done.output
        assert "  swing of link 6: 85 deg" in done.output.splitlines()
    written = json.loads((folder / "candidates.json").read_text(encoding="utf-8"))
    assert written


def _done(what: str, document: dict[str, Any], shown: bytes = b"") -> tuple[list[dict[str, Any]], bytes]:
    """The lines of a job of the live page, and its designs."""
    found: list[Line] = []
    lines(Job(what, document, NAME, shown=shown), lambda: False, found.append)
    left = [line.shown for line in found if line.shown is not None]
    return [json.loads(line.text) for line in found], left[-1]


@pytest.mark.slow
def test_the_live_page_searches_and_follows() -> None:
    document = document_of(problem_text(NAME), NAME) | {"search": {"enough": 10}}
    said, shown = _done("search", document)
    assert said[-1]["kind"] == "done"
    assert any(len(each["designs"]) >= 10 for each in said if each["kind"] == "list")
    moved = assigned(document, key_parts("stroke[1].swing_deg"), 84)
    said, _ = _done("track", moved, shown)
    assert "error" not in {each["kind"] for each in said}
    (tracked,) = (each for each in said if each["kind"] == "list")
    assert len(tracked["designs"]) >= 8


def test_the_table_of_a_page_has_the_goal() -> None:
    problem = load(NAME)
    rows = [{"output_acceleration_max": 1.2, "swing_4_deg": 90.0, "full_rotation": True}]
    listed = {each.key: each.listed for each in columns_of(problem, rows)}
    assert listed == {"output_acceleration_max": True, "swing_4_deg": False}
    assert rows_of(problem, ()) == []
