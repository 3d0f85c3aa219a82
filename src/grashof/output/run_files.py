"""The files of a run: candidates as CSV and JSON, the closest misses, the page, the record, the drawings."""

from __future__ import annotations

import csv
import json
import os
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import asdict, replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from grashof.analysis import solve_position
from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.judge.cylinder_drive import cylinder_forces
from grashof.output.drawing import Files, drawer
from grashof.output.folder import PAGE, RECORD, replacing_own_files
from grashof.output.process import ExitCode, Interruption
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.text import no_formula
from grashof.synth import Candidate, Result
from grashof.synth.designs.table import LISTED, OWN, Row, facts, known, rows_of, rows_of_nearest
from grashof.synth.search.history import StopReason, now
from grashof.wording.proof import enclosure_record

if TYPE_CHECKING:
    import pandas as pd

    from grashof.output.drawing import Drawer

_GUARDS = ("Maximum_Iterations_Exceeded", "Maximum_WallTime_Exceeded")  # limits that ended solves
_PACKAGES = ("grashof", "casadi", "numpy", "scipy", "pandas", "matplotlib", "jinja2")


def write_run(
    folder: Path,
    result: Result,
    settings: dict[str, Any],
    drawings: int,
    stop: Interruption | None = None,
    problem_text: str = "",
    drawing: Drawer | None = None,
    listed: Callable[[], None] | None = None,
) -> list[str]:
    """Write all files of a run, the lists first; names, sorted. A drawing that fails does not cost the lists.

    `settings` go into the record, `problem_text` into the page. `listed` is called once the lists are in the
    folder, `stop` before each of the `drawings` best is drawn. OSError for a full disk or a lost folder; it
    then holds its former files, or the lists alone.
    """
    stop = Interruption() if stop is None else stop
    best = result.candidates[:drawings]
    with drawer(len(best)) if drawing is None else nullcontext(drawing) as ready:
        drawn = ready(result.problem, best)
        from grashof.page.search import search_page  # only a run needs the templates, while designs are drawn

        with replacing_own_files(folder) as fresh:
            rows = _write_lists(fresh, result)
            write_page(fresh / PAGE, search_page(result, _about(settings), problem_text, rows=rows))
            files = _write_record(fresh, result, settings, drawings, stop)
        if listed is not None:
            listed()
        if drawings and result.candidates and not stop():
            with replacing_own_files(folder, keep=files) as fresh:
                _draw(fresh, drawn, stop)
                files = _write_record(fresh, result, settings, drawings, stop, files)
    return files


def _write_lists(folder: Path, result: Result) -> list[Row]:
    """Write the designs, or the nearest misses, whose rows it returns."""
    rows = rows_of(result.problem, result.candidates)
    if result.candidates:
        write_rows(folder / "candidates.csv", rows)
        write_json(folder / "candidates.json", list_content(result, rows))
    if result.nearest:
        rows = rows_of_nearest(result.problem, result.nearest)
        write_rows(folder / "nearest.csv", rows)
    return rows


def missing_drawings(result: Result, drawings: int, files: Iterable[str]) -> int:
    """Number of requested drawings that are not among the files of a run."""
    return min(drawings, len(result)) - sum(name.endswith(".png") for name in files)


def _draw(folder: Path, drawn: Iterator[Files], stop: Interruption) -> None:
    for rank, files in enumerate(drawn, start=1):
        for ending, file in files.items():
            (folder / f"design-{rank:02d}{ending}").write_bytes(file)
        if stop():
            return


def _write_record(
    folder: Path,
    result: Result,
    settings: dict[str, Any],
    drawings: int,
    stop: Interruption,
    others: Iterable[str] = (),
) -> list[str]:
    """Write the record of the files in a folder and of others, and return their names, sorted."""
    files = listed_files(folder, RECORD, others)
    content = {
        "problem": result.problem.name,
        **_about(settings),
        "run": _history(result, missing_drawings(result, drawings, files), stop),
        **outcome(result),
        "designs": len(result),
        "counts": result.counts,
        "guards_hit": {name: result.tally.statuses[name] for name in _GUARDS},
        "seconds": {stage: round(time, 4) for stage, time in result.seconds.items()},
        "files": files,
    }
    write_json(folder / RECORD, content)
    return files


def outcome(result: Result) -> dict[str, Any]:
    """The outcome of a search besides its designs; None for errors that it lacks."""
    errors = {name: getattr(result, name) for name in ("least_error", "most_error")}
    return {
        "complete": result.complete,
        "ended": result.ended,
        **{name: None if np.isnan(error) else error for name, error in errors.items()},
        "note": result.note,
        "proof": None if result.proof is None else result.proof.stated,
        "intervals": enclosure_record(result),
    }


def listed_files(folder: Path, record: str, others: Iterable[str] = ()) -> list[str]:
    """The files of a run, sorted: those in a folder, others, and its record."""
    return sorted({*(path.name for path in folder.iterdir()), *others, record})


def list_content(result: Result, rows: Sequence[Row] | None = None) -> dict[str, Any]:
    """The content of ``candidates.json``; `rows` are those of the list, where they are known already."""
    problem = result.problem
    rows = rows_of(problem, result.candidates) if rows is None else rows
    keys, last = _written(rows), ("pareto", OWN.column)
    return {
        "grashof": version("grashof"),
        "problem": problem.name,
        "problem_toml": problem_toml(problem),
        "title": problem.title,
        "length_unit": problem.length_unit,
        "angle_unit": "rad",
        **({} if problem.dynamics is None else {"dynamics": problem.dynamics.tables["dynamics"]}),
        "designs": [
            {"rank": row["rank"], **_design(candidate, keys), **{key: row[key] for key in last if key in row}}
            for candidate, row in zip(result.candidates, rows, strict=True)
        ],
    }


def _given(errors: FloatArray) -> list[float | None]:
    """Errors as JSON knows them: null where a pose leaves this part free."""
    return [None if np.isnan(error) else float(error) for error in errors]


def _design(candidate: Candidate, keys: Mapping[str, str]) -> dict[str, Any]:
    verdict = candidate.verdict
    turned = verdict.angle_error
    output_error = {"output_error": verdict.output_error.tolist()} if verdict.output_error.size else {}
    angle_error = {} if np.isnan(turned).all() else {"angle_error": _given(turned)}
    return {
        **facts(candidate),
        "linkage": candidate.linkage.stated,
        "theta2": verdict.theta2.tolist(),
        "assembly": verdict.assembly.tolist(),
        "position_error": _given(verdict.position_error),
        **angle_error,
        **output_error,
        **_driven(candidate),
        **({} if verdict.effort is None else {"parts": verdict.effort.stated["parts"]}),
        **{name: x if np.isfinite(x := candidate.values[key]) else None for name, key in keys.items()},
    }


def _driven(candidate: Candidate) -> dict[str, Any]:
    """The cylinder that drives it, with its length and, with dynamics, its force at every target."""
    linkage, verdict = candidate.linkage, candidate.verdict
    if verdict.cylinder is None:
        return {}
    at = solve_position(linkage, verdict.theta2, verdict.assembly)
    length = cylinder_state(verdict.cylinder, linkage, at).length.tolist()
    forces = cylinder_forces(linkage, candidate.problem, verdict)
    force = {} if np.isnan(forces).all() else {"force": _given(forces)}
    return {"cylinder": {**verdict.cylinder.stated, "length": length, **force}}


def _written(rows: Sequence[Row]) -> dict[str, str]:
    """Keys of the quantities that some design has, by their columns without the unit."""
    columns = {each.column for row in rows for each in LISTED if known(row[each.column])}
    return {each.column.removesuffix("_deg"): each.key for each in LISTED if each.column in columns}


def _about(settings: dict[str, Any]) -> dict[str, Any]:
    """Versions and settings, from which the search can be repeated."""
    return {"versions": versions_of(_PACKAGES), "settings": settings}


def versions_of(packages: Iterable[str]) -> dict[str, str]:
    """Versions of Python and of packages."""
    return {"python": platform.python_version(), **{name: version(name) for name in packages}}


_ENDINGS = {ExitCode.INTERRUPTED: StopReason.INTERRUPTED, ExitCode.TERMINATED: StopReason.TERMINATED}


def _history(result: Result, undrawn: int, stop: Interruption) -> dict[str, Any] | None:
    """The history of the run until now; None for a list that no search made."""
    if result.history is None:
        return None
    ending = _ENDINGS.get(stop.code, result.history.ending)
    why = ending if stop() else "the run ended before they were drawn"
    history = replace(result.history, ended=now(), ending=ending, drawings_left_out=undrawn)
    history = replace(history, why_left_out=why if undrawn else "")
    times = {name: getattr(history, name).isoformat(timespec="seconds") for name in ("begun", "ended")}
    return {**asdict(history), **times, "processors": os.cpu_count()}


def write_rows(path: Path, rows: Sequence[Row]) -> None:
    """Rows as `write_csv` has them, without pandas, which takes long to import."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(map(_plain, rows[0]))
        writer.writerows([_cell(value) for value in row.values()] for row in rows)


def _cell(value: Any) -> Any:
    if not known(value):
        return ""
    return float(value) if isinstance(value, float) else _plain(value)


def write_csv(path: Path, frame: pd.DataFrame) -> None:
    """A table with floats in full precision; no text in it is a formula to a spreadsheet."""
    texts = frame.select_dtypes(exclude=["number", "bool"]).columns
    frame = frame.assign(**{name: frame[name].map(_plain) for name in texts}).rename(columns=_plain)
    with path.open("w", encoding="utf-8", newline="") as file:  # pandas would read ~ as a home
        frame.to_csv(file, index=False, lineterminator="\n")


def _plain(value: Any) -> Any:
    return no_formula(value) if isinstance(value, str) else value


def write_json(path: Path, content: dict[str, Any]) -> None:
    """JSON that every reader knows: no NaN."""
    path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def write_page(path: Path, page: str) -> None:
    """Write HTML with the same line ends everywhere."""
    path.write_text(page, encoding="utf-8", newline="\n")
