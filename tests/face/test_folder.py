"""The output folder is written whole or not at all."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from grashof.folder import RECORD, check_writable, own_files, replacing_own_files
from grashof.problems import ProblemError


def write(folder: Path, *names: str) -> None:
    with replacing_own_files(folder) as fresh:
        for name in names:
            (fresh / name).write_text(f"new {name}")
        (fresh / RECORD).write_text(json.dumps({"files": [*names, RECORD]}))


def test_files_of_the_last_run_go_others_stay(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    write(tmp_path, "a", "b")
    write(tmp_path, "b", "c")
    assert {path.name for path in tmp_path.iterdir()} == {"b", "c", "mine", RECORD}
    assert own_files(tmp_path) == {"b", "c", RECORD}


def fail_halfway(folder: Path) -> None:
    with replacing_own_files(folder) as fresh:
        (fresh / "a").write_text("half")
        raise OSError("full")


def test_failure_leaves_everything_as_it_was(tmp_path: Path) -> None:
    write(tmp_path, "a")
    with pytest.raises(OSError, match="full"):
        fail_halfway(tmp_path)
    assert (tmp_path / "a").read_text() == "new a"
    assert {path.name for path in tmp_path.iterdir()} == {"a", RECORD}


@pytest.mark.parametrize(
    "record", ["", "[]", "{}", '{"files": 3}', '{"files": ["../x", "/x", 1, ""]}', "\x00"]
)
def test_a_strange_record_owns_nothing(tmp_path: Path, record: str) -> None:
    (tmp_path / RECORD).write_text(record)
    assert own_files(tmp_path) == set()
    write(tmp_path, "a")
    assert own_files(tmp_path) == {"a", RECORD}


def test_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ProblemError, match="--out"):
        check_writable(tmp_path / "file" / "below")
    check_writable(tmp_path / "new" / "deep")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
