"""Figures of the live page: from a move to the list, to the first searched design, processor time, memory.

Run by hand on an idle machine: `python scripts/benchmarks/benchmark_live.py`.
"""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx
import numpy as np

TASKS = ("luggage", "path-vertical-line", "path-ellipse")
MOVES = 40
LONG = 1000  # moves over which memory is watched


class Client:
    """A page without a browser."""

    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        origin = f"{parts.scheme}://{parts.netloc}"
        headers = {"Origin": origin, "Grashof-Token": parts.fragment}
        self.http = httpx.Client(base_url=origin, headers=headers, timeout=120)

    def begin(self, name: str) -> dict[str, Any]:
        """The problem of a name."""
        found: dict[str, Any] = self.http.post("/begin", json={"catalogue": name}).json()["document"]
        return found

    def ask(self, what: str, document: dict[str, Any]) -> dict[str, Any]:
        """The last list of a job, when the first one came, and when the last one did."""
        since, first, found = time.perf_counter(), np.nan, {}
        body = {"what": what, "document": document, "name": "task", "page": "figures"}
        with self.http.stream("POST", "/ask", json=body) as answer:
            for line in answer.iter_lines():
                said = json.loads(line)
                if said["kind"] == "list":
                    first = first if np.isfinite(first) else time.perf_counter() - since
                    found = said
                elif said["kind"] == "done":
                    found = {**found, "seconds": said["seconds"]}
        return {**found, "first": first, "all": time.perf_counter() - since}


def moved(document: dict[str, Any], number: int, step: float = 0.004) -> dict[str, Any]:
    """A target a little elsewhere, to and fro."""
    found: dict[str, Any] = json.loads(json.dumps(document))
    targets = found["motion"]["poses"] if "motion" in found else found["path"]["points"]
    size = float(np.ptp(np.array(targets)[:, :2], axis=0).max())
    targets[1][1] += step * size * np.sin(0.35 * number)
    targets[1][0] += step * size * np.sin(0.21 * number)
    return found


def processor_seconds(pids: list[int]) -> float:
    """User and system time of some processes so far."""
    ticks = [Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13] for pid in pids]
    return sum(int(one) + int(other) for one, other in ticks) / 100


def memory(pids: list[int]) -> float:
    """Resident memory of some processes, MB."""
    return sum(int(Path(f"/proc/{pid}/statm").read_text().split()[1]) for pid in pids) * 4096 / 1e6


def children(pid: int) -> list[int]:
    """The solvers of a server."""
    listed = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(each) for each in listed if b"spawn_main" in Path(f"/proc/{each}/cmdline").read_bytes()]


def main() -> None:
    """Print the figures."""
    command = [sys.executable, "-c", "from grashof.cli import main; main()", "live", "--no-browser"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)  # noqa: S603
    assert server.stdout is not None  # noqa: S101
    client = Client(server.stdout.readline().strip())
    for name in TASKS:
        document = client.begin(name)
        client.ask("search", document)
        searched = [client.ask("search", moved(document, k)) for k in range(5)]
        client.ask("search", document)
        solvers = children(server.pid)
        before = processor_seconds(solvers)
        waits = [client.ask("track", moved(document, number))["all"] for number in range(MOVES)]
        used = (processor_seconds(solvers) - before) / MOVES
        first = np.median([each["first"] for each in searched])
        print(
            f"{name}: move to list, s: median {np.median(waits):.3f}, 95 % {np.quantile(waits, 0.95):.3f}, "
            f"most {max(waits):.3f}; processor {used:.3f}; first searched design {first:.3f}"
        )
    document = client.begin("luggage")
    client.ask("search", document)
    everyone = [server.pid, *children(server.pid)]
    for number in range(LONG + 1):
        client.ask("track", moved(document, number))
        if number in (100, LONG // 2, LONG):
            print(f"after {number} moves: {memory(everyone):.1f} MB")
    server.send_signal(signal.SIGINT)
    server.wait()


if __name__ == "__main__":
    main()
