"""Time to make the page of a search, and time of the live page from a move to the list.

The live page is measured over HTTP, without a browser; its processor time and memory are read from /proc.
"""

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any
from urllib.parse import urlsplit

import httpx
import numpy as np
from measuring import Case, spread, timed

from grashof import load, synthesize
from grashof.page.search import search_page
from grashof.synth.designs.table import rows_of

RECORD = {"versions": {"grashof": ""}, "settings": {}}
RUNS = 5


def search_page_of(name: str, count: int, seed: int) -> Iterator[str]:
    """Time and size of a page for `count` designs; the list repeats to fill it."""
    found = synthesize(load(name), seed=seed)
    repeated = found.candidates * -(-count // max(len(found), 1))
    result, times = replace(found, candidates=repeated[:count]), []
    with TemporaryDirectory() as folder:
        path = Path(folder) / "report.html"
        for _ in range(RUNS):
            rows, valued = timed(partial(rows_of, result.problem, result.candidates))
            begun = perf_counter()
            path.write_text(search_page(result, RECORD, rows=rows), encoding="utf-8")
            times.append((valued, perf_counter() - begun))
        size = path.stat().st_size / 1e6
    values, page = (median(each) for each in zip(*times, strict=True))
    yield f"{len(result)} designs ({len(found)} distinct), their values {values:.2f} s"
    yield f"page made and written in {page:.2f} s, {size:.2f} MB"


@dataclass(frozen=True, slots=True)
class Live:
    """A server of the live page, and a page without a browser."""

    pid: int
    http: httpx.Client

    def begin(self, name: str) -> dict[str, Any]:
        """The problem of a name, as a document."""
        found: dict[str, Any] = self.http.post("/begin", json={"catalogue": name}).json()["document"]
        return found

    def ask(self, what: str, document: dict[str, Any]) -> tuple[float, float]:
        """Seconds to the first list of a job, and to its end."""
        since, first = perf_counter(), np.nan
        body = {"what": what, "document": document, "name": "task", "page": "figures"}
        with self.http.stream("POST", "/ask", json=body) as answer:
            for line in answer.iter_lines():
                if json.loads(line)["kind"] == "list" and np.isnan(first):
                    first = perf_counter() - since
        return first, perf_counter() - since

    @property
    def solvers(self) -> list[int]:
        """Processes of the server that solve."""
        listed = Path(f"/proc/{self.pid}/task/{self.pid}/children").read_text().split()
        return [int(each) for each in listed if b"spawn_main" in Path(f"/proc/{each}/cmdline").read_bytes()]

    def processor_seconds(self) -> float:
        """User and system time of the solvers so far."""
        stats = [Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split() for pid in self.solvers]
        return sum(int(ticks) for stat in stats for ticks in stat[11:13]) / 100

    def megabytes(self) -> float:
        """Resident memory of server and solvers."""
        every = [self.pid, *self.solvers]
        return sum(int(Path(f"/proc/{pid}/statm").read_text().split()[1]) for pid in every) * 4096 / 1e6


@contextmanager
def live() -> Iterator[Live]:
    """A server with a search of the luggage problem behind it."""
    command = [sys.executable, "-c", "from grashof.cli import main; main()", "live", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:  # noqa: S603
        parts = urlsplit(server.stdout.readline().strip() if server.stdout else "")
        origin = f"{parts.scheme}://{parts.netloc}"
        headers = {"Origin": origin, "Grashof-Token": parts.fragment}
        try:
            yield Live(server.pid, httpx.Client(base_url=origin, headers=headers, timeout=120))
        finally:
            server.send_signal(signal.SIGINT)


def moved(document: dict[str, Any], number: int, step: float = 0.004) -> dict[str, Any]:
    """A target moved slightly, back and forth."""
    found: dict[str, Any] = json.loads(json.dumps(document))
    targets = found["motion"]["poses"] if "motion" in found else found["path"]["points"]
    size = float(np.ptp(np.array(targets)[:, :2], axis=0).max())
    targets[1][1] += step * size * np.sin(0.35 * number)
    targets[1][0] += step * size * np.sin(0.21 * number)
    return found


def moves(name: str, count: int, seed: int) -> Iterator[str]:
    """From a move to the list, for `count` moves; processor time of each; the first searched design."""
    with live() as page:
        document = page.begin(name)
        page.ask("search", document)
        first = np.median([page.ask("search", moved(document, seed + k))[0] for k in range(5)])
        page.ask("search", document)
        before = page.processor_seconds()
        waits = [page.ask("track", moved(document, seed + number))[1] for number in range(count)]
        used = (page.processor_seconds() - before) / count
        yield f"{spread(waits)}; processor {used:.3f} s; first searched design {first:.3f} s"


def memory(count: int, seed: int) -> Iterator[str]:
    """Memory over many moves."""
    with live() as page:
        document = page.begin("luggage")
        page.ask("search", document)
        for number in range(count + 1):
            page.ask("track", moved(document, seed + number))
            if number in (count // 10, count // 2, count):
                yield f"{page.megabytes():.1f} MB after {number} moves"


CASES = [
    Case("page of a search, luggage", 200, partial(search_page_of, "luggage")),
    *(
        Case(f"live, {name}", 40, partial(moves, name))
        for name in ("luggage", "path-vertical-line", "path-ellipse")
    ),
    Case("live, memory", 1000, memory),
]
