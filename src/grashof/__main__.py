"""The `grashof` command, also as `python -m grashof`: it can be interrupted while it is being loaded."""

from __future__ import annotations

import os
import signal
from types import FrameType

_INTERRUPTED = 128 + signal.SIGINT


def main() -> None:
    """Entry point of the `grashof` command."""
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_IGN:  # as of jobs in the background
        signal.signal(signal.SIGINT, _leave)
    from grashof.cli import main as command

    signal.signal(signal.SIGINT, before)
    command()


def _leave(_number: int, _frame: FrameType | None) -> None:
    """End at once: compiled modules make other errors of a `KeyboardInterrupt`, and nothing has begun yet."""
    os.write(2, b"grashof: interrupted\n")
    os._exit(_INTERRUPTED)


if __name__ == "__main__":
    main()
