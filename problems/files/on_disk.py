"""Files on disk: TOML that people write, the catalogues, and results that are complete or absent."""

from __future__ import annotations

import json
import lzma
import os
import stat
import struct
import tomllib
import warnings
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from importlib import import_module, resources
from importlib.metadata import version
from importlib.resources.abc import Traversable
from pathlib import Path
from types import ModuleType
from typing import Any

from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.text import hint, readable

MOST_BYTES = 4 * 2**20  # of files that people write or draw
MOST_BYTES_MADE = 256 * 2**20  # of those that this program writes


@dataclass(frozen=True, slots=True)
class Catalogue:
    """Files shipped with the package, each under the name of its stem."""

    what: str  # one of them, in messages
    folders: tuple[str, ...] = ("",)  # below the data of the problems; empty for these themselves

    @property
    def names(self) -> tuple[str, ...]:
        """All names, sorted."""
        return tuple(sorted(self._files))

    def text(self, name: str) -> str:
        """The file of this name; `ProblemError` when there is none."""
        if name not in self._files:
            raise ProblemError(f"{shown(name)} is not a {self.what} of the catalogue; {self.hint(name)}")
        return self._files[name].read_text(encoding="utf-8")

    @property
    def titles(self) -> dict[str, str]:
        """The title of each, by its name, without checking the rest of its file."""
        texts = {name: file.read_text(encoding="utf-8") for name, file in sorted(self._files.items())}
        return {name: str(document_of(text, name)["title"]) for name, text in texts.items()}

    def hint(self, name: str) -> str:
        """The likely name in place of one that is not there."""
        return hint(name, self.names, f"the catalogue has {', '.join(self.names)}")

    def read(self, given: str | os.PathLike[str]) -> tuple[str, str, str, Path | None]:
        """Text, file name, name and folder of an entry, or of the file of a path; entries have no folder."""
        name = os.fspath(given)
        if isinstance(given, str) and not looks_like_path(name):
            if name in self.names:
                return self.text(name), f"{name}.toml", name, None
            if not exists(name):
                neither = f"{shown(name)} is neither a {self.what} of the catalogue nor a file"
                raise ProblemError(f"{neither}; {self.hint(name)}")
        path = Path(given)
        text = file_text(path, f"a {self.what} file", self.hint(path.stem))
        return text, str(path), readable(path.stem), path.parent

    @property
    def _files(self) -> dict[str, Traversable]:
        data = resources.files("grashof.problems") / "data"
        files = (file for folder in self.folders for file in (data / folder).iterdir())
        return {Path(file.name).stem: file for file in files if file.name.endswith(".toml")}


PROBLEMS = Catalogue("problem", ("", "practice"))
LINKAGES = Catalogue("linkage", ("linkages",))


def catalogue() -> tuple[str, ...]:
    """Names of the problems shipped with the package, sorted.

    Examples
    --------
    >>> "luggage" in catalogue()
    True
    """
    return PROBLEMS.names


def problem_text(name: str) -> str:
    """Problem of the catalogue as TOML, to copy and change.

    Raises
    ------
    ProblemError
        No problem of the catalogue has this name.

    Examples
    --------
    >>> print(problem_text("luggage").splitlines()[1])
    kind = "motion"
    """
    return PROBLEMS.text(name)


def linkage_catalogue() -> tuple[str, ...]:
    """Names of the linkages shipped with the package, sorted.

    Examples
    --------
    >>> linkage_catalogue()
    ('crank-shaper', 'dwell-six-bar', 'engine', 'klann', 'lufkin-c912d', 'luggage-report', 'pumpjack')
    """
    return LINKAGES.names


def linkage_text(name: str) -> str:
    """Linkage of the catalogue as TOML, to copy and change.

    Raises
    ------
    ProblemError
        No linkage of the catalogue has this name.

    Examples
    --------
    >>> print(linkage_text("pumpjack").splitlines()[3])
    length_unit = "m"
    """
    return LINKAGES.text(name)


def looks_like_path(text: str) -> bool:
    """Whether a string names a file, and not an entry of a catalogue."""
    separators = {"/", os.sep, os.altsep}
    return text.endswith(".toml") or any(sep in text for sep in separators if sep)


def exists(text: str) -> bool:
    """Whether there is such a file; False for names that no file can have, where Path.exists raises."""
    return bool(text) and os.path.exists(text)  # noqa: PTH110


def file_text(path: Path, wanted: str, suggestion: str = "", most: int = MOST_BYTES) -> str:
    """Text of a file that a user named; `ProblemError` states why it cannot be read, with a suggestion."""
    try:
        # utf-8-sig: editors on Windows put a byte order mark first, which TOML does not know.
        return file_bytes(path, wanted, suggestion, most).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ProblemError(f"{path}: is not UTF-8 text, at byte {error.start}") from None


def file_bytes(path: Path, wanted: str, suggestion: str = "", most: int = MOST_BYTES) -> bytes:
    """Content of a plain file of at most `most` bytes, likewise."""
    content = b""
    try:
        mode = path.stat().st_mode
        if stat.S_ISREG(mode):  # reading a pipe or a device may never end
            with path.open("rb") as file:
                content = file.read(most + 1)
    except FileNotFoundError:
        raise ProblemError(f"{path}: there is no such file{suggestion and '; '}{suggestion}") from None
    except OSError as error:
        raise ProblemError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:  # no name of a file, such as one with a null character
        raise ProblemError(f"{str(path)!r}: cannot be read: {error}") from None
    if not stat.S_ISREG(mode):
        found = "a folder" if stat.S_ISDIR(mode) else "not a plain file"
        raise ProblemError(f"{path}: is {found}; it must be {wanted}")
    if len(content) > most:
        raise ProblemError(f"{path}: has more than {most} bytes; {wanted} must have at most that")
    return content


def installed(library: str, needed: str) -> ModuleType:
    """A library of the extra `export`; `ProblemError`, which begins with `needed`, where it is absent."""
    try:
        return import_module(library)
    except ModuleNotFoundError:
        install = "pip install 'grashof[export]' (in a clone '.[export]')"
        raise ProblemError(f"{needed} {library}: {install}") from None


# What Python raises in a library that reads damaged bytes.
_DAMAGED: tuple[type[Exception], ...] = (
    ArithmeticError, AssertionError, AttributeError, EOFError, LookupError, MemoryError, NameError, OSError,
    RuntimeError, SyntaxError, TypeError, ValueError, struct.error, zlib.error, lzma.LZMAError,
)  # fmt: skip


@contextmanager
def read_by_others(wanted: str, *own: type[Exception]) -> Iterator[None]:
    """Errors of a library on a file that is not `wanted`, as a `ProblemError` of one line; no warnings.

    `own` are the library's own errors besides those.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except ProblemError:
        raise
    except (*_DAMAGED, *own) as error:
        said = str(error).split("\n", maxsplit=1)[0].strip()
        raise ProblemError(f"is not {wanted}: {shown(said) if said else type(error).__name__}") from None


def document_of(text: str, file_name: str) -> dict[str, Any]:
    """The document of a TOML text; `ProblemError` where it is not TOML."""
    try:
        return tomllib.loads(text)
    # Besides its own error: an integer of thousands of digits, lists nested a thousand deep.
    except (ValueError, RecursionError) as error:
        why = str(error).replace("Cannot overwrite a value", "a key or table is given twice")
        raise ProblemError(f"{file_name}: is not TOML: {why}") from None


PACKAGES = ("grashof", "casadi", "numpy", "scipy")  # whose versions may change a digit
WRITING = ".writing-"  # beginning of the names of incomplete files


@cache
def versions() -> dict[str, str]:
    """Of the packages that decide which designs are found."""
    return {name: version(name) for name in PACKAGES}


def write_whole(path: Path, content: Mapping[str, Any] | str) -> None:
    """Write a file, JSON or text, that is complete or absent even if the machine stops.

    `OSError` where the disk is full or the folder is lost; no part of the file is left then.
    """
    beside = path.with_name(f"{WRITING}{os.getpid()}-{path.name}")
    try:
        with beside.open("w", encoding="utf-8", newline="\n") as file:
            file.write(content if isinstance(content, str) else json.dumps(content))
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    except OSError as error:
        with suppress(OSError):
            beside.unlink()
        if error.strerror is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None  # a full disk names no file
