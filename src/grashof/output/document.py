"""The outcome of a search as one JSON document on standard output, for `--json`."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grashof.output.process import ExitCode, failure, say

if TYPE_CHECKING:
    from grashof.synth import Result

_STATUS = {
    ExitCode.OK: "found",
    ExitCode.NO_DESIGN: "none",
    ExitCode.BAD_INPUT: "bad input",
    ExitCode.SURROUNDINGS: "environment error",
    ExitCode.INTERRUPTED: "interrupted",
    ExitCode.TERMINATED: "terminated",
}


@dataclass(slots=True)
class Document:
    """The document of a command, which gets its content while the command runs.

    Parameters
    ----------
    code : ExitCode
    error : str
        The message of the error that ended the command; a line for each error of a file.
    folder : Path, optional
        The folder written; None where nothing was written.
    files : list of str
        Names of the files written into it.
    listed : mapping
        The list as ``candidates.json`` has it, and the outcome as ``run.json`` has it.

    Examples
    --------
    >>> failed = Document(ExitCode.BAD_INPUT, "kind is missing")
    >>> failed.content["status"], failed.content["designs"]
    ('bad input', [])
    """

    code: ExitCode = ExitCode.OK
    error: str = ""
    folder: Path | None = None
    files: list[str] = field(default_factory=list)
    listed: dict[str, Any] = field(default_factory=dict)

    @property
    def content(self) -> dict[str, Any]:
        """The document; `designs` is empty where there is no list."""
        return {
            "status": _STATUS[self.code],
            "exit_code": int(self.code),
            "error": self.error,
            "folder": None if self.folder is None else str(self.folder),
            "files": self.files,
            "grashof": version("grashof"),
            **{"note": "", "ended": "", "proof": None, "designs": []},
            **self.listed,
        }

    def note_list(self, result: Result) -> None:
        """Take the outcome and the list, which may be empty, of a search."""
        from grashof.output.run_files import list_content, outcome

        self.listed = {**outcome(result), **list_content(result)}

    def note_files(self, folder: Path, files: list[str]) -> None:
        """Take the files that were written."""
        self.folder, self.files = folder, files


@contextmanager
def documented(wanted: bool) -> Iterator[Document]:
    """A document that is printed at the end of the block, if it is wanted, whatever ends the block."""
    document = Document()
    try:
        yield document
    except BaseException as error:  # it is raised again
        document.code, document.error = failure(error)
        raise
    finally:
        if wanted:
            print_document(document)


def print_document(document: Document) -> None:
    """Print a document on standard output."""
    say(json.dumps(document.content, indent=1, allow_nan=False))
