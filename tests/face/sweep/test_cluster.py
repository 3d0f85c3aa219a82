"""A sweep on a Dask cluster of two processes on this machine: the same table, whatever happens to it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from command_runs import script_done

from grashof.sweep import sweep

pytestmark = pytest.mark.slow
STUDY = """\
problem = "base.toml"
[vary]
"path.points[1].y" = { from = 0.5, to = 1.6, steps = 30 }
[search]
starts = 16
enough = 12
"""
# How the command ends, and what it says: once with a worker killed, once interrupted and gone on with.
SCRIPT = """
import json
import os
import signal
import subprocess
import sys

from distributed import LocalCluster

COMMAND = [sys.executable, "-c", "from grashof.cli import main; main()", "sweep", "study.toml", "--scheduler"]


def run(address, out, after, act, *options):
    command = [*COMMAND, address, "--out", out, *options]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    said = ""
    for line in running.stderr:
        said += line
        if line.startswith(f"{after} of 30: "):
            act(running)
    return {"code": running.wait(timeout=60), "said": said}


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        address = cluster.scheduler_address
        lose = lambda _: os.kill(cluster.workers[0].pid, signal.SIGKILL)
        interrupt = lambda running: running.send_signal(signal.SIGINT)
        print(json.dumps([
            run(address, "lost", 5, lose),
            run(address, "interrupted", 5, interrupt),
            run(address, "interrupted", 0, interrupt, "--resume"),
        ]))
"""


@pytest.mark.study
@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
def test_a_cluster_gives_the_same_table(write: Callable[..., Path], tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    study = write(STUDY)
    runs = json.loads(script_done(SCRIPT, tmp_path).stdout.splitlines()[-1])
    assert [each["code"] for each in runs] == [0, 130, 0], runs
    _, interrupted, resumed = runs
    assert "interrupted: --resume continues it" in interrupted["said"]
    assert resumed["said"].count(" of 30: ") < 30
    sweep(study, out=tmp_path / "here")
    table = (tmp_path / "here" / "sweep.csv").read_bytes()
    assert table.count(b"\n") == 31
    for folder in ("lost", "interrupted"):
        assert (tmp_path / folder / "sweep.csv").read_bytes() == table
