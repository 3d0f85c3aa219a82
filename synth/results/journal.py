"""A search recorded on disk as it goes, so that it can be gone on with."""

from __future__ import annotations

import hashlib
import json
import logging
import os
import tempfile
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from time import monotonic
from typing import Any, Protocol, TypeVar

from grashof.problems import Problem, ProblemError, Search
from grashof.problems.files.problem_writing import problem_toml
from grashof.synth.results.plain import plain, restored

_LOG = logging.getLogger(__name__)
FORMAT = 1
HEAD = "search.json"
EVERY = 2.0  # s of work that a file holds
PACKAGES = ("grashof", "casadi", "numpy", "scipy")  # whose versions may change a digit

T = TypeVar("T")


class Journal(Protocol):
    """What has been done in a search, in its order."""

    @property
    def recorded(self) -> bool:
        """Whether the next step is recorded, or may be."""

    @property
    def resumed(self) -> int:
        """How often the search was gone on with."""

    @property
    def taken(self) -> int:
        """How many steps were taken from the record."""

    def done(self, kind: str, of: Any, problem: Problem, do: Callable[[], T], /) -> T:
        """The result of the next step: as recorded, else done now.

        Parameters
        ----------
        kind : str
            Of step.
        of : value
            What it is done with (see `plain`).
        problem : Problem
            That its designs are for.
        do : callable
            Does it.
        """

    def close(self) -> None:
        """Write what is not written; nothing more is recorded."""


class Unrecorded:
    """No journal: every step is done."""

    recorded, resumed, taken = False, 0, 0

    def done(self, _kind: str, _of: Any, _problem: Problem, do: Callable[[], T], /) -> T:
        """The result of a step."""
        return do()

    def close(self) -> None:
        """Nothing to write."""


class Recorded:
    """A journal in a folder: `HEAD` states of which search, ``000001.json`` and so on hold its steps.

    A search is a sequence of steps, screenings and solves, each of which depends on nothing but the
    problem, the seed and the steps before; so it goes on by taking the results of the first ones from
    the record. Each file is written to a temporary name, flushed to disk and renamed, about every
    `EVERY` seconds, and holds all steps since the one before.

    Parameters
    ----------
    folder : Path
        Goes on from the record in it, if there is one; made with the first file.
    problem : Problem
    search : Search
        The options that change designs.

    Raises
    ------
    ProblemError
        The record is of another search, or of another version of a package.
    """

    def __init__(self, folder: Path, problem: Problem, search: Search) -> None:
        self._folder, self._head = folder, _head(problem, search)
        self._recorded: deque[dict[str, Any]] = deque()
        self._unread, self._fresh = deque[Path](), list[dict[str, Any]]()
        self._written, self._since, self._open = 0, monotonic(), True
        self.resumed = self.taken = 0
        if (folder / HEAD).exists():
            refuse_other(folder, self._head)
            self.resumed = _resumed(folder) + 1
            self._write_head()
            self._unread.extend(sorted(folder.glob("[0-9]*.json")))

    def done(self, kind: str, of: Any, problem: Problem, do: Callable[[], T], /) -> T:
        """The result of the next step: as recorded, else done now and recorded."""
        if not self._open:
            return do()
        name = f"{kind} {hashlib.sha256(json.dumps(plain(of)).encode()).hexdigest()[:16]}"
        found = self._next(name, problem)
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
        """Write what is not written; nothing more is recorded."""
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

    def remove(self) -> None:
        """Delete the record, and its folder if nothing else is in it; nothing more is recorded."""
        self._open = False
        for path in (*self._folder.glob("[0-9]*.json"), self._folder / HEAD):
            path.unlink(missing_ok=True)
        with suppress(OSError):
            self._folder.rmdir()

    def _next(self, name: str, problem: Problem) -> tuple[Any] | None:
        while not self._recorded and self._unread:
            path = self._unread.popleft()
            self._recorded.extend(_steps(path))
            self._written = int(path.stem)
        if not self._recorded:
            return None
        step = self._recorded.popleft()
        try:
            if step["step"] == name:
                known = (restored(step["result"], problem),)
                self.taken += 1
                if not self.recorded:
                    _LOG.info("resumed from a record of %d steps", self.taken)
                return known
        except (ValueError, KeyError, TypeError):  # what is damaged is done again
            pass
        _LOG.info("resumed from a record of %d steps; what follows in it is done again", self.taken)
        self._forget()
        return None

    def _forget(self) -> None:
        """Drop the rest of the record: it is not that of this search any more."""
        self._recorded.clear()
        for path in self._unread:
            path.unlink(missing_ok=True)
        self._unread.clear()

    def _write(self) -> None:
        self._folder.mkdir(exist_ok=True)
        if not (self._folder / HEAD).exists():
            self._write_head()
        self._written += 1
        _write_whole(self._folder / f"{self._written:06}.json", {"steps": self._fresh})
        self._fresh, self._since = [], monotonic()

    def _write_head(self) -> None:
        _write_whole(self._folder / HEAD, {**self._head, "resumed": self.resumed})


@contextmanager
def journal_of(folder: Path | None, problem: Problem, search: Search) -> Iterator[Journal]:
    """The journal of a search in a folder; the record goes once the search is whole.

    It stays where the search was stopped, or failed.
    """
    if folder is None:
        yield Unrecorded()
        return
    journal = Recorded(folder, problem, search)
    try:
        yield journal
        if journal.is_open:
            journal.remove()
    finally:
        journal.close()


def refuse_other(folder: Path, head: Mapping[str, Any]) -> None:
    """Raise `ProblemError` unless a record is of the search that a head states."""
    try:
        found = json.loads((folder / HEAD).read_text(encoding="utf-8"))
        known = {key: found[key] for key in head}
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        raise ProblemError(f"{folder / HEAD}: is not the record of a search; delete {folder}") from None
    if known["problem"] != head["problem"]:
        raise ProblemError(f"{folder}: is the record of a search for another problem; name another folder")
    for key, value in head.items():
        if known[key] != value:
            there = f"{folder}: is the record of a search with {key} {known[key]}"
            raise ProblemError(f"{there}; here it is {value}")


def _resumed(folder: Path) -> int:
    """How often the search of a record was gone on with."""
    count = json.loads((folder / HEAD).read_text(encoding="utf-8")).get("resumed")
    return count if isinstance(count, int) else 0


def _head(problem: Problem, search: Search) -> dict[str, Any]:
    """What a record is of: the same head, the same search."""
    stated = problem_toml(problem).partition("\n[search]")[0]
    return {
        "format": FORMAT,
        "problem": hashlib.sha256(stated.encode()).hexdigest(),
        **asdict(search),
        **{f"{name} version": version(name) for name in PACKAGES},
    }


def _steps(path: Path) -> list[dict[str, Any]]:
    """Steps of a file; none where it is damaged."""
    try:
        steps = json.loads(path.read_text(encoding="utf-8"))["steps"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return [{"step": "damaged"}]
    return steps if isinstance(steps, list) else [{"step": "damaged"}]


def _write_whole(path: Path, content: Mapping[str, Any]) -> None:
    """A JSON file that is there whole or not at all, whenever the machine stops."""
    with tempfile.NamedTemporaryFile(
        "w", encoding="utf-8", dir=path.parent, prefix=".writing-", delete=False
    ) as file:
        json.dump(content, file)
        file.flush()
        os.fsync(file.fileno())
    Path(file.name).replace(path)
