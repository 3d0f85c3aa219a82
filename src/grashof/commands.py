"""What the commands do: search, in shards too, sweep, analyse, animate; what they write and print."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grashof.options import TOP, AnimateOptions, MergeOptions, ProveOptions, SolveOptions, SweepOptions
from grashof.output.ending import ExitCode, Interruption, interruptible
from grashof.output.streams import say
from grashof.problems import AssemblyError, Problem, ProblemError, Search, load, load_linkage_spec
from grashof.problems.values.checks import counted

if TYPE_CHECKING:
    from grashof.output.drawing import Drawer
    from grashof.synth import Result
    from grashof.synth.results.so_far import SoFar
    from grashof.synth.search.run import Progress


def solve(problem: Problem, text: str, options: SolveOptions) -> ExitCode:
    """Search for designs and write them; `text` is the problem file."""
    from grashof.output.folder import SEARCH, check_writable, in_use
    from grashof.output.log_file import logged

    folder = options.out if options.out is not None else Path(f"{problem.name}-designs")
    check_writable(folder, options.drawings)
    with in_use(folder), logged(options.log, folder, folder / SEARCH):
        return _solve(problem, text, options, folder)


def _solve(problem: Problem, text: str, options: SolveOptions, folder: Path) -> ExitCode:
    from grashof.output.drawing import drawer
    from grashof.output.folder import SEARCH
    from grashof.synth.results.so_far import SoFar
    from grashof.synth.search.history import StopReason
    from grashof.synth.search.journal import remove_record

    given = {name: getattr(options, name) for name in ("starts", "seed", "effort")}
    search = replace(problem.search, **{name: value for name, value in given.items() if value is not None})
    search = replace(search, enough=max(search.enough, options.top or 0))
    dask = None if options.scheduler is None else "Dask"  # not where: that names machines
    settings = {
        **asdict(search),
        "workers": options.workers,
        "scheduler": dask,
        "time_limit": options.time_limit,
        "gap": options.gap,
        "prove": options.prove,
        "top": options.top or max(TOP, search.enough),
    }
    record = folder / SEARCH
    _begin_record(folder, resume=options.resume)
    with (
        drawer(options.drawings) as drawing,
        interruptible() as interrupted,
        _pointing_to(record),
    ):
        deliver = partial(_deliver, text=text, settings=settings, folder=folder, drawings=options.drawings,
                          interrupted=interrupted, drawing=drawing)  # fmt: skip
        so_far = SoFar(problem)
        try:
            found = _found(problem, options, settings, search, record, interrupted, so_far)
        except Exception:  # it is reported after the list
            if (verified := so_far.result()).candidates:
                deliver(verified)
            raise
        whole = found.history is not None and found.history.ending is StopReason.COMPLETE
        return deliver(found, listed=partial(remove_record, record) if whole else None)


def _found(
    problem: Problem,
    options: SolveOptions,
    settings: dict[str, Any],
    search: Search,
    record: Path,
    interrupted: Interruption,
    so_far: SoFar,
) -> Result:
    """What the search comes to; `settings` gets the number of workers that a scheduler has."""
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
            **asdict(search),
            workers=workers,
            executor=executor,
            time_limit=options.time_limit,
            gap=options.gap,
            prove=options.prove,
            progress=progress,
            stop=interrupted,
            record=record,
            keep_record=True,
        )


@contextmanager
def _pointing_to(record: Path) -> Iterator[None]:
    """State at the end where the search so far is, if it is not whole or its lists could not be written."""
    from grashof.synth.search.journal import HEAD

    try:
        yield
    finally:
        if (record / HEAD).exists():
            say(f"{record}: the search so far; --resume goes on with it", err=True)


def _deliver(
    found: Result,
    text: str,
    settings: dict[str, Any],
    folder: Path,
    drawings: int,
    interrupted: Interruption,
    drawing: Drawer | None = None,
    listed: Callable[[], None] | None = None,
) -> ExitCode:
    """Write what a search found, and print the list; `listed` is called in between, see `write_run`."""
    from grashof.output.folder import PAGE
    from grashof.output.run_files import left_out, write_run
    from grashof.output.terminal import print_table
    from grashof.wording.proof import proof_line

    if found.history is not None and found.history.record_lost:
        say(f"{found.history.record_lost}; the search went on without its record", err=True)
    if found.ended:
        say(found.ended, err=True)
    result = found.top(settings["top"])
    if not (result.candidates or result.complete):  # an interrupted search replaces nothing
        say(result.note, err=True)
        return interrupted.code if interrupted() else ExitCode.NO_DESIGN
    try:
        files = write_run(folder, result, settings, drawings, interrupted, text, drawing, listed)
        if not result.candidates and (proven := proof_line(result)):
            say(proven, err=True)
        _report(result.note, files, folder)
        if left := left_out(result, drawings, files):
            say(f"drawings are left out: {interrupted.by} came before {left} of them were made", err=True)
    finally:  # whatever the disk does
        if result.candidates:
            print_table(result, len(found))
    _point_to(folder / PAGE)
    if interrupted():
        return interrupted.code
    return ExitCode.OK if result.candidates else ExitCode.NO_DESIGN


def solve_shard(problem: Problem, text: str, stated: str, options: SolveOptions) -> ExitCode:
    """Make a shard of a search, such as 7/200; what its folder has of it is not done again."""
    from grashof.output.cluster import cluster
    from grashof.output.folder import part_in_use
    from grashof.output.log_file import logged
    from grashof.output.terminal import search_progress
    from grashof.synth.shards import SHARDS, Shard, solve_shard

    if options.top is not None:
        raise ProblemError("--top does not go with --shard; it is for grashof merge")
    shard = Shard.stated(stated)
    folder = options.out if options.out is not None else Path(f"{problem.name}-designs")
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
            starts=options.starts,
            seed=options.seed,
            effort=options.effort,
            workers=workers,
            executor=executor,
            time_limit=options.time_limit,
            progress=progress,
            stop=interrupted,
        )
    counts = f"{counted(made.solved, 'solve')}, {counted(made.designs, 'verified design')}"
    next_step = f"grashof merge {folder} makes the list" if made.whole else "the same command goes on with it"
    say(f"shard {shard}: {made.chunks} of {counted(made.of, 'chunk')}, {counts}; {next_step}", err=True)
    if interrupted():
        return interrupted.code
    return ExitCode.OK if made.whole else ExitCode.NO_DESIGN


def merge(folder: Path, options: MergeOptions) -> ExitCode:
    """Make the list of a search from its shards, and write it into the same folder."""
    from grashof.output.folder import check_writable, in_use
    from grashof.output.terminal import search_progress
    from grashof.synth.merging import Shards, merge_shards

    shards = Shards.found(folder)
    check_writable(folder, options.drawings)
    with in_use(folder), interruptible() as interrupted:
        with search_progress(shards.problem.name, "merging", wanted=False) as progress:
            found = merge_shards(
                folder,
                partial=options.partial,
                workers=options.workers,
                progress=progress,
                stop=interrupted,
            )
        if shards.lacking:
            say(f"{folder}: without {shards.lacking}", err=True)
        most = options.top or max(TOP, shards.search.enough)
        settings = {**asdict(shards.search), "workers": options.workers, "top": most, "shards": shards.of}
        settings["without"] = shards.lacking
        return _deliver(found, shards.text, settings, folder, options.drawings, interrupted)


def sweep(study: str, options: SweepOptions) -> ExitCode:
    """Solve a study file into a folder, here or on a Dask cluster, and say how it goes."""
    from grashof.output.cluster import cluster
    from grashof.output.folder import SWEEP_PAGE, in_use
    from grashof.sweep.files import check_folder
    from grashof.sweep.run import sweep
    from grashof.sweep.study import load_study

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
    return ExitCode.OK if done.with_designs else ExitCode.NO_DESIGN


def _begin_record(folder: Path, *, resume: bool) -> None:
    """Keep the record of a search that is not gone on with; say where there is none to go on with."""
    from grashof.output.folder import OLD_SEARCH, SEARCH
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


def analyse(linkage: str, out: Path | None, *, pictures: bool = False, **asked: Any) -> None:
    """Write how a linkage moves, and print the summary; for what else is asked see `Asked`."""
    from grashof.output.analysis_files import print_report, write_report
    from grashof.output.folder import ANALYSIS_PAGE, ANALYSIS_RECORD, check_writable
    from grashof.survey import Asked, report_on

    spec = load_linkage_spec(linkage)
    folder = out if out is not None else Path(f"{spec.name}-analysis")
    check_writable(folder, record=ANALYSIS_RECORD)
    try:
        report = report_on(spec, Asked(**asked))
    except AssemblyError as error:  # lengths so unlike that every position is dead but for rounding
        raise ProblemError(f"{spec.name}: its lengths are too unlike to be analysed: {error}") from None
    files = write_report(folder, report, pictures=pictures)
    for note in report.notes:
        say(note, err=True)
    _report("", files, folder)
    print_report(report)
    _point_to(folder / ANALYSIS_PAGE)


def animate(linkage: str, options: AnimateOptions) -> None:
    """Write a linkage in motion."""
    from grashof.figures.animation import check_animation, save_animation
    from grashof.figures.files import draw_motion

    spec = load_linkage_spec(linkage)
    path = options.out if options.out is not None else Path(f"{spec.name}.gif")
    check_animation(path)
    save_animation(draw_motion(spec, seconds=options.seconds, fps=options.fps), path)
    say(str(path), err=True)


def _report(note: str, files: list[str], folder: Path) -> None:
    if note:
        say(note, err=True)
    drawn = sum(name.endswith(".png") for name in files)
    named = [name for name in files if name.endswith((".csv", ".json", ".html"))]
    pictures = f" and {counted(drawn, 'drawing')} (PNG, SVG)" if drawn else ""
    say(f"{folder}: {', '.join(named)}{pictures}", err=True)


def _point_to(page: Path) -> None:
    say(f"Open {page} in a browser to look at it.", err=True)


def prove(problem: str, options: ProveOptions) -> ExitCode:
    """Print what is proven of a problem."""
    from grashof.synth import prove as proven
    from grashof.synth.prove import has_certificate
    from grashof.wording.proof import bound_line, is_decided, work_line

    loaded = load(problem)
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


def judge(linkage: str, problem: str) -> ExitCode:
    """Print the verdict on a linkage that is not out of a search."""
    from grashof.wording.verdict import judged_for, verdict_lines

    spec = load_linkage_spec(linkage)
    judged = judged_for(load(problem), spec)
    for line in verdict_lines(judged, spec.name):
        say(line)
    return ExitCode.OK if judged.verdict.ok else ExitCode.NO_DESIGN
