"""Where screenings and attempts are made: here, or in other processes."""

from __future__ import annotations

import logging
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from multiprocessing import connection, get_context, parent_process, resource_tracker
from threading import Thread, Timer
from typing import Any, TypeAlias, TypeVar

import numpy as np

from grashof.problems import SolverError
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import LEFT_ALONE, Attempt, attempts
from grashof.synth.search.finder import finder_for
from grashof.synth.theory.stopping import StopRequested, stop_requested, stop_when

_LOG = logging.getLogger(__name__)
# Solves begun for each process before they are known to be needed: of least squares, and exact ones, which
# are bundled.
AHEAD, AHEAD_EXACT, BUNDLE = 4, 16, 4
LARGER = 2  # times the draws and starts of a usual round: rounds that more effort adds
LOOK = 0.1  # s between two checks whether to stop
LONG = 0.7  # s after which processes begin, which takes as long again
CRASHED = "Crashed"  # status of a start that ends the process that solves it

STOP, OVER = 1, 2  # orders to the processes: to accept the current results, and to end

T = TypeVar("T")
# A function of a module, of the problem and some numbers; its value depends on nothing else.
Make: TypeAlias = Callable[..., T]


def screen(scaled: ScaledProblem, effort: int, number: int, enough: int, seed: int) -> Round | None:
    """One round of the search for starts, independent of the others."""
    key = (effort, number) if effort or number else ()
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
    # effort 0: the usual rounds; those that a greater effort adds are larger
    return finder_for(scaled).round(number, enough, rng, LARGER if effort else 1)


@lru_cache(maxsize=8)
def _unpacked(packed: bytes) -> ScaledProblem:
    """The same object each time, so that its cached values stay."""
    scaled: ScaledProblem = pickle.loads(packed)  # noqa: S301  (from the parent process, as all that it sends)
    return scaled


def solved_there(packed: bytes, *starts: Proposal) -> list[Attempt]:
    """Attempts, in a process that receives the problem in bytes."""
    return attempts(_unpacked(packed), starts, 0)


def made_there(make: Make[T], packed: bytes, *which: float) -> T:
    """The value of `Work.made`, in a process that receives the problem in bytes."""
    return make(_unpacked(packed), *which)


class Work:
    """Screenings and attempts, functions of their arguments, made in this process one after the other."""

    width: int = 1  # number that can be made at a time
    lost: int = 0  # how often a process was lost and replaced

    def attempts(self, scaled: ScaledProblem, starts: Sequence[Proposal], first: int, /) -> list[Attempt]:
        """Attempts from starts, numbered from a first one, in their order."""
        return attempts(scaled, starts, first)

    def made(self, make: Make[T], scaled: ScaledProblem, /, *which: float) -> T:
        """The value of a function of a module for the problem and some numbers, such as a round."""
        return make(scaled, *which)

    def begin_attempts(self, scaled: ScaledProblem, starts: Sequence[Proposal], /) -> None:
        """Begin attempts that may be needed; here none."""

    def begin(self, make: Make[Any], scaled: ScaledProblem, /, *which: float) -> bool:
        """Begin work that `made` may need; whether it was not begun before. Here none."""
        return False


class OnExecutor(Work):
    """On an executor, `width` at a time; work that may be needed is begun early, and dropped if it is not."""

    def __init__(self, executor: Executor, width: int) -> None:
        self._executor, self.width, self.lost = executor, width, 0
        self._last: tuple[ScaledProblem, bytes] | None = None
        # Work by its function, problem and numbers; attempts with their place in a bundle, by the identity of
        # the start, which is kept with them.
        self._begun: dict[tuple[Any, ...], Future[Any]] = {}
        self._solves: dict[int, tuple[Future[list[Attempt]], int, Proposal]] = {}

    def attempts(self, scaled: ScaledProblem, starts: Sequence[Proposal], first: int, /) -> list[Attempt]:
        """Attempts from starts; `CRASHED` is the status of one that ends the process that makes it."""
        made = []
        for number, start in enumerate(starts):
            try:
                one = self._solved(scaled, start, starts[number:])
            except CrashError:
                one = Attempt(CRASHED, None)
            except StopRequested:
                one = Attempt(LEFT_ALONE, None)
            made.append(_numbered(one, first + number))
        return made

    def made(self, make: Make[T], scaled: ScaledProblem, /, *which: float) -> T:
        """The value of a function."""
        key = (make, self._packed(scaled), *which)
        begun = self._begun.pop(key, None)
        future: Future[T] = self._submit(made_there, *key) if begun is None else begun
        try:
            return self._waited_for(future)
        except BrokenExecutor as error:
            self._lost(error)
        done: T = self._alone(made_there, *key)
        return done

    def begin_attempts(self, scaled: ScaledProblem, starts: Sequence[Proposal], /) -> None:
        """Begin as many as there may soon be processes for."""
        if self.width > 1:
            self._begin_solves(scaled, starts[: (AHEAD_EXACT if scaled.exact else AHEAD) * self.width])

    def begin(self, make: Make[Any], scaled: ScaledProblem, /, *which: float) -> bool:
        """Begin a function; whether it was not begun before."""
        key = (make, self._packed(scaled), *which)
        if self.width == 1 or key in self._begun:
            return False
        self._begun[key] = self._submit(made_there, *key)
        return True

    def drop(self) -> None:
        """Cancel all work in progress."""
        for future in (*self._begun.values(), *(future for future, _, _ in self._solves.values())):
            future.cancel()
        self._begun.clear()
        self._solves.clear()

    def _packed(self, scaled: ScaledProblem) -> bytes:
        """The problem in bytes, packed once."""
        if self._last is None or self._last[0] is not scaled:
            self._last = (scaled, pickle.dumps(scaled))
        return self._last[1]

    def _begin_solves(self, scaled: ScaledProblem, starts: Sequence[Proposal]) -> None:
        """Begin attempts: exact ones, which take milliseconds each, in bundles."""
        fresh = [start for start in starts if id(start) not in self._solves]
        size = BUNDLE if scaled.exact and self.width > 1 else 1
        for begin in range(0, len(fresh), size):
            bundle = fresh[begin : begin + size]
            future = self._submit(solved_there, self._packed(scaled), *bundle)
            self._solves |= {id(start): (future, place, start) for place, start in enumerate(bundle)}

    def _solved(self, scaled: ScaledProblem, start: Proposal, starts: Sequence[Proposal]) -> Attempt:
        """The attempt from the first of some starts."""
        if id(start) not in self._solves:
            self._begin_solves(scaled, starts)
        future, place, _ = self._solves.pop(id(start))
        try:
            return self._waited_for(future)[place]
        except CrashError:  # by any of the bundle
            pass
        except BrokenExecutor as error:
            self._lost(error)
        (one,) = self._alone(solved_there, self._packed(scaled), start)
        return one

    def _submit(self, function: Callable[..., T], *given: Any) -> Future[T]:
        try:
            return self._executor.submit(function, *given)
        except BrokenExecutor as error:
            self._lost(error)
            return self._executor.submit(function, *given)

    def _alone(self, function: Callable[..., T], *given: Any) -> T:
        """Work repeated alone, which shows whether it caused a loss."""
        try:
            return self._waited_for(self._submit(function, *given))
        except BrokenExecutor as error:
            self._lost(error)
            raise CrashError(f"a worker process was lost twice: {error}") from error

    def _waited_for(self, future: Future[T]) -> T:
        while not future.done() and not wait([future], LOOK).done:
            self._look()
        return future.result()

    def _look(self) -> None:
        if stop_requested():
            raise StopRequested

    def _lost(self, error: BrokenExecutor) -> None:
        raise SolverError(f"a worker process was lost: {error}") from error


class CrashError(SolverError):
    """Work that ends the process that does it."""


class Processes(OnExecutor):
    """In own processes, which begin once a search takes long and end with it; a lost one is replaced."""

    def __init__(self, count: int) -> None:
        self._state = new_state()
        self._first: Future[int] | None = None  # the answer of the first process
        self._executor: ProcessPoolExecutor
        super().__init__(processes(count, self._state), count)
        self._timer = Timer(LONG, self._begin)
        self._timer.start()

    def _begin(self) -> None:
        try:
            self._first = begun(self._executor, self.width)
        except OSError as error:  # too many processes, or no memory
            _LOG.warning("the search goes on in one process, since no others can be begun: %s", error)

    def _ready(self) -> bool:
        """Whether a process is there to work."""
        return self._first is not None and self._first.done()

    def end(self) -> None:
        """End the processes and their work, also those that have not come to look for orders."""
        self._timer.cancel()
        self._timer.join()
        self._state.value = OVER
        self.drop()
        if not self._ready():
            # Of this executor alone: other threads have processes of their own.
            for each in list((self._executor._processes or {}).values()):
                each.terminate()
        self._executor.shutdown(cancel_futures=True)

    def attempts(self, scaled: ScaledProblem, starts: Sequence[Proposal], first: int, /) -> list[Attempt]:
        """Attempts from starts; in this process while the others begin."""
        made, some = list[Attempt](), BUNDLE if scaled.exact else 1
        while len(made) < len(starts) and not self._ready():
            made += attempts(scaled, starts[len(made) :][:some], first + len(made))
        return made + super().attempts(scaled, starts[len(made) :], first + len(made))

    def made(self, make: Make[T], scaled: ScaledProblem, /, *which: float) -> T:
        """The value of a function; made in this process while the others begin, unless one has begun it."""
        if self._ready() or (make, self._packed(scaled), *which) in self._begun:
            return super().made(make, scaled, *which)
        return make(scaled, *which)

    def begin(self, make: Make[Any], scaled: ScaledProblem, /, *which: float) -> bool:
        """Begin a function, once there are processes; whether it was not begun before."""
        return self._first is not None and super().begin(make, scaled, *which)

    def begin_attempts(self, scaled: ScaledProblem, starts: Sequence[Proposal], /) -> None:
        """Begin as many as there may soon be processes for, once these run."""
        if self._ready():
            super().begin_attempts(scaled, starts)

    def _look(self) -> None:
        if stop_requested():
            self._state.value = STOP

    def _lost(self, error: BrokenExecutor) -> None:  # lost work is done again
        self.lost += 1
        _LOG.warning("a worker process was lost and is replaced: %s", error)
        self.drop()
        self._executor.shutdown(cancel_futures=True)
        self._executor = processes(self.width, self._state)
        self._first = begun(self._executor, self.width)


@contextmanager
def working(workers: int, executor: Executor | None) -> Iterator[Work]:
    """Where screenings and attempts are made.

    In as many own processes as there are `workers`, which end with it (none for one), or on an `executor`
    that has as many and is not shut down. SolverError where the executor was lost.
    """
    if executor is not None:
        elsewhere = OnExecutor(executor, workers)
        try:
            yield elsewhere
        finally:
            elsewhere.drop()
    elif workers > 1:
        own = Processes(workers)
        try:
            yield own
        finally:
            own.end()
    else:
        yield Work()


def _numbered(one: Attempt, number: int) -> Attempt:
    """An attempt with the number of its start."""
    if one.candidate is None:
        return one
    cognates = tuple(replace(each, start=number) for each in one.cognates)
    return replace(one, candidate=replace(one.candidate, start=number), cognates=cognates)


def new_state() -> Any:
    """The order to `processes` by its value: none (0), `STOP` or `OVER`."""
    return get_context("spawn").RawValue("b", 0)  # no lock: one that a killed process holds is never free


def processes(count: int, state: Any) -> ProcessPoolExecutor:
    """Processes that end once `state` is `OVER`, even in the middle of work, and with this one."""
    context = get_context("spawn")
    return ProcessPoolExecutor(count, mp_context=context, initializer=_begin_worker, initargs=(state,))


def begun(executor: Executor, count: int) -> Future[int]:
    """Begin all processes of an executor; return once the first of them runs."""
    if sys.platform == "win32":
        return executor.submit(abs, 0)
    resource_tracker.ensure_running()  # begun with them otherwise, it would let Ctrl-C through again
    # Ctrl-C reaches every process of a terminal: where it comes before a process can ignore it, that one
    # would end with a traceback. So it waits in them, and here while they are begun.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        first, *_ = [executor.submit(abs, 0) for _ in range(count)]  # each begins one
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return first


def _begin_worker(state: Any) -> None:
    """Ctrl-C reaches every process of a terminal, and the parent alone decides what it means."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    stop_when(lambda: state.value >= STOP)
    Thread(target=_end_in_time, args=(state,), daemon=True).start()


def _end_in_time(state: Any) -> None:
    parent = parent_process()
    sentinels = [parent.sentinel] if parent is not None else []
    while state.value < OVER and not connection.wait(sentinels, LOOK):
        pass
    os._exit(0)
