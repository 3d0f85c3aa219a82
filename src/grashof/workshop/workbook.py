"""The candidate list as an Excel workbook, with a sheet for every design chosen."""

from __future__ import annotations

import csv
import re
import zipfile
from collections.abc import Sequence
from contextlib import suppress
from datetime import datetime
from io import BytesIO
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from grashof.analysis import (
    driver_ranges,
    full_rotation,
    grashof_class,
    solve_position,
    transmission_angle,
    worst_transmission_cycle,
)
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import LinkageSpec, ProblemError
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.specs.linkage_spec import ListedDesign
from grashof.problems.values.text import no_formula
from grashof.workshop.sheet import printable

if TYPE_CHECKING:
    import pandas as pd
    from openpyxl.cell import Cell, MergedCell
    from openpyxl.worksheet.worksheet import Worksheet

_EPOCH = datetime(2000, 1, 1)  # a spreadsheet's times have no zone
_MODIFIED = re.compile(rb"(<dcterms:modified[^>]*>)[^<]*")
_TRANSMISSION_COLUMN = 13
_WIDEST = 40  # letters of a column
_UNITS = {quantity.column: quantity.unit for quantity in QUANTITIES.values() if quantity.listed}


def workbook(chosen: Sequence[LinkageSpec | ListedDesign], candidates: pd.DataFrame | None = None) -> bytes:
    """An .xlsx file of the candidate list, if any, as candidates.csv has it, then a sheet for each linkage.

    Numbers have 16 digits there; Excel calculates with 15. The bytes are the same for the same input, without
    any time. ProblemError where openpyxl is not installed.
    """
    book = _openpyxl().Workbook()
    book.remove(book.active)
    book.properties.creator, book.properties.created = "Grashof", _EPOCH
    if candidates is not None:
        unit = _spec(chosen[0]).length_unit if chosen else ""
        _list_sheet(book.create_sheet("candidates"), candidates, unit)
    for one in chosen:
        name = f"design {one.rank}" if isinstance(one, ListedDesign) else "linkage"
        _linkage_sheet(book.create_sheet(name), one)
    file = BytesIO()
    book.save(file)
    return _without_times(file.getvalue())


def listed_candidates(path: Path, designs: Sequence[ListedDesign]) -> pd.DataFrame:
    """The candidates.csv beside a candidates.json; ProblemError if missing, no table, or of other designs."""
    import pandas as pd

    table = path.with_name("candidates.csv")
    try:
        with table.open(encoding="utf-8", newline="") as file:
            rows = [{name: _value(text) for name, text in row.items()} for row in csv.DictReader(file)]
        ids = {row["rank"]: row["id"] for row in rows}
    except OSError as error:
        raise ProblemError(f"{table}: cannot be read: {error.strerror}; --xlsx lists it") from None
    except (ValueError, KeyError, TypeError, csv.Error):
        raise ProblemError(f"{table}: is not a table of designs; it must be that of grashof solve") from None
    for design in designs:
        if ids.get(design.rank) != design.id:
            raise ProblemError(
                f"{table}: does not list design {design.rank} of {path.name}, {design.id}; solve again"
            )
    return pd.DataFrame(rows, dtype=object)


def _value(text: str) -> bool | int | float | str | None:
    """Value of a cell of a CSV file; pandas would lose the last digit of some."""
    if text in ("", "True", "False"):
        return None if not text else text == "True"
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    return text


def _list_sheet(page: Worksheet, frame: pd.DataFrame, unit: str) -> None:
    """Names, units, then a row for each design; the row of units has the filters."""
    from openpyxl.styles import Font, PatternFill
    from openpyxl.utils import get_column_letter

    shade = PatternFill("solid", fgColor="E8EEF4")
    for column, name in enumerate(frame.columns, start=1):
        values = frame[name].tolist()
        shown = _number_format(values)
        _put(page, 1, column, name, bold=True)
        _put(page, 2, column, _UNITS[name].of(unit) if name in _UNITS else "").font = Font(italic=True)
        for row, value in enumerate(values, start=3):
            _put(page, row, column, value, shown)
        for row in (1, 2):
            page.cell(row, column).fill = shade
        widest = max((len(value) for value in values if isinstance(value, str)), default=0)
        page.column_dimensions[get_column_letter(column)].width = max(len(name), min(widest, _WIDEST), 8) + 3
    page.freeze_panes = "C3"
    page.auto_filter.ref = f"A2:{get_column_letter(len(frame.columns))}{len(frame) + 2}"


def _number_format(values: Sequence[Any]) -> str:
    """Format for six digits of the greatest of some numbers, exponential where they would be zeros."""
    sizes = [abs(value) for value in values if isinstance(value, float) and np.isfinite(value)]
    greatest = max(sizes, default=0.0)
    if not greatest:
        return "0"
    if not 1e-3 <= greatest < 1e7:
        return "0.00000E+00"
    places = max(0, 5 - int(np.floor(np.log10(greatest))))
    return f"0.{places * '0'}" if places else "0"


def _linkage_sheet(page: Worksheet, one: LinkageSpec | ListedDesign) -> None:
    spec = _spec(one)
    facts = _facts(spec)
    for row, (name, value, unit) in enumerate(facts, start=1):
        _put(page, row, 1, name, bold=True)
        _put(page, row, 2, value, _number_format([value]))
        _put(page, row, 3, unit)
    if isinstance(one, ListedDesign):
        _table(page, len(facts) + 2, 1, _targets(one))
    transmission = _transmission(spec)
    _table(page, 1, _TRANSMISSION_COLUMN, transmission)
    _chart(page, len(transmission))
    for letter, width in (("A", 32), ("B", 24)):
        page.column_dimensions[letter].width = width


def _facts(spec: LinkageSpec) -> list[tuple[str, Any, str]]:
    """Properties of a linkage: name, value, unit."""
    linkage, unit = spec.linkage, spec.length_unit
    return [
        ("title", spec.title or spec.name, ""),
        ("source", spec.source, ""),
        ("mechanism", linkage.mechanism.word, ""),
        *((name, value, _unit_of(name, unit)) for name, value in linkage.columns.items()),
        ("grashof_class", str(grashof_class(linkage)), ""),
        ("full_rotation", bool(full_rotation(linkage)), ""),
        ("transmission_min_cycle_deg", float(np.degrees(worst_transmission_cycle(linkage))), "deg"),
    ]


def _unit_of(column: str, unit: str) -> str:
    """Unit of a column of a linkage; signs and names of links have none."""
    bare = column.startswith("assembly") or column in ("hosts", "point_link")
    return "deg" if column.endswith("_deg") else "" if bare else unit


def _targets(design: ListedDesign) -> list[Sequence[Any]]:
    """The position of the linkage at each target, under a heading."""
    linkage = design.spec.linkage
    state = solve_position(linkage, design.theta2, design.assembly)
    places = [f"{name}_{axis}" for name in linkage.mechanism.moving for axis in "xy"]
    heading = ["target", "theta2_deg", "assembly", *places, "position_error"]
    joints = np.column_stack([getattr(state, name) for name in linkage.mechanism.moving]).tolist()
    angles = np.degrees(design.theta2).tolist()
    columns = [range(1, len(joints) + 1), angles, design.assembly, joints, design.position_error]
    rows = [
        [number, angle, sign, *at, error] for number, angle, sign, at, error in zip(*columns, strict=True)
    ]
    if design.angle_error:
        heading.append("angle_error_deg")
        for row, turned in zip(rows, design.angle_error, strict=True):
            row.append(None if turned is None else float(np.degrees(turned)))
    return [heading, *rows]


def _transmission(spec: LinkageSpec) -> list[Sequence[Any]]:
    """Transmission angle at the ends of each driver range and at every whole degree, under a heading."""
    rows: list[Sequence[Any]] = [("theta2_deg", "mu_deg", "quality_deg")]
    for low, high in np.degrees(driver_ranges(spec.linkage)).tolist():
        if np.isfinite(low):
            theta2 = np.unique([low, *np.arange(np.ceil(low), high), high])
            mu = transmission_angle(spec.linkage, np.radians(theta2))
            apart = [(None,) * 3] if len(rows) > 1 else []  # a gap in the chart, too
            rows += apart
            rows += np.column_stack([theta2, np.degrees(mu), np.degrees(quality(mu))]).tolist()
    return rows


def _chart(page: Worksheet, rows: int) -> None:
    """The transmission angle over the driver angle, beside its table."""
    from openpyxl.chart import Reference, ScatterChart, Series

    chart = ScatterChart(scatterStyle="lineMarker")
    chart.title = "Transmission angle over driver angle"
    chart.x_axis.title, chart.y_axis.title = "theta2, deg", "mu, deg"
    chart.x_axis.delete = chart.y_axis.delete = False  # hidden by default
    chart.x_axis.number_format = chart.y_axis.number_format = "0"
    chart.legend, chart.width, chart.height = None, 18, 10
    theta2, mu = (
        Reference(page, min_col=column, min_row=2, max_row=rows)
        for column in (_TRANSMISSION_COLUMN, _TRANSMISSION_COLUMN + 1)
    )
    line = Series(mu, theta2)
    line.marker.symbol, line.smooth = "none", False
    chart.series.append(line)
    page.add_chart(chart, "Q2")


def _table(page: Worksheet, row: int, column: int, lines: Sequence[Sequence[Any]]) -> None:
    """Lines of cells from a corner on, the first one a heading."""
    from openpyxl.utils import get_column_letter

    shown = [_number_format(values) for values in zip(*lines[1:], strict=True)]
    for right, name in enumerate(lines[0], start=column):
        _put(page, row, right, name, bold=True)
        dimensions = page.column_dimensions[get_column_letter(right)]
        dimensions.width = max(12, len(str(name)) + 3, dimensions.width)
    for down, line in enumerate(lines[1:], start=row + 1):
        for right, value in enumerate(line):
            _put(page, down, column + right, value, shown[right])


def _put(
    page: Worksheet, row: int, column: int, value: Any, number_format: str = "", *, bold: bool = False
) -> Cell | MergedCell:
    """Write a cell: numbers as numbers, text that no spreadsheet takes for a formula, and no NaN."""
    from openpyxl.styles import Font

    cell = page.cell(row, column)
    if isinstance(value, str):
        cell.value = printable(value)
        cell.data_type = "s"
        cell.quotePrefix = no_formula(value) != value
    elif isinstance(value, float) and not np.isfinite(value):
        cell.value = None if np.isnan(value) else str(value)
    else:
        cell.value = value
    if isinstance(value, float) and number_format:
        cell.number_format = number_format
    if bold:
        cell.font = Font(bold=True)
    return cell


def _spec(one: LinkageSpec | ListedDesign) -> LinkageSpec:
    return one.spec if isinstance(one, ListedDesign) else one


def _openpyxl() -> ModuleType:
    try:
        import openpyxl
    except ModuleNotFoundError:
        raise ProblemError(
            "XLSX needs openpyxl: pip install 'grashof[export]' (in a clone '.[export]')"
        ) from None
    return openpyxl


def _without_times(file: bytes) -> bytes:
    """The workbook without the time of its writing, which openpyxl adds everywhere."""
    made = BytesIO()
    with zipfile.ZipFile(BytesIO(file)) as old, zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "docProps/core.xml":
                content = _MODIFIED.sub(rb"\g<1>" + _EPOCH.isoformat().encode() + b"Z", content)
            entry = zipfile.ZipInfo(name, _EPOCH.timetuple()[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            new.writestr(entry, content)
    return made.getvalue()
