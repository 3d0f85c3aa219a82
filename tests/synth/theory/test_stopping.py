"""Computations that end on request: at once, or after some time for results."""

import pytest

from grashof.synth.theory import stopping
from grashof.synth.theory.stopping import (
    StopRequested,
    overdue,
    raise_if_overdue,
    raise_if_stopped,
    stop_requested,
)


def test_without_a_request_nothing_stops() -> None:
    assert not stop_requested()
    assert not overdue()
    raise_if_stopped()
    raise_if_overdue()


def test_computations_with_results_soon_have_time_for_them(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 10.0
    monkeypatch.setattr(stopping, "perf_counter", lambda: now)
    with stopping.stopping(lambda: now >= 20):
        raise_if_overdue()
        now = 25.0  # nobody looked before
        assert stop_requested()
        assert not overdue()
        raise_if_overdue()
        with pytest.raises(StopRequested):
            raise_if_stopped()
        now = 25.1 + stopping.GRACE
        assert overdue()
        with pytest.raises(StopRequested):
            raise_if_overdue()
    assert not overdue()
