"""A Dask cluster of two processes on this machine, one of which is lost: the same list."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import os
import signal
from threading import Timer

from distributed import Client, LocalCluster

from grashof import load, synthesize

SEARCHES = {"luggage": {"starts": 400, "enough": 200}, "path-ellipse": {"effort": 0.6}}

if __name__ == "__main__":
    started = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with started as cluster, Client(cluster) as client:
        for name, options in SEARCHES.items():
            alone = synthesize(load(name), **options)
            lost = Timer(1.0, os.kill, (cluster.workers[0].pid, signal.SIGKILL))
            lost.start()
            shared = synthesize(load(name), **options, executor=client.get_executor(), workers=2)
            lost.join()
            same = shared.to_frame().to_csv() == alone.to_frame().to_csv() and shared.ended == alone.ended
            print(name, len(alone), "the same list" if same else "another list", flush=True)
"""


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_gives_the_same_list(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "cluster.py").write_text(SCRIPT, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "cluster.py"], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("the same list") == 2, done.stdout
