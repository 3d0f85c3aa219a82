"""A sweep from its study to its files."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import asdict, replace
from pathlib import Path
from time import perf_counter

from grashof.problems import ProblemError
from grashof.problems.values.checks import whole_number
from grashof.sweep.checkpoints import Checkpoints, fingerprint
from grashof.sweep.combinations import combinations
from grashof.sweep.files import check_folder, record_of, write_sweep
from grashof.sweep.result import Step, Sweep
from grashof.sweep.solving import solved
from grashof.sweep.study import Study, load_study
from grashof.sweep.task import Options, invalid, task_key


def sweep(
    study: Study | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    workers: int = 1,
    resume: bool = False,
    designs: int | None = None,
    progress: Callable[[Step], object] | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> Sweep:
    """Solve every combination of a study.

    Parameters
    ----------
    study : Study or path-like
        A study file, or the study that `load_study` made of it.
    out : path-like, optional
        Folder in which each combination is kept as soon as it is finished, and all files at the end; without
        it nothing is written.
    executor : concurrent.futures.Executor, optional
        Where to solve, a combination a task; not shut down. Tasks are text and plain values.
    workers : int
        Processes without an executor. The table does not depend on it.
    resume : bool
        Continue the sweep of the same study that `out` holds.
    designs : int, optional
        In place of the study's own.
    progress : callable, optional
        Called with a `Step` for every combination that is solved.
    stop : callable, optional
        Called all the time; the sweep ends when it returns True, with the tasks finished by then.

    Returns
    -------
    Sweep

    Raises
    ------
    ProblemError
        The study or another argument is invalid, or `out` holds files that must not be replaced.
    SolverError
        A worker process was lost; the finished tasks are in `out`.
    """
    loaded = study if isinstance(study, Study) else load_study(study)
    if designs is not None:
        loaded = replace(loaded, designs=whole_number(designs, 1, "designs"))
    whole_number(workers, 1, "workers")
    if resume and out is None:
        raise ProblemError("resume needs out, the folder of the sweep to continue")
    begun = perf_counter()
    made = combinations(loaded)
    options = Options(loaded.designs, loaded.time_limit)
    keys = tuple(task_key(one.name, one.text, options) if one.text else "" for one in made)
    mark = fingerprint([[dict(one.cells), key] for one, key in zip(made, keys, strict=True)])
    checkpoints = None if out is None else Checkpoints(Path(out))
    check_folder(None if out is None else Path(out), loaded)
    finished = {} if checkpoints is None else checkpoints.read(mark, keys, resume=resume)
    results = {number: finished[key] for number, key in enumerate(keys) if key in finished}
    results |= {number: invalid(one.wrong) for number, one in enumerate(made) if not one.text}
    if checkpoints is not None:
        checkpoints.begin(record_of(Sweep(loaded, made, results), mark, complete=False), finished)
    places: dict[str, list[int]] = {}
    for number, key in enumerate(keys):
        places.setdefault(key, []).append(number)
    report = progress or (lambda _: None)
    for number in places.pop("", []):
        report(Step(len(results), len(made), made[number], results[number]))
    firsts = {key: made[numbers[0]] for key, numbers in places.items() if key not in finished}
    tasks = [(key, one.name, one.text) for key, one in firsts.items()]
    try:
        with closing(solved(tasks, asdict(options), stop, executor, workers)) as ended:
            for key, result in ended:
                if checkpoints is not None:
                    checkpoints.write(key, result)
                results |= dict.fromkeys(places[key], result)
                report(Step(len(results), len(made), made[places[key][0]], result))
    finally:
        done = Sweep(loaded, made, results, perf_counter() - begun)
        if checkpoints is not None:
            write_sweep(checkpoints.folder, done, mark)
    return done
