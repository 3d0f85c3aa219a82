"""How a command ends: its exit codes, and what Ctrl-C, SIGTERM and SIGHUP do."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from enum import IntEnum
from types import FrameType

_SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


class ExitCode(IntEnum):
    """Exit codes."""

    OK = 0
    NO_DESIGN = 1
    BAD_INPUT = 2
    SURROUNDINGS = 3
    INTERRUPTED = 128 + signal.SIGINT
    TERMINATED = 128 + signal.SIGTERM


class Interruption:
    """Whether the user, or the system, has asked the program to end, by what, and its exit code then."""

    def __init__(self) -> None:
        self.code, self.by = ExitCode.OK, ""

    def __call__(self) -> bool:
        """Whether it was asked for."""
        return self.code is not ExitCode.OK


@contextmanager
def interruptible() -> Iterator[Interruption]:
    """The first Ctrl-C, SIGTERM or SIGHUP asks to end soon, the second ends at once; ignored ones stay so."""
    asked = Interruption()
    handlers = {number: signal.getsignal(number) for number in _SIGNALS}
    before = {number: handler for number, handler in handlers.items() if handler is not signal.SIG_IGN}

    def ask(number: int, _frame: FrameType | None) -> None:
        asked.code = ExitCode.INTERRUPTED if number == signal.SIGINT else ExitCode.TERMINATED
        asked.by = "Ctrl-C" if number == signal.SIGINT else signal.Signals(number).name
        restore()

    def restore() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    for number in before:
        signal.signal(number, ask)
    try:
        yield asked
    finally:
        restore()
