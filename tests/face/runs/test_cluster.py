"""A Dask scheduler that is named: a task that ends its workers fails, and a lost scheduler is reported."""

from pathlib import Path

import pytest
from command_runs import script_done

SCRIPT = '''
import os
import subprocess
import sys

from grashof import load
from grashof.output.cluster import cluster
from grashof.problems import SolverError
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.workers import CrashError, OnExecutor, Work, screen


def crash(_scaled, code):
    os._exit(code)


SCHEDULER = """
import sys
from distributed import LocalCluster

if __name__ == "__main__":
    started = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    print(started.scheduler_address, flush=True)
    sys.stdin.read()
"""


def nap(_scaled, seconds):
    import time

    time.sleep(seconds)


if __name__ == "__main__":
    with open("scheduler.py", "w", encoding="utf-8") as file:
        file.write(SCHEDULER)
    piped = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    once = {**os.environ, "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"}
    scheduler = subprocess.Popen([sys.executable, "scheduler.py"], env=once, **piped)
    scaled = ScaledProblem.of(load("luggage"))
    with cluster(scheduler.stdout.readline().strip(), 1) as (executor, width):
        work = OnExecutor(executor, width)
        try:
            work.made(crash, scaled, 7)
        except CrashError as error:
            print("failed:", error)
        starts = screen(scaled, 0, 0, 50, 0).starts[:3]
        known = Work().attempts(scaled, starts, 0)
        made = work.attempts(scaled, starts, 0)
        print([one.status for one in made] == [one.status for one in known], flush=True)
        work.begin(nap, scaled, 30)
        scheduler.kill()
        scheduler.wait()
        try:
            work.made(nap, scaled, 30)
        except SolverError as error:
            print("lost:", error)
'''


@pytest.mark.study
def test_a_task_that_ends_workers_fails_and_a_lost_scheduler_is_reported(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    done = script_done(SCRIPT, tmp_path)
    failed, same, lost = done.stdout.splitlines()
    assert failed.startswith("failed: a task ends the workers that do it")
    assert same == "True"
    assert lost == "lost: a worker process was lost: the scheduler was lost"
    assert "Traceback" not in done.stderr
