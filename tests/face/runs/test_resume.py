"""Runs that are killed, interrupted or ended, and resumed."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from command_runs import Grashof

from grashof.output.folder import in_use

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")

FOUR = ("solve", "luggage", "--starts", "4", "--drawings", "0")
# Some seconds of search: a drawn curve, fitted by crank-rockers.
LONG = """
kind = "path"
[path]
points = [[0, 0], [1, 2], [3, 3], [5, 2.5], [6, 1], [7, -1], [5, -2], [3, -2.2], [1, -1.5], [-0.4, -0.3]]
[requirements]
transmission_min_deg = 25
"""


def running(folder: Path, *options: str) -> subprocess.Popen[str]:
    (folder / "long.toml").write_text(LONG, encoding="utf-8")
    # Each step in a file of its own, as if it had taken two seconds.
    program = (
        "import grashof.synth.search.journal as journal; journal.EVERY = 0.0; "
        "from grashof.cli import main; main()"
    )
    given = ["solve", "long.toml", "--drawings", "0", "--out", "out", *options]
    command = [sys.executable, "-c", program, *given]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def finished(folder: Path, *options: str) -> bytes:
    process = running(folder, *options)
    _, said = process.communicate(timeout=240)
    assert process.returncode == 0, said
    return (folder / "out" / "candidates.csv").read_bytes()


def killed_and_resumed(folder: Path, moments: list[float]) -> bytes:
    for number, moment in enumerate(moments):
        process = running(folder, *(["--resume"] if number else []))
        try:
            process.wait(timeout=moment)
        except subprocess.TimeoutExpired:
            process.kill()
        process.communicate()
    return finished(folder, "--resume")


@pytest.mark.study
@pytest.mark.parametrize("moments", [2, pytest.param(20, marks=pytest.mark.study)])
def test_a_run_that_was_killed_goes_on_to_the_same_list(tmp_path: Path, moments: int) -> None:
    once, killed = tmp_path / "once", tmp_path / "killed"
    once.mkdir()
    killed.mkdir()
    begun = time.monotonic()
    table = finished(once)
    seconds = time.monotonic() - begun
    at = (np.random.default_rng(moments).uniform(0.3, 1.0, moments) * seconds).tolist()
    assert killed_and_resumed(killed, at) == table
    assert sorted(path.name for path in (killed / "out").iterdir()) == [
        *("candidates.csv", "candidates.json", "report.html", "run.json")
    ]


SIGNALS = [(signal.SIGINT, 130, "interrupted", 0), (signal.SIGTERM, 143, "terminated", 1)]


@pytest.mark.slow
@pytest.mark.parametrize(("number", "code", "ending", "drawings"), SIGNALS)
def test_a_signal_ends_the_search_and_writes_its_designs(
    tmp_path: Path, number: int, code: int, ending: str, drawings: int
) -> None:
    process = running(tmp_path, "--drawings", str(drawings))
    out = tmp_path / "out"
    while len(list((out / "search").glob("0*.json"))) < 2:
        time.sleep(0.05)
    begun = time.monotonic()
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == code
    assert time.monotonic() - begun < 6  # of which 2 are the search's; machines are busy
    assert "--resume continues it" in said
    left_out = "drawings are left out: SIGTERM came before 1 of them were made"  # of those requested
    assert [line for line in said.splitlines() if "left out" in line] == [left_out] * drawings
    record = json.loads((out / "run.json").read_text())
    assert (record["complete"], record["run"]["ending"]) == (False, ending)
    assert record["run"]["why_left_out"] == ending * drawings
    assert len(pd.read_csv(out / "candidates.csv")) > 0
    assert (out / "search" / "search.json").exists()


def test_a_record_that_is_not_resumed_is_kept(
    grashof: Grashof, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    record = tmp_path / "luggage-designs" / "search"
    record.mkdir(parents=True)
    (record / "search.json").write_text("{}", encoding="utf-8")
    refused = grashof(*FOUR, "--resume")
    assert refused.exit_code == 2
    assert "search.json: is not the record of a search" in refused.stderr
    request.getfixturevalue("found_at_once")
    done = grashof(*FOUR)
    assert done.exit_code == 0
    assert "the record of an unfinished search is kept as search-old" in done.stderr
    assert (tmp_path / "luggage-designs" / "search-old" / "search.json").read_text() == "{}"


@pytest.mark.usefixtures("found_at_once")
@pytest.mark.parametrize("place", ["search", "search-old"])
def test_files_of_others_beside_a_record_are_never_deleted(
    grashof: Grashof, tmp_path: Path, place: str
) -> None:
    folder = tmp_path / "luggage-designs"
    for name in ("search", "search-old"):
        (folder / name).mkdir(parents=True)
        (folder / name / "search.json").write_text("{}", encoding="utf-8")
    (folder / place / "2026.json").write_text("mine", encoding="utf-8")
    done = [grashof(*FOUR) for _ in range(2)]
    # The record moves with the files beside it, and is not replaced there.
    assert [each.exit_code for each in done] == ([0, 0] if place == "search" else [2, 2])
    if place == "search-old":
        (line,) = done[0].stderr.splitlines()
        assert line.endswith("search-old: is, or has, more than the record of a search; move it away")
    kept = folder / "search-old" / "2026.json"
    assert kept.read_text(encoding="utf-8") == "mine"


def test_a_file_named_search_is_refused(grashof: Grashof, tmp_path: Path) -> None:
    folder = tmp_path / "luggage-designs"
    folder.mkdir()
    (folder / "search").touch()
    done = grashof(*FOUR)
    assert done.exit_code == 2
    assert "search: is a file; the search is recorded in a folder of this name" in done.stderr
    assert [path.name for path in folder.iterdir()] == ["search"]


def test_a_run_has_its_folder_to_itself_and_removes_the_rest_of_a_killed_one(
    grashof: Grashof, tmp_path: Path
) -> None:
    folder = tmp_path / "luggage-designs"
    with in_use(folder):
        done = grashof(*FOUR)
    assert done.exit_code == 2
    assert done.stderr.splitlines()[-1].endswith("name another folder")
    left, mine = folder / ".writing-abc", folder / "search" / "notes"
    for path in (left / "candidates.csv", mine):
        path.parent.mkdir(parents=True)
        path.touch()
    done = grashof(*FOUR)
    assert done.exit_code == 0
    assert not left.exists()
    assert mine.exists()


@pytest.mark.usefixtures("found_at_once")
def test_without_a_record_a_resumed_search_begins_anew(grashof: Grashof) -> None:
    done = grashof(*FOUR, "--resume")
    assert done.exit_code == 0
    assert "has no record of a search; it begins anew" in done.stderr
