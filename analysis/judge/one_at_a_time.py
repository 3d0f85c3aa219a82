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
    """A function that may use CasADi, entered by one thread at a time: two in one solver crash.

    What it gives must not hold anything of CasADi; an error that leaves it does not keep its symbols, whose
    end would be out of the lock.
    """

    @wraps(function)
    def alone(*args: P.args, **kwargs: P.kwargs) -> T:
        with _LOCK:
            handled = sys.exception()
            try:
                return function(*args, **kwargs)
            finally:
                _let_go(sys.exception(), handled)

    return alone


def _let_go(error: BaseException | None, handled: BaseException | None) -> None:
    """Clear the variables of what an error came through, and those it arose from since one was handled."""
    seen = {id(handled)}
    while error is not None and id(error) not in seen:
        seen.add(id(error))
        clear_frames(error.__traceback__)
        error = error.__cause__ or error.__context__
