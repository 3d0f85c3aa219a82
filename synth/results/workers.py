"""Where attempts are made: here, or in other processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from signal import SIG_IGN, SIGINT, signal
from typing import TypeAlias

from grashof.problems import SolverError
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.start import Start
from grashof.synth.results.attempt import Attempt, attempt

# Attempts from starts, numbered from a first one, in their order.
Solver: TypeAlias = Callable[[ScaledProblem, list[Start], int], list[Attempt]]


@contextmanager
def solving(workers: int, executor: Executor | None) -> Iterator[Solver]:
    """A function that makes attempts, in the order of their starts, here or in other processes.

    Parameters
    ----------
    workers : int
        Processes of its own, which end with it; none for one.
    executor : concurrent.futures.Executor, optional
        Where to solve instead; not shut down.

    Raises
    ------
    SolverError
        A process was lost.
    """
    own = None
    if executor is None and workers > 1:
        own = executor = ProcessPoolExecutor(
            workers, mp_context=get_context("spawn"), initializer=_ignore_interrupt
        )

    def solve(scaled: ScaledProblem, batch: list[Start], first: int) -> list[Attempt]:
        numbers = range(first, first + len(batch))
        if executor is None:
            return [attempt(scaled, start, number) for start, number in zip(batch, numbers, strict=True)]
        try:
            return list(executor.map(attempt, [scaled] * len(batch), batch, numbers))
        except BrokenExecutor as error:
            raise SolverError(f"a worker process was lost: {error}") from error

    try:
        yield solve
    finally:
        if own is not None:
            own.shutdown(cancel_futures=True)


def _ignore_interrupt() -> None:
    """Ctrl-C reaches every process of a terminal; the parent alone decides what it means."""
    signal(SIGINT, SIG_IGN)
