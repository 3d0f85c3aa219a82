"""The output folder of a run: lists complete or absent, and only a run's own files replaced."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Collection, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from grashof.problems.values.errors import ProblemError

if sys.platform != "win32":
    import fcntl

RECORD = "run.json"
SEARCH, OLD_SEARCH = "search", "search-old"  # folders: the search as it goes, and one that was not finished
UNFINISHED = ".writing-"  # files of a run that is not done
ANALYSIS_RECORD = "analysis.json"
SWEEP_RECORD = "sweep.json"
PAGE = "report.html"
ANALYSIS_PAGE = "analysis.html"
SWEEP_PAGE = "sweep.html"
# Every name that a run writes, by its record; a drawing's carries its rank.
_NAMES = {
    RECORD: re.compile(
        r"candidates\.(csv|json)|nearest\.csv|run\.json|report\.html|design-(?P<rank>[0-9]{2,})\.(png|svg)"
    ),
    ANALYSIS_RECORD: re.compile(
        r"(kinematics|dynamics|extremes|summary)\.csv|(summary|analysis)\.json|analysis\.html"
        r"|(path|angles|velocities|accelerations|torque|forces)\.(png|svg)"
        r"|table-[a-z0-9-]+\.csv|plot-[a-z0-9-]+\.(png|svg)(?P<rank>)"
    ),
    SWEEP_RECORD: re.compile(r"sweep\.(csv|parquet|png|html|json)(?P<rank>)"),
}


def check_writable(folder: Path, drawings: int = 0, record: str = RECORD) -> None:
    """Refuse (ProblemError), before any work, a folder that a run cannot write into; leave no trace.

    Nor may a file be replaced that no run of Grashof wrote; files of runs with another `record` do not mix.
    """
    try:
        with _made(folder), tempfile.TemporaryDirectory(dir=folder, prefix=UNFINISHED) as name:
            (Path(name) / "candidates.json").touch()
        taken = _taken(folder, drawings, record) if folder.exists() else []
    except OSError as error:
        raise _unwritable(folder, error) from None
    if taken:
        raise ProblemError(f"--out {folder}: {taken[0]} in it is not Grashof's own; name a folder without it")


@contextmanager
def in_use(folder: Path) -> Iterator[None]:
    """The folder for this run alone; it is made, and removed if it stays empty.

    Unfinished files of a killed run are removed. The lock ends with its process, however that ends; where
    the system has none (Windows), two runs are not kept apart.
    ProblemError where another run uses it, or it cannot be made.
    """
    with ExitStack() as stack:
        try:
            stack.enter_context(_made(folder))
            stack.enter_context(_locked(folder))
        except OSError as error:
            raise _unwritable(folder, error) from None
        for left in folder.glob(f"{UNFINISHED}*"):
            if left.is_dir() and not left.is_symlink():
                shutil.rmtree(left, ignore_errors=True)
            else:
                with suppress(OSError):
                    left.unlink()
        yield


@contextmanager
def part_in_use(folder: Path, part: Path) -> Iterator[None]:
    """A part of a folder for this run alone, while others use other parts of it.

    ProblemError where another run uses it, the folder cannot be written, or the part is a link to elsewhere.
    """
    if part.is_symlink():
        raise ProblemError(f"--out {part}: is a link; it must be a folder")
    # In this order: check_writable removes a folder that it made, which others may have begun to use.
    with in_use(part):
        check_writable(folder)
        yield


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    if sys.platform == "win32":
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(handle)
        raise ProblemError(
            f"--out {folder}: another run uses it; wait for its end, or name another folder"
        ) from None
    except OSError:  # a file system without locks
        pass
    try:
        yield
    finally:
        os.close(handle)


@contextmanager
def replacing_own_files(folder: Path, keep: Collection[str] = (), record: str = RECORD) -> Iterator[Path]:
    """An empty folder for new files, which at the end replace those of the last run.

    Files of the last run (in `record` under "files") that this one neither writes nor keeps are removed;
    other files are left alone. If anything fails, as a full disk does (OSError), the folder stays as
    it was, and is removed if it was made here. Links in it are replaced or removed, not their targets.
    """
    try:
        with _made(folder):
            before = own_files(folder, record)
            with tempfile.TemporaryDirectory(dir=folder, prefix=UNFINISHED) as name:
                fresh = Path(name)
                yield fresh
                written = sorted(path.name for path in fresh.iterdir())
                # The record goes last: until then the old one still lists every old file.
                for file in sorted(written, key=lambda file: file == record):
                    (fresh / file).replace(folder / file)
            for file in before - {*written, *keep}:
                (folder / file).unlink(missing_ok=True)
    except OSError as error:
        if error.filename is not None or error.strerror is None:
            raise
        raise OSError(error.errno, error.strerror, str(folder)) from None  # a full disk names no file


def is_own_name(name: str, record: str = RECORD) -> bool:
    """Whether a run writes files of this name into its folder."""
    return _NAMES[record].fullmatch(name) is not None


def own_files(folder: Path, record: str = RECORD) -> set[str]:
    """Names of the files that the last run wrote into a folder; empty where there was none."""
    if not (folder / record).is_file():  # a pipe or a device may never end
        return set()
    try:
        content = json.loads((folder / record).read_text(encoding="utf-8"))
        names, versions = content["files"], content["versions"]
    # Not a run, or not our record; RecursionError for lists nested a thousand deep.
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return set()
    if not (isinstance(names, list) and isinstance(versions, dict) and "grashof" in versions):
        return set()
    # Our names only: a record that was tampered with must not reach any other file.
    ours = {name for name in names if isinstance(name, str) and is_own_name(name, record)}
    return {name for name in ours if (folder / name).is_file()}


def _unwritable(folder: Path, error: OSError) -> ProblemError:
    reason = error.strerror or "it cannot be written"
    return ProblemError(f"--out {folder}: {reason}; it must be a folder that can be written")


def _taken(folder: Path, drawings: int, record: str) -> list[str]:
    """Names of files of others that a run may write."""
    own = own_files(folder, record)
    found = [(path.name, _NAMES[record].fullmatch(path.name)) for path in folder.iterdir()]
    return sorted(
        name for name, ours in found if ours and name not in own and int(ours["rank"] or 0) <= drawings
    )


@contextmanager
def _made(folder: Path) -> Iterator[None]:
    """The folder, with its parents; those made here are removed if they stay empty."""
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    finally:
        for path in missing:
            with suppress(OSError):
                path.rmdir()
