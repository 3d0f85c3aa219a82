"""Files that a problem file names in place of lists: tables of targets, drawings of areas and outlines."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from pathlib import Path
from typing import Any

from grashof.problems.files import drawing_files, spreadsheet
from grashof.problems.files.drawing_files import areas_of, outlines_of
from grashof.problems.files.number_table import number_rows, numbers_wanted
from grashof.problems.files.spreadsheet import rows_of
from grashof.problems.values.checks import bounded, each_checked, located, noted, refuse
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.specs.problem import MOST_TARGETS

Read = Callable[[str, Path, str], dict[str, Any]]  # from a name, its folder and the length unit to keys
_ANGLES = ("angle_deg", "angle")
_TIMING = "timing_deg"


def poses_of(name: str, folder: Path) -> dict[str, Any]:
    """``poses``, as a problem file has them, and ``timing_deg`` where a column has it.

    The columns are x, y and angle_deg; empty cells leave parts of a pose free. `ProblemError` where there are
    others, or what is no number, a line each.
    """
    rows, timing = _table(name, folder, ("x", "y", "angle_deg"))
    return {"poses": each_checked(rows, name, _pose, ": row {}", 1), **timing}


def points_of(name: str, folder: Path) -> dict[str, Any]:
    """Points from the columns x and y; else as `poses_of`, but that no cell may be empty."""
    rows, timing = _table(name, folder, ("x", "y"))
    for number, row in enumerate(rows, start=1):
        if None in row:
            raise ProblemError(f"{name}: row {number} has an empty cell; it must be numbers")
    return {"points": rows, **timing}


def _pose(row: list[float | None], where: str) -> Any:
    x, y, angle = row
    if (x is None) != (y is None):
        raise ProblemError(f"{where} has one of x and y; it must have both or neither")
    if x is None and angle is None:
        raise ProblemError(f"{where} has neither a place nor an angle")
    if angle is None:
        return {"x": x, "y": y}
    return {"angle": angle} if x is None else [x, y, angle]


def _table(
    name: str, folder: Path, wanted: tuple[str, ...]
) -> tuple[list[list[float | None]], dict[str, Any]]:
    """The wanted columns of a file, None where a cell is empty, and its timing."""
    lines = rows_of(name, folder)
    given = [cell.casefold() for cell in lines[0]] if lines else []
    columns = ["angle_deg" if cell in _ANGLES else cell for cell in given]
    if columns not in ([*wanted], [*wanted, _TIMING]):
        found = f"has the columns {shown(','.join(given))}" if given else "is empty"
        raise ProblemError(
            f"{name}: {found}; its first row must be {','.join(wanted)}, perhaps with {_TIMING}"
        )
    rows = number_rows(lines[1:], name, MOST_TARGETS, lambda line, where: _numbers(line, len(columns), where))
    if len(columns) == len(wanted):
        return rows, {}
    timing = [row.pop() for row in rows]
    if None in timing:
        raise ProblemError(f"{name}: row {timing.index(None) + 1} has no {_TIMING}; all rows must have it")
    return rows, {_TIMING: timing}


def _numbers(line: list[str], columns: int, where: str) -> list[float | None]:
    if len(line) > columns and any(line[columns:]):
        raise ProblemError(f"{where} has {len(line)} cells; it must have {columns}")
    with numbers_wanted(line, where):
        return [bounded(float(cell), where) if cell else None for cell in [*line, *[""] * columns][:columns]]


def _body(name: str, folder: Path, unit: str) -> dict[str, Any]:
    areas = areas_of(name, folder, unit)
    if len(areas) > 1:
        raise ProblemError(f"{name}: has {len(areas)} closed lines; a body must be one")
    return {"body": areas[0]}


# By table and key; what is read may be keys of the same table besides.
FILES: dict[tuple[str, str], tuple[tuple[str, ...], Read]] = {
    ("motion", "poses"): (spreadsheet.ENDINGS, lambda name, folder, _: poses_of(name, folder)),
    ("path", "points"): (spreadsheet.ENDINGS, lambda name, folder, _: points_of(name, folder)),
    ("motion", "body"): (drawing_files.ENDINGS, _body),
    ("requirements", "keep_out"): (
        drawing_files.ENDINGS,
        lambda name, folder, unit: {"keep_out": areas_of(name, folder, unit)},
    ),
    ("scene", "outlines"): (
        drawing_files.ENDINGS,
        lambda name, folder, unit: {"outlines": outlines_of(name, folder, unit)},
    ),
}


def with_files(document: dict[str, Any], folder: Path | None) -> dict[str, Any]:
    """A copy of a parsed problem file with what it names in place of the names.

    Names are relative to a folder; without it none may be given. `ProblemError` has what a file lacks, after
    the key that names it, a line each.
    """
    found, wrong = dict(document), list[str]()
    unit = document.get("length_unit", "")
    for (table, key), (endings, read) in FILES.items():
        stated = found.get(table)
        name = stated.get(key) if isinstance(stated, dict) else None
        if not isinstance(name, str) or not isinstance(stated, dict):
            continue
        with noted(wrong):
            found[table] = _filled(stated, f"{table}.{key}", name, endings, folder, read, unit)
    refuse(wrong)
    return found


def _filled(
    stated: dict[str, Any],
    where: str,
    name: str,
    endings: tuple[str, ...],
    folder: Path | None,
    read: Read,
    unit: Any,
) -> dict[str, Any]:
    """A table with what a file has in place of its name."""
    if Path(name.partition("#")[0]).suffix.lower() not in endings:
        raise ProblemError(f"{where} is {shown(name)}; it must be a list, or a file {' or '.join(endings)}")
    if folder is None:
        raise ProblemError(f"{where} is the file {name}; here it must be a list instead")
    try:
        keys = read(name, folder, unit if isinstance(unit, str) else "")
    except ProblemError as error:
        raise located(error, where) from None
    filled = copy(stated)
    for key, value in keys.items():
        if key in stated and not where.endswith(f".{key}"):
            raise ProblemError(f"{where}: {name} has {key}, which is given besides; give one of them")
        filled[key] = value
    return filled
