"""Rows of CSV and Excel files as text, the cells as they stand."""

from __future__ import annotations

import csv
from pathlib import Path

from grashof.problems.files.toml_file import file_bytes, file_text
from grashof.problems.values.errors import ProblemError

ENDINGS = (".csv", ".xlsx")


def rows_of(name: str, folder: Path) -> list[list[str]]:
    """The rows of a table that are not empty.

    Parameters
    ----------
    name : str
        A file, .csv or .xlsx; of a workbook ``points.xlsx#Sheet`` is a sheet, the first one by default.
    folder : Path
        That the name is relative to.

    Raises
    ------
    ProblemError
        It cannot be read, is no workbook or has no such sheet; or openpyxl is not installed.
    """
    file, _, sheet = name.partition("#")
    path = folder / file
    if path.suffix.lower() == ".xlsx":
        rows = _sheet(path, sheet)
    else:
        rows = [
            [cell.strip() for cell in line] for line in csv.reader(file_text(path, "a CSV file").splitlines())
        ]
    return [row for row in rows if any(row)]


def _sheet(path: Path, name: str) -> list[list[str]]:
    try:
        from openpyxl import load_workbook
        from openpyxl.utils.exceptions import InvalidFileException
    except ModuleNotFoundError:
        raise ProblemError(
            "Excel files need openpyxl: pip install 'grashof[export]' (in a clone '.[export]')"
        ) from None
    from io import BytesIO
    from zipfile import BadZipFile

    content = BytesIO(file_bytes(path, "an Excel workbook"))
    try:
        book = load_workbook(content, read_only=True, data_only=True)
    except (InvalidFileException, BadZipFile, KeyError, ValueError) as error:
        raise ProblemError(f"{path}: is not an Excel workbook: {error}") from None
    if name and name not in book.sheetnames:
        raise ProblemError(f"{path}: has no sheet {name!r}; it has {', '.join(book.sheetnames)}")
    page = book[name] if name else book.worksheets[0]
    return [
        ["" if cell is None else str(cell).strip() for cell in row]
        for row in page.iter_rows(values_only=True)
    ]
