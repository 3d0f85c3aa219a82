"""Poses and points out of CSV and Excel files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from grashof.problems.files.number_table import number_rows, numbers_wanted
from grashof.problems.files.spreadsheet import rows_of
from grashof.problems.values.checks import bounded, each_checked
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.specs.problem import MOST_TARGETS

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
