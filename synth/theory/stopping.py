"""Long computations that end when they are asked to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar


class Stopped(Exception):  # noqa: N818  (no error: it was asked for)
    """A computation was asked to end before it was done."""


_ASKED: ContextVar[Callable[[], bool]] = ContextVar("asked to stop", default=lambda: False)


@contextmanager
def stopping(asked: Callable[[], bool]) -> Iterator[None]:
    """What is computed inside, in this thread, ends soon after `asked` gives True."""
    token = _ASKED.set(asked)
    try:
        yield
    finally:
        _ASKED.reset(token)


def stop_when(asked: Callable[[], bool]) -> None:
    """As `stopping`, for all that this thread computes from now on."""
    _ASKED.set(asked)


def who_asks() -> Callable[[], bool]:
    """What is asked here and now; inside `stopping`, `asked_to_stop` asks something else."""
    return _ASKED.get()


def asked_to_stop() -> bool:
    """Whether to be content with what there is."""
    return _ASKED.get()()


def give_way() -> None:
    """Raise `Stopped` where asked to stop; for what is of no use unless it is done."""
    if asked_to_stop():
        raise Stopped
