"""How a command ends: its exit codes, and what Ctrl-C and SIGTERM do."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from enum import IntEnum
from types import FrameType


class Exit(IntEnum):
    """Exit codes."""

    OK = 0
    NO_DESIGN = 1
    BAD_INPUT = 2
    SURROUNDINGS = 3
    INTERRUPTED = 128 + signal.SIGINT
    TERMINATED = 128 + signal.SIGTERM


class Interruption:
    """Whether the user, or the system, has asked the program to end, and its exit code then."""

    def __init__(self) -> None:
        self.code = Exit.OK

    def __call__(self) -> bool:
        """Whether it was asked for."""
        return self.code is not Exit.OK


@contextmanager
def interruptible() -> Iterator[Interruption]:
    """Turn the first Ctrl-C or SIGTERM into a request to end soon; the second one ends at once."""
    asked = Interruption()
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}

    def ask(number: int, _frame: FrameType | None) -> None:
        asked.code = Exit.INTERRUPTED if number == signal.SIGINT else Exit.TERMINATED
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
