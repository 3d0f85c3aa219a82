"""The command `grashof sweep`: what it prints, and what ends it."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from types import FrameType

from grashof.output.folder import SWEEP_PAGE
from grashof.output.streams import say
from grashof.sweep.result import Sweep
from grashof.sweep.run import sweep
from grashof.sweep.study import load_study


def run(study: str, out: Path | None, workers: int, resume: bool, top: int | None) -> Sweep:
    """Solve a study file into a folder, and say how it goes."""
    stated = load_study(study)
    folder = out if out is not None else Path(f"{stated.name}-sweep")
    with _interruptible() as interrupted:
        done = sweep(
            stated,
            out=folder,
            workers=workers,
            resume=resume,
            designs=top,
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
    return done


@contextmanager
def _interruptible() -> Iterator[Callable[[], bool]]:
    """Turn the first Ctrl-C or SIGTERM into a request to stop; the second one ends at once."""
    asked = Event()
    signals = (signal.SIGINT, signal.SIGTERM)
    before = {number: signal.getsignal(number) for number in signals}

    def ask(_signal: int, _frame: FrameType | None) -> None:
        asked.set()
        for number in signals:
            signal.signal(number, before[number])

    for number in signals:
        signal.signal(number, ask)
    try:
        yield asked.is_set
    finally:
        for number in signals:
            signal.signal(number, before[number])
