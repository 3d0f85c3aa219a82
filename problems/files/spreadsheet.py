"""Rows of CSV and Excel files as text, the cells as they stand."""

from __future__ import annotations

import csv
from io import BytesIO, StringIO
from itertools import islice
from pathlib import Path
from zipfile import ZipFile

from grashof.problems.files.foreign import read_by_others
from grashof.problems.files.toml_file import MOST_BYTES, file_bytes, file_text
from grashof.problems.values.checks import located_in
from grashof.problems.values.errors import ProblemError, shown

MOST_LINES = 20_000  # of a table, empty ones among them
_MOST_COLUMNS = 64

ENDINGS = (".csv", ".xlsx")


def rows_of(name: str, folder: Path) -> list[list[str]]:
    """The rows of a table, .csv or .xlsx, that are not empty.

    Of a workbook ``points.xlsx#Sheet`` is a sheet, the first one by default. `ProblemError` where it cannot
    be read, is no workbook or has no such sheet; or openpyxl is not installed.
    """
    file, _, sheet = name.partition("#")
    path = folder / file
    rows = _sheet(path, sheet) if path.suffix.lower() == ".xlsx" else csv_rows(path, "a CSV file")
    return [row for row in rows if any(row)]


def csv_rows(path: Path, wanted: str) -> list[list[str]]:
    """All rows of a CSV file, stripped cells; `ProblemError` where it is not what is wanted."""
    text = StringIO(file_text(path, wanted), newline="")
    with located_in(str(path)), read_by_others(wanted):
        lines = list(islice(csv.reader(text), MOST_LINES + 1))
    if len(lines) > MOST_LINES:
        raise ProblemError(f"{path}: has more than {MOST_LINES} lines; it must have at most that")
    return [[cell.strip() for cell in line] for line in lines]


def _sheet(path: Path, name: str) -> list[list[str]]:
    try:
        from openpyxl import load_workbook
    except ModuleNotFoundError:
        raise ProblemError(
            "Excel files need openpyxl: pip install 'grashof[export]' (in a clone '.[export]')"
        ) from None
    content = file_bytes(path, "an Excel workbook")
    with located_in(str(path)), read_by_others("an Excel workbook"):
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
