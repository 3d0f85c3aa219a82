"""Shards and their merging at the command line."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from grashof.output.folder import in_use

Grashof = Callable[..., Any]
ROOT = Path(__file__).parents[2]


def which(program: str) -> str:
    found = shutil.which(program, path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    assert found is not None
    return found


def shard(number: int, of: int, out: str, *options: str) -> list[str]:
    return ["solve", "luggage", "--starts", "32", "--shard", f"{number}/{of}", "--out", out, *options]


def test_shards_are_merged_into_the_files_of_a_search(grashof: Grashof, tmp_path: Path) -> None:
    for number in (1, 2):
        done = grashof(*shard(number, 2, "two"))
        assert done.exit_code == 0
        assert f"shard {number}/2: 2 of 2 chunks, 16 solves" in done.stderr.splitlines()[-1]
        assert done.stderr.splitlines()[-1].endswith("grashof merge two makes the list")
    merged = grashof("merge", "two", "--drawings", "1")
    assert merged.exit_code == 0
    assert "distinct verified crank-rocker design" in merged.stdout
    assert grashof(*shard(1, 1, "one")).exit_code == 0
    assert grashof("merge", "one", "--drawings", "0", "--top", "2").exit_code == 0
    two, one = ((tmp_path / name / "candidates.csv") for name in ("two", "one"))
    assert two.read_bytes() == one.read_bytes()
    assert sorted(path.name for path in (tmp_path / "two").iterdir()) == [
        *("candidates.csv", "candidates.json", "design-01.png", "design-01.svg"),
        *("report.html", "run.json", "shards"),
    ]
    assert '"shards": 2' in (tmp_path / "two" / "run.json").read_text(encoding="utf-8")


def test_what_cannot_be_merged_is_told_in_one_line(grashof: Grashof, tmp_path: Path) -> None:
    def said(*given: str) -> str:
        done = grashof(*given)
        assert done.exit_code == 2
        (line,) = done.stderr.splitlines()
        return str(line)

    assert "nowhere: has no shards; grashof solve PROBLEM --shard I/N --out nowhere" in said(
        "merge", "nowhere"
    )
    assert not (tmp_path / "nowhere").exists()
    assert "--shard is '3/2'; it must be I/N with I from 1 to N" in said(*shard(3, 2, "out"))
    assert "--top does not go with --shard" in said(*shard(1, 2, "out", "--top", "3"))
    assert not (tmp_path / "out").exists()
    assert grashof(*shard(1, 2, "out")).exit_code == 0
    assert "out: shard 2 of 2 to be done; --partial merges the others" in said("merge", "out")
    assert not (tmp_path / "out" / "candidates.csv").exists()
    assert "a search with starts 32; here it is 200" in said(
        "solve", "luggage", "--shard", "1/2", "--out", "out"
    )
    some = grashof("merge", "out", "--partial", "--drawings", "0")
    assert some.exit_code == 0
    assert "out: without shard 2 of 2" in some.stderr
    with in_use(tmp_path / "out" / "shards" / "0002-of-0002"):
        assert "another run uses it" in said(*shard(2, 2, "out"))
    assert grashof(*shard(2, 2, "out")).exit_code == 0


@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
def test_a_terminated_shard_goes_on_with_the_same_command(tmp_path: Path) -> None:
    program = "from grashof.cli import main; main()"
    given = ["solve", "luggage", "--effort", "10", "--shard", "1/1", "--out", "out"]
    command = [sys.executable, "-c", program, *given]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    process.stderr.readline()  # a chunk is done
    begun = time.monotonic()
    process.send_signal(signal.SIGTERM)
    said = process.stderr.read()
    assert process.wait(timeout=60) == 143
    assert time.monotonic() - begun < 6
    first = re.search(r"shard 1/1: (\d+) of 40 chunks.*; the same command goes on with it", said)
    assert first is not None
    process.stderr.close()
    again = subprocess.run([*command, "--time-limit", "1"], cwd=tmp_path, capture_output=True, text=True)
    assert again.returncode == 1
    second = re.search(r"shard 1/1: (\d+) of 40 chunks", again.stderr)
    assert second is not None
    assert int(second[1]) >= int(first[1]) > 0


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="a script for a shell")
def test_the_batch_script_of_the_documentation_works(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "shards.sh").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 10
    small = text.replace("--effort 100", "--effort 0.5").replace("mine.toml", "luggage")
    assert small != text
    (tmp_path / "shards.sh").write_text(small, encoding="utf-8")
    here = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    for task in ("1", "2"):
        numbered = {"SLURM_ARRAY_TASK_ID": task, "SLURM_ARRAY_TASK_COUNT": "2", "SLURM_CPUS_PER_TASK": "1"}
        subprocess.run([which("bash"), "shards.sh"], cwd=tmp_path, env={**here, **numbered}, check=True)
    subprocess.run([which("grashof"), "merge", "found"], cwd=tmp_path, check=True)
    assert len(pd.read_csv(tmp_path / "found" / "candidates.csv")) > 0
