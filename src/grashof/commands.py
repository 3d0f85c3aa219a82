"""The commands that do not search: their output and files."""

from __future__ import annotations

import json
import webbrowser
from contextlib import closing, suppress
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path
from socket import AF_INET, SO_REUSEADDR, SOCK_STREAM, SOL_SOCKET, socket
from typing import Annotated

import typer

import grashof.problems
from grashof.options import (
    AnalyseOptions,
    AnimateOptions,
    ExportOptions,
    LinkageName,
    LiveOptions,
    ProblemName,
    ProveOptions,
)
from grashof.output.folder import ANALYSIS_PAGE, ANALYSIS_RECORD, check_writable
from grashof.output.process import ExitCode, interruptible, say, say_page, say_written
from grashof.problems.files.design_link import is_link
from grashof.problems.files.on_disk import LINKAGES, PROBLEMS, Catalogue
from grashof.problems.schema import FileKind
from grashof.problems.values.errors import AssemblyError, ProblemError, SolverError


def check(problem: ProblemName) -> None:
    """Read PROBLEM and print the requirements on a design, without solving."""
    from grashof.output.terminal import folded
    from grashof.synth.proof.curve.required import enclosed
    from grashof.synth.results.explain import advice
    from grashof.synth.search.finder import refuse_unsearchable
    from grashof.wording.problem import summary

    loaded = grashof.problems.load(problem)
    refuse_unsearchable(loaded)
    notes = [f"note: {note}" for note in (advice(loaded), enclosed(loaded)) if note]
    for line in folded([*summary(loaded), *notes]):
        say(line)


def prove(problem: ProblemName, options: ProveOptions) -> ExitCode:
    """Prove how large the transmission angle of the best design can be, or that there is no design.

    For three to five complete poses, or pairs of a function, of a four-bar; four complete poses of a
    slider-crank; a swing or a stroke. Exit code 0: decided; 1: not decided; 2: bad input;
    3: environment error; 130: interrupted (Ctrl-C).
    """
    from grashof.synth import prove as proven
    from grashof.synth.proving import has_certificate
    from grashof.wording.proof import bound_line, is_decided, work_line

    loaded = grashof.problems.load(problem)
    with interruptible() as interrupted:
        proof = proven(loaded, **asdict(options), stop=interrupted)
        say(bound_line(proof, options.at_least))
        if proof.pairs:
            say(work_line(proof))
        if options.certificate is not None and not has_certificate(proof):
            say(f"certificate {options.certificate}: not written, for no bound was reached", err=True)
        if interrupted():
            return interrupted.code
    return ExitCode.OK if is_decided(proof, options.at_least) else ExitCode.NO_DESIGN


def judge(linkage: LinkageName, problem: ProblemName) -> ExitCode:
    """Print whether your own LINKAGE meets PROBLEM, the requirements that it misses, and its figures.

    By the judge of every search, from the linkage alone. Exit code 0: met; 1: missed; 2: bad input;
    3: environment error.
    """
    from grashof.wording.problem import judged_for, verdict_lines

    spec = grashof.problems.load_linkage_spec(linkage)
    judged = judged_for(grashof.problems.load(problem), spec)
    for line in verdict_lines(judged, spec.name):
        say(line)
    return ExitCode.OK if judged.verdict.ok else ExitCode.NO_DESIGN


def show(
    linkage: Annotated[
        str,
        typer.Argument(metavar="LINKAGE", help="Folder or list of a search, or as for analyse."),
    ],
    number: Annotated[
        str | None,
        typer.Argument(
            metavar="[NUMBER]", help="Rank or id of the design in the list.", show_default="1, the best"
        ),
    ] = None,
) -> None:
    """Print a design as a linkage file of a few lines, which judge and analyse read to the last digit.

    Exit code 0: done; 2: bad input; 3: environment error.
    """
    from grashof.problems.files.linkage_writing import mail_toml

    say(mail_toml(grashof.problems.load_linkage_spec(_in_list(linkage, number))).removesuffix("\n"))


def _in_list(given: str, number: str | None) -> str:
    """The name of a linkage: of a folder or list that of a design in it."""
    if is_link(given):
        if number is not None:
            raise ProblemError(f"NUMBER is {number}; a link has one design")
        return given
    folder = Path(given)
    listed = folder / "candidates.json" if folder.is_dir() and given not in LINKAGES.names else folder
    if listed.suffix == ".json":
        return f"{listed}#{number or 1}"
    if number is not None:
        raise ProblemError(
            f"NUMBER is {number}; {given} is one linkage; NUMBER needs a folder or list of a search"
        )
    return given


def problems(
    name: Annotated[
        str | None, typer.Argument(help="Print this problem as TOML, to copy and change.", show_default=False)
    ] = None,
) -> None:
    """List the problems of the catalogue, or print one."""
    _say_catalogue(PROBLEMS, name)


def linkages(
    name: Annotated[
        str | None, typer.Argument(help="Print this linkage as TOML, to copy and change.", show_default=False)
    ] = None,
) -> None:
    """List the linkages of the catalogue, or print one."""
    _say_catalogue(LINKAGES, name)


def schema(
    file: Annotated[FileKind, typer.Argument(help="Kind of file.")] = FileKind.PROBLEM,
) -> None:
    """Print a JSON Schema of problem or linkage files, with which editors complete and check keys."""
    from grashof.problems.schema.json_schema import json_schema

    say(json.dumps(json_schema(file), indent=1))


def _say_catalogue(catalogue: Catalogue, name: str | None) -> None:
    if name is not None:
        say(catalogue.text(name).removesuffix("\n"))
        return
    for each, title in catalogue.titles.items():
        say(f"{each:20} {title}")


def analyse(linkage: LinkageName, options: AnalyseOptions) -> None:
    """Report motion and forces of LINKAGE; write tables, a summary, a page and plots.

    Exit code 0: done; 2: bad input; 3: environment error.
    """
    from grashof.output.analysis_files import print_report, write_report
    from grashof.survey import report_on
    from grashof.synth import place_parts

    spec = grashof.problems.load_linkage_spec(linkage)
    folder = options.out or Path(f"{spec.name}-analysis")
    check_writable(folder, record=ANALYSIS_RECORD)
    try:
        report = report_on(place_parts(spec), options.asked())
    except AssemblyError as error:  # lengths so unlike that every position is dead but for rounding
        raise ProblemError(f"{spec.name}: its lengths are too unlike to be analysed: {error}") from None
    files = write_report(folder, report, pictures=options.pictures)
    for note in report.notes:
        say(note, err=True)
    say_written("", files, folder)
    print_report(report)
    say_page(folder / ANALYSIS_PAGE)


def live(
    options: LiveOptions,
    problem: Annotated[
        str | None,
        typer.Argument(
            metavar="PROBLEM",
            help="Name in the catalogue, a TOML file, or a link copied from the page.",
            show_default="luggage",
        ),
    ] = None,
) -> None:
    """Edit PROBLEM by hand in the browser, and see the verified list follow.

    Exit code 0: ended by Ctrl-C; 2: bad input; 3: environment error.
    """
    if not all(map(find_spec, ("starlette", "uvicorn"))):
        raise ProblemError(
            "grashof live needs Starlette and uvicorn; pip install 'grashof[live]' installs them"
        )
    from uvicorn import Config, Server

    from grashof.live.requests import beginning
    from grashof.live.server import HOST, Live, application

    begin = beginning(problem)
    with closing(socket(AF_INET, SOCK_STREAM)) as own:
        own.setsockopt(SOL_SOCKET, SO_REUSEADDR, 1)
        try:
            own.bind((HOST, options.port))
        except OSError as error:
            raise SolverError(f"--port {options.port}: {error.strerror}; 0 takes a free one") from None
        own.listen()  # browsers that are sooner than the server wait
        served = Live(begin, own.getsockname()[1])
        say(f"{served.address}\nThe page of {begin['name']}, for this machine alone. Ctrl-C ends it.")
        if options.browser:
            webbrowser.open(served.address)
        config = Config(
            application(served), log_level="warning", access_log=False, timeout_graceful_shutdown=2
        )
        with suppress(KeyboardInterrupt):  # uvicorn raises it again once all is closed
            Server(config).run(sockets=[own])


def animate(linkage: LinkageName, options: AnimateOptions) -> None:
    """Animate LINKAGE over a turn of its driver, or from limit to limit and back.

    Exit code 0: done; 2: bad input; 3: environment error.
    """
    from grashof.figures.animation import check_animation, save_animation
    from grashof.figures.files import draw_motion

    spec = grashof.problems.load_linkage_spec(linkage)
    path = options.out or Path(f"{spec.name}.gif")
    check_animation(path)
    save_animation(draw_motion(spec, seconds=options.seconds, fps=options.fps), path)
    say(str(path), err=True)


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
