"""A search on many processes, simulated: the share of their time that goes into the search.

Chunks of a search are made here and timed, and so is the work of the process in charge with each. Clusters of
several sizes are simulated with chunks drawn from these, not with their mean: one process in charge of all
workers (`grashof solve --workers`, `--scheduler`), which takes chunks in their order, or shards (`--shard
I/N`) with some workers each. ``--count`` is the number of chunks measured.
"""

import heapq
import pickle
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from time import process_time

import numpy as np
from measuring import Case, timed

from grashof import load
from grashof.problems.files.on_disk import write_whole
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import counted
from grashof.synth.search.chunks import AHEAD, chunk, which
from grashof.synth.search.journal import content_of
from grashof.synth.search.plain import plain
from grashof.synth.shards import Plan

WORKERS, TEAM = (10, 100, 1000), 10  # TEAM: workers of a shard
EACH = 50  # chunks of a worker


@dataclass(frozen=True, slots=True)
class Measured:
    """Times of chunks, s: to make each, and for the process in charge to take it in and write it."""

    made: FloatArray
    taken: FloatArray


def measured(name: str, count: int) -> Measured:
    """Times of the chunks of a problem of the catalogue."""
    problem = load(name)
    plan = Plan.of(problem, problem.search)
    (scaled,) = plan.problems
    ledger = plan.ledger(scaled, count)
    made, taken, steps = [], [], []
    chunk(scaled, 0, *which(problem.search, plan.starts))  # programmes are built with the first one
    for number in range(1, count + 1):
        one, seconds = timed(
            partial(chunk, scaled, number, *which(problem.search, plan.starts)), process_time
        )
        made.append(seconds)
        sent = pickle.dumps(one)
        since = process_time()
        received = pickle.loads(sent)  # noqa: S301  (just made)
        steps.append({"step": "chunk", "result": plain(received)})
        ledger.absorb(received)
        taken.append(process_time() - since)
    with tempfile.TemporaryDirectory() as folder:
        _, written = timed(lambda: write_whole(Path(folder) / "000001.json", content_of(steps)))
    return Measured(np.array(made), np.array(taken) + written / count)


def makespan(times: Measured, workers: int, chunks: int, rng: np.random.Generator) -> tuple[float, float]:
    """Time until one process in charge has taken in all chunks, and the time that it was busy.

    A chunk is begun once a worker is free and it is less than AHEAD chunks a worker beyond the first one that
    has not been taken in. They are taken in, in their order, one after the other.
    """
    made, taken = rng.choice(times.made, chunks), rng.choice(times.taken, chunks)
    free, window = [0.0] * workers, AHEAD * workers
    in_charge, over = 0.0, np.zeros(chunks)
    for number in range(chunks):
        open_at = over[number - window] if number >= window else 0.0
        done_at = max(heapq.heappop(free), open_at) + made[number]
        heapq.heappush(free, done_at)
        in_charge = max(in_charge, done_at) + taken[number]
        over[number] = in_charge
    return in_charge, float(taken.sum())


def simulated(name: str, count: int, seed: int) -> Iterator[str]:
    """Times of chunks; then, for clusters of several sizes, the share of time that goes into chunks."""
    times, rng = measured(name, count), np.random.default_rng(seed)
    yield (
        f"{count} chunks of {times.made.mean():.2f} s ({times.made.min():.2f} to {times.made.max():.2f}), "
        f"taken in by the process in charge in {1e3 * times.taken.mean():.1f} ms each"
    )
    for workers in WORKERS:
        for shards in sorted({1, max(1, workers // TEAM)}):
            runs = [makespan(times, workers // shards, workers * EACH // shards, rng) for _ in range(shards)]
            share = float(times.made.mean()) * EACH / max(length for length, _ in runs)
            busy = max(busy / length for length, busy in runs)
            yield (
                f"{workers} workers in {counted(shards, 'shard')}, efficiency {share:.3f}; "
                f"a process in charge is busy {busy:.0%} of the time"
            )


CASES = [Case(name, 60, partial(simulated, name)) for name in ("luggage", "path-ellipse")]
