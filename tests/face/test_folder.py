"""The output folder is written whole or not at all."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from grashof.output.folder import ANALYSIS_RECORD, RECORD, check_writable, own_files, replacing_own_files
from grashof.problems import ProblemError, load_linkage

CSV = "candidates.csv"


def write(folder: Path, *names: str) -> None:
    with replacing_own_files(folder) as fresh:
        for name in names:
            (fresh / name).write_text(f"new {name}")
        (fresh / RECORD).write_text(json.dumps({"versions": {"grashof": "0"}, "files": [*names, RECORD]}))


def test_files_of_the_last_run_go_others_stay(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    write(tmp_path, CSV, "design-01.png")
    write(tmp_path, "design-01.png", "design-02.svg")
    assert {path.name for path in tmp_path.iterdir()} == {"design-01.png", "design-02.svg", "mine", RECORD}
    assert own_files(tmp_path) == {"design-01.png", "design-02.svg", RECORD}


def test_files_to_keep_stay(tmp_path: Path) -> None:
    write(tmp_path, CSV, "design-01.png")
    with replacing_own_files(tmp_path, keep=[CSV]) as fresh:
        (fresh / "design-02.png").touch()
    assert {path.name for path in tmp_path.iterdir()} == {CSV, "design-02.png"}


def fail_halfway(folder: Path) -> None:
    with replacing_own_files(folder) as fresh:
        (fresh / CSV).write_text("half")
        raise OSError("full")


def test_failure_leaves_everything_as_it_was(tmp_path: Path) -> None:
    write(tmp_path, CSV)
    with pytest.raises(OSError, match="full"):
        fail_halfway(tmp_path)
    assert (tmp_path / CSV).read_text() == f"new {CSV}"
    assert {path.name for path in tmp_path.iterdir()} == {CSV, RECORD}


def test_failure_leaves_no_new_folder(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="full"):
        fail_halfway(tmp_path / "new" / "deep")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "record",
    [
        "",
        "[]",
        "{}",
        "\x00",
        "[" * 100_000,
        '{"files": ["candidates.csv"]}',
        '{"versions": "grashof", "files": ["candidates.csv"]}',
        '{"versions": {"other": "1"}, "files": ["candidates.csv"]}',
        '{"versions": {"grashof": "0"}, "files": 3}',
        '{"versions": {"grashof": "0"}, "files": ["../x", "/x", 1, "", "mine", "design-1.gif"]}',
    ],
)
def test_a_strange_record_owns_nothing_and_is_refused(tmp_path: Path, record: str) -> None:
    (tmp_path / RECORD).write_text(record)
    (tmp_path / "mine").touch()
    assert own_files(tmp_path) == set()
    with pytest.raises(ProblemError, match=r"run\.json in it is not Grashof's own"):
        check_writable(tmp_path)
    assert (tmp_path / RECORD).read_text() == record


@pytest.mark.parametrize("name", [CSV, "nearest.csv", RECORD, "design-02.svg"])
def test_a_name_that_is_taken_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / name).mkdir()
    with pytest.raises(ProblemError, match=name):
        check_writable(tmp_path, drawings=8)
    (tmp_path / name).rmdir()
    (tmp_path / name).touch()
    with pytest.raises(ProblemError, match=name):
        check_writable(tmp_path, drawings=8)
    (tmp_path / name).rename(tmp_path / "design-09.png")
    check_writable(tmp_path, drawings=8)


def test_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ProblemError, match="--out"):
        check_writable(tmp_path / "file" / "below")
    with pytest.raises(ProblemError, match="--out"):
        check_writable(tmp_path / "new" / ("x" * 300))
    with pytest.raises(ProblemError, match="--out"):
        check_writable(tmp_path / ("x" * 300) / "below")
    check_writable(tmp_path / "new" / "deep")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in folders")
@pytest.mark.parametrize("record", [RECORD, ANALYSIS_RECORD])
def test_a_pipe_or_device_in_place_of_the_record_is_not_read(tmp_path: Path, record: str) -> None:
    for place in (lambda path: os.mkfifo(path), lambda path: path.symlink_to("/dev/zero")):
        place(tmp_path / record)
        with pytest.raises(
            ProblemError, match=rf"{record} in it is not Grashof's own; name a folder without it"
        ):
            check_writable(tmp_path, record=record)
        (tmp_path / record).unlink()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in folders")
def test_a_pipe_in_place_of_a_list_is_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "candidates.json")
    with pytest.raises(ProblemError, match=r"json: is not an ordinary file; it must be a list of designs"):
        load_linkage(f"{tmp_path / 'candidates.json'}#1")
