"""A Dask cluster of two processes on this machine, one of which is lost: the same list."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import os
import signal
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Timer
from time import sleep

from distributed import Client, LocalCluster

from grashof import load, synthesize
from grashof.synth.merging import merge_shards
from grashof.synth.shards import Shard, solve_shard

MORE = {"effort": 4}
SEARCHES = {"luggage": {"starts": 400, "enough": 200}, "path-ellipse": {"effort": 0.6}, "dwell": MORE}


def kill_a_worker(cluster):
    # while a lost process is being started again, the other one is there, or in a moment this one
    while not (pids := [worker.pid for worker in list(cluster.workers.values()) if worker.pid]):
        sleep(0.05)
    os.kill(pids[0], signal.SIGKILL)


def in_one_shard(name, executor=None):
    with TemporaryDirectory() as folder:
        solve_shard(load(name), Shard(1, 1), Path(folder), effort=2, executor=executor, workers=2)
        return merge_shards(Path(folder))


if __name__ == "__main__":
    started = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with started as cluster, Client(cluster) as client:
        ways = [lambda executor=None, given=given: synthesize(load(given[0]), **given[1], executor=executor,
                workers=2) for given in SEARCHES.items()]
        for way in (*ways, partial(in_one_shard, "luggage")):
            alone = way()
            lost = Timer(1.0, kill_a_worker, (cluster,))
            lost.start()
            shared = way(executor=client.get_executor())
            lost.join()
            same = shared.to_frame().to_csv() == alone.to_frame().to_csv() and shared.ended == alone.ended
            print(len(alone), "the same list" if same else "another list", flush=True)
"""


@pytest.mark.study
def test_a_cluster_that_loses_a_worker_gives_the_same_list(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "cluster.py").write_text(SCRIPT, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "cluster.py"], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("the same list") == 4, done.stdout
