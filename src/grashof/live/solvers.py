"""Live pages, and the solver processes that work for them: warm, interruptible, replaced when one is lost."""

from __future__ import annotations

import asyncio
import signal
from collections import OrderedDict
from collections.abc import AsyncGenerator, Callable
from contextlib import aclosing, suppress
from dataclasses import dataclass, field, replace
from enum import Enum
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from time import monotonic

from grashof.live.requests import Job, Line, error_line
from grashof.problems.values.errors import wrong_value

WARM = 2  # one works, the other takes over while that one stops
GRACE = 2.0  # s to stop in, after which a solver is replaced
PAUSE = 0.002  # s between two checks of a solver
MOST_PAGES = 16
_MOST_NAME = 64


class State(Enum):
    """State of a solver."""

    STARTING = "starting"
    IDLE = "idle"
    WORKING = "working"
    STOPPING = "stopping"  # leaving its job


STOP, DONE, READY = "stop", "done", "ready"
TRIES = WARM + 1  # of a job: all warm solvers may be lost together, and none of them over it
LOST = f"{TRIES} solvers were lost over this; the task is left as it is"


def run_solver(pipe: Connection) -> None:
    """The work of a solver process: job after job, until the pipe closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the server, which closes the pipe
    from grashof.live.work import lines, warm_up

    with suppress(EOFError, BrokenPipeError, ConnectionResetError):
        warm_up()
        pipe.send(READY)
        while True:
            job = pipe.recv()
            if job == STOP:  # it came after the end of its job
                continue
            try:
                lines(job, pipe.poll, pipe.send)
            except (OSError, EOFError):
                raise
            except Exception as error:  # noqa: BLE001  (the outermost boundary: nothing else reports it)
                pipe.send(error_line(f"unexpected {type(error).__name__}: {error}"))
            pipe.send(DONE)


@dataclass(slots=True, eq=False)
class Solver:
    """A process for one job at a time; `stopped` is the time (s) of a request to stop."""

    process: BaseProcess
    pipe: Connection
    state: State = State.STARTING
    stopped: float = 0.0

    @classmethod
    def started(cls) -> Solver:
        """A new process, which reports when it is ready."""
        context = get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=run_solver, args=(theirs,), daemon=True)
        process.start()
        theirs.close()
        return cls(process, ours)

    def received(self) -> object | None:
        """The next message, or None; `EOFError` where the process is lost."""
        with suppress(OSError):  # also of a pipe that another job closed when it replaced this solver
            return self.pipe.recv() if self.pipe.poll() else None
        raise EOFError

    def give(self, job: Job) -> None:
        """Give it a job; `EOFError` where it is lost."""
        try:
            self.pipe.send(job)
        except OSError:
            raise EOFError from None

    def stop(self) -> None:
        """Make it leave its job."""
        if self.state is State.WORKING:
            self.state, self.stopped = State.STOPPING, monotonic()
            with suppress(OSError):
                self.pipe.send(STOP)

    def end(self) -> None:
        """Kill the process."""
        self.process.kill()
        self.process.join()
        self.pipe.close()


@dataclass(slots=True)
class Solvers:
    """Warm solvers, for jobs of any page."""

    warm: int = WARM
    every: list[Solver] = field(default_factory=list)

    def start(self) -> None:
        """Begin to warm them up."""
        self.every += [Solver.started() for _ in range(self.warm - len(self.every))]

    def end(self) -> None:
        """End them all."""
        for solver in self.every:
            solver.end()
        self.every.clear()

    async def lines(self, job: Job, left: Callable[[], bool]) -> AsyncGenerator[Line]:
        """Lines of a job, which begins again where its solver is lost, and stops once `left` is True."""
        for _ in range(TRIES):
            solver = await self._taken(left)
            if solver is None:
                return
            try:
                async for line in self._done_by(solver, job, left):
                    yield line
                return
            except EOFError:
                self._replace(solver)
            finally:
                solver.stop()  # where it is not done
        yield error_line(LOST)

    async def _done_by(self, solver: Solver, job: Job, left: Callable[[], bool]) -> AsyncGenerator[Line]:
        solver.give(job)
        while True:
            found = solver.received()
            if isinstance(found, Line):
                if left():
                    return
                yield found
            elif found == DONE:
                solver.state = State.IDLE
                return
            elif left():
                return
            else:
                await asyncio.sleep(PAUSE)

    async def _taken(self, left: Callable[[], bool]) -> Solver | None:
        """A solver for a job, as soon as one is idle; None once the job is left."""
        while not left():
            self._look()
            for solver in self.every:
                if solver.state is State.IDLE:
                    solver.state = State.WORKING
                    return solver
            await asyncio.sleep(PAUSE)
        return None

    def _look(self) -> None:
        """Find solvers that have become ready; replace those that are lost or do not stop."""
        for solver in list(self.every):
            try:
                while (
                    solver.state in (State.STARTING, State.STOPPING)
                    and (said := solver.received()) is not None
                ):
                    if said in (READY, DONE):
                        solver.state = State.IDLE
            except EOFError:
                self._replace(solver)
                continue
            late = solver.state is State.STOPPING and monotonic() > solver.stopped + GRACE
            if late or not solver.process.is_alive():
                self._replace(solver)

    def _replace(self, solver: Solver) -> None:
        solver.end()
        if solver in self.every:
            self.every[self.every.index(solver)] = Solver.started()


@dataclass(slots=True, eq=False)
class Session:
    """A page: its designs, as a solver wrote them, and its newest job; earlier jobs are left."""

    solvers: Solvers
    shown: bytes = b""
    newest: Job | None = None

    async def lines(self, job: Job) -> AsyncGenerator[str]:
        """Lines of a job, as JSON, until the page requests a newer one; a file is made beside other jobs."""
        aside = job.what == "file"
        if not aside:
            self.newest = job
        job = job if aside else replace(job, shown=self.shown)
        mine = self.newest

        def left() -> bool:
            return not aside and self.newest is not mine

        async with aclosing(self.solvers.lines(job, left)) as lines:
            async for line in lines:
                if line.shown is not None and not left():
                    self.shown = line.shown
                yield line.text


@dataclass(slots=True)
class Sessions:
    """Pages by their names; of more than `MOST_PAGES` the least recently used is forgotten."""

    solvers: Solvers
    pages: OrderedDict[str, Session] = field(default_factory=OrderedDict)

    def of(self, page: object) -> Session:
        """The page of a name; ProblemError where the name is invalid."""
        if not isinstance(page, str) or not 0 < len(page) <= _MOST_NAME:
            raise wrong_value("page", page, f"a name of up to {_MOST_NAME} characters")
        if page not in self.pages:
            self.pages[page] = Session(self.solvers)
            if len(self.pages) > MOST_PAGES:
                self.pages.popitem(last=False)
        self.pages.move_to_end(page)
        return self.pages[page]
