"""What happened to a run, besides its designs."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from enum import StrEnum
from time import perf_counter

_LOG = logging.getLogger(__name__)


class StopReason(StrEnum):
    """What ended a run."""

    COMPLETE = "complete"
    TIME_LIMIT = "time limit"
    STOPPED = "stopped"
    INTERRUPTED = "interrupted"
    TERMINATED = "terminated"
    FAILED = "failed"


@dataclass(frozen=True, slots=True, kw_only=True)
class RunHistory:
    """What happened to a run, besides its designs; times in UTC."""

    begun: datetime  # of the search, in ``run.json`` with what is written, as `ended`
    ended: datetime
    ending: StopReason
    resumed: int = 0  # how often it was gone on with from its record
    steps_recorded: int = 0  # screenings, solves and chunks taken from the record
    record_lost: str = ""  # why the record ended before the search; empty where it did not
    processes_lost: int = 0  # how often a process was lost and replaced
    starts_crashed: tuple[int, ...] = ()  # numbers of the starts that end the process that solves them
    drawings_left_out: int = 0
    why_left_out: str = ""  # empty where none is


def now() -> datetime:
    """The time of day, UTC."""
    return datetime.now(UTC)


@dataclass(slots=True)
class StopCondition:
    """Whether a search is asked to end, and what asks; once it is asked, it stays so."""

    time_limit: float | None  # s, from now on
    stop: Callable[[], bool] | None  # asks it by True
    ending: StopReason = StopReason.COMPLETE
    begun: datetime = field(default_factory=now)  # UTC
    _since: float = field(default_factory=perf_counter)

    def __call__(self) -> bool:
        """Whether it is asked to end."""
        if self.ending is StopReason.COMPLETE:
            self.ending = self._asked()
            if self.ending is not StopReason.COMPLETE:
                _LOG.info("asked to end after %.1f s: %s", perf_counter() - self._since, self.ending)
        return self.ending is not StopReason.COMPLETE

    def part(self, number: int, of: int) -> StopCondition:
        """The same for the first `number` of so many parts of a search, with their share of the time."""
        limit = None if self.time_limit is None else self.time_limit * number / of
        return replace(self, time_limit=limit)

    def _asked(self) -> StopReason:
        if self.time_limit is not None and perf_counter() - self._since > self.time_limit:
            return StopReason.TIME_LIMIT
        return StopReason.STOPPED if self.stop is not None and self.stop() else StopReason.COMPLETE
