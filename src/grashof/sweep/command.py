"""The command `grashof sweep`: what it prints, and what ends it."""

from __future__ import annotations

from pathlib import Path

from grashof.options import SweepOptions
from grashof.output.cluster import cluster
from grashof.output.ending import Exit, interruptible
from grashof.output.folder import SWEEP_PAGE, in_use
from grashof.output.streams import say
from grashof.sweep.files import check_folder
from grashof.sweep.run import sweep
from grashof.sweep.study import load_study


def run(study: str, options: SweepOptions) -> Exit:
    """Solve a study file into a folder, here or on a Dask cluster, and say how it goes."""
    stated = load_study(study)
    folder = options.out if options.out is not None else Path(f"{stated.name}-sweep")
    check_folder(folder, stated)
    with (
        in_use(folder),
        interruptible() as interrupted,
        cluster(options.scheduler, options.workers) as (executor, at_a_time),
    ):
        done = sweep(
            stated,
            out=folder,
            executor=executor,
            workers=at_a_time,
            resume=options.resume,
            designs=options.top,
            progress=lambda step: say(str(step), err=True),
            stop=interrupted,
        )
    say(done.headline)
    if done.best:
        say(f"best: {done.best}")
    if done.results:
        say(f"Open {folder / SWEEP_PAGE} in a browser to look at it; sweep.csv has the table.", err=True)
    if not done.complete:
        say(f"interrupted: --resume goes on; what is finished is in {folder}", err=True)
        return interrupted.code
    return Exit.OK if done.with_designs else Exit.NO_DESIGN
