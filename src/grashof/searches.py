"""The commands that search: `solve` with its shards, `merge` and `sweep`; their output and files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import grashof.problems
from grashof.options import TOP, MergeOptions, ProblemName, SolveOptions, SweepOptions
from grashof.output.document import Document, documented
from grashof.output.folder import (
    OLD_SEARCH,
    PAGE,
    SEARCH,
    SWEEP_PAGE,
    check_writable,
    in_use,
    part_in_use,
)
from grashof.output.process import ExitCode, Interruption, interruptible, say, say_page, say_written
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.text import counted

if TYPE_CHECKING:
    from grashof.output.drawing import Drawer
    from grashof.problems import Problem
    from grashof.synth import Result
    from grashof.synth.results.lists import ReportedDesigns
    from grashof.synth.search.run import Progress

# Settings of a run that are arguments of `synthesize`.
_SEARCHED = ("starts", "enough", "seed", "effort", "time_limit", "gap", "prove")


def solve(problem: ProblemName, options: SolveOptions) -> ExitCode:
    """Find designs for PROBLEM; write the ranked list, a page, drawings and the record of the run.

    Exit code 0: at least one verified design; 1: none; 2: bad input; 3: environment error;
    130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP). With --shard, 0: it is done; 1: not yet.
    """
    from grashof.output.log_file import logged

    with documented(options.json) as document:
        loaded, text = grashof.problems.load_with_text(problem)
        folder = options.out or Path(f"{loaded.name}-designs")
        if options.shard is not None:
            return _solve_shard(loaded, text, options.shard, options, folder)
        check_writable(folder, options.drawings)
        with in_use(folder), logged(options.log, folder, folder / SEARCH):
            document.code = _solve(loaded, text, options, folder, document)
        return document.code


def _solve(problem: Problem, text: str, options: SolveOptions, folder: Path, document: Document) -> ExitCode:
    from grashof.output.drawing import drawer
    from grashof.synth.results.lists import ReportedDesigns
    from grashof.synth.search.history import StopReason
    from grashof.synth.search.journal import remove_record
    from grashof.wording.problem import ends_with_enough

    given = _fields(options, "starts", "seed", "effort")
    search = replace(problem.search, **{name: value for name, value in given.items() if value is not None})
    alone = options.top == 1 and not ends_with_enough(problem)
    search = replace(search, enough=1 if alone else max(search.enough, options.top or 0))
    settings = {
        **asdict(search),
        "workers": options.workers,
        "scheduler": options.scheduler and "Dask",  # not its address, which names machines
        **_fields(options, "time_limit", "gap", "prove"),
        "top": options.top or max(TOP, search.enough),
    }
    record = folder / SEARCH
    _begin_record(folder, resume=options.resume)
    with (
        drawer(options.drawings) as drawing,
        interruptible() as interrupted,
        _pointing_to(record),
    ):
        deliver = partial(_deliver, text=text, settings=settings, folder=folder, options=options,
                          interrupted=interrupted, document=document, drawing=drawing)  # fmt: skip
        so_far = ReportedDesigns(problem)
        try:
            found = _found(problem, options, record, settings, interrupted, so_far)
        except Exception:  # it is reported after the list
            if (verified := so_far.result()).candidates:
                deliver(verified)
            raise
        complete = found.history is not None and found.history.ending is StopReason.COMPLETE
        return deliver(found, listed=partial(remove_record, record) if complete else None)


def _found(
    problem: Problem,
    options: SolveOptions,
    record: Path,
    settings: dict[str, Any],
    interrupted: Interruption,
    so_far: ReportedDesigns,
) -> Result:
    """The result of the search; `settings` gets the number of workers that a scheduler has."""
    from grashof.output.cluster import cluster
    from grashof.output.terminal import search_progress
    from grashof.synth import synthesize
    from grashof.synth.search.finder import finder_of
    from grashof.wording.problem import ends_with_enough

    wanted, beginning = ends_with_enough(problem), finder_of(problem).beginning
    with (
        cluster(options.scheduler, options.workers) as (executor, workers),
        search_progress(problem.name, beginning, wanted=wanted) as show,
    ):

        def progress(step: Progress) -> None:
            so_far.note(step)
            show(step)

        settings["workers"] = workers
        return synthesize(
            problem,
            **{name: settings[name] for name in _SEARCHED},
            record=record,
            workers=workers,
            executor=executor,
            progress=progress,
            stop=interrupted,
            keep_record=True,
        )


def _fields(options: object, *names: str) -> dict[str, Any]:
    return {name: getattr(options, name) for name in names}


@contextmanager
def _pointing_to(record: Path) -> Iterator[None]:
    """Name the record of the search at the end, if it is incomplete or its lists could not be written."""
    from grashof.synth.search.journal import HEAD

    try:
        yield
    finally:
        if (record / HEAD).exists():
            say(f"{record}: the search so far; --resume continues it", err=True)


def _deliver(
    found: Result,
    text: str,
    settings: dict[str, Any],
    folder: Path,
    options: SolveOptions | MergeOptions,
    interrupted: Interruption,
    document: Document,
    drawing: Drawer | None = None,
    listed: Callable[[], None] | None = None,
) -> ExitCode:
    """Write the result of a search, and print the list; `listed` is called in between, see `write_run`."""
    from grashof.output.run_files import missing_drawings, write_run
    from grashof.output.terminal import print_table
    from grashof.wording.proof import proof_line

    if found.history is not None and found.history.record_lost:
        say(f"{found.history.record_lost}; the search continued without its record", err=True)
    if found.ended:
        say(found.ended, err=True)
    result = found.top(settings["top"])
    if options.json:
        document.note_list(result)
    if not (result.candidates or result.complete):  # an interrupted search replaces nothing
        say(result.note, err=True)
        return interrupted.code if interrupted() else ExitCode.NO_DESIGN
    try:
        files = write_run(folder, result, settings, options.drawings, interrupted, text, drawing, listed)
        document.note_files(folder, files)
        if not result.candidates and (proven := proof_line(result)):
            say(proven, err=True)
        say_written(result.note, files, folder)
        if missing := missing_drawings(result, options.drawings, files):
            say(f"drawings are left out: {interrupted.by} came before {missing} of them were made", err=True)
    finally:  # whatever the disk does
        if result.candidates and not options.json:
            print_table(result, len(found))
    say_page(folder / PAGE)
    if interrupted():
        return interrupted.code
    return ExitCode.OK if result.candidates else ExitCode.NO_DESIGN


def _solve_shard(problem: Problem, text: str, stated: str, options: SolveOptions, folder: Path) -> ExitCode:
    """Make a shard of a search, such as 7/200, except for the part that its folder holds already."""
    from grashof.output.cluster import cluster
    from grashof.output.log_file import logged
    from grashof.output.terminal import search_progress
    from grashof.synth.shards import SHARDS, Shard, solve_shard

    for name, given in (("top", options.top is not None), ("json", options.json)):
        if given:
            raise ProblemError(f"--{name} does not go with --shard; it is for grashof merge")
    shard = Shard.stated(stated)
    own = folder / SHARDS / shard.folder
    with (
        part_in_use(folder, own),
        logged(options.log, folder, own),
        interruptible() as interrupted,
        cluster(options.scheduler, options.workers) as (executor, workers),
        search_progress(problem.name, f"shard {shard}", wanted=False) as progress,
    ):
        made = solve_shard(
            problem,
            shard,
            folder,
            text=text,
            **_fields(options, "starts", "seed", "effort", "time_limit"),
            workers=workers,
            executor=executor,
            progress=progress,
            stop=interrupted,
        )
    counts = f"{counted(made.solved, 'solve')}, {counted(made.designs, 'verified design')}"
    next_step = f"grashof merge {folder} makes the list" if made.complete else "the same command continues it"
    say(f"shard {shard}: {made.chunks} of {counted(made.of, 'chunk')}, {counts}; {next_step}", err=True)
    if interrupted():
        return interrupted.code
    return ExitCode.OK if made.complete else ExitCode.NO_DESIGN


def merge(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The --out of the shards.")],
    options: MergeOptions,
) -> ExitCode:
    """Make the list of a search from the shards in DIR; write it there, as solve does.

    Exit code 0: at least one verified design; 1: none; 2: bad input, or shards are missing;
    3: environment error; 130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP).
    """
    with documented(options.json) as document:
        document.code = _merge(folder, options, document)
        return document.code


def _merge(folder: Path, options: MergeOptions, document: Document) -> ExitCode:
    from grashof.output.terminal import search_progress
    from grashof.synth.merging import Shards, merge_shards

    shards = Shards.found(folder)
    check_writable(folder, options.drawings)
    with in_use(folder), interruptible() as interrupted:
        with search_progress(shards.problem.name, "merging", wanted=False) as progress:
            given = _fields(options, "partial", "workers")
            found = merge_shards(folder, **given, progress=progress, stop=interrupted)
        if shards.lacking:
            say(f"{folder}: without {shards.lacking}", err=True)
        most = options.top or max(TOP, shards.search.enough)
        settings = {**asdict(shards.search), "workers": options.workers, "top": most, "shards": shards.of}
        settings["without"] = shards.lacking
        return _deliver(found, shards.text, settings, folder, options, interrupted, document)


def sweep(
    study: Annotated[str, typer.Argument(metavar="STUDY", help="A TOML file that states what varies.")],
    options: SweepOptions,
) -> ExitCode:
    """Solve every combination of STUDY; write a table, a plot, a page and the record of the sweep.

    Exit code 0: at least one verified design; 1: none; 2: bad input; 3: environment error;
    130: interrupted (Ctrl-C); 143: terminated (SIGTERM, SIGHUP).
    """
    from grashof.output.cluster import cluster
    from grashof.sweep.files import check_folder
    from grashof.sweep.run import sweep
    from grashof.sweep.study import load_study

    loaded = load_study(study)
    folder = options.out or Path(f"{loaded.name}-sweep")
    check_folder(folder, loaded)
    with (
        in_use(folder),
        interruptible() as interrupted,
        cluster(options.scheduler, options.workers) as (executor, at_a_time),
    ):
        done = sweep(
            loaded,
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
        say(f"interrupted: --resume continues it; finished combinations are in {folder}", err=True)
        return interrupted.code
    return ExitCode.OK if done.with_designs else ExitCode.NO_DESIGN


def _begin_record(folder: Path, *, resume: bool) -> None:
    """Put aside the record of a search that is not resumed; report where there is none to resume."""
    from grashof.synth.search.journal import HEAD, remove_record

    record, kept = folder / SEARCH, folder / OLD_SEARCH
    if record.exists() and not record.is_dir():
        raise ProblemError(f"{record}: is a file; the search is recorded in a folder of this name")
    if resume and not record.exists():
        say(f"{record}: has no record of a search; it begins anew", err=True)
    elif (record / HEAD).exists() and not resume:
        remove_record(kept)
        if kept.exists() or kept.is_symlink():
            raise ProblemError(f"{kept}: is, or has, more than the record of a search; move it away")
        record.replace(kept)
        say(f"{record}: the record of an unfinished search is kept as {kept.name}", err=True)
