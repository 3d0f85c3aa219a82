"""Long computations that end on request."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from time import perf_counter

GRACE = 1.0  # s that work under way has after a request to stop


class StopRequested(Exception):  # noqa: N818  (a request, not an error)
    """A computation ended on request before it was done."""


@dataclass(slots=True)
class _Request:
    """A function that returns True to request a stop, and the time (s) when it first did."""

    requested: Callable[[], bool]
    since: float | None = None

    def made(self) -> bool:
        """Whether to stop."""
        if not self.requested():
            return False
        if self.since is None:
            self.since = perf_counter()
        return True


_NEVER = _Request(lambda: False)
_REQUEST: ContextVar[_Request] = ContextVar("request to stop")


@contextmanager
def stopping(requested: Callable[[], bool]) -> Iterator[None]:
    """End computations inside, in this thread, soon after `requested` returns True."""
    token = _REQUEST.set(_Request(requested))
    try:
        yield
    finally:
        _REQUEST.reset(token)


def stop_when(requested: Callable[[], bool]) -> None:
    """As `stopping`, for all that this thread computes from now on."""
    _REQUEST.set(_Request(requested))


def stop_request() -> Callable[[], bool]:
    """The function of the enclosing `stopping`, to be called from another context."""
    return _REQUEST.get(_NEVER).requested


def stop_requested() -> bool:
    """Whether to accept the current results."""
    return _REQUEST.get(_NEVER).made()


def raise_if_stopped() -> None:
    """Raise `StopRequested` after a request to stop; for computations that are useless unless completed."""
    if stop_requested():
        raise StopRequested


def overdue() -> bool:
    """Whether a stop was requested more than `GRACE` ago, as of the checks that were made."""
    request = _REQUEST.get(_NEVER)
    if not request.made() or request.since is None:
        return False
    return perf_counter() - request.since > GRACE


def raise_if_overdue() -> None:
    """Raise `StopRequested` where `overdue`; for computations that will soon have results."""
    if overdue():
        raise StopRequested
