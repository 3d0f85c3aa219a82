"""Drawings of designs, made beside the lists where a core is free: matplotlib takes its time."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grashof.problems import Problem
    from grashof.synth import Candidate

Files = dict[str, bytes]

FORMATS = (".png", ".svg")
_MOST = 20.0  # s, for a drawing that takes less than one: more, and something is wrong beside


@contextmanager
def drawings_of(problem: Problem, candidates: Sequence[Candidate]) -> Iterator[Iterator[Files]]:
    """Drawings of some designs one after the other, by the endings of their files.

    A copy of this process makes them from now on where there can be one, and else this process, each
    when it is asked for.

    Parameters
    ----------
    problem : Problem
    candidates : sequence of Candidate
    """
    if not candidates or not _may_be_copied():
        yield _made(problem, candidates)
        return
    context = get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    beside = context.Process(target=_send, args=(theirs, problem, candidates), daemon=True)
    beside.start()
    theirs.close()
    try:
        yield _received(ours, problem, candidates)
    finally:
        beside.kill()
        beside.join()
        ours.close()


def _may_be_copied() -> bool:
    """Whether a copy of this process can work beside it: a thread might hold what the copy waits for."""
    return sys.platform == "linux" and threading.active_count() == 1 and len(os.sched_getaffinity(0)) > 1


def _made(problem: Problem, candidates: Sequence[Candidate], done: int = 0) -> Iterator[Files]:
    """Drawings of some designs after the first ones, which are done."""
    for rank, candidate in enumerate(candidates[done:], start=done + 1):
        from grashof.figures.files import draw_design, drawn  # matplotlib takes long to import

        figure = draw_design(problem, candidate, rank)
        yield {ending: drawn(figure, ending) for ending in FORMATS}


def _received(pipe: Connection, problem: Problem, candidates: Sequence[Candidate]) -> Iterator[Files]:
    """What a copy sends; made here from where it is lost."""
    done = 0
    with suppress(EOFError, ConnectionError):
        while done < len(candidates) and pipe.poll(_MOST):
            files: Files = pipe.recv()
            yield files
            done += 1
    yield from _made(problem, candidates, done)


def _send(pipe: Connection, problem: Problem, candidates: Sequence[Candidate]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # which reaches every process of a terminal
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    with suppress(ConnectionError):
        for files in _made(problem, candidates):
            pipe.send(files)
