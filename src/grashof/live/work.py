"""The work of a solver of the live page: designs followed, searched for, written to files; as JSON lines."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np

from grashof.live.requests import Job, Line, error_line
from grashof.page.designs import moves
from grashof.page.search import headline, search_data
from grashof.problems import Problem, ProblemError
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.linkages.mechanisms import DIMENSIONS, is_of
from grashof.synth import Candidate, Progress, Result, synthesize, track
from grashof.synth.designs.table import LISTED, rows_of
from grashof.wording.problem import summary

TOP = 50  # families in a list, as `grashof solve` has them
TIME_LIMIT = 120.0  # s, of a search
TRACKED = 10  # designs that follow the hand
# Quantities known at once; others take longer than following the design.
_FOLLOWED = ("error", "transmission_min_task", "transmission_min_cycle", "size", *DIMENSIONS)
AT_ONCE = tuple(each for each in LISTED if each.key in _FOLLOWED)
ABSENT = 100  # designs of earlier lists that are recognised when they return
SHARE = 0.2  # of the time of a search, for reports
SAME = 1e-6  # of the largest parameter: then two designs are the same


@dataclass(frozen=True, slots=True)
class Shown:
    """Designs on a page by their keys, which stay while a design is followed.

    `absent` are those of earlier lists, which a continued search may find again.
    """

    designs: Mapping[int, Candidate] = field(default_factory=dict)
    absent: Mapping[int, Candidate] = field(default_factory=dict)
    result: Result | None = None
    next_key: int = 1

    @classmethod
    def read(cls, shown: bytes) -> Shown:
        """As the previous job wrote it."""
        return pickle.loads(shown) if shown else cls()  # noqa: S301  (our own, from a solver)

    def written(self) -> bytes:
        """For the next job, in any process."""
        return pickle.dumps(self)

    def matched(self, found: Sequence[Candidate], result: Result | None = None) -> Shown:
        """A new list; known designs keep their keys, and the end of a search forgets the others."""
        known = {**self.designs, **self.absent}
        numbers_of = {key: _numbers(design) for key, design in known.items()}
        designs: dict[int, Candidate] = {}
        key = self.next_key
        for design in found:
            numbers = _numbers(design)
            same = (k for k, other in numbers_of.items() if k not in designs and _alike(numbers, other))
            kept = next(same, None)
            designs[key if kept is None else kept] = design
            key += kept is None
        absent = {} if result is not None else {k: design for k, design in known.items() if k not in designs}
        return Shown(designs, dict(islice(absent.items(), ABSENT)), result, key)

    def following(self, designs: Mapping[int, Candidate]) -> Shown:
        """The followed designs of the list, as they are now."""
        others = {key: design for key, design in self.designs.items() if key not in designs}
        return replace(self, designs=designs, absent={**others, **self.absent}, result=None)


def _numbers(design: Candidate) -> np.ndarray[Any, np.dtype[np.float64]]:
    parameters = map(np.ravel, design.linkage.parameters)
    return np.concatenate([[len(design.linkage.mechanism.word)], *parameters]).astype(float)


def _alike(one: np.ndarray[Any, Any], other: np.ndarray[Any, Any]) -> bool:
    return one.shape == other.shape and bool(np.abs(one - other).max() <= SAME * np.abs(one).max())


def lines(job: Job, stop: Callable[[], bool], send: Callable[[Line], object]) -> None:
    """Do a job and `send` each line, the last of kind "done"; it ends soon after `stop`, called often."""
    since = perf_counter()
    try:
        _JOBS[job.what](job, stop, send)
    except ProblemError as error:
        send(error_line(*str(error).splitlines()))
    send(_line("done", seconds=round(perf_counter() - since, 4)))


def _line(kind: str, shown: Shown | None = None, **content: Any) -> Line:
    text = json.dumps({"kind": kind, **content}, allow_nan=False, separators=(",", ":"))
    return Line(text, None if shown is None else shown.written())


def _defects(design: Candidate) -> str:
    return "; ".join(map(str, design.verdict.defects))


def _problem(job: Job) -> Problem:
    return problem_from(job.document, job.name)


def _track(job: Job, _stop: object, send: Callable[[Line], object]) -> None:
    problem, shown = _problem(job), Shown.read(job.shown)
    chosen = [key for key in job.options.get("keys", ()) if key in shown.designs]
    first = list(dict.fromkeys([*chosen, *shown.designs]))[:TRACKED]
    followed = {key: design for key, design in shown.designs.items() if key in first}
    kept = {key: design for key, design in followed.items() if is_of(design.linkage, problem.mechanism)}
    moved = dict(zip(kept, track(list(kept.values()), problem), strict=True))
    there = {key: design for key, design in moved.items() if design.verdict.ok}
    lost = {key: _defects(design) for key, design in moved.items() if key not in there}
    # A lost one stays as it last was, and may come back from there.
    send(_list_line("track", problem, there, shown.following({**kept, **there}), lost=lost))


def _search(job: Job, stop: Callable[[], bool], send: Callable[[Line], object]) -> None:
    problem, shown = _problem(job), Shown.read(job.shown)
    next_at = 0.0

    def report(progress: Progress) -> None:
        nonlocal shown, next_at
        since = perf_counter()
        send(_line("progress", solved=progress.solved, starts=progress.starts, verified=progress.verified))
        if since < next_at or stop() or not progress.designs:
            return
        so_far = Result(problem, progress.designs).top(TOP)
        shown = shown.matched(so_far.candidates)
        send(_list_line("searching", problem, shown.designs, shown))
        now = perf_counter()
        next_at = now + (now - since) / SHARE

    result = synthesize(problem, progress=report, stop=stop, time_limit=TIME_LIMIT).top(TOP)
    if stop():
        return
    shown = shown.matched(result.candidates, result)
    misses = shown.matched(() if shown.designs else result.nearest)
    shown = replace(shown, next_key=misses.next_key)
    send(_list_line("found", problem, shown.designs or misses.designs, shown, result))


def _list_line(
    phase: str,
    problem: Problem,
    designs: Mapping[int, Candidate],
    shown: Shown,
    result: Result | None = None,
    lost: Mapping[int, str] | None = None,
) -> Line:
    """A list as the page draws it; of closest misses where the search found none."""
    drawn = {key: one for key, one in designs.items() if moves(one)}
    columns = AT_ONCE if phase == "track" else LISTED
    rows = rows_of(problem, list(drawn.values()), columns)
    data = search_data(problem, list(drawn.values()), rows, found=result is None or bool(result.candidates))
    for (key, one), design in zip(drawn.items(), data["designs"], strict=True):
        design |= {"key": key, "misses": _defects(one)}
    return _line(
        "list",
        shown,
        phase=phase,
        headline="" if result is None else headline(result),
        note="" if result is None else result.note,
        asked=[line.strip() for line in summary(problem)][1:],
        lost=[{"key": key, "why": why} for key, why in (lost or {}).items()],
        **data,
    )


def _file(job: Job, _stop: object, send: Callable[[Line], object]) -> None:
    """A file to save: the problem, or one that `grashof solve` or `grashof export` writes of the list."""
    from grashof.output.run_files import write_run
    from grashof.workshop.export import Making, export_files
    from grashof.workshop.plates import PlateSizes

    problem, wanted = _problem(job), job.options["file"]
    text = problem_toml(problem)
    if wanted == "problem":
        send(_line("file", name=f"{job.name}.toml", type="application/toml", text=text))
        return
    shown = Shown.read(job.shown)
    there = {key: design for key, design in shown.designs.items() if design.verdict.ok}
    if not there:
        raise ProblemError("there is no design to save")
    result = shown.result or Result(problem, tuple(there.values()))
    if wanted == "dxf":
        if (design := there.get(job.options.get("key", 0))) is None:
            raise ProblemError("choose a design first; DXF is of one of them")
        result = Result(problem, (design,))
    with TemporaryDirectory() as folder:
        write_run(Path(folder), result, {"top": TOP, "made by": "grashof live"}, 0, problem_text=text)
        name, kind = _SAVED.get(wanted, (f"{result.best.id}.dxf", "image/vnd.dxf"))
        if wanted == "dxf":
            export_files(f"{folder}/candidates.json#1", Making(PlateSizes()), {"dxf": Path(folder) / name})
        content = (Path(folder) / name).read_text(encoding="utf-8")
    send(_line("file", name=f"{job.name}-{name}", type=kind, text=content))


def _outline(job: Job, _stop: object, send: Callable[[Line], object]) -> None:
    """The lines of a DXF drawing, shown behind the task."""
    from grashof.problems.files.dxf_lines import dxf_polylines

    lines = dxf_polylines(job.options["text"])
    send(_line("outline", polylines=[line.tolist() for line in lines]))


# Name and type of the files of a run, by "file" of a job.
_SAVED = {
    "list": ("candidates.csv", "text/csv"),
    "designs": ("candidates.json", "application/json"),
    "report": ("report.html", "text/html"),
}
_JOBS: dict[str, Callable[[Job, Callable[[], bool], Callable[[Line], object]], None]] = {
    "track": _track,
    "search": _search,
    "file": _file,
    "outline": _outline,
}


def warm_up() -> None:
    """Load all modules and caches of a first job."""
    from grashof.problems import load
    from grashof.problems.files.on_disk import document_of
    from grashof.problems.files.problem_file import problem_text

    document = document_of(problem_text("luggage"), "luggage.toml")
    found = synthesize(load("luggage"), enough=2, starts=16)
    shown = Shown().matched(found.candidates)
    lines(Job("track", document, "luggage", shown=shown.written()), lambda: False, lambda _line: None)
