"""CasADi in programs with several threads: one of them at a time."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import wraps
from threading import RLock
from traceback import clear_frames
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

_LOCK = RLock()


def one_at_a_time(function: Callable[P, T]) -> Callable[P, T]:
    """A function that uses CasADi, or may as users' own do, entered by one thread at a time.

    CasADi lets other threads run while it works: two of them in one solver crash the interpreter.
    Processes are what makes a search faster. What the function gives must not hold anything of CasADi;
    an error that leaves it does not keep its symbols, whose end would be out of the lock.
    """

    @wraps(function)
    def alone(*args: P.args, **kwargs: P.kwargs) -> T:
        with _LOCK:
            handled = sys.exception()
            try:
                return function(*args, **kwargs)
            except BaseException as error:
                _let_go(error, handled)
                raise

    return alone


def _let_go(error: BaseException, handled: BaseException | None) -> None:
    """Clear the variables of what an error came through, and those it arose from since one was handled."""
    arose: BaseException | None = error
    seen = {id(handled)}
    while arose is not None and id(arose) not in seen:
        seen.add(id(arose))
        clear_frames(arose.__traceback__)
        arose = arose.__cause__ or arose.__context__
