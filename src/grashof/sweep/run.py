"""A sweep from its study to its files."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import asdict, replace
from pathlib import Path
from time import perf_counter
from typing import Any

from grashof.problems import ProblemError
from grashof.problems.values.checks import whole_number
from grashof.sweep.checkpoints import Checkpoints, fingerprint
from grashof.sweep.combinations import Combination, combinations
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
        A study file, or what `load_study` made of it.
    out : path-like, optional
        Folder in which each combination is kept as soon as it is finished, and all files at the end; without
        it nothing is written.
    executor : concurrent.futures.Executor, optional
        Where to solve, a combination a task; not shut down. Tasks are text and plain values.
    workers : int
        Processes without an executor. The table does not depend on it.
    resume : bool
        Go on with the sweep of the same study that `out` holds.
    designs : int, optional
        In place of the study's own.
    progress : callable, optional
        Called with a `Step` for every combination that is solved.
    stop : callable, optional
        Asked all the time; the sweep ends when it returns True, with what is finished.

    Returns
    -------
    Sweep

    Raises
    ------
    ProblemError
        The study or another argument is invalid, or `out` holds what must not be replaced.
    SolverError
        A worker process was lost; what is finished is in `out`.
    """
    stated = study if isinstance(study, Study) else load_study(study)
    if designs is not None:
        stated = replace(stated, designs=whole_number(designs, 1, "designs"))
    whole_number(workers, 1, "workers")
    if resume and out is None:
        raise ProblemError("resume needs out, the folder of the sweep to go on with")
    begun = perf_counter()
    made = combinations(stated)
    options = Options(stated.designs, stated.time_limit)
    keys = tuple(task_key(one.name, one.text, options) if one.text else "" for one in made)
    mark = fingerprint([[dict(one.cells), key] for one, key in zip(made, keys, strict=True)])
    kept, finished = _opened(stated, made, keys, mark, out, resume)
    results = _of_combinations(made, keys, finished)
    places: dict[str, list[int]] = {}
    for number, key in enumerate(keys):
        places.setdefault(key, []).append(number)
    tell = progress or (lambda _: None)
    for number in places.pop("", []):
        tell(Step(len(results), len(made), made[number], results[number]))
    firsts = {key: made[numbers[0]] for key, numbers in places.items() if key not in finished}
    tasks = [(key, one.name, one.text) for key, one in firsts.items()]
    try:
        with closing(solved(tasks, asdict(options), stop, executor, workers)) as ended:
            for key, result in ended:
                if kept is not None:
                    kept.write(key, result)
                results |= dict.fromkeys(places[key], result)
                tell(Step(len(results), len(made), made[places[key][0]], result))
    finally:
        done = Sweep(stated, made, results, perf_counter() - begun)
        if kept is not None:
            write_sweep(kept.folder, done, mark)
    return done


def _opened(
    study: Study,
    made: Sequence[Combination],
    keys: Sequence[str],
    mark: str,
    out: str | os.PathLike[str] | None,
    resume: bool,
) -> tuple[Checkpoints | None, dict[str, dict[str, Any]]]:
    """The folder of the sweep with its record, and the finished tasks in it."""
    check_folder(None if out is None else Path(out), study)
    if out is None:
        return None, {}
    kept = Checkpoints(Path(out))
    finished = kept.read(mark, keys, resume=resume)
    begun = Sweep(study, tuple(made), _of_combinations(made, keys, finished))
    kept.begin(record_of(begun, mark, complete=False), finished)
    return kept, finished


def _of_combinations(
    made: Sequence[Combination], keys: Sequence[str], finished: dict[str, dict[str, Any]]
) -> dict[int, dict[str, Any]]:
    """Results by the place of the combination; of those that state no problem, too."""
    known = {number: finished[key] for number, key in enumerate(keys) if key in finished}
    wrong = {number: invalid(one.wrong) for number, one in enumerate(made) if not one.text}
    return known | wrong
