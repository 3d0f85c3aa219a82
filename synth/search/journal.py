"""A search recorded on disk while it runs, so that it can be resumed."""

from __future__ import annotations

import hashlib
import json
import logging
import re
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from time import monotonic
from typing import Any, TypeVar

from grashof.problems import Problem, ProblemError, Search
from grashof.problems.files.on_disk import WRITING, versions, write_whole
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.errors import shown
from grashof.synth.search.plain import plain, restored

_LOG = logging.getLogger(__name__)
FORMAT = 2
HEAD = "search.json"
RESUMED, COMPLETE = "resumed", "whole"  # in the head: how often; whether no work is left
EVERY = 2.0  # s of work that a file holds
_STEPS = re.compile(r"[0-9]{6,}\.json")  # names of files that hold steps; any other file is not ours

T = TypeVar("T")


class Journal:
    """The steps of a search in their order, recorded in a folder; without a folder nothing is recorded.

    `HEAD` states which search it is, ``000001.json`` and so on hold its steps: screenings, solves and chunks,
    each of which depends only on the problem, the seed and the steps before. So a search is resumed by taking
    the results of its first steps from the record. Each file is written to a temporary name, flushed to disk
    and renamed, about every `EVERY` seconds, and holds all steps since the one before. A folder without a
    record is made with the first file.

    Where the record is `needed`, a file that cannot be written ends the search (OSError); else it ends the
    record alone, and `lost` states why. ProblemError where the record is of another search (see `head_of`) or
    of another version of a package. `resumed` counts how often the search was resumed, `taken` the steps
    taken from the record.
    """

    def __init__(
        self, folder: Path | None = None, head: Mapping[str, Any] | None = None, *, needed: bool = False
    ) -> None:
        self._folder, self._head, self._needed = folder or Path(), head or {}, needed
        self.lost = ""
        self._recorded, self._read = deque[dict[str, Any]](), list[dict[str, Any]]()  # of one file
        self._unread, self._fresh = deque[Path](), list[dict[str, Any]]()
        self._written, self._since, self._open = 0, monotonic(), folder is not None
        self.resumed = self.taken = 0
        if folder is not None and (folder / HEAD).exists():
            refuse_other(folder, self._head)
            count = read_head(folder).get(RESUMED)
            self.resumed = count + 1 if isinstance(count, int) else 1
            self._unread.extend(_files(folder))
            with self._kept():
                self.begin()

    def done(
        self, kind: str, of: Any, problem: Problem, do: Callable[[], T], is_valid: Callable[[object], bool], /
    ) -> T:
        """The result of the next step: as recorded, where that `is_valid`, else computed now and recorded.

        The step is of a `kind`, with `of` (see `plain`); its designs are for `problem`.
        """
        if not self._open:
            return do()
        name = step_name(kind, of)
        found = self._next(name, problem, is_valid)
        if found is not None:
            known: T = found[0]
            return known
        result = do()
        if not self._open:
            return result
        self._fresh.append({"step": name, "result": plain(result)})
        if monotonic() - self._since >= EVERY:
            self._write()
        return result

    def close(self) -> None:
        """Write the steps not yet written; nothing more is recorded."""
        if self._open and self._fresh:
            self._write()
        self._open = False

    @property
    def recorded(self) -> bool:
        """Whether the next step may be recorded."""
        return bool(self._recorded or self._unread)

    @property
    def is_open(self) -> bool:
        """Whether steps are recorded: the search was not stopped."""
        return self._open

    def begin(self) -> None:
        """Write the head of a search that is not complete."""
        self._folder.mkdir(parents=True, exist_ok=True)
        write_whole(self._folder / HEAD, {**self._head, RESUMED: self.resumed})

    def finish(self) -> None:
        """State in the head that the search is complete, and keep the record; nothing more is recorded."""
        self.close()
        with self._kept():
            write_whole(self._folder / HEAD, {**self._head, RESUMED: self.resumed, COMPLETE: True})

    def remove(self) -> None:
        """Delete the record, and its folder if nothing else is in it; nothing more is recorded."""
        self._open = False
        remove_record(self._folder)

    def _next(self, name: str, problem: Problem, is_valid: Callable[[object], bool]) -> tuple[Any] | None:
        while not self._recorded and self._unread:
            path = self._unread.popleft()
            self._recorded.extend(_steps(path))
            self._read, self._written = [], int(path.stem)
        if not self._recorded:
            return None
        step = self._recorded.popleft()
        try:
            known = (restored(step["result"], problem),) if step["step"] == name else None
            if known is not None and is_valid(known[0]):
                self._read.append(step)
                self.taken += 1
                if not self.recorded:
                    _LOG.info("resumed from a record of %d steps", self.taken)
                return known
        except (ValueError, KeyError, TypeError):  # damaged
            pass
        _LOG.info("resumed from a record of %d steps; what follows in it is done again", self.taken)
        self._forget()
        return None

    def _forget(self) -> None:
        """Drop the rest of the record, which no longer belongs to this search."""
        self._recorded.clear()
        self._fresh = self._read
        for path in (self._path, *self._unread):
            path.unlink(missing_ok=True)
        self._unread.clear()
        self._written -= 1

    @property
    def _path(self) -> Path:
        """The file last written or read."""
        return self._folder / f"{self._written:06}.json"

    def _write(self) -> None:
        with self._kept():
            if not (self._folder / HEAD).exists():
                self.begin()
            self._written += 1
            write_whole(self._path, content_of(self._fresh))
        self._fresh, self._since = [], monotonic()

    @contextmanager
    def _kept(self) -> Iterator[None]:
        """End the record, not the search, where the disk is full."""
        try:
            yield
        except OSError as error:
            if self._needed:
                raise
            self.lost, self._open = f"{error.filename or self._folder}: {error.strerror}", False
            _LOG.warning("%s; the search continues without a record", self.lost)


@contextmanager
def journal_of(
    folder: Path | None, problem: Problem, search: Search, *, keep: bool = False
) -> Iterator[Journal]:
    """The journal of a search in a folder; the record of a search that was stopped, or failed, stays."""
    if folder is None:
        yield Journal()
        return
    journal = Journal(folder, head_of(problem, search))
    try:
        yield journal
        # that of a complete one is removed, or marked as complete where it is to be kept
        if keep and journal.is_open and (folder / HEAD).exists():
            journal.finish()
        elif journal.is_open or (journal.lost and not keep):
            journal.remove()
    finally:
        journal.close()


def head_of(problem: Problem, search: Search, **more: Any) -> dict[str, Any]:
    """The head of a record, which identifies the search."""
    stated = problem_toml(problem).partition("\n[search]")[0]
    return {
        "format": FORMAT,
        "problem": hashlib.sha256(stated.encode()).hexdigest(),
        **asdict(search),
        **more,
        **{f"{name} version": number for name, number in versions().items()},
    }


def read_head(folder: Path) -> dict[str, Any]:
    """The head of a record; ProblemError where there is none."""
    found = json_content(folder / HEAD)
    if not isinstance(found, dict):
        raise ProblemError(f"{folder / HEAD}: is not the record of a search; delete {folder}")
    return found


def refuse_other(folder: Path, head: Mapping[str, Any]) -> None:
    """Raise `ProblemError` unless a record is of the search that a head states."""
    found = read_head(folder)
    if not head.keys() <= found.keys():
        raise ProblemError(f"{folder / HEAD}: is not the record of a search; delete {folder}")
    if found["problem"] != head["problem"]:
        raise ProblemError(f"{folder}: is the record of a search for another problem; name another folder")
    for key, value in head.items():
        if type(found[key]) is not type(value) or found[key] != value:  # True is not 1
            there = f"{folder}: is the record of a search with {key} {shown(found[key])}"
            raise ProblemError(f"{there}; here it is {shown(value)}")


def step_name(kind: str, of: Any) -> str:
    """Name of a step by its kind and a digest of its arguments (see `plain`)."""
    return f"{kind} {hashlib.sha256(json.dumps(plain(of)).encode()).hexdigest()[:16]}"


def recorded_steps(folder: Path) -> Iterator[dict[str, Any]]:
    """Steps of a record, in their order; one without a name where a file is damaged."""
    for path in _files(folder):
        yield from _steps(path)


def content_of(steps: list[dict[str, Any]]) -> dict[str, Any]:
    """Content of a file of a record: steps, and a checksum that reveals damage."""
    return {"sha256": hashlib.sha256(json.dumps(steps).encode()).hexdigest(), "steps": steps}


def remove_record(folder: Path) -> None:
    """Delete a record, and its folder if nothing else is in it."""
    for path in (*_files(folder), *folder.glob(f"{WRITING}*"), folder / HEAD):
        path.unlink(missing_ok=True)
    with suppress(OSError):
        folder.rmdir()


def is_record_name(name: str) -> bool:
    """Whether a file of this name in the folder of a record belongs to it."""
    return name == HEAD or _STEPS.fullmatch(name) is not None


def _files(folder: Path) -> list[Path]:
    """Files of a record that hold steps, in their order."""
    return sorted(path for path in folder.glob("*.json") if _STEPS.fullmatch(path.name))


def _steps(path: Path) -> list[dict[str, Any]]:
    """Steps of a file; one without a name where it is damaged."""
    content = json_content(path)
    steps = content.get("steps") if isinstance(content, dict) else None
    try:
        return steps if isinstance(steps, list) and content == content_of(steps) else [{}]
    except RecursionError:  # nested more deeply than can be written
        return [{}]


def json_content(path: Path) -> Any:
    """Content of a JSON file; None where it is missing or damaged."""
    if not path.is_file():  # a pipe or a device may never end
        return None
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
