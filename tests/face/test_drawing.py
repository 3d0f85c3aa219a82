"""Drawings by a copy of the process are those of the process itself, and made here where it is lost."""

import os
import signal
import sys
import threading
from collections.abc import Iterator

import pytest

import grashof.output.drawing as grashof_drawing
from grashof.output.drawing import FORMATS, Files, drawings_of
from grashof.synth import Result

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="a process is copied on Linux alone")


def test_a_copy_draws_the_same(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    given = few.problem, few.candidates[:2]
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: False)
    with drawings_of(*given) as drawn:
        here = list(drawn)
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)
    with drawings_of(*given) as drawn:
        beside = list(drawn)
    assert beside == here
    assert [set(files) for files in here] == [set(FORMATS)] * 2
    assert here[0] != here[1]


def test_what_a_lost_copy_owes_is_drawn_here(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object) -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)
    monkeypatch.setattr(grashof_drawing, "_send", none)
    with drawings_of(few.problem, few.candidates[:2]) as drawn:
        assert [set(files) for files in drawn] == [set(FORMATS)] * 2


def test_a_copy_ends_with_its_list(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)

    def first(drawn: Iterator[Files]) -> Files:
        return next(drawn)

    from multiprocessing import active_children

    with drawings_of(few.problem, few.candidates[:3]) as drawn:
        assert len(active_children()) == 1
        first(drawn)
    assert active_children() == []


def test_none_is_made_beside_other_threads() -> None:
    over = threading.Event()
    other = threading.Thread(target=over.wait)
    other.start()
    assert not grashof_drawing._may_be_copied()
    over.set()
    other.join()
