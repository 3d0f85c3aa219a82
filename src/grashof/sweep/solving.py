"""Tasks solved here, in other processes, or by an executor."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from itertools import islice
from typing import Any, TypeAlias

from grashof.problems import SolverError
from grashof.sweep.task import solve_task
from grashof.synth.search.workers import OVER, begun, new_state, processes
from grashof.synth.theory.stopping import stop_request

# Key, name and text of a problem.
Task: TypeAlias = tuple[str, str, str]
Finished: TypeAlias = tuple[str, dict[str, Any]]
_AHEAD = 1000  # tasks that an executor has at once
_PERIOD = 0.2  # s, between calls of `stop` while others solve


def solved(
    tasks: Sequence[Task],
    options: Mapping[str, Any],
    stop: Callable[[], bool],
    executor: Executor | None = None,
    workers: int = 1,
) -> Generator[Finished, None, None]:
    """Key and result of every task as it ends, in no order, except for stopped ones.

    No task begins once `stop` is True. The executor, which gets text and plain values only, is not shut down;
    without one, `workers` new processes, or this one, solve. SolverError where a process was lost and `stop`
    is False. `options` are those of `grashof.sweep.task.Options`.
    """
    if executor is not None:
        yield from _elsewhere(executor, solve_task, tasks, options, stop)
    elif workers > 1 and len(tasks) > 1:
        yield from _in_processes(min(workers, len(tasks)), tasks, options, stop)
    else:
        for key, name, text in tasks:
            if stop():
                return
            if (result := solve_task(name, text, options, stop)) is not None:
                yield key, result


def _in_processes(
    workers: int, tasks: Sequence[Task], options: Mapping[str, Any], stop: Callable[[], bool]
) -> Generator[Finished, None, None]:
    state = new_state()
    own = processes(workers, state)
    try:
        begun(own, workers)
        yield from _elsewhere(own, _solve_until_stopped, tasks, options, stop)
    finally:
        state.value = OVER
        own.shutdown(cancel_futures=True)


def _elsewhere(
    executor: Executor,
    solve: Callable[[str, str, Mapping[str, Any]], dict[str, Any] | None],
    tasks: Sequence[Task],
    options: Mapping[str, Any],
    stop: Callable[[], bool],
) -> Generator[Finished, None, None]:
    left: dict[Future[dict[str, Any] | None], str] = {}
    try:
        waiting = iter(tasks)
        ended = False
        while not ended:
            for key, name, text in islice(waiting, _AHEAD - len(left)):
                left[executor.submit(solve, name, text, dict(options))] = key
            ended = not left or stop()  # tasks finished by then count
            timeout = 0 if ended else _PERIOD
            for future in wait(left, timeout=timeout, return_when=FIRST_COMPLETED).done:
                key = left.pop(future)
                if (result := future.result()) is not None:
                    yield key, result
    except BrokenExecutor as error:
        if not stop():  # a signal to the group of processes ends these, too
            raise SolverError(f"a worker process was lost: {error}; --resume continues it") from error
    finally:
        for future in left:
            future.cancel()


def _solve_until_stopped(name: str, text: str, options: Mapping[str, Any]) -> dict[str, Any] | None:
    return solve_task(name, text, options, stop_request())
