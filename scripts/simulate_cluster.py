"""Simulate a search on many processes: the share of their time that goes into the search.

Chunks of a search are made here and timed; what the process in charge does with each one, too. A simulation
then draws chunks from those that were measured, not from their mean, for clusters of several sizes: one
process in charge of all workers (`grashof solve --workers`, `--scheduler`), which takes chunks in
their order, or shards (`--shard I/N`) with some workers each. Run it on a quiet machine.
"""

import argparse
import heapq
import json
import os
import pickle
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter, process_time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from grashof import load
from grashof.problems.files.on_disk import write_whole
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import counted
from grashof.synth.search.chunks import AHEAD, arguments, chunk
from grashof.synth.search.journal import content_of
from grashof.synth.search.plain import plain
from grashof.synth.shards import Plan

PROBLEMS = ("luggage", "path-ellipse")
WORKERS = (10, 100, 1000)
TEAM = 10  # workers of a shard


@dataclass(frozen=True, slots=True)
class Measured:
    """Times of chunks, s: to make each, and what the process in charge does with each."""

    made: FloatArray
    taken: FloatArray


def measured(name: str, count: int) -> Measured:
    """Times of the chunks of a problem of the catalogue."""
    problem = load(name)
    plan = Plan.of(problem, problem.search)
    (scaled,) = plan.problems
    ledger = plan.ledger(scaled, count)
    made, taken, steps = [], [], []
    chunk(scaled, 0, *arguments(problem.search, plan.starts))  # programmes are built with the first one
    for number in range(1, count + 1):
        since = process_time()
        one = chunk(scaled, number, *arguments(problem.search, plan.starts))
        made.append(process_time() - since)
        sent = pickle.dumps(one)
        since = process_time()
        received = pickle.loads(sent)  # noqa: S301  (what was just made)
        steps.append({"step": "chunk", "result": plain(received)})
        ledger.absorb(received)
        taken.append(process_time() - since)
    with tempfile.TemporaryDirectory() as folder:
        since = perf_counter()
        write_whole(Path(folder) / "000001.json", content_of(steps))
        written = perf_counter() - since
    size = len(json.dumps(steps)) / count
    print(
        f"{name}: {count} chunks of {np.mean(made):.2f} s (from {min(made):.2f} to {max(made):.2f}); "
        f"the process in charge takes {1e3 * np.mean(taken):.1f} ms for each, "
        f"and {1e3 * written / count:.1f} ms to write its {size / 1e3:.0f} kB",
        flush=True,
    )
    return Measured(np.array(made), np.array(taken) + written / count)


def makespan(
    times: Measured, workers: int, chunks: int, rng: np.random.Generator, ahead: int
) -> tuple[float, float]:
    """Time until one process in charge has taken in all chunks, and the time of that which it was busy.

    A chunk is begun once a worker is free and it is less than `ahead` chunks a worker beyond the first one
    that has not been taken in. They are taken in, in their order, one after the other.
    """
    made, taken = rng.choice(times.made, chunks), rng.choice(times.taken, chunks)
    free = [0.0] * workers
    heapq.heapify(free)
    in_charge, over = 0.0, np.zeros(chunks)
    window = ahead * workers
    done_at = np.zeros(chunks)
    for number in range(chunks):
        open_at = over[number - window] if number >= window else 0.0
        begun = max(heapq.heappop(free), open_at)
        done_at[number] = begun + made[number]
        heapq.heappush(free, done_at[number])
        in_charge = max(in_charge, done_at[number]) + taken[number]
        over[number] = in_charge
    return in_charge, float(taken.sum())


def efficiency(
    times: Measured, workers: int, each: int, shards: int, rng: np.random.Generator
) -> tuple[float, float]:
    """Share of the workers' time that goes into chunks, and how busy a process in charge is."""
    team, chunks = workers // shards, workers * each // shards
    runs = [makespan(times, team, chunks, rng, AHEAD) for _ in range(shards)]
    longest = max(length for length, _ in runs)
    useful = float(times.made.mean()) * workers * each
    return useful / (workers * longest), max(busy / length for length, busy in runs)


def main(argv: Sequence[str] | None = None) -> int:
    """Print efficiencies."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("problems", nargs="*", default=list(PROBLEMS), help="Of the catalogue.")
    parser.add_argument("--chunks", type=int, default=60, help="Chunks that are measured.")
    parser.add_argument("--each", type=int, default=50, help="Chunks a worker in the simulation.")
    chosen = parser.parse_args(argv)
    rng = np.random.default_rng(0)
    for name in chosen.problems:
        times = measured(name, chosen.chunks)
        for workers in WORKERS:
            for shards in sorted({1, max(1, workers // TEAM)}):
                share, busy = efficiency(times, workers, chosen.each, shards, rng)
                print(
                    f"  {workers} workers in {counted(shards, 'shard')}: efficiency {share:.3f}; "
                    f"a process in charge is busy {busy:.0%} of the time",
                    flush=True,
                )
    return 0


if __name__ == "__main__":
    sys.exit(main())
