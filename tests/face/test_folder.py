"""The output folder is written completely or not at all."""

from __future__ import annotations

import json
import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import pytest

from grashof.output.folder import (
    ANALYSIS_RECORD,
    RECORD,
    check_writable,
    in_use,
    own_files,
    part_in_use,
    replacing_own_files,
)
from grashof.problems import ProblemError, load_linkage
from grashof.workshop.export import Making, export_files
from grashof.workshop.plates import PlateSizes

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
    with replacing_own_files(tmp_path, keep=["design-01.png"]) as fresh:
        (fresh / CSV).touch()
    assert {path.name for path in tmp_path.iterdir()} == {"design-01.png", CSV, "mine"}


def fail_halfway(folder: Path) -> None:
    with replacing_own_files(folder) as fresh:
        (fresh / CSV).write_text("half")
        raise OSError("full")


def test_failure_leaves_everything_as_it_was(tmp_path: Path) -> None:
    write(tmp_path, CSV)
    for folder in (tmp_path, tmp_path / "new" / "deep"):
        with pytest.raises(OSError, match="full"):
            fail_halfway(folder)
    assert (tmp_path / CSV).read_text() == f"new {CSV}"
    assert {path.name for path in tmp_path.iterdir()} == {CSV, RECORD}


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
    for make in (Path.mkdir, Path.touch):
        make(tmp_path / name)
        with pytest.raises(ProblemError, match=name):
            check_writable(tmp_path, drawings=8)
        if make is Path.mkdir:
            (tmp_path / name).rmdir()
    (tmp_path / name).rename(tmp_path / "design-09.png")
    check_writable(tmp_path, drawings=8)


def test_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for bad in ("file/below", f"new/{'x' * 300}", f"{'x' * 300}/below"):
        with pytest.raises(ProblemError, match="--out"):
            check_writable(tmp_path / bad)
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
    with pytest.raises(ProblemError, match=r"json: is not a plain file; it must be a list of designs"):
        load_linkage(f"{tmp_path / 'candidates.json'}#1")


@pytest.fixture
def outside(tmp_path: Path) -> Path:
    """A file that no run may touch."""
    path = tmp_path / "outside" / "thesis.txt"
    path.parent.mkdir()
    path.write_text("mine")
    return path


@pytest.mark.skipif(os.name == "nt", reason="links need leave there")
@pytest.mark.parametrize("again", [True, False])
def test_links_are_replaced_and_not_followed(tmp_path: Path, outside: Path, again: bool) -> None:
    folder = tmp_path / "out"
    write(folder, CSV, "design-01.png")
    for name in (CSV, "design-01.png"):  # the record says that they are ours
        (folder / name).unlink()
        (folder / name).symlink_to(outside)
    check_writable(folder, drawings=1)
    write(folder, *([CSV, "design-01.png"] if again else []))
    assert outside.read_text() == "mine"
    assert not any(path.is_symlink() for path in folder.iterdir())
    assert {path.name for path in folder.iterdir()} == ({CSV, "design-01.png", RECORD} if again else {RECORD})
    assert list(outside.parent.iterdir()) == [outside]


@pytest.mark.skipif(os.name == "nt", reason="links need leave there")
def test_a_record_that_is_a_link_is_replaced_itself(tmp_path: Path, outside: Path) -> None:
    folder = tmp_path / "out"
    write(folder, CSV)
    record = (folder / RECORD).read_text()
    outside.write_text(record)
    (folder / RECORD).unlink()
    (folder / RECORD).symlink_to(outside)
    write(folder, CSV)
    assert outside.read_text() == record
    assert not (folder / RECORD).is_symlink()


@pytest.mark.skipif(os.name == "nt", reason="links need leave there")
def test_a_link_that_leads_nowhere_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "out").symlink_to(tmp_path / "outside" / "new")
    with pytest.raises(ProblemError, match="it must be a folder that can be written"):
        check_writable(tmp_path / "out")
    assert {path.name for path in tmp_path.iterdir()} == {"out"}
    assert (tmp_path / "out").is_symlink()


@pytest.mark.skipif(os.name == "nt", reason="links need leave there")
def test_exports_replace_links_and_do_not_follow_them(tmp_path: Path, outside: Path) -> None:
    files = {kind: tmp_path / f"parts.{kind}" for kind in ("dxf", "svg", "xlsx")}
    for path in files.values():
        path.symlink_to(outside)
    export_files("pumpjack", Making(PlateSizes(), "1:20"), files)
    assert outside.read_text() == "mine"
    assert all(path.is_file() and not path.is_symlink() for path in files.values())


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no folder that not even root can write")
@pytest.mark.parametrize("record", [RECORD, ANALYSIS_RECORD])
def test_a_folder_that_cannot_be_written(record: str) -> None:
    for folder in (Path("/proc"), Path("/proc/designs")):
        with pytest.raises(ProblemError, match=rf"--out {folder}: .*; it must be a folder"):
            check_writable(folder, record=record)
    with (
        pytest.raises(ProblemError, match=r"--out /proc/designs/1: .*; it must be a folder"),
        part_in_use(Path("/proc/designs"), Path("/proc/designs/1")),
    ):
        pass


def test_parts_of_a_folder_may_be_begun_at_the_same_moment(tmp_path: Path) -> None:
    count = 8
    together = Barrier(count)

    def part(folder: Path, number: int) -> None:
        together.wait()
        own = folder / "shards" / str(number)
        with part_in_use(folder, own):
            (own / "search.json").touch()

    with ThreadPoolExecutor(count) as threads:
        for turn in range(15):
            folder = tmp_path / str(turn) / "out"
            list(threads.map(part, [folder] * count, range(count)))  # raises what one of them raises
            assert len(list(folder.glob("shards/*/search.json"))) == count


def test_a_part_of_a_folder_with_a_file_of_others_is_refused_without_a_trace(tmp_path: Path) -> None:
    (tmp_path / CSV).write_text("mine", encoding="utf-8")
    with (
        pytest.raises(ProblemError, match="is not Grashof's own"),
        part_in_use(tmp_path, tmp_path / "shards" / "1"),
    ):
        pass
    assert [path.name for path in tmp_path.iterdir()] == [CSV]


def test_files_of_a_killed_run_are_removed(tmp_path: Path) -> None:
    (tmp_path / ".writing-7-000001.json").touch()
    (tmp_path / ".writing-abc").mkdir()
    (tmp_path / ".writing-abc" / CSV).touch()
    (tmp_path / "000001.json").touch()
    with in_use(tmp_path):
        assert [path.name for path in tmp_path.iterdir()] == ["000001.json"]


def test_an_error_without_a_file_names_the_folder(tmp_path: Path) -> None:
    def full() -> None:
        with replacing_own_files(tmp_path / "new"):
            raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match=r"No space left on device: '.*new'"):
        full()
