"""Shards and their merging at the command line."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from command_runs import COMMAND, Grashof

from grashof.output.folder import in_use

ROOT = Path(__file__).parents[3]


def which(program: str) -> str:
    found = shutil.which(program, path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    assert found is not None
    return found


def shard(number: int, of: int, out: str, *options: str) -> list[str]:
    return ["solve", "luggage", "--starts", "32", "--shard", f"{number}/{of}", "--out", out, *options]


@pytest.mark.slow
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


@pytest.mark.study
def test_shards_that_cannot_be_merged_are_refused_in_one_line(grashof: Grashof, tmp_path: Path) -> None:
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


def test_merging_of_shards_none_of_which_is_done_searches_for_nothing(
    grashof: Grashof, tmp_path: Path
) -> None:
    assert grashof(*shard(1, 2, "out", "--time-limit", "1e-6")).exit_code == 1
    done = grashof("merge", "out", "--partial")
    assert (done.exit_code, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line == "grashof: out: none of its shards is done; the command that began one continues it"
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["shards"]


@pytest.mark.skipif(sys.platform == "win32", reason="links need leave there")
@pytest.mark.parametrize("there", [True, False])
def test_a_shard_does_not_follow_a_link_in_the_place_of_its_folder(
    grashof: Grashof, tmp_path: Path, *, there: bool
) -> None:
    elsewhere, shards = tmp_path / "elsewhere", tmp_path / "out" / "shards"
    shards.mkdir(parents=True)
    (shards / "0001-of-0001").symlink_to(elsewhere)
    if there:
        elsewhere.mkdir()
        (elsewhere / "problem.toml").write_text("mine", encoding="utf-8")
    done = grashof(*shard(1, 1, "out"))
    assert done.exit_code == 2
    assert done.stderr == "grashof: --out out/shards/0001-of-0001: is a link; it must be a folder\n"
    assert elsewhere.exists() is there
    if there:
        assert [path.read_text(encoding="utf-8") for path in elsewhere.iterdir()] == ["mine"]


@pytest.mark.study
@pytest.mark.skipif(sys.platform == "win32", reason="no limits of files there")
def test_a_full_disk_costs_no_shard(grashof: Grashof, tmp_path: Path) -> None:
    import resource

    own = tmp_path / "out" / "shards" / "0001-of-0001"
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, before[1]))  # bytes: a head fits, chunks do not
    try:
        done = grashof(*shard(1, 1, "out"))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert done.exit_code == 3
    assert done.stderr.splitlines()[-1].endswith("File too large: 'out/shards/0001-of-0001/000001.json'")
    assert sorted(path.name for path in own.iterdir()) == ["problem.toml", "search.json"]
    assert grashof(*shard(1, 1, "out")).exit_code == 0
    assert grashof("merge", "out", "--drawings", "0").exit_code == 0


@pytest.mark.study
@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
def test_the_same_command_continues_a_terminated_shard(tmp_path: Path) -> None:
    given = ["solve", "luggage", "--effort", "10", "--shard", "1/1", "--out", "out"]
    command = [*COMMAND, *given]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    process.stderr.readline()  # a chunk is done
    begun = time.monotonic()
    process.send_signal(signal.SIGTERM)
    said = process.stderr.read()
    assert process.wait(timeout=60) == 143
    assert time.monotonic() - begun < 6
    first = re.search(r"shard 1/1: (\d+) of 40 chunks.*; the same command continues it", said)
    assert first is not None
    process.stderr.close()
    again = subprocess.run([*command, "--time-limit", "1"], cwd=tmp_path, capture_output=True, text=True)
    assert again.returncode == 1
    second = re.search(r"shard 1/1: (\d+) of 40 chunks", again.stderr)
    assert second is not None
    assert int(second[1]) >= int(first[1]) > 0


@pytest.mark.study
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
