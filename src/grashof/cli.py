"""The command line: solve, check, problems."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from enum import IntEnum
from pathlib import Path
from threading import Event
from types import FrameType
from typing import Annotated

import typer

from grashof.problems import Problem, ProblemError, SolverError, catalogue, load, problem_text


class Exit(IntEnum):
    """Exit codes."""

    OK = 0
    NO_DESIGN = 1
    BAD_INPUT = 2
    SURROUNDINGS = 3
    INTERRUPTED = 130


TOP = 50

app = typer.Typer(
    help="Find planar four-bar linkages that do a job, verify them, and rank them.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

ProblemArgument = Annotated[
    str, typer.Argument(metavar="PROBLEM", help="Name in the catalogue, or a TOML file.")
]


@app.command()
def solve(
    problem: ProblemArgument,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the results; NAME-designs by default.", show_default=False)
    ] = None,
    starts: Annotated[int | None, typer.Option(min=1, help="Most Ipopt solves.", show_default=False)] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Of all randomness.", show_default=False)] = None,
    workers: Annotated[int, typer.Option(min=1, help="Processes; they change the time, not the result.")] = 1,
    time_limit: Annotated[
        float | None, typer.Option(help="Seconds after which no new solves begin.", show_default=False)
    ] = None,
    top: Annotated[
        int | None, typer.Option(min=1, help="Most designs in the list.", show_default=str(TOP))
    ] = None,
    drawings: Annotated[int, typer.Option(min=0, help="How many of them to draw.")] = 8,
) -> None:
    """Find designs for PROBLEM; write the ranked list, the record of the run, and drawings.

    Exit code 0: at least one verified design; 1: none; 2: bad input; 3: the surroundings failed;
    130: interrupted.
    """
    with _errors_told():
        raise typer.Exit(_solve(load(problem), out, starts, seed, workers, time_limit, top, drawings))


@app.command()
def check(problem: ProblemArgument) -> None:
    """Read PROBLEM and say what will be asked of a design, without solving."""
    from grashof.terminal import summary

    with _errors_told():
        for line in summary(load(problem)):
            typer.echo(line)


@app.command()
def problems(
    name: Annotated[
        str | None, typer.Argument(help="Print this problem as TOML, to copy and change.", show_default=False)
    ] = None,
) -> None:
    """List the problems of the catalogue, or print one."""
    with _errors_told():
        if name is not None:
            typer.echo(problem_text(name), nl=False)
            return
        for each in catalogue():
            typer.echo(f"{each:20} {load(each).title}")


def main() -> None:
    """Entry point of the `grashof` command."""
    app(prog_name="grashof")


def _solve(
    problem: Problem,
    out: Path | None,
    starts: int | None,
    seed: int | None,
    workers: int,
    time_limit: float | None,
    top: int | None,
    drawings: int,
) -> Exit:
    from grashof.folder import check_writable
    from grashof.output import write_run
    from grashof.synth import synthesize
    from grashof.terminal import print_table, search_progress

    folder = out if out is not None else Path(f"{problem.name}-designs")
    check_writable(folder)
    enough = max(problem.search.enough, top or 0)
    top = top or TOP
    with _interruptible() as interrupted, search_progress(problem.name) as progress:
        result = synthesize(
            problem,
            starts=starts,
            enough=enough,
            seed=seed,
            workers=workers,
            time_limit=time_limit,
            progress=progress,
            stop=interrupted,
        )
    result = replace(result, candidates=result.candidates[:top])
    if result.candidates or result.complete:  # an interrupted search with nothing to show replaces nothing
        settings = {
            "starts": starts or problem.search.starts,
            "seed": problem.search.seed if seed is None else seed,
            "enough": enough,
            "workers": workers,
            "time_limit": time_limit,
            "top": top,
        }
        files = write_run(folder, result, settings, drawings)
        _report(result.note, files, folder)
    else:
        typer.echo(result.note, err=True)
    if result.candidates:
        print_table(result)
    if interrupted():
        return Exit.INTERRUPTED
    return Exit.OK if result.candidates else Exit.NO_DESIGN


def _report(note: str, files: list[str], folder: Path) -> None:
    if note:
        typer.echo(note, err=True)
    drawn = sum(name.endswith(".png") for name in files)
    named = [name for name in files if name.endswith((".csv", ".json"))]
    pictures = f" and {drawn} drawings (PNG, SVG)" if drawn else ""
    typer.echo(f"{folder}: {', '.join(named)}{pictures}", err=True)


@contextmanager
def _errors_told() -> Iterator[None]:
    """Bad input and failed surroundings end the program with one line, not with a traceback."""
    try:
        yield
    except ProblemError as error:
        typer.echo(f"grashof: {error}", err=True)
        raise typer.Exit(Exit.BAD_INPUT) from None
    except (SolverError, OSError) as error:
        typer.echo(f"grashof: {error}", err=True)
        raise typer.Exit(Exit.SURROUNDINGS) from None
    except KeyboardInterrupt:
        raise typer.Exit(Exit.INTERRUPTED) from None


@contextmanager
def _interruptible() -> Iterator[Callable[[], bool]]:
    """Turn the first Ctrl-C into a request to stop between batches; the second one ends at once."""
    asked = Event()

    def ask(_signal: int, _frame: FrameType | None) -> None:
        asked.set()
        signal.signal(signal.SIGINT, before)

    before = signal.signal(signal.SIGINT, ask)
    try:
        yield asked.is_set
    finally:
        signal.signal(signal.SIGINT, before)
