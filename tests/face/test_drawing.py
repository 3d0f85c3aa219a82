"""Drawings by a copy of the process are those of the process itself, and made here where it is lost."""

import os
import signal
import sys
import threading
from collections.abc import Iterator
from dataclasses import fields
from multiprocessing import active_children

import pytest

import grashof.output.drawing as grashof_drawing
from grashof.output.drawing import FORMATS, Files, drawer
from grashof.synth import Result

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="a process is copied on Linux alone")


@pytest.mark.slow
def test_a_copy_draws_the_same(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    given = few.problem, few.candidates[:2]
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: False)
    with drawer(2) as here_too:
        here = list(here_too(*given))
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)
    with drawer(2) as ready:
        beside = list(ready(*given))
    assert beside == here
    assert [set(files) for files in here] == [set(FORMATS)] * 2
    assert here[0] != here[1]


@pytest.mark.slow
def test_drawings_of_a_lost_copy_are_made_here(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object) -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)
    monkeypatch.setattr(grashof_drawing, "_draw", none)
    with drawer(2) as ready:
        drawn = ready(few.problem, few.candidates[:2])
        assert [set(files) for files in drawn] == [set(FORMATS)] * 2


def test_designs_that_cannot_be_sent_are_drawn_here(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)
    monkeypatch.setattr(grashof_drawing, "_received", pytest.fail)
    unnamed = few.problem.__class__.__new__(type("Local", (few.problem.__class__,), {}))
    for field in fields(few.problem):
        object.__setattr__(unnamed, field.name, getattr(few.problem, field.name))
    with drawer(1) as ready:
        assert [set(files) for files in ready(unnamed, few.candidates[:1])] == [set(FORMATS)]


def test_nothing_to_draw_makes_no_copy(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)
    with drawer(0) as ready:
        assert active_children() == []
        assert list(ready(few.problem, ())) == []
    with drawer(3) as ready:  # and one that was ready for nothing ends
        assert len(active_children()) == 1
    assert active_children() == []


def test_a_copy_ends_with_its_list(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: True)

    def first(drawn: Iterator[Files]) -> Files:
        return next(drawn)

    with drawer(3) as ready:
        assert len(active_children()) == 1
        first(ready(few.problem, few.candidates[:3]))
    assert active_children() == []


def test_none_is_made_beside_other_threads() -> None:
    over = threading.Event()
    other = threading.Thread(target=over.wait)
    other.start()
    assert not grashof_drawing._may_be_copied()
    over.set()
    other.join()
