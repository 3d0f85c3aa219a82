"""Drawings of designs, made in a copy of the process where a core is free: matplotlib is slow."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pickle import PicklingError
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grashof.problems import Problem
    from grashof.synth import Candidate

    # Begins to draw designs, once.
    Drawer = Callable[[Problem, Sequence[Candidate]], Iterator[dict[str, bytes]]]

Files = dict[str, bytes]  # of a drawing, by ending

FORMATS = (".png", ".svg")
_MOST = 20.0  # s; a drawing takes less than one, so that the copy has then failed
_UNSENDABLE = (PicklingError, AttributeError, TypeError)  # errors of pickle for a function without a name


@contextmanager
def drawer(most: int) -> Iterator[Drawer]:
    """A drawer of at most `most` designs, made ready beside this process until there are any, or within it.

    The copy is made here, where it may be: with a single thread and a second core.
    """
    if not most or not _may_be_copied():
        yield _made
        return
    context = get_context("fork")
    ours, theirs = context.Pipe()
    beside = context.Process(target=_draw, args=(theirs, ours), daemon=True)
    beside.start()
    theirs.close()
    try:
        yield partial(_begun, ours)
    finally:
        beside.kill()
        beside.join()
        ours.close()


def _may_be_copied() -> bool:
    """Whether a copy of this process can work beside it: a thread might hold a lock that it needs."""
    return sys.platform == "linux" and threading.active_count() == 1 and len(os.sched_getaffinity(0)) > 1


def _made(problem: Problem, candidates: Sequence[Candidate], done: int = 0) -> Iterator[Files]:
    """Drawings of some designs after the first ones, which are done."""
    for rank, candidate in enumerate(candidates[done:], start=done + 1):
        from grashof.figures.files import draw_design, drawn  # matplotlib takes long to import

        figure = draw_design(problem, candidate, rank)
        yield {ending: drawn(figure, ending) for ending in FORMATS}


def _begun(pipe: Connection, problem: Problem, candidates: Sequence[Candidate]) -> Iterator[Files]:
    """Drawings of the copy, which begins at once; made here where the designs cannot be sent."""
    with suppress(ConnectionError):
        try:
            pipe.send((problem, tuple(candidates)))
        except _UNSENDABLE:
            return _made(problem, candidates)
    return _received(pipe, problem, candidates)


def _received(pipe: Connection, problem: Problem, candidates: Sequence[Candidate]) -> Iterator[Files]:
    """Drawings of the copy; from where it is lost they are made here."""
    done = 0
    with suppress(EOFError, ConnectionError):
        while done < len(candidates) and pipe.poll(_MOST):
            files: Files = pipe.recv()
            yield files
            done += 1
    yield from _made(problem, candidates, done)


def _draw(pipe: Connection, other: Connection) -> None:
    """The work of the copy; it ends with the process that made it, which closes the other end of the pipe."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # which reaches every process of a terminal
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    other.close()
    _get_ready()
    with suppress(EOFError, ConnectionError):
        problem, candidates = pipe.recv()
        for files in _made(problem, candidates):
            pipe.send(files)


def _get_ready() -> None:
    """Import matplotlib, and load its fonts."""
    from matplotlib.figure import Figure

    from grashof.figures.files import drawn

    figure = Figure(figsize=(1, 1))
    figure.add_subplot().set_title("1")
    for ending in FORMATS:
        drawn(figure, ending)
