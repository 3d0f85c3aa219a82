"""Measure least squares under active limits against the best designs known.

`tests/data/limited.json` holds twelve tasks with the best design that three searches found of each;
`tests/data/limited_random.json` random ones with the best of `independent_search.py`, which shares nothing
with the package's own search. Random tasks that the file does not hold yet are searched for, which takes some
ten seconds each, and added.

Prints one line a task and a summary. An error is sqrt(weighted squares / targets), in mm; a ratio is
ours / best known.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np
from independent_search import STARTS, search
from limited_tasks import problem_of, random_task

from grashof import synthesize
from grashof.problems import FourBar, Problem

DATA = Path(__file__).parents[2] / "tests" / "data"
ROUNDS = 6  # most of the independent search, each of STARTS starts; fewer once --agree of them agree
AGREED, NEAR = 1.002, 1.02
ABOUT = (
    "Random least-squares tasks with limits, made by limited_tasks.py. best: the least error, "
    "sqrt(sum of weighted squares |dp|^2 + (angle_length * dangle)^2 / number of targets), in length units, "
    "that independent_search.py found and the judge accepted; null where there was none. rounds: the "
    f"same of each round of {STARTS} starts. linkage: fields of FourBar. Written by benchmark_limited.py."
)


@dataclass(frozen=True, slots=True)
class Run:
    """One search of the package: error (infinite where it found nothing), and time taken, s."""

    error: float
    processor: float
    wall: float

    @classmethod
    def of(cls, problem: Problem, seed: int, effort: int | None = None) -> "Run":
        """Search for a problem, with an effort of its own if one is given."""
        wanted: dict[str, Any] = {} if effort is None else {"effort": effort}
        begun, wall = process_time(), perf_counter()
        result = synthesize(problem, seed=seed, **wanted)
        processor, wall = process_time() - begun, perf_counter() - wall
        square = min((each.verdict.square for each in result.candidates), default=np.inf)
        return cls(float(np.sqrt(square / len(problem.task))), processor, wall)


def ratio_to(best: float | None, error: float, problem: Problem) -> float:
    """Error / best, NaN where neither search found anything, 0 where only ours did.

    Errors below the tolerance of the problem count as the tolerance.
    """
    least = problem.requirements.tolerance * problem.task.size
    if best is None:
        return np.nan if np.isinf(error) else 0.0
    return max(error, least) / max(best, least)


def shown(ratio: float) -> str:
    """A ratio as a column prints it."""
    return "  none" if np.isinf(ratio) else "     -" if np.isnan(ratio) else f"{ratio:6.3f}"


def known_tasks(seeds: int) -> None:
    """The tasks with best designs known, for several seeds."""
    ratios: list[float] = []
    runs: list[Run] = []
    for task in json.loads((DATA / "limited.json").read_text(encoding="utf-8"))["tasks"]:
        problem = problem_of(task["toml"], task["name"])
        mine = [Run.of(problem, seed) for seed in range(seeds)]
        each = [ratio_to(task["best"], run.error, problem) for run in mine]
        columns = " ".join(map(shown, each))
        print(f"{task['name']:12} best {task['best']:10.6g}  ours/best {columns}  {times(mine)}", flush=True)
        ratios, runs = ratios + each, runs + mine
    print(f"known tasks, {seeds} seeds: {summary(ratios)}; {times(runs)}")


def times(runs: Sequence[Run]) -> str:
    """Median times of searches."""
    processor, wall = (np.median([getattr(run, name) for run in runs]) for name in ("processor", "wall"))
    return f"median {processor:.2f} s of the processor, {wall:.2f} s in all"


def summary(ratios: Sequence[float]) -> str:
    """How many ratios are near 1, the worst one, and what was not found."""
    known = np.array([ratio for ratio in ratios if np.isfinite(ratio) and ratio > 0])
    missed, only = np.count_nonzero(np.isinf(ratios)), np.count_nonzero(np.equal(ratios, 0))
    count, near = len(known) + missed, np.count_nonzero(known <= NEAR)
    worst = known.max() if known.size else np.nan
    return (
        f"{near} of {count} within {100 * (NEAR - 1):.0f} %, worst ratio {worst:.3f}, none on {missed}; "
        f"better on {np.count_nonzero(known < 0.999) + only} ({only} of them with no design known)"
    )


def random_tasks(references: Sequence[dict[str, Any]]) -> None:
    """Random tasks, one seed each."""
    ratios: list[float] = []
    runs: list[Run] = []
    for task in references:
        problem = problem_of(task["toml"], task["name"])
        run = Run.of(problem, 0)
        ratio = ratio_to(task["best"], run.error, problem)
        best = "      none" if task["best"] is None else f"{task['best']:10.6g}"
        print(f"{task['name']:26} best {best}  ours/best {shown(ratio)}  {run.processor:.2f} s", flush=True)
        ratios.append(ratio)
        runs.append(run)
    print(f"{len(references)} random tasks: {summary(ratios)}; {times(runs)}")


def referenced(path: Path, count: int, agree: int) -> list[dict[str, Any]]:
    """The first random tasks with the best design of the independent search, from the file or added to it.

    Every task gets rounds until so many agree on the best.
    """
    tasks = json.loads(path.read_text(encoding="utf-8"))["tasks"] if path.exists() else []
    for number in range(len(tasks), count):
        name, text = random_task(number)
        tasks.append({"name": name, "toml": text, "best": None, "rounds": [], "linkage": None})
    for task in tasks[:count]:
        before, begun = len(task["rounds"]), process_time()
        while not settled(task["rounds"], agree):
            another_round(task)
        if len(task["rounds"]) == before:
            continue
        print(
            "{name}: best {best}, rounds {rounds}".format(**task),
            f"{process_time() - begun:.1f} s",
            flush=True,
        )
        done = [task for task in tasks if task["rounds"]]
        path.write_text(json.dumps({"about": ABOUT, "tasks": done}, indent=1) + "\n", encoding="utf-8")
    return tasks[:count]


def settled(found: Sequence[float | None], agree: int) -> bool:
    """Whether so many of these rounds agree on the best, or there are too many."""
    errors = np.array([np.inf if error is None else error for error in found])
    agreed = np.count_nonzero(errors <= errors.min() * AGREED) if len(errors) else 0
    return bool(agreed >= agree or len(errors) >= ROUNDS)


def another_round(task: dict[str, Any]) -> None:
    """Search once more for a task, as the file holds it, and note what is found."""
    found = search(problem_of(task["toml"], task["name"]), STARTS, seed=len(task["rounds"]))
    task["rounds"].append(found.error if found else None)
    if found and (task["best"] is None or found.error < task["best"]):
        task.update(best=found.error, linkage=fields_of(found.linkage))


def fields_of(linkage: FourBar) -> dict[str, Any]:
    """A linkage as numbers and lists, by the names of its fields."""
    return {field.name: getattr(linkage, field.name).tolist() for field in fields(linkage)}


def efforts(references: Sequence[dict[str, Any]]) -> None:
    """Effort 1 against effort 10: what the greater one finds that the lesser one missed."""
    ratios: list[float] = []
    plain, hard = list[Run](), list[Run]()
    for task in references:
        problem = problem_of(task["toml"], task["name"])
        plain.append(Run.of(problem, 0, effort=1))
        hard.append(Run.of(problem, 0, effort=10))
        least = hard[-1].error
        ratios.append(ratio_to(least if np.isfinite(least) else None, plain[-1].error, problem))
        print(f"{task['name']:26} effort 1 / effort 10: {shown(ratios[-1])}", flush=True)
    print(f"effort 1 against 10: {summary(ratios)}")
    print(f"effort 1: {times(plain)}; effort 10: {times(hard)}")


def main(argv: Sequence[str] | None = None) -> int:
    """Run the measurements."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=5, help="seeds of the known tasks; 0 leaves them out")
    parser.add_argument("--random", type=int, default=60, metavar="N", help="random tasks")
    parser.add_argument(
        "--reference", type=Path, default=DATA / "limited_random.json", metavar="FILE",
        help="best designs of the random tasks; those missing are searched for and added",
    )  # fmt: skip
    parser.add_argument(
        "--agree", type=int, default=1, help="rounds of the independent search that have to agree on the best"
    )
    parser.add_argument("--only-reference", action="store_true", help="search for those missing, and end")
    parser.add_argument("--effort", action="store_true", help="compare effort 1 with 10, and end")
    options = parser.parse_args(argv)
    references = referenced(options.reference, options.random, options.agree)
    if options.only_reference:
        return 0
    if options.effort:
        known = json.loads((DATA / "limited.json").read_text(encoding="utf-8"))["tasks"]
        efforts([*known, *references])
        return 0
    if options.seeds:
        known_tasks(options.seeds)
    if references:
        random_tasks(references)
    return 0


if __name__ == "__main__":
    sys.exit(main())
