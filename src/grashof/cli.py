"""The command line: a command for each verb, its options, and one line for each error."""

from __future__ import annotations

import atexit
import gc
import os
import sys
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from grashof import commands
from grashof.commands import TOP, Options
from grashof.output.ending import Exit
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
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.specs.problem import EFFORTS
from grashof.study.asked import FIT_POINTS, ON_REQUEST, STEP

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
            code = Exit.BAD_INPUT
        except OSError as error:  # of the help or the version: commands report their own
            say(f"grashof: {f'standard output: {error.strerror}' if error.strerror else error}", err=True)
            code = Exit.SURROUNDINGS
        except Exception as error:  # noqa: BLE001  (the outermost boundary: nobody else reports what is left)
            if os.environ.get(TRACEBACK):
                say(traceback.format_exc(), err=True)
            say(f"grashof: {_unexpected(error)}", err=True)
            code = Exit.SURROUNDINGS
        sys.exit(code or Exit.OK)


app = typer.Typer(
    cls=_Commands,
    help="Find planar four-bar linkages that do a job, verify them, and rank them.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

ProblemArgument = Annotated[
    str, typer.Argument(metavar="PROBLEM", help="Name in the catalogue, or a TOML file.")
]

LinkageArgument = Annotated[
    str,
    typer.Argument(
        metavar="LINKAGE",
        help="Name in the catalogue of linkages, a linkage file, or DIR/candidates.json#3 (rank or id).",
    ),
]

WorkersOption = Annotated[int, typer.Option(min=1, help="Processes; they change the time, not the result.")]

TopOption = Annotated[
    int | None,
    typer.Option(
        min=1,
        help="Most families of like designs in the list.",
        show_default=f"{TOP}, or search.enough if more",
    ),
]

GapOption = Annotated[
    float, typer.Option(min=1e-4, max=90, help="Deg up to which proofs bring their bounds together.")
]

SchedulerOption = Annotated[
    str | None,
    typer.Option(help="Dask scheduler to work on, such as tcp://host:8786.", show_default=False),
]

DrawingsOption = Annotated[int, typer.Option(min=0, help="Designs to draw.")]


def _tell_version(wanted: bool) -> None:
    if wanted:
        say(f"grashof {version('grashof')}")
        raise typer.Exit


@app.callback()
def grashof(
    _version: Annotated[
        bool, typer.Option("--version", callback=_tell_version, is_eager=True, help="Print it and exit.")
    ] = False,
) -> None:
    """The command without a subcommand."""


@app.command()
def solve(
    problem: ProblemArgument,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the results; NAME-designs by default.", show_default=False)
    ] = None,
    starts: Annotated[int | None, typer.Option(min=1, help="Most Ipopt solves.", show_default=False)] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Random seed.", show_default=False)] = None,
    workers: WorkersOption = 1,
    time_limit: Annotated[
        float | None, typer.Option(help="Seconds after which no new solves begin.", show_default=False)
    ] = None,
    gap: GapOption = 0.01,
    prove: Annotated[
        bool, typer.Option("--prove", help="Give proofs minutes where they need them, not seconds.")
    ] = False,
    top: TopOption = None,
    drawings: DrawingsOption = 3,
    effort: Annotated[
        float | None,
        typer.Option(
            min=EFFORTS[0],
            max=EFFORTS[1],
            help="How long to look for better designs; 1 is usual.",
            show_default=False,
        ),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the unfinished search in --out.")
    ] = False,
    scheduler: SchedulerOption = None,
    shard: Annotated[
        str | None,
        typer.Option(
            metavar="I/N", help="Part I of N of the whole search; grashof merge follows.", show_default=False
        ),
    ] = None,
    log: Annotated[
        Path | None,
        typer.Option(help="File to append a log to: rounds, every start, what was lost.", show_default=False),
    ] = None,
) -> None:
    """Find designs for PROBLEM; write the ranked list, a page, drawings and the record of the run.

    Exit code 0: at least one verified design; 1: none; 2: bad input; 3: environment error;
    130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP). With --shard, 0: it is done; 1: not yet.
    """
    with _errors_told():
        loaded, text = load_with_text(problem)
        options = Options(
            out=out,
            starts=starts,
            seed=seed,
            effort=effort,
            workers=workers,
            time_limit=time_limit,
            gap=gap,
            prove=prove,
            top=top,
            drawings=drawings,
            resume=resume,
            scheduler=scheduler,
            log=log,
        )
        if shard is not None:
            raise typer.Exit(commands.solve_shard(loaded, text, shard, options))
        raise typer.Exit(commands.solve(loaded, text, options))


@app.command()
def merge(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The --out of the shards.")],
    partial: Annotated[
        bool, typer.Option("--partial", help="Be content with the shards that are done.")
    ] = False,
    workers: WorkersOption = 1,
    top: TopOption = None,
    drawings: DrawingsOption = 3,
) -> None:
    """Make the list of a search from the shards in DIR; write it there, as solve does.

    Exit code 0: at least one verified design; 1: none; 2: bad input, or shards are missing;
    3: environment error; 130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP).
    """
    with _errors_told():
        raise typer.Exit(commands.merge(folder, partial=partial, top=top, drawings=drawings, workers=workers))


@app.command()
def sweep(
    study: Annotated[str, typer.Argument(metavar="STUDY", help="A TOML file that states what varies.")],
    out: Annotated[
        Path | None, typer.Option(help="Folder for the results; NAME-sweep by default.", show_default=False)
    ] = None,
    workers: WorkersOption = 1,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with what the folder holds.")] = False,
    top: Annotated[
        int | None, typer.Option(min=1, help="Best designs listed of each combination.", show_default=False)
    ] = None,
    scheduler: SchedulerOption = None,
) -> None:
    """Solve every combination of STUDY; write a table, a plot, a page and the record of the sweep.

    Exit code 0: at least one verified design; 1: none; 2: bad input; 3: environment error;
    130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP).
    """
    from grashof.sweep.command import run

    with _errors_told():
        raise typer.Exit(run(study, out, workers, resume, top, scheduler))


@app.command()
def check(problem: ProblemArgument) -> None:
    """Read PROBLEM and print what will be required of a design, without solving."""
    from grashof.output.terminal import folded
    from grashof.synth.proof.curve.asked import enclosed
    from grashof.synth.results.advice import advice
    from grashof.synth.starts.finder import refuse_unsearchable
    from grashof.wording.problem import summary

    with _errors_told():
        loaded = load(problem)
        refuse_unsearchable(loaded)
        for line in folded(summary(loaded)):
            say(line)
        for told in (advice(loaded), enclosed(loaded)):
            for line in folded([f"note: {told}"] if told else []):
                say(line)


@app.command()
def prove(
    problem: ProblemArgument,
    at_least: Annotated[
        float | None,
        typer.Option(min=0, max=90, help="Only decide whether a design has so many deg.", show_default=False),
    ] = None,
    gap: GapOption = 0.01,
    time_limit: Annotated[
        float | None, typer.Option(help="Seconds after which the bound so far counts.", show_default=False)
    ] = None,
    certificate: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="File for the proof of four poses, for scripts/check_certificate.py.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Prove how large the transmission angle of the best design can be, or that there is no design.

    For three to five whole poses, or pairs of a function, of a four-bar; four whole poses of a
    slider-crank; a swing or a stroke. Exit code 0: decided; 1: not decided; 2: bad input;
    3: environment error; 130: interrupted (Ctrl-C).
    """
    with _errors_told():
        raise typer.Exit(commands.prove(problem, at_least, gap, time_limit, certificate))


@app.command()
def judge(linkage: LinkageArgument, problem: ProblemArgument) -> None:
    """Print whether LINKAGE, your own, does what PROBLEM asks for, what it misses, and its figures.

    By the judge of every search, from the linkage alone. Exit code 0: it does; 1: it does not; 2: bad input;
    3: environment error.
    """
    with _errors_told():
        raise typer.Exit(commands.judge(linkage, problem))


@app.command()
def problems(
    name: Annotated[
        str | None, typer.Argument(help="Print this problem as TOML, to copy and change.", show_default=False)
    ] = None,
) -> None:
    """List the problems of the catalogue, or print one."""
    with _errors_told():
        if name is not None:
            say(problem_text(name).removesuffix("\n"))
            return
        for each in catalogue():
            say(f"{each:20} {load(each).title}")


@app.command()
def linkages(
    name: Annotated[
        str | None, typer.Argument(help="Print this linkage as TOML, to copy and change.", show_default=False)
    ] = None,
) -> None:
    """List the linkages of the catalogue, or print one."""
    with _errors_told():
        if name is not None:
            say(linkage_text(name).removesuffix("\n"))
            return
        for each in linkage_catalogue():
            say(f"{each:20} {load_linkage_spec(each).title}")


@app.command()
def analyse(
    linkage: LinkageArgument,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the results; NAME-analysis by default.", show_default=False),
    ] = None,
    speed_rpm: Annotated[
        float | None,
        typer.Option(help="Of the driver, clockwise below 0; the file's by default.", show_default=False),
    ] = None,
    pictures: Annotated[
        bool, typer.Option("--pictures", help="Plots of all sections as PNG and SVG, not in the page alone.")
    ] = False,
    at: Annotated[
        str | None,
        typer.Option(help="Driver angles, deg, to look at closely: 0,90,180,270.", show_default=False),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(
            help="Length of a history over time, or of the free motion, s.",
            show_default="no history; 5 of the free motion",
        ),
    ] = None,
    step: Annotated[float | None, typer.Option(help="Of the history, s.", show_default=str(STEP))] = None,
    start_deg: Annotated[
        float | None,
        typer.Option(
            help="Driver angle at its beginning.", show_default="0, or the end of the driver's first range"
        ),
    ] = None,
    with_: Annotated[
        str | None,
        typer.Option("--with", help=f"Longer sections, of {', '.join(ON_REQUEST)}.", show_default=False),
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="All of these.")] = False,
    fit_from_deg: Annotated[
        float | None,
        typer.Option(
            help="Driver angle from which paths are fitted.",
            show_default="the task motion of a design, or all that the driver does",
        ),
    ] = None,
    fit_to_deg: Annotated[
        float | None, typer.Option(help="Driver angle up to which they are.", show_default=False)
    ] = None,
    fit_points: Annotated[int, typer.Option(help="Points through which they are.")] = FIT_POINTS,
    dwell_deg: Annotated[
        float | None,
        typer.Option(help="Report how long link 4 (link 6) dwells in a band so wide.", show_default=False),
    ] = None,
    balance: Annotated[
        bool, typer.Option("--balance", help="Report counterweights, before and after.")
    ] = False,
    flywheel: Annotated[
        float | None,
        typer.Option(help="Report the flywheel for this fluctuation of speed: 0.05.", show_default=False),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(
            help="Report how far P and link 4 (6) move where dimensions are off by so much (length unit).",
            show_default=False,
        ),
    ] = None,
    release: Annotated[
        float | None,
        typer.Option(
            metavar="DEG",
            help="Report the free motion from this driver angle, from rest by default.",
            show_default=False,
        ),
    ] = None,
    release_rpm: Annotated[
        float | None, typer.Option(help="Speed of the driver at the release.", show_default=False)
    ] = None,
) -> None:
    """Report motion and forces of LINKAGE; write tables, a summary, a page and plots.

    Exit code 0: done; 2: bad input; 3: environment error.
    """
    with _errors_told():
        commands.analyse(
            linkage,
            out,
            pictures=pictures,
            speed_rpm=speed_rpm,
            at_deg=_numbers(at, "--at"),
            seconds=seconds,
            step=step,
            start_deg=start_deg,
            sections=ON_REQUEST if every else _words(with_),
            fit_from_deg=fit_from_deg,
            fit_to_deg=fit_to_deg,
            fit_points=fit_points,
            dwell_deg=dwell_deg,
            balance=balance,
            flywheel=flywheel,
            tolerance=tolerance,
            release_deg=release,
            release_rpm=release_rpm,
        )


@app.command()
def live(
    problem: Annotated[
        str | None,
        typer.Argument(
            metavar="PROBLEM", help="Name in the catalogue, or a TOML file.", show_default="luggage"
        ),
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Of the server; 0 takes a free one.")] = 0,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
) -> None:
    """Edit PROBLEM by hand in the browser, and see the verified list follow.

    Exit code 0: ended by Ctrl-C; 2: bad input; 3: environment error.
    """
    with _errors_told():
        from grashof.live.command import live as serve

        raise typer.Exit(serve(problem, port, browser=browser))


@app.command()
def animate(
    linkage: LinkageArgument,
    out: Annotated[
        Path | None, typer.Option(help="File, .gif or .mp4; NAME.gif by default.", show_default=False)
    ] = None,
    seconds: Annotated[float, typer.Option(min=0.1, max=20, help="Length of the motion.")] = 4.0,
    fps: Annotated[float, typer.Option(min=1, max=50, help="Frames a second.")] = 25.0,
) -> None:
    """Animate LINKAGE over a turn of its driver, or from limit to limit and back.

    Exit code 0: done; 2: bad input; 3: environment error.
    """
    with _errors_told():
        commands.animate(linkage, out, seconds, fps)


@app.command()
def export(
    linkage: Annotated[
        str,
        typer.Argument(
            metavar="LINKAGE",
            help="As for analyse; for --xlsx alone also several designs, DIR/candidates.json#1,3,5.",
        ),
    ],
    dxf: Annotated[
        Path | None, typer.Option(help="Drawing of the parts to cut, and how they stack.", show_default=False)
    ] = None,
    svg: Annotated[Path | None, typer.Option(help="The same drawing.", show_default=False)] = None,
    step: Annotated[
        Path | None, typer.Option(help="The parts as solids, assembled.", show_default=False)
    ] = None,
    stl: Annotated[Path | None, typer.Option(help="The same as flats.", show_default=False)] = None,
    mujoco: Annotated[
        Path | None, typer.Option(help="Model for MuJoCo, an .xml file.", show_default=False)
    ] = None,
    geogebra: Annotated[
        Path | None, typer.Option(help="Worksheet for GeoGebra, a .ggb file.", show_default=False)
    ] = None,
    solidworks: Annotated[
        Path | None, typer.Option(help="Equations for SolidWorks, a .txt file.", show_default=False)
    ] = None,
    freecad: Annotated[
        Path | None, typer.Option(help="Table for FreeCAD, a .csv file.", show_default=False)
    ] = None,
    linkage2: Annotated[
        Path | None, typer.Option(help="Document of the program Linkage.", show_default=False)
    ] = None,
    xlsx: Annotated[
        Path | None,
        typer.Option(help="Excel workbook: the list, and a sheet for each design.", show_default=False),
    ] = None,
    width: Annotated[float, typer.Option(help="Of the links, mm.")] = 20.0,
    hole: Annotated[float, typer.Option(help="Diameter of holes and pins, mm.")] = 6.0,
    thickness: Annotated[float, typer.Option(help="Of the material, mm.")] = 5.0,
    clearance: Annotated[
        float | None,
        typer.Option(
            help="Least gap between parts on one layer, mm.", show_default="a twentieth of the width"
        ),
    ] = None,
    scale: Annotated[str, typer.Option(help="Of a model: 0.05 or 1:20.")] = "1",
    mm_per_unit: Annotated[
        float | None,
        typer.Option(help="Where the length unit is not mm, cm, m, in or ft.", show_default=False),
    ] = None,
    theta2_deg: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="LOW HIGH",
            help="Range of driver angles used; all that the driver reaches by default.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Write the parts of LINKAGE for the workshop, plates stacked so that nothing collides, or models of it.

    Exit code 0: done; 2: bad input, or a format that cannot represent LINKAGE; 3: environment error.
    """
    from grashof.workshop.export import Making, export_files, plan_lines
    from grashof.workshop.plates import PlateSizes

    given = {
        "dxf": dxf, "svg": svg, "step": step, "stl": stl, "mujoco": mujoco, "geogebra": geogebra,
        "solidworks": solidworks, "freecad": freecad, "linkage2": linkage2, "xlsx": xlsx,
    }  # fmt: skip
    files = {kind: path for kind, path in given.items() if path is not None}
    with _errors_told():
        making = Making(PlateSizes(width, hole, thickness, clearance), scale, mm_per_unit, theta2_deg)
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


def _words(given: str | None) -> tuple[str, ...]:
    return tuple(word.strip() for word in given.split(",")) if given is not None else ()


def _numbers(given: str | None, option: str) -> tuple[float, ...]:
    try:
        return tuple(map(float, _words(given)))
    except ValueError:
        raise wrong_value(option, given, "numbers with commas between them, such as 0,90,180") from None


def _one_line(error: Exception) -> str:
    message: str = getattr(error, "format_message", error.__str__)()
    return f"{' '.join(message.split()).rstrip('.')}; see grashof --help"


def _unexpected(error: Exception) -> str:
    words = " ".join(f"{type(error).__name__}: {error}".rstrip(": ").split())
    return f"unexpected error: {words}; {TRACEBACK}=1 shows where, please report it with that"


@contextmanager
def _errors_told() -> Iterator[None]:
    """Bad input and environment errors end the program with one line, not with a traceback."""
    try:
        yield
    except ProblemError as error:
        for line in str(error).splitlines():
            say(f"grashof: {line}", err=True)
        raise typer.Exit(Exit.BAD_INPUT) from None
    except (SolverError, OSError) as error:
        say(f"grashof: {error}", err=True)
        raise typer.Exit(Exit.SURROUNDINGS) from None
    except KeyboardInterrupt:
        say("grashof: interrupted", err=True)
        raise typer.Exit(Exit.INTERRUPTED) from None
