"""The command line: a command for each verb, and one line for each error."""

from __future__ import annotations

import atexit
import gc
import os
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from importlib.metadata import version
from inspect import Signature, signature
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import typer
from typer.core import TyperGroup

from grashof import commands
from grashof.options import (
    AnalyseOptions,
    AnimateOptions,
    ExportOptions,
    LiveOptions,
    MergeOptions,
    ProveOptions,
    SolveOptions,
    SweepOptions,
    parameters,
)
from grashof.output.ending import ExitCode
from grashof.output.streams import say
from grashof.problems import (
    ProblemError,
    SolverError,
    catalogue,
    linkage_catalogue,
    linkage_text,
    load,
    load_linkage_spec,
    load_with_text,
    problem_text,
)

TRACEBACK = "GRASHOF_TRACEBACK"  # environment variable: unexpected errors with their traceback
# Typer makes the base of its usage errors public only through this one.
_UsageError: type[Exception] = typer.BadParameter.__bases__[0]


class _Commands(TyperGroup):
    """The commands, with one line for a usage error."""

    def main(self, args: Sequence[str] | None = None, *rest: Any, **options: Any) -> Any:
        given = list(sys.argv[1:] if args is None else args)
        if not given:  # the help
            return super().main(given, *rest, **options)
        try:
            code = super().main(given, *rest, **{**options, "standalone_mode": False})
        except _UsageError as error:
            say(f"grashof: {_one_line(error)}", err=True)
            code = ExitCode.BAD_INPUT
        except OSError as error:  # of the help or the version: commands report their own
            say(f"grashof: {f'standard output: {error.strerror}' if error.strerror else error}", err=True)
            code = ExitCode.SURROUNDINGS
        except Exception as error:  # noqa: BLE001  (the outermost boundary: nobody else reports what is left)
            if os.environ.get(TRACEBACK):
                say(traceback.format_exc(), err=True)
            say(f"grashof: {_unexpected(error)}", err=True)
            code = ExitCode.SURROUNDINGS
        sys.exit(code or ExitCode.OK)


app = typer.Typer(
    cls=_Commands,
    help="Find planar four-bar linkages that do a job, verify them, and rank them.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

_Problem = Annotated[str, typer.Argument(metavar="PROBLEM", help="Name in the catalogue, or a TOML file.")]
_Linkage = Annotated[
    str,
    typer.Argument(
        metavar="LINKAGE",
        help="Name in the catalogue of linkages, a linkage file, or DIR/candidates.json#3 (rank or id).",
    ),
]


def _print_version(wanted: bool) -> None:
    if wanted:
        say(f"grashof {version('grashof')}")
        raise typer.Exit


@app.callback()
def grashof(
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print it and exit.")
    ] = False,
) -> None:
    """The command without a subcommand."""


def _command(run: Callable[..., ExitCode | None]) -> Callable[..., None]:
    """Register a command; `options`, where it has them, are of a class of which each field is an option."""
    hints = get_type_hints(run, include_extras=True)
    stated = list(signature(run).parameters.values())
    own = [each.replace(annotation=hints[each.name]) for each in stated if each.name != "options"]
    kept = parameters(hints["options"]) if "options" in hints else []

    @wraps(run)
    def command(**given: Any) -> None:
        with _reported_errors():
            if kept:
                given["options"] = hints["options"](**{each.name: given.pop(each.name) for each in kept})
            raise typer.Exit(run(**given) or ExitCode.OK)

    command.__signature__ = Signature([*own, *kept])  # type: ignore[attr-defined]
    return app.command()(command)


@_command
def solve(problem: _Problem, options: SolveOptions) -> ExitCode:
    """Find designs for PROBLEM; write the ranked list, a page, drawings and the record of the run.

    Exit code 0: at least one verified design; 1: none; 2: bad input; 3: environment error;
    130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP). With --shard, 0: it is done; 1: not yet.
    """
    loaded, text = load_with_text(problem)
    if options.shard is not None:
        return commands.solve_shard(loaded, text, options.shard, options)
    return commands.solve(loaded, text, options)


@_command
def merge(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The --out of the shards.")],
    options: MergeOptions,
) -> ExitCode:
    """Make the list of a search from the shards in DIR; write it there, as solve does.

    Exit code 0: at least one verified design; 1: none; 2: bad input, or shards are missing;
    3: environment error; 130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP).
    """
    return commands.merge(folder, options)


@_command
def sweep(
    study: Annotated[str, typer.Argument(metavar="STUDY", help="A TOML file that states what varies.")],
    options: SweepOptions,
) -> ExitCode:
    """Solve every combination of STUDY; write a table, a plot, a page and the record of the sweep.

    Exit code 0: at least one verified design; 1: none; 2: bad input; 3: environment error;
    130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP).
    """
    return commands.sweep(study, options)


@_command
def check(problem: _Problem) -> None:
    """Read PROBLEM and print what will be required of a design, without solving."""
    from grashof.output.terminal import folded
    from grashof.synth.proof.curve.asked import enclosed
    from grashof.synth.results.advice import advice
    from grashof.synth.search.finder import refuse_unsearchable
    from grashof.wording.problem import summary

    loaded = load(problem)
    refuse_unsearchable(loaded)
    for line in folded(summary(loaded)):
        say(line)
    for told in (advice(loaded), enclosed(loaded)):
        for line in folded([f"note: {told}"] if told else []):
            say(line)


@_command
def prove(problem: _Problem, options: ProveOptions) -> ExitCode:
    """Prove how large the transmission angle of the best design can be, or that there is no design.

    For three to five whole poses, or pairs of a function, of a four-bar; four whole poses of a
    slider-crank; a swing or a stroke. Exit code 0: decided; 1: not decided; 2: bad input;
    3: environment error; 130: interrupted (Ctrl-C).
    """
    return commands.prove(problem, options)


@_command
def judge(linkage: _Linkage, problem: _Problem) -> ExitCode:
    """Print whether LINKAGE, your own, does what PROBLEM asks for, what it misses, and its figures.

    By the judge of every search, from the linkage alone. Exit code 0: it does; 1: it does not; 2: bad input;
    3: environment error.
    """
    return commands.judge(linkage, problem)


@_command
def problems(
    name: Annotated[
        str | None, typer.Argument(help="Print this problem as TOML, to copy and change.", show_default=False)
    ] = None,
) -> None:
    """List the problems of the catalogue, or print one."""
    if name is not None:
        say(problem_text(name).removesuffix("\n"))
        return
    for each in catalogue():
        say(f"{each:20} {load(each).title}")


@_command
def linkages(
    name: Annotated[
        str | None, typer.Argument(help="Print this linkage as TOML, to copy and change.", show_default=False)
    ] = None,
) -> None:
    """List the linkages of the catalogue, or print one."""
    if name is not None:
        say(linkage_text(name).removesuffix("\n"))
        return
    for each in linkage_catalogue():
        say(f"{each:20} {load_linkage_spec(each).title}")


@_command
def analyse(linkage: _Linkage, options: AnalyseOptions) -> None:
    """Report motion and forces of LINKAGE; write tables, a summary, a page and plots.

    Exit code 0: done; 2: bad input; 3: environment error.
    """
    commands.analyse(linkage, options.out, pictures=options.pictures, **options.asked())


@_command
def live(
    options: LiveOptions,
    problem: Annotated[
        str | None,
        typer.Argument(
            metavar="PROBLEM", help="Name in the catalogue, or a TOML file.", show_default="luggage"
        ),
    ] = None,
) -> ExitCode:
    """Edit PROBLEM by hand in the browser, and see the verified list follow.

    Exit code 0: ended by Ctrl-C; 2: bad input; 3: environment error.
    """
    from grashof.live.command import live as serve

    return serve(problem, options.port, browser=options.browser)


@_command
def animate(linkage: _Linkage, options: AnimateOptions) -> None:
    """Animate LINKAGE over a turn of its driver, or from limit to limit and back.

    Exit code 0: done; 2: bad input; 3: environment error.
    """
    commands.animate(linkage, options)


@_command
def export(
    linkage: Annotated[
        str,
        typer.Argument(
            metavar="LINKAGE",
            help="As for analyse; for --xlsx alone also several designs, DIR/candidates.json#1,3,5.",
        ),
    ],
    options: ExportOptions,
) -> None:
    """Write the parts of LINKAGE for the workshop, plates stacked so that nothing collides, or models of it.

    Exit code 0: done; 2: bad input, or a format that cannot represent LINKAGE; 3: environment error.
    """
    from grashof.workshop.export import FORMATS, WORKBOOK, Making, export_files, plan_lines
    from grashof.workshop.plates import PlateSizes

    given = {kind: getattr(options, kind) for kind in (*FORMATS, WORKBOOK)}
    files = {kind: path for kind, path in given.items() if path is not None}
    sizes = PlateSizes(options.width, options.hole, options.thickness, options.clearance)
    making = Making(sizes, options.scale, options.mm_per_unit, options.theta2_deg)
    exported = export_files(linkage, making, files)
    for line in plan_lines(exported.plan) if exported.plan else ():
        say(line)
    say(f"written: {', '.join(map(str, exported.written))}", err=True)
    if exported.refused:
        raise ProblemError("\n".join(exported.refused))


def main() -> None:
    """Entry point of the `grashof` command."""
    # Drawings go to files: a backend meant for windows, or a misspelt one, must not stand in the way.
    os.environ["MPLBACKEND"] = "agg"
    gc.set_threshold(50_000)  # what is loaded stays: to look through it often takes time
    atexit.register(gc.freeze)  # looking through it at the end takes 0.15 s
    app(prog_name="grashof")


def _one_line(error: Exception) -> str:
    message: str = getattr(error, "format_message", error.__str__)()
    return f"{' '.join(message.split()).rstrip('.')}; see grashof --help"


def _unexpected(error: Exception) -> str:
    words = " ".join(f"{type(error).__name__}: {error}".rstrip(": ").split())
    return f"unexpected error: {words}; {TRACEBACK}=1 shows where, please report it with that"


@contextmanager
def _reported_errors() -> Iterator[None]:
    """Bad input and environment errors end the program with one line, not with a traceback."""
    try:
        yield
    except ProblemError as error:
        for line in str(error).splitlines():
            say(f"grashof: {line}", err=True)
        raise typer.Exit(ExitCode.BAD_INPUT) from None
    except (SolverError, OSError) as error:
        say(f"grashof: {error}", err=True)
        raise typer.Exit(ExitCode.SURROUNDINGS) from None
    except KeyboardInterrupt:
        say("grashof: interrupted", err=True)
        raise typer.Exit(ExitCode.INTERRUPTED) from None
