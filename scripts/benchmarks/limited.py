"""Least squares under active limits against the best designs known, in tests/data.

`limited.json` holds twelve tasks with the best design that three searches found of each, and
`limited_random.json` sixty random ones with the best of `independent_search.py`, which shares nothing with
`grashof.synth`. An error is sqrt(weighted squares / targets), in mm; a ratio is ours / best known. Times are
those of the processor.
"""

import json
import tomllib
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from measuring import Case, spread, timed

from grashof import synthesize
from grashof.problems import Problem
from grashof.problems.files.problem_schema import problem_from

DATA = Path(__file__).parents[2] / "tests" / "data"
KNOWN, RANDOM = DATA / "limited.json", DATA / "limited_random.json"
NEAR = 1.02


def problem_of(text: str, name: str) -> Problem:
    """The problem that a problem file's text states."""
    return problem_from(tomllib.loads(text), name)


def tasks(path: Path) -> list[dict[str, Any]]:
    """Tasks of a file: name, TOML, and the least known error, null where none is known."""
    found: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["tasks"]
    return found


def searched(problem: Problem, **options: Any) -> tuple[float, float]:
    """Least error of a search, infinite where it finds nothing, and the time that it takes, s."""
    result, seconds = timed(partial(synthesize, problem, **options), process_time)
    square = min((each.verdict.square for each in result.candidates), default=np.inf)
    return float(np.sqrt(square / len(problem.task))), seconds


def ratio_to(best: float | None, error: float, problem: Problem) -> float:
    """Error / best, NaN where neither search found anything, 0 where only ours did.

    Errors below the tolerance of the problem count as the tolerance.
    """
    least = problem.requirements.tolerance * problem.task.size
    if best is None:
        return np.nan if np.isinf(error) else 0.0
    return max(error, least) / max(best, least)


def summary(ratios: list[float]) -> str:
    """The number of ratios near 1, the worst one, and tasks without a design."""
    known = np.array([ratio for ratio in ratios if np.isfinite(ratio) and ratio > 0])
    missed, only = np.count_nonzero(np.isinf(ratios)), np.count_nonzero(np.equal(ratios, 0))
    near, worst = np.count_nonzero(known <= NEAR), known.max() if known.size else np.nan
    return (
        f"{near} of {len(known) + missed} within {100 * (NEAR - 1):.0f} %, worst ratio {worst:.3f}, none on "
        f"{missed}; better on {np.count_nonzero(known < 0.999) + only} ({only} of them with no design known)"
    )


def against_known(path: Path, seeds: int, count: int, seed: int) -> Iterator[str]:
    """Ratios to the best known of each task, for some seeds."""
    ratios, seconds = list[float](), list[float]()
    for task in tasks(path)[:count]:
        problem, best = problem_of(task["toml"], task["name"]), task["best"]
        for each in range(seed, seed + seeds):
            error, took = searched(problem, seed=each)
            ratios.append(ratio_to(best, error, problem))
            seconds.append(took)
            yield f"{task['name']}, best {best or np.nan:.6g}, ours/best {ratios[-1]:.3f}, {took:.2f} s"
    yield f"{summary(ratios)}; {spread(seconds)}"


def efforts(count: int, seed: int) -> Iterator[str]:
    """Effort 1 against effort 10: designs that the lesser one missed."""
    ratios = list[float]()
    for task in [*tasks(KNOWN), *tasks(RANDOM)][:count]:
        problem = problem_of(task["toml"], task["name"])
        (plain, _), (hard, _) = (searched(problem, seed=seed, effort=effort) for effort in (1, 10))
        ratios.append(ratio_to(hard if np.isfinite(hard) else None, plain, problem))
        yield f"{task['name']}, effort 1 / effort 10: {ratios[-1]:.3f}"
    yield summary(ratios)


CASES = [
    Case("known tasks", 12, partial(against_known, KNOWN, 5)),
    Case("random tasks", 60, partial(against_known, RANDOM, 1)),
    Case("efforts", 72, efforts),
]
