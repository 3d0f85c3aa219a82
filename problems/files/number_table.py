"""CSV files of numbers that a problem or linkage file names, such as the load of a rod."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from grashof.problems.files.spreadsheet import rows_of
from grashof.problems.values.checks import bounded, each_checked
from grashof.problems.values.errors import ProblemError, shown

Names = tuple[str, ...]  # that a column may have
_MOST_ROWS = 10_000
Cell = TypeVar("Cell", float, float | None)


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
    return number_rows(lines[1:], str(path), _MOST_ROWS, lambda line, where: _row(line, len(given), where))


def number_rows(
    lines: list[list[str]], where: str, most: int, row: Callable[[list[str], str], list[Cell]]
) -> list[list[Cell]]:
    """The rows of a table below its first line, each read with its place; `ProblemError` has a line a row."""
    if len(lines) > most:
        raise ProblemError(f"{where}: has {len(lines)} rows; it must have at most {most}")
    return each_checked(lines, where, row, ": row {}", 1)


def _named(given: list[str], kind: Sequence[Names]) -> bool:
    return len(given) == len(kind) and all(name in names for name, names in zip(given, kind, strict=True))


def _row(line: list[str], columns: int, where: str) -> list[float]:
    if len(line) != columns:
        raise ProblemError(f"{where} has {len(line)} cells; it must have {columns}")
    with numbers_wanted(line, where):
        return [bounded(float(cell), where) for cell in line]


@contextmanager
def numbers_wanted(line: list[str], where: str) -> Iterator[None]:
    """`ProblemError` for a line whose cells, read inside, are not all numbers."""
    try:
        yield
    except ProblemError:
        raise
    except ValueError:
        raise ProblemError(f"{where} is {shown(','.join(line))}; it must be numbers") from None
