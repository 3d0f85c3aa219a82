"""A Dask cluster to work on."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib import import_module

from grashof.problems import ProblemError, SolverError

PATIENCE = 10  # s to wait for an answer


@contextmanager
def cluster(scheduler: str | None, workers: int) -> Iterator[tuple[Executor | None, int]]:
    """Executor of a Dask scheduler, if one is named, and how many it works on at a time.

    Raises
    ------
    ProblemError
        Dask is not installed, or the address is none.
    SolverError
        No scheduler answers.
    """
    if scheduler is None:
        yield None, workers
        return
    try:
        distributed = import_module("distributed")  # without types
    except ImportError:
        raise ProblemError("--scheduler needs Dask; pip install 'grashof[cluster]' installs it") from None
    try:
        client = distributed.Client(scheduler, timeout=PATIENCE)
    except OSError:
        raise SolverError(f"--scheduler {scheduler}: no Dask scheduler answers there") from None
    except ValueError as error:
        raise ProblemError(f"--scheduler {scheduler}: {error}; it must be like tcp://host:8786") from None
    with client:
        yield client.get_executor(), max(2, sum(client.nthreads().values()))
