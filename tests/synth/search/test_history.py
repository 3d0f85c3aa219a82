"""The history of a run: its ending, steps from its record, and its log."""

import logging
from datetime import UTC, datetime, timedelta

import pytest

from grashof import load, synthesize
from grashof.problems import Search
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.history import StopCondition, StopReason
from grashof.synth.search.searches import Run
from grashof.synth.search.workers import CRASHED, Work

pytestmark = pytest.mark.usefixtures("small_search")
ENDINGS = {
    "whole": ({}, StopReason.COMPLETE),
    "in time": ({"time_limit": 1000.0}, StopReason.COMPLETE),
    "late": ({"time_limit": 1e-6}, StopReason.TIME_LIMIT),
    "stopped": ({"stop": lambda: True}, StopReason.STOPPED),
    "late, not stopped": ({"time_limit": 1e-6, "stop": lambda: False}, StopReason.TIME_LIMIT),
}


@pytest.mark.quick("whole", "in time", "stopped", "late, not stopped")
@pytest.mark.parametrize("how", ENDINGS)
def test_the_history_states_why_the_search_ended(how: str) -> None:
    options, ending = ENDINGS[how]
    before = datetime.now(UTC)
    history = synthesize(load("luggage"), starts=8, **options).history
    assert history.ending is ending
    assert before <= history.begun <= history.ended <= datetime.now(UTC)
    assert history.ended - history.begun > timedelta(milliseconds=10)
    assert (history.resumed, history.steps_recorded, history.processes_lost, history.starts_crashed) == (
        0,
        0,
        0,
        (),
    )


def test_a_stop_condition_stays_met() -> None:
    """Work cut short by one answer must not count as complete because of the next one."""
    answers = iter([False, True, False])
    asked = StopCondition(None, lambda: next(answers))
    assert [asked(), asked(), asked()] == [False, True, True]
    assert list(answers) == [False]  # not asked any more
    assert asked.ending is StopReason.STOPPED


class Crashing(Work):
    """Two starts of each batch end the process that solves them."""

    def attempts(self, scaled: ScaledProblem, starts: list[Start], first: int, /) -> list[Attempt]:
        made = super().attempts(scaled, starts, first)
        return [Attempt(CRASHED, None) if number in (1, 3) else one for number, one in enumerate(made)]


def test_starts_that_crash_are_named(caplog: pytest.LogCaptureFixture) -> None:
    scaled = ScaledProblem.of(load("luggage"))
    run = Run(Search(), Crashing(), lambda: False)
    found = run.screened(scaled, 0)
    assert found is not None
    run.solve(scaled, found.starts[:5], 10)
    assert run.crashed == [11, 13]
    assert [each.getMessage() for each in caplog.records if each.levelno == logging.WARNING] == [
        f"start {number} ends the process that solves it, and is skipped" for number in (11, 13)
    ]


def test_the_log_states_rounds_and_starts(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.DEBUG, logger="grashof"):
        result = synthesize(load("luggage"), starts=20)
    told = [each.getMessage() for each in caplog.records]
    assert told[0] == "luggage: motion; seed 0, effort 1, at most 20 starts, 1 at a time"
    assert told[1].startswith("bounds: 27.3")
    assert told[2] == "search begun: FewPoses, 4 targets"
    solved = [line.partition(":")[0] for line in told if line.startswith("start ")]
    assert solved == [f"start {number}" for number in range(20)]
    (ended,) = [line for line in told if line.startswith("round ")]
    assert ended.endswith(f"; 20 of 20 solves, {len(result)} designs")
    assert told[-1].endswith(f", complete: {len(result)} designs; {result.ended}")
    assert all(each.name.startswith("grashof.synth.") for each in caplog.records)


def test_the_log_states_why_the_search_stopped(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, logger="grashof"):
        synthesize(load("luggage"), time_limit=1e-6)
    told = [each.getMessage() for each in caplog.records]
    assert sum(line.startswith("asked to end after ") and line.endswith(": time limit") for line in told) == 1
    assert not any(line.startswith("start ") for line in told)
