"""Shared by tests of the command line: the command in this process, and in one of its own."""

import sys
from collections.abc import Callable
from typing import Any

Grashof = Callable[..., Any]  # the fixture of this name
COMMAND = [sys.executable, "-c", "from grashof.cli import main; main()"]


def failing(error: BaseException) -> Callable[..., None]:
    """A function that raises an error whatever it is given."""

    def fail(*_: object, **__: object) -> None:
        raise error

    return fail
