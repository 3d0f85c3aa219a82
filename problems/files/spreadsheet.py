"""Tables in CSV and Excel files: their rows as text, or as numbers under named columns."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from functools import partial
from io import BytesIO, StringIO
from itertools import islice
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from grashof.problems.files.on_disk import MOST_BYTES, file_bytes, file_text, installed, read_by_others
from grashof.problems.values.checks import bounded, each_checked, located_in
from grashof.problems.values.errors import ProblemError, shown

MOST_LINES = 20_000  # of a table, empty ones among them
_MOST_COLUMNS = 64


def rows_of(name: str, folder: Path) -> list[list[str]]:
    """The rows of a table, .csv or .xlsx, that are not empty.

    Of a workbook ``points.xlsx#Sheet`` is a sheet, the first one by default. `ProblemError` where it cannot
    be read, is not a workbook, has no such sheet, or openpyxl is not installed.
    """
    file, _, sheet = name.partition("#")
    path = folder / file
    rows = _sheet(path, sheet) if path.suffix.lower() == ".xlsx" else csv_rows(path, "a CSV file")
    return [row for row in rows if any(row)]


def csv_rows(path: Path, wanted: str) -> list[list[str]]:
    """All rows of a CSV file, cells stripped; `ProblemError` where it is not `wanted`."""
    text = StringIO(file_text(path, wanted), newline="")
    with located_in(str(path)), read_by_others(wanted, csv.Error):
        lines = list(islice(csv.reader(text), MOST_LINES + 1))
    if len(lines) > MOST_LINES:
        raise ProblemError(f"{path}: has more than {MOST_LINES} lines; it must have at most that")
    return [[cell.strip() for cell in line] for line in lines]


def _sheet(path: Path, name: str) -> list[list[str]]:
    installed("openpyxl", "Excel files need")
    from openpyxl import load_workbook
    from openpyxl.utils.exceptions import CellCoordinatesException, InvalidFileException

    own = (BadZipFile, CellCoordinatesException, InvalidFileException)
    content = file_bytes(path, "an Excel workbook")
    with located_in(str(path)), read_by_others("an Excel workbook", *own):
        with ZipFile(BytesIO(content)) as parts:
            size = sum(part.file_size for part in parts.infolist())
        if size > MOST_BYTES:
            raise ProblemError(f"has {size} bytes when it is unpacked; it must have at most {MOST_BYTES}")
        book = load_workbook(BytesIO(content), read_only=True, data_only=True)
        if name and name not in book.sheetnames:
            raise ProblemError(f"has no sheet {shown(name)}; it has {', '.join(book.sheetnames)}")
        sheets = [book[name]] if name else book.worksheets
        if not sheets or not hasattr(sheets[0], "iter_rows"):
            raise ProblemError("has no sheet of cells")
        # Empty cells before and between others are made, however far away these are.
        lines = sheets[0].iter_rows(max_row=MOST_LINES + 1, max_col=_MOST_COLUMNS + 1, values_only=True)
        rows = [["" if cell is None else str(cell).strip() for cell in line] for line in lines]
    if len(rows) > MOST_LINES:
        raise ProblemError(f"{path}: has more than {MOST_LINES} rows; it must have at most that")
    for row in rows:  # each as wide as the widest may be
        while row and not row[-1]:
            row.pop()
    if any(len(row) > _MOST_COLUMNS for row in rows):
        raise ProblemError(f"{path}: has more than {_MOST_COLUMNS} columns; it must have at most that")
    return rows


Names = tuple[str, ...]  # that a column may have
_MOST_ROWS = 10_000


def number_table(
    path: Path, where: str, kinds: Sequence[Sequence[Names]], *, gaps: bool = False
) -> list[list[float]]:
    """The rows of a table whose first line names its columns; with `gaps` NaN where a cell is empty.

    `kinds` are the possible tables, each by the possible names of its columns. `ProblemError`, which begins
    with `where`, for other columns, too many rows, or cells that are not numbers, a line each.
    """
    lines = rows_of(path.name, path.parent)
    given = [name.casefold() for name in lines[0]] if lines else []
    if not any(_named(given, kind) for kind in kinds):
        wanted = " or ".join(",".join(names[-1] for names in kind) for kind in kinds)
        found = f"has the columns {shown(','.join(given))}" if given else "is empty"
        raise ProblemError(f"{where}: {found}; its first line must be {wanted}")
    if len(lines) > _MOST_ROWS + 1:
        raise ProblemError(f"{where}: has {len(lines) - 1} rows; it must have at most {_MOST_ROWS}")
    row = partial(_row, columns=len(given), gaps=gaps)
    return each_checked(lines[1:], where, row, ": row {}", 1)


def _named(given: list[str], kind: Sequence[Names]) -> bool:
    return len(given) == len(kind) and all(name in names for name, names in zip(given, kind, strict=True))


def _row(line: list[str], where: str, *, columns: int, gaps: bool) -> list[float]:
    if gaps and not any(line[columns:]):
        line = [*line, *[""] * columns][:columns]
    if len(line) != columns:
        raise ProblemError(f"{where} has {len(line)} cells; it must have {columns}")
    try:
        numbers = [float(cell) if cell or not gaps else None for cell in line]
    except ValueError:
        raise ProblemError(f"{where} is {shown(','.join(line))}; it must be numbers") from None
    return [math.nan if number is None else bounded(number, where) for number in numbers]
