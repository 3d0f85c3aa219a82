"""Drawings of designs, made in a process beside where a core is free: matplotlib takes its time."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from threading import Thread
from typing import IO, TYPE_CHECKING, cast

if TYPE_CHECKING:
    from grashof.problems import Problem
    from grashof.synth import Candidate

FORMATS = (".png", ".svg")
_BESIDE = "from grashof.output.drawing import draw_what_comes; draw_what_comes()"


class Drawings:
    """Makes drawings in this process, each when it is asked for."""

    def begin(self, problem: Problem, candidates: Sequence[Candidate]) -> None:
        """Name the designs that are to be drawn, in the order in which they are asked for."""
        self._problem, self._candidates = problem, candidates

    def files(self, rank: int) -> dict[str, bytes]:
        """The drawing of the next design, by the endings of its files; `rank` from 1."""
        from grashof.figures.files import draw_design, drawn  # matplotlib takes half a second to import

        figure = draw_design(self._problem, self._candidates[rank - 1], rank)
        return {ending: drawn(figure, ending) for ending in FORMATS}


class DrawingsBeside(Drawings):
    """Made in a process of its own, which gets ready meanwhile; in this one where that is lost.

    Raises
    ------
    OSError
        There can be no such process.
    """

    def __init__(self) -> None:
        # In a session of its own: Ctrl-C in a terminal is for this process.
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", _BESIDE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def begin(self, problem: Problem, candidates: Sequence[Candidate]) -> None:
        """As of `Drawings`; they are made from now on."""
        super().begin(problem, candidates)
        # By a thread: a pipe that nobody reads yet takes little.
        Thread(target=self._tell, args=(pickle.dumps((problem, tuple(candidates))),), daemon=True).start()

    def files(self, rank: int) -> dict[str, bytes]:
        """As of `Drawings`."""
        try:
            found: dict[str, bytes] = pickle.load(cast(IO[bytes], self._process.stdout))
        except (EOFError, pickle.UnpicklingError):
            return super().files(rank)
        return found

    def end(self) -> None:
        """End the process, whatever it does."""
        self._process.kill()
        self._process.wait()
        cast(IO[bytes], self._process.stdout).close()

    def _tell(self, told: bytes) -> None:
        with suppress(OSError), cast(IO[bytes], self._process.stdin) as pipe:
            pipe.write(told)


@contextmanager
def drawings(wanted: int, workers: int = 1) -> Iterator[Drawings]:
    """What makes drawings: a process beside where a core is free besides the workers.

    Parameters
    ----------
    wanted : int
        How many drawings there will be at most.
    workers : int
        Processes that work meanwhile.
    """
    beside = None
    if wanted and free_cores() > workers:
        with suppress(OSError):
            beside = DrawingsBeside()
    try:
        yield beside or Drawings()
    finally:
        if beside is not None:
            beside.end()


def free_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def draw_what_comes() -> None:
    """Make the drawings that `DrawingsBeside` asks for, and write them to stdout."""
    made = Drawings()
    made.begin(*(asked := pickle.load(sys.stdin.buffer)))
    for rank in range(1, len(asked[1]) + 1):
        pickle.dump(made.files(rank), sys.stdout.buffer)
        sys.stdout.buffer.flush()
