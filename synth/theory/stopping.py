"""Long computations that end when they are asked to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from time import perf_counter

GRACE = 1.0  # s: so long what is under way may still come to something


class StopRequested(Exception):  # noqa: N818  (no error: it was asked for)
    """A computation was asked to end before it was done."""


@dataclass(slots=True)
class _Question:
    """What is asked, and since when it is answered by True (s)."""

    asked: Callable[[], bool]
    since: float | None = None

    def answered(self) -> bool:
        """Whether to stop."""
        if not self.asked():
            return False
        if self.since is None:
            self.since = perf_counter()
        return True


_NOBODY = _Question(lambda: False)
_ASKED: ContextVar[_Question] = ContextVar("asked to stop")


@contextmanager
def stopping(asked: Callable[[], bool]) -> Iterator[None]:
    """What is computed inside, in this thread, ends soon after `asked` gives True."""
    token = _ASKED.set(_Question(asked))
    try:
        yield
    finally:
        _ASKED.reset(token)


def stop_when(asked: Callable[[], bool]) -> None:
    """As `stopping`, for all that this thread computes from now on."""
    _ASKED.set(_Question(asked))


def stop_request() -> Callable[[], bool]:
    """What is asked here and now; inside `stopping`, `stop_requested` asks something else."""
    return _ASKED.get(_NOBODY).asked


def stop_requested() -> bool:
    """Whether to be content with what there is."""
    return _ASKED.get(_NOBODY).answered()


def raise_if_stopped() -> None:
    """Raise `StopRequested` where asked to stop; for what is of no use unless it is done."""
    if stop_requested():
        raise StopRequested


def overdue() -> bool:
    """Whether it was asked to stop more than `GRACE` ago, as far as anybody looked."""
    question = _ASKED.get(_NOBODY)
    if not question.answered() or question.since is None:
        return False
    return perf_counter() - question.since > GRACE


def raise_if_overdue() -> None:
    """Raise `StopRequested` where that is overdue; for what soon comes to something."""
    if overdue():
        raise StopRequested
