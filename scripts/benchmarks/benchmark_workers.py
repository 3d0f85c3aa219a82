"""Measure what processes gain: the same search on one and on several, in turn.

Prints medians over repetitions on this machine, and checks that the lists are the same; and what the
machine itself gives: the time of as many whole searches at once, each in a process that has begun, divided
by their number. No way of sharing one search can do better. Run it on a quiet machine, with one thread a
process for linear algebra (OPENBLAS_NUM_THREADS=1).
"""

import argparse
import os
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from statistics import median
from time import perf_counter
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from grashof import load, synthesize

# One that solves most of the time, and one that screens most of it.
SEARCHES: dict[str, dict[str, Any]] = {
    "luggage": {"starts": 2000, "enough": 800},
    "path-ellipse": {"effort": 10},
}


def alone(name: str) -> float:
    """Time of a search on one process, s."""
    since = perf_counter()
    synthesize(load(name), **SEARCHES.get(name, {}))
    return perf_counter() - since


def at_once(name: str, count: int) -> float:
    """Time of so many whole searches at once, for each, s."""
    with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as processes:
        list(processes.map(alone, ["dwell"] * 2 * count))  # imports are made, programmes built
        since = perf_counter()
        list(processes.map(alone, [name] * count))
        return (perf_counter() - since) / count


def main(argv: Sequence[str] | None = None) -> int:
    """Print times; 1 where lists differ."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("problems", nargs="*", default=list(SEARCHES), help="Of the catalogue.")
    parser.add_argument("--workers", type=int, default=2, help="Processes.")
    parser.add_argument("--runs", type=int, default=3, help="Repetitions.")
    chosen = parser.parse_args(argv)
    same = True
    for name in chosen.problems:
        problem, options = load(name), SEARCHES.get(name, {})
        times: dict[int, list[float]] = {1: [], chosen.workers: []}
        tables = set()
        for _ in range(chosen.runs):
            for workers, seconds in times.items():
                since = perf_counter()
                result = synthesize(problem, **options, workers=workers)
                seconds.append(perf_counter() - since)
                tables.add(result.to_frame().to_csv())
        one, shared = (median(seconds) for seconds in times.values())
        limit = median(at_once(name, chosen.workers) for _ in range(chosen.runs))
        same &= len(tables) == 1
        screening = result.seconds["screening"] / result.seconds["total"]
        print(
            f"{name}: {one:.2f} s on one process, {shared:.2f} s on {chosen.workers}: "
            f"ratio {shared / one:.2f}, where the machine gives {limit / one:.2f}; "
            f"waiting for screening {screening:.0%} of the time; "
            f"{'the same list' if len(tables) == 1 else 'ANOTHER LIST'}"
        )
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
