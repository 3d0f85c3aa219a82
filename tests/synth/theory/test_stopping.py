"""Computations that end when asked: at once, or when they have had time to come to something."""

import pytest

from grashof.synth.theory import stopping
from grashof.synth.theory.stopping import Stopped, asked_to_stop, give_way, leave_off, overdue


def test_nobody_asks() -> None:
    assert not asked_to_stop()
    assert not overdue()
    give_way()
    leave_off()


def test_what_soon_comes_to_something_has_time_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 10.0
    monkeypatch.setattr(stopping, "perf_counter", lambda: now)
    with stopping.stopping(lambda: now >= 20):
        leave_off()
        now = 25.0  # nobody looked before
        assert asked_to_stop()
        assert not overdue()
        leave_off()
        with pytest.raises(Stopped):
            give_way()
        now = 25.1 + stopping.GRACE
        assert overdue()
        with pytest.raises(Stopped):
            leave_off()
    assert not overdue()
