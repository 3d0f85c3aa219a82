"""Lines on stdout and stderr, exit codes, and the handling of Ctrl-C, SIGTERM and SIGHUP."""

from __future__ import annotations

import os
import re
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from enum import IntEnum
from pathlib import Path
from types import FrameType

import typer

from grashof.problems.values.errors import ProblemError, SolverError
from grashof.problems.values.text import counted, readable

TRACEBACK = "GRASHOF_TRACEBACK"  # environment variable: print tracebacks of unexpected errors
_LAID_OUT = re.compile(r"[^\n\t]+")  # all but line ends and tabs
_SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


class ExitCode(IntEnum):
    """Exit codes."""

    OK = 0
    NO_DESIGN = 1
    BAD_INPUT = 2
    SURROUNDINGS = 3
    INTERRUPTED = 128 + signal.SIGINT
    TERMINATED = 128 + signal.SIGTERM


def failure(error: BaseException) -> tuple[ExitCode, str]:
    """Exit code and message, a line for each error of a file, of the error that ends a command.

    Examples
    --------
    >>> failure(ProblemError("kind is missing"))
    (<ExitCode.BAD_INPUT: 2>, 'kind is missing')
    """
    if isinstance(error, KeyboardInterrupt):
        return ExitCode.INTERRUPTED, "interrupted"
    if isinstance(error, ProblemError):
        return ExitCode.BAD_INPUT, str(error)
    if isinstance(error, (SolverError, OSError)):
        return ExitCode.SURROUNDINGS, str(error)
    words = " ".join(f"{type(error).__name__}: {error}".rstrip(": ").split())
    hint = f"{TRACEBACK}=1 prints the traceback; please report it with that"
    return ExitCode.SURROUNDINGS, f"unexpected error: {words}; {hint}"


class Interruption:
    """Whether a signal has requested the end of the program; which one, and the exit code then."""

    def __init__(self) -> None:
        self.code, self.by = ExitCode.OK, ""

    def __call__(self) -> bool:
        """Whether a signal has come."""
        return self.code is not ExitCode.OK


@contextmanager
def interruptible() -> Iterator[Interruption]:
    """The first Ctrl-C, SIGTERM or SIGHUP requests an early end, the second ends at once.

    Signals that are ignored stay ignored.
    """
    request = Interruption()
    handlers = {number: signal.getsignal(number) for number in _SIGNALS}
    before = {number: handler for number, handler in handlers.items() if handler is not signal.SIG_IGN}

    def note(number: int, _frame: FrameType | None) -> None:
        request.code = ExitCode.INTERRUPTED if number == signal.SIGINT else ExitCode.TERMINATED
        request.by = "Ctrl-C" if number == signal.SIGINT else signal.Signals(number).name
        restore()

    def restore() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    for number in before:
        signal.signal(number, note)
    try:
        yield request
    finally:
        restore()


def say(line: str, *, err: bool = False) -> None:
    """Print a line; nothing once nobody reads the stream any more (`| head`).

    Control characters, such as of file names, do not reach the terminal. OSError where stdout cannot be
    written, such as to a full disk; lines on stderr never cost a result.
    """
    stream = sys.stderr if err else sys.stdout
    try:
        typer.echo(_LAID_OUT.sub(lambda found: readable(found[0]), line), err=err)
    except OSError as error:
        # Not only this line: the rest of the buffer is flushed when the interpreter ends.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        if not (err or isinstance(error, BrokenPipeError)):
            raise OSError(f"standard output: {error.strerror}") from None


def say_written(note: str, files: list[str], folder: Path) -> None:
    """Print a note, if any, and the files of a run."""
    if note:
        say(note, err=True)
    drawn = sum(name.endswith(".png") for name in files)
    named = [name for name in files if name.endswith((".csv", ".json", ".html"))]
    pictures = f" and {counted(drawn, 'drawing')} (PNG, SVG)" if drawn else ""
    say(f"{folder}: {', '.join(named)}{pictures}", err=True)


def say_page(page: Path) -> None:
    """Print where the page of a run is."""
    say(f"Open {page} in a browser to look at it.", err=True)
