"""The history of a run, and the condition under which it ends."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from enum import StrEnum
from time import perf_counter

from grashof.problems.values.checks import finite_number
from grashof.problems.values.errors import wrong_value

_LOG = logging.getLogger(__name__)


class StopReason(StrEnum):
    """The reason that a run ended."""

    COMPLETE = "complete"
    TIME_LIMIT = "time limit"
    STOPPED = "stopped"
    INTERRUPTED = "interrupted"
    TERMINATED = "terminated"
    FAILED = "failed"


@dataclass(frozen=True, slots=True, kw_only=True)
class RunHistory:
    """Events of a run besides its designs; times in UTC."""

    begun: datetime  # of the search, in ``run.json`` of the run with its files, as `ended`
    ended: datetime
    ending: StopReason
    resumed: int = 0  # number of times it was resumed from its record
    steps_recorded: int = 0  # screenings, solves and chunks taken from the record
    record_lost: str = ""  # why the record ended before the search; empty where it did not
    processes_lost: int = 0  # number of processes lost and replaced
    starts_crashed: tuple[int, ...] = ()  # numbers of the starts that end the process that solves them
    drawings_left_out: int = 0
    why_left_out: str = ""  # empty where all are drawn


def now() -> datetime:
    """The time of day, UTC."""
    return datetime.now(UTC)


@dataclass(slots=True)
class StopCondition:
    """The condition under which a search ends, and the reason; once met, it stays met."""

    time_limit: float | None  # s, from now on
    stop: Callable[[], bool] | None  # ends it by returning True
    ending: StopReason = StopReason.COMPLETE
    begun: datetime = field(default_factory=now)  # UTC
    _since: float = field(default_factory=perf_counter)

    @classmethod
    def of(cls, time_limit: float | None, stop: Callable[[], bool] | None) -> StopCondition:
        """A time from now on, s (ProblemError if invalid), or a function that the user gives."""
        if time_limit is not None and finite_number(time_limit, "time_limit") <= 0:
            raise wrong_value("time_limit", time_limit, "a time in s greater than zero")
        return cls(time_limit, stop)

    def __call__(self) -> bool:
        """Whether the search has to end."""
        if self.ending is StopReason.COMPLETE:
            self.ending = self._reason()
            if self.ending is not StopReason.COMPLETE:
                _LOG.info("asked to end after %.1f s: %s", perf_counter() - self._since, self.ending)
        return self.ending is not StopReason.COMPLETE

    def part(self, number: int, of: int) -> StopCondition:
        """The condition for the first `number` of `of` parts of a search, with their share of the time."""
        limit = None if self.time_limit is None else self.time_limit * number / of
        return replace(self, time_limit=limit)

    def _reason(self) -> StopReason:
        if self.time_limit is not None and perf_counter() - self._since > self.time_limit:
            return StopReason.TIME_LIMIT
        return StopReason.STOPPED if self.stop is not None and self.stop() else StopReason.COMPLETE
