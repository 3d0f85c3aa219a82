"""CSV files of numbers that a problem or linkage file names, such as the load of a rod."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from grashof.problems.files.spreadsheet import rows_of
from grashof.problems.values.checks import bounded, noted, refuse
from grashof.problems.values.errors import ProblemError, shown

Names = tuple[str, ...]  # that a column may have
_MOST_ROWS = 10_000


def number_table(path: Path, kinds: Sequence[Sequence[Names]]) -> list[list[float]]:
    """The rows of a CSV file whose first line names its columns.

    `kinds` are the tables that it may be, each by the names that each column may have. `ProblemError` where
    it cannot be read, has other columns, or what is no number; a line each.
    """
    lines = rows_of(path.name, path.parent)
    given = [name.strip().casefold() for name in lines[0]] if lines else []
    if not any(_named(given, kind) for kind in kinds):
        wanted = " or ".join(",".join(names[-1] for names in kind) for kind in kinds)
        found = f"has the columns {shown(','.join(given))}" if given else "is empty"
        raise ProblemError(f"{path}: {found}; its first line must be {wanted}")
    if len(lines) - 1 > _MOST_ROWS:
        raise ProblemError(f"{path}: has {len(lines) - 1} rows; it must have at most {_MOST_ROWS}")
    rows: list[list[float]] = []
    wrong: list[str] = []
    for number, line in enumerate(lines[1:], start=1):
        with noted(wrong):
            rows.append(_row(line, len(given), f"{path}: row {number}"))
    refuse(wrong)
    return rows


def _named(given: list[str], kind: Sequence[Names]) -> bool:
    return len(given) == len(kind) and all(name in names for name, names in zip(given, kind, strict=True))


def _row(line: list[str], columns: int, where: str) -> list[float]:
    if len(line) != columns:
        raise ProblemError(f"{where} has {len(line)} cells; it must have {columns}")
    try:
        return [bounded(float(cell), where) for cell in line]
    except ValueError as error:
        if isinstance(error, ProblemError):
            raise
        raise ProblemError(f"{where} is {shown(','.join(line))}; it must be numbers") from None
