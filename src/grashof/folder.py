"""The output folder of a run: written whole or not at all, and only its own files replaced."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from grashof.problems import ProblemError

RECORD = "run.json"


def check_writable(folder: Path) -> None:
    """Refuse, before any work is done, a folder that cannot be made or written; leave no trace.

    Raises
    ------
    ProblemError
    """
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
        for path in missing:
            path.rmdir()
    except OSError as error:
        reason = error.strerror or "it cannot be written"
        raise ProblemError(f"--out {folder}: {reason}; allowed is a folder that can be written") from None


@contextmanager
def replacing_own_files(folder: Path) -> Iterator[Path]:
    """A folder to write files into, which at the end take the place of those of the last run.

    What the last run wrote and this one does not is removed; other files are left alone. If
    anything fails, the folder stays as it was.

    Parameters
    ----------
    folder : Path
        Its `RECORD` lists the files of the last run under "files".

    Yields
    ------
    Path
        Empty folder beside the files, on the same disk.
    """
    folder.mkdir(parents=True, exist_ok=True)
    before = own_files(folder)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".writing-") as name:
        fresh = Path(name)
        yield fresh
        written = sorted(path.name for path in fresh.iterdir())
        # The record goes last: until then the old one still knows every old file.
        for file in sorted(written, key=lambda file: file == RECORD):
            (fresh / file).replace(folder / file)
    for file in before - set(written):
        (folder / file).unlink(missing_ok=True)


def own_files(folder: Path) -> set[str]:
    """Names of the files that the last run wrote into a folder; empty where there was none."""
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        names = record["files"]
    except (OSError, ValueError, KeyError, TypeError):  # no run, or a record that is not ours
        return set()
    if not isinstance(names, list):
        return set()
    # Plain names only: a record that was tampered with must not reach outside the folder.
    plain = (name for name in names if isinstance(name, str) and Path(name).name == name)
    return {name for name in plain if (folder / name).is_file()}
