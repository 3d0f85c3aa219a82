"""The log of a run: where it goes, and what it may not do."""

from __future__ import annotations

import json
import logging
import re
import sys
from pathlib import Path

import pytest
from command_runs import Grashof

FEW = ("solve", "luggage", "--starts", "4", "--drawings", "0")
LINE = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z (DEBUG|INFO|WARNING) grashof\.[\w.]+: \S.*")


@pytest.mark.slow
def test_a_log_in_the_folder_of_the_run_is_added_to(grashof: Grashof, tmp_path: Path) -> None:
    log = tmp_path / "luggage-designs" / "run.log"
    assert grashof(*FEW, "--log", log).exit_code == 0
    first = log.read_text().splitlines()
    assert all(LINE.fullmatch(line) for line in first)
    assert sum(": start " in line for line in first) == 4
    assert grashof(*FEW, "--log", log).exit_code == 0
    assert log.read_text().splitlines()[: len(first)] == first
    assert len(log.read_text().splitlines()) == 2 * len(first)
    assert "run.log" not in json.loads((log.parent / "run.json").read_text())["files"]


@pytest.mark.slow
def test_a_run_without_a_log_logs_nothing_and_changes_no_level(grashof: Grashof, tmp_path: Path) -> None:
    logger = logging.getLogger("grashof")
    before = logger.level, list(logger.handlers)
    assert any(isinstance(each, logging.NullHandler) for each in logger.handlers)
    grashof(*FEW, "--log", "run.log")
    assert (logger.level, logger.handlers) == before
    done = grashof(*FEW)
    assert ": start " not in done.output
    assert "grashof.synth" not in done.output


REFUSED = {
    ".": "Is a directory; it must be a file that can be written",
    "nowhere/run.log": "No such file or directory; it must be a file that can be written",
    "luggage-designs/run.json": "the run writes this file itself; name another one",
    "luggage-designs/../luggage-designs/design-03.png": "the run writes this file itself; name another one",
    "luggage-designs/search/search.json": "the run writes this file itself; name another one",
    "luggage-designs/search/000001.json": "the run writes this file itself; name another one",
    "mine.toml": "is a problem file by its name; name another one",
}


@pytest.mark.parametrize("log", REFUSED)
def test_a_log_that_cannot_be_is_refused(grashof: Grashof, tmp_path: Path, log: str) -> None:
    done = grashof(*FEW, "--log", log)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == f"grashof: --log {Path(log)}: {REFUSED[log]}\n"
    assert not (tmp_path / "luggage-designs").exists()


@pytest.mark.slow
@pytest.mark.quick("shards/0001-of-0002/search.json")
@pytest.mark.parametrize("name", ["candidates.csv", "shards/0001-of-0002/search.json", "link"])
def test_the_log_of_a_shard_harms_no_file_of_the_search(grashof: Grashof, tmp_path: Path, name: str) -> None:
    shard = (*FEW, "--shard", "1/2", "--out", "out")
    assert grashof(*shard, "--log", "run.log").exit_code == 0
    own = tmp_path / "out" / "shards" / "0001-of-0002"
    (tmp_path / "out" / "link").symlink_to(own / "000001.json")
    before = {path.name: path.read_bytes() for path in own.iterdir()}
    done = grashof(*shard, "--log", f"out/{name}")
    assert done.exit_code == 2
    assert (
        done.stderr
        == f"grashof: --log {Path('out') / name}: the run writes this file itself; name another one\n"
    )
    assert {path.name: path.read_bytes() for path in own.iterdir()} == before
    assert not (tmp_path / "out" / "candidates.csv").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="needs /dev/full")
def test_a_full_disk_costs_the_log_alone(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof(*FEW, "--log", "/dev/full")
    assert done.exit_code == 0
    assert done.stderr.count("--log /dev/full: No space left on device; the log is incomplete\n") == 1
    assert (tmp_path / "luggage-designs" / "candidates.csv").exists()
