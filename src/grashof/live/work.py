"""The work of a solver of the live page: designs followed, searched for, written to files; as JSON lines."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import islice
from time import perf_counter
from typing import Any

import numpy as np

from grashof.live.requests import TOP, Job, Line, error_line
from grashof.page.designs import moves
from grashof.page.search import headline, search_data
from grashof.problems import Problem, ProblemError
from grashof.problems.files.linkage_file import linkage_spec_of
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.linkages.mechanisms import DIMENSIONS, is_of
from grashof.synth import Candidate, Progress, Result, synthesize, track
from grashof.synth.designs.table import LISTED, rows_of
from grashof.wording.problem import judged_for, summary

TIME_LIMIT = 120.0  # s, of a search
TRACKED = 10  # designs that follow the hand
# Quantities known at once; others take longer than following the design.
_FOLLOWED = ("error", "transmission_min_task", "transmission_min_cycle", "size", *DIMENSIONS)
AT_ONCE = tuple(each for each in LISTED if each.key in _FOLLOWED)
ABSENT = 100  # designs of earlier lists that are recognised when they return
SHARE = 0.2  # of the time of a search, for reports
ONLY_GIVEN = "The design of the link; the search found no other"
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
    _tell_problem(problem, send)
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
    _tell_problem(problem, send)
    given = _given(job, problem, send)
    next_at = 0.0

    def listed(designs: Sequence[Candidate]) -> None:
        nonlocal shown
        shown = shown.matched(_with(given, designs))
        send(_list_line("searching", problem, shown.designs, shown, lost=_missed(shown.designs)))

    def report(progress: Progress) -> None:
        nonlocal next_at
        since = perf_counter()
        send(_line("progress", solved=progress.solved, starts=progress.starts, verified=progress.verified))
        if since < next_at or stop() or not progress.designs:
            return
        listed(Result(problem, progress.designs).top(TOP).candidates)
        now = perf_counter()
        next_at = now + (now - since) / SHARE

    if given is not None:
        listed(())
    result = synthesize(problem, progress=report, stop=stop, time_limit=TIME_LIMIT).top(TOP)
    if not stop():
        send(_found_line(problem, shown, result, given))


def _given(job: Job, problem: Problem, send: Callable[[Line], object]) -> Candidate | None:
    """The linkage of a link, judged for its problem; where that fails, None, and a line with the reason."""
    if not (text := job.options.get("given")):
        return None
    try:
        given = judged_for(problem, linkage_spec_of(text, "the link", job.name))
    except ProblemError as error:
        send(error_line(*str(error).splitlines()))
        return None
    if moves(given):
        return given
    send(error_line(f"the design of the link cannot be drawn: {_defects(given).partition('; ')[0]}"))
    return None


def _with(given: Candidate | None, found: Sequence[Candidate]) -> Sequence[Candidate]:
    """A list with the linkage of a link, to its last digit: in its place where it was found, or last."""
    if given is None:
        return found
    numbers = _numbers(given)
    there = [given if _alike(numbers, _numbers(each)) else each for each in found]
    return there if any(each is given for each in there) else [*there, given]


def _missed(designs: Mapping[int, Candidate]) -> dict[int, str]:
    """The defects of the designs that are not verified."""
    return {key: _defects(one) for key, one in designs.items() if not one.verdict.ok}


def _found_line(problem: Problem, shown: Shown, result: Result, given: Candidate | None) -> Line:
    """The list of a search that has ended, or its closest misses; with the linkage of a link."""
    listed = _with(given, result.candidates)
    found = any(each.verdict.ok for each in listed)
    misses = shown.matched(() if found else _with(given, result.nearest))
    shown = shown.matched(listed if found else (), result)
    shown = replace(shown, next_key=max(shown.next_key, misses.next_key))
    return _list_line(
        "found",
        problem,
        shown.designs or misses.designs,
        shown,
        found=found,
        lost=_missed(shown.designs),
        headline=headline(result) if result.candidates or not found else ONLY_GIVEN,
        note=result.note if result.candidates or not found else "",
    )


def _list_line(
    phase: str,
    problem: Problem,
    designs: Mapping[int, Candidate],
    shown: Shown,
    *,
    found: bool = True,
    lost: Mapping[int, str] | None = None,
    **words: str,
) -> Line:
    """A list as the page draws it; of closest misses unless `found`."""
    drawn = {key: one for key, one in designs.items() if moves(one)}
    columns = AT_ONCE if phase == "track" else LISTED
    rows = rows_of(problem, list(drawn.values()), columns)
    data = search_data(problem, list(drawn.values()), rows, found=found)
    for (key, one), design in zip(drawn.items(), data["designs"], strict=True):
        design |= {"key": key, "misses": _defects(one)}
    return _line(
        "list",
        shown,
        phase=phase,
        lost=[{"key": key, "why": why} for key, why in (lost or {}).items()],
        **{"headline": "", "note": "", **words},
        **data,
    )


def _tell_problem(problem: Problem, send: Callable[[Line], object]) -> None:
    """The problem as its file and in words."""
    asked = [line.strip() for line in summary(problem)][1:]
    send(_line("problem", text=problem_toml(problem), asked=asked))


def _file(job: Job, _stop: object, send: Callable[[Line], object]) -> None:
    """A file to save, or text to copy."""
    from grashof.live.saving import saved

    problem, shown = _problem(job), Shown.read(job.shown)
    there = {key: design for key, design in shown.designs.items() if design.verdict.ok}
    send(_line("file", **asdict(saved(job, problem, there, shown.result))))


def _outline(job: Job, _stop: object, send: Callable[[Line], object]) -> None:
    """The lines of a DXF drawing, shown behind the task."""
    from grashof.problems.files.dxf_lines import dxf_polylines

    lines = dxf_polylines(job.options["text"])
    send(_line("outline", polylines=[line.tolist() for line in lines]))


_JOBS: dict[str, Callable[[Job, Callable[[], bool], Callable[[Line], object]], None]] = {
    "track": _track,
    "search": _search,
    "file": _file,
    "outline": _outline,
}


def warm_up() -> None:
    """Load all modules and caches of a first job."""
    from grashof.problems import load
    from grashof.problems.files.on_disk import document_of, problem_text

    document = document_of(problem_text("luggage"), "luggage.toml")
    found = synthesize(load("luggage"), enough=2, starts=16)
    shown = Shown().matched(found.candidates)
    lines(Job("track", document, "luggage", shown=shown.written()), lambda: False, lambda _line: None)
