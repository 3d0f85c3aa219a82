"""CasADi in programs with several threads: one of them at a time."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from threading import RLock
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

_LOCK = RLock()


def one_at_a_time(function: Callable[P, T]) -> Callable[P, T]:
    """A function that uses CasADi, entered by one thread at a time: two of them crash the interpreter.

    CasADi lets other threads run while it works, and shares what it has built among them. Processes
    are what makes a search faster.
    """

    @wraps(function)
    def alone(*args: P.args, **kwargs: P.kwargs) -> T:
        with _LOCK:
            return function(*args, **kwargs)

    return alone
