"""Least squares under active limits against the best designs known, in tests/data.

`limited.json` holds twelve tasks with the best design that three searches found of each, and
`limited_random.json` sixty random ones with the best of `independent_search.py`, which shares nothing with
`grashof.synth`. An error is sqrt(weighted squares / targets), in mm; a ratio is ours / best known. Times are
those of the processor.
"""

import json
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from independent_search import search
from measuring import Case, spread, timed

from grashof import synthesize
from grashof.analysis import Verdict, solve_position
from grashof.analysis.judge.planted import planted_path
from grashof.problems import Box, Linkage, PathTask, Problem, Requirements, Rotatability, TargetLimits
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


def _ratio(linkage: Linkage, _: Verdict, rng: np.random.Generator) -> dict[str, Any]:
    """The ratio of two links, away from that of the best design without limits."""
    return {
        "link_ratios": {
            "r4/r2": min(float(linkage.lengths[3] / linkage.lengths[1] * rng.uniform(1.1, 1.5)), 15.0)
        }
    }


def _toggle(_: Linkage, verdict: Verdict, _rng: np.random.Generator) -> dict[str, Any]:
    """A toggle at the last target."""
    return {"at": (TargetLimits(targets=[len(verdict.theta2)], past_deg=(2, 5)),)}


def _place(linkage: Linkage, verdict: Verdict, rng: np.random.Generator) -> dict[str, Any]:
    """Places of A at the first target that begin beyond the best one."""
    least = float(solve_position(linkage, verdict.theta2[0]).a[0]) + rng.uniform(0.02, 0.1)
    return {"at": (TargetLimits(targets=[1], a=Box(x=(least, np.inf))),)}


def _distance(linkage: Linkage, verdict: Verdict, rng: np.random.Generator) -> dict[str, Any]:
    """Distances of A from O4 that are greater than the least of the best design."""
    a = solve_position(linkage, verdict.theta2).a
    least = float(np.hypot(*(a - linkage.o4).T).min())
    return {"distances": {"a-o4": (least * rng.uniform(1.05, 1.2), 1e6)}}


def _direction(linkage: Linkage, verdict: Verdict, rng: np.random.Generator) -> dict[str, Any]:
    """A direction of the coupler at the middle target beyond that of the best design."""
    middle = len(verdict.theta2) // 2
    theta3 = solve_position(linkage, verdict.theta2[middle], verdict.assembly[middle]).theta3
    low = float(np.degrees(np.angle(np.exp(1j * theta3))) + rng.uniform(3, 10))
    return {"at": (TargetLimits(targets=[middle + 1], coupler_angle_deg=(low, low + 50)),)}


LIMITS = {
    "link_ratios": _ratio,
    "toggle": _toggle,
    "place at a target": _place,
    "distances": _distance,
    "coupler at a target": _direction,
}


def beside_independent(name: str, count: int, seed: int) -> Iterator[str]:
    """Least errors under a limit that binds, beside those of the independent search, of random paths."""
    ratios = list[float]()
    for number in range(seed, seed + count):
        rng = np.random.default_rng([11, number])
        task, _ = planted_path(rng, points=9)
        noisy = PathTask(task.positions + rng.normal(0, 0.02 * task.size, task.positions.shape))
        wanted = Requirements(exact=False, rotatability=Rotatability.ANY, transmission_min_deg=10)
        free = synthesize(Problem(task=noisy, requirements=wanted), seed=0).best
        limits = LIMITS[name](free.linkage, free.verdict, rng)
        problem = Problem(task=noisy, requirements=replace(wanted, **limits))
        other, seconds = timed(partial(search, problem, seed=number), process_time)
        error, took = searched(problem, seed=0)
        ratios.append(ratio_to(None if other is None else other.error, error, problem))
        yield f"{name} {number}: ours/independent {ratios[-1]:.4f}; {took:.1f} s and {seconds:.1f} s"
    yield summary(ratios)


CASES = [
    *(
        Case(f"beside an independent search: {name}", 10, partial(beside_independent, name))
        for name in LIMITS
    ),
    Case("known tasks", 12, partial(against_known, KNOWN, 5)),
    Case("random tasks", 60, partial(against_known, RANDOM, 1)),
    Case("efforts", 72, efforts),
]
