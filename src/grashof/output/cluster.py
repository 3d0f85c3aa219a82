"""A Dask cluster to work on."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from grashof.problems import ProblemError, SolverError
from grashof.synth.search.workers import CrashError

PATIENCE = 10  # s to wait for an answer


class _Cluster(Executor):
    """Dask's executor; a task that ends one worker after another (`killed`, in Dask) is a `CrashError`."""

    def __init__(self, dask: Executor, killed: type[Exception]) -> None:
        self._dask, self._killed = dask, killed

    def submit(self, function: Callable[..., Any], /, *given: Any, **named: Any) -> Future[Any]:
        """Begin a task."""
        theirs, ours = self._dask.submit(function, *given, **named), Future[Any]()

        def pass_on(done: Future[Any]) -> None:
            if not ours.set_running_or_notify_cancel():
                return
            error = BrokenExecutor("the scheduler was lost") if done.cancelled() else done.exception()
            if isinstance(error, self._killed):
                error = CrashError(f"a task ends the workers that do it: {error}")
            if error is None:
                ours.set_result(done.result())
            else:
                ours.set_exception(error)

        theirs.add_done_callback(pass_on)
        ours.add_done_callback(lambda done: done.cancelled() and theirs.cancel())
        return ours


# They would print tracebacks of a lost scheduler before the one line that reports it.
_NOISY = ("distributed.client", "distributed.core", "distributed.comm.core", "distributed.utils")


@contextmanager
def cluster(scheduler: str | None, workers: int) -> Iterator[tuple[Executor | None, int]]:
    """Executor of a Dask scheduler, if one is named, and its number of tasks at a time.

    ProblemError where Dask is missing or the address is invalid; SolverError where no scheduler answers.
    """
    if scheduler is None:
        yield None, workers
        return
    try:
        distributed = import_module("distributed")  # without types
    except ImportError:
        raise ProblemError("--scheduler needs Dask; pip install 'grashof[cluster]' installs it") from None
    for name in _NOISY:
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = distributed.Client(scheduler, timeout=PATIENCE)
    except OSError:
        raise SolverError(f"--scheduler {scheduler}: no Dask scheduler answers there") from None
    except ValueError as error:
        raise ProblemError(f"--scheduler {scheduler}: {error}; it must be like tcp://host:8786") from None
    with client:
        yield (
            _Cluster(client.get_executor(), distributed.KilledWorker),
            max(2, sum(client.nthreads().values())),
        )
