"""Files that a problem file names in place of lists: tables of targets, drawings of areas and outlines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np

from grashof.problems.files.curves import ENDS_MEET, POINTS, even_places_along, is_closed
from grashof.problems.files.dxf_lines import dxf_curve, dxf_drawing
from grashof.problems.files.on_disk import file_bytes
from grashof.problems.files.spreadsheet import Names, number_table
from grashof.problems.files.svg_lines import svg_curve, svg_drawing
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import each_checked, located_in, noted, refuse, whole_number
from grashof.problems.values.dynamics.dynamics_spec import METRES
from grashof.problems.values.errors import ProblemError, listing, shown
from grashof.problems.values.requirements.limit_kinds import Kind
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.problems.values.specs.problem import MOST_TARGETS

TABLES, DRAWINGS = (".csv", ".xlsx"), (".dxf", ".svg")


def areas_of(name: str, folder: Path, length_unit: str) -> list[list[list[float]]]:
    """Polygons that the lines of a drawing enclose; `ProblemError` where they enclose nothing.

    In `name` ``machine.dxf#KEEP_OUT`` are the lines of a layer, of an SVG those of a group; a drawing that
    states its own unit is converted to that of the problem, `length_unit`.
    """
    import shapely

    lines, size = _lines(name, folder, length_unit)
    grid = ENDS_MEET * size
    closed = [line for line in lines if _meets(line, grid)]
    rest = [line for line in lines if not _meets(line, grid)]
    apart: Any = [shapely.set_precision(shapely.linestrings(line), grid) for line in rest]
    merged: Any = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(apart))) if apart else []
    chained = [np.asarray(shapely.get_coordinates(part)) for part in merged]
    if left := [line for line in chained if not _meets(line, grid)]:
        (x, y), more = left[0][0].tolist(), len(left) - 1
        others = f", and {more} more" if more else ""
        where = f"the line that begins at ({x:.6g}, {y:.6g})"
        raise ProblemError(f"{name}: {where} is open{others}; it must be closed")
    for line in [*closed, *chained]:
        if len(line) < 4 or not shapely.Polygon(line).area:
            x, y = line[0].tolist()
            raise ProblemError(f"{name}: the line that begins at ({x:.6g}, {y:.6g}) encloses nothing")
    return [line[:-1].tolist() for line in [*closed, *chained]]


def _meets(line: FloatArray, grid: float) -> bool:
    """Whether a line ends where it begins."""
    return bool(np.hypot(*(line[0] - line[-1])) <= 2 * grid)


def outlines_of(name: str, folder: Path, length_unit: str) -> list[list[list[float]]]:
    """Lines of a drawing as they are drawn; parameters as for `areas_of`."""
    return [line.tolist() for line in _lines(name, folder, length_unit)[0]]


def _lines(name: str, folder: Path, length_unit: str) -> tuple[list[FloatArray], float]:
    """Polylines in the problem's unit, and the size of all."""
    lines, factor = _drawn(name, folder, length_unit, {".dxf": dxf_drawing, ".svg": svg_drawing})
    lines = [factor * line for line in lines]
    every = np.concatenate(lines)
    return lines, float(np.ptp(every, axis=0).max())


_Content = TypeVar("_Content")


def _drawn(
    name: str,
    folder: Path,
    length_unit: str,
    read: Mapping[str, Callable[[bytes, str], tuple[_Content, float | None]]],
) -> tuple[_Content, float]:
    """What is read from a drawing, by the ending of its name, and its unit over that of the problem."""
    file, _, part = name.partition("#")
    path = folder / file
    try:
        content, metre = read[path.suffix.lower()](file_bytes(path, "a drawing"), part)
    except ProblemError as error:
        raise ProblemError(str(error) if str(error).startswith(str(path)) else f"{name}: {error}") from None
    return content, metre / METRES[length_unit] if metre is not None and length_unit in METRES else 1.0


def curve_points_of(name: str, folder: Path, length_unit: str, count: int) -> dict[str, Any]:
    """``points`` at equal distances along the curve of a drawing, and ``closed`` where it is.

    In `name` ``leg.svg#foot`` is the path with this id, ``leg.dxf#foot`` what is drawn on a layer; without
    either the drawing has to be one curve. Units as for `areas_of`.
    """
    curve, factor = _drawn(name, folder, length_unit, {".dxf": dxf_curve, ".svg": svg_curve})
    with located_in(name):
        return {"points": even_places_along(factor * curve, count).tolist(), "closed": is_closed(curve)}


# From a name, its folder, the length unit and the table that names it to keys, None for those used up.
Read = Callable[[str, Path, str, Mapping[str, Any]], dict[str, Any]]
_X, _Y, _ANGLE = ("x",), ("y",), ("angle", "angle_deg")
_TIMING = "timing_deg"


def poses_of(name: str, folder: Path) -> dict[str, Any]:
    """``poses``, as a problem file has them, and ``timing_deg`` where a column has it.

    The columns are x, y and angle_deg; empty cells leave parts of a pose free. `ProblemError` where there are
    others, or cells that are not numbers, a line each.
    """
    rows, timing = _table(name, folder, _X, _Y, _ANGLE)
    return {"poses": each_checked(rows, name, _pose, ": row {}", 1), **timing}


def points_of(name: str, folder: Path) -> dict[str, Any]:
    """Points from the columns x and y; else as `poses_of`, but that no cell may be empty."""
    rows, timing = _table(name, folder, _X, _Y)
    for number, row in enumerate(rows, start=1):
        if np.isnan(row).any():
            raise ProblemError(f"{name}: row {number} has an empty cell; it must be numbers")
    return {"points": rows, **timing}


def _pose(row: list[float], where: str) -> Any:
    (x, y, angle), (no_x, no_y, no_angle) = row, np.isnan(row)
    if no_x != no_y:
        raise ProblemError(f"{where} has one of x and y; it must have both or neither")
    if no_x and no_angle:
        raise ProblemError(f"{where} has neither a place nor an angle")
    if no_angle:
        return {"x": x, "y": y}
    return {"angle": angle} if no_x else [x, y, angle]


def _table(name: str, folder: Path, *wanted: Names) -> tuple[list[list[float]], dict[str, Any]]:
    """The wanted columns of a file, NaN where a cell is empty, and its timing."""
    rows = number_table(folder / name, name, (wanted, (*wanted, (_TIMING,))), gaps=True)
    if not rows or len(rows[0]) == len(wanted):
        return rows, {}
    timing = [row.pop() for row in rows]
    for index in np.flatnonzero(np.isnan(timing)):
        raise ProblemError(f"{name}: row {index + 1} has no {_TIMING}; all rows must have it")
    return rows, {_TIMING: timing}


def _path_points(name: str, folder: Path, unit: str, stated: Mapping[str, Any]) -> dict[str, Any]:
    if _ending(name) in TABLES:
        return points_of(name, folder)
    count = whole_number(stated.get("count", POINTS), 2, "count", MOST_TARGETS)
    keys = curve_points_of(name, folder, unit, count)
    closed = stated.get("closed", keys["closed"])
    if isinstance(closed, bool) and closed != keys["closed"]:
        found = "closed" if keys["closed"] else "open: it does not end where it begins"
        raise ProblemError(f"the curve of {name} is {found}; remove closed = {str(closed).lower()}")
    return {**keys, "closed": closed, "count": None}


def _only_area(name: str, folder: Path, unit: str, noun: str) -> list[list[float]]:
    areas = areas_of(name, folder, unit)
    if len(areas) > 1:
        raise ProblemError(f"{name}: has {len(areas)} closed lines; a {noun} must be one")
    return areas[0]


def _body(name: str, folder: Path, unit: str, _: object) -> dict[str, Any]:
    return {"body": _only_area(name, folder, unit, "body")}


def _inside(name: str, folder: Path, unit: str, _: object) -> dict[str, Any]:
    return {"inside": _only_area(name, folder, unit, "region")}


def _areas(name: str, folder: Path, unit: str, _: object) -> dict[str, Any]:
    return {"keep_out": areas_of(name, folder, unit)}


def _outlines(name: str, folder: Path, unit: str, _: object) -> dict[str, Any]:
    return {"outlines": outlines_of(name, folder, unit)}


PLACES = [name for name, limit in LIMITS.items() if limit.kind in (Kind.INSIDE, Kind.ON_BODY)]
# By table, or its path, and key; a file may give further keys of the same table.
FILES: dict[tuple[str, str], tuple[tuple[str, ...], Read]] = {
    ("motion", "poses"): (TABLES, lambda name, folder, *_: poses_of(name, folder)),
    ("path", "points"): (TABLES + DRAWINGS, _path_points),
    ("motion", "body"): (DRAWINGS, _body),
    ("requirements", "keep_out"): (DRAWINGS, _areas),
    **{(f"requirements.{name}", "inside"): (DRAWINGS, _inside) for name in PLACES},
    ("scene", "outlines"): (DRAWINGS, _outlines),
}


def _ending(name: str) -> str:
    return Path(name.partition("#")[0]).suffix.lower()


def with_files(document: dict[str, Any], folder: Path | None) -> dict[str, Any]:
    """A copy of a parsed problem file with the content of the files that it names.

    Names are relative to a folder; without it they are refused. `ProblemError` has a line for each error of
    a file, after the key that names it.
    """
    found, wrong = dict(document), list[str]()
    unit = document.get("length_unit", "")
    for (table, key), (endings, read) in FILES.items():
        stated, where = reduce(_inner, table.split("."), cast(Any, found)), f"{table}.{key}"
        name = stated.get(key) if isinstance(stated, dict) else None
        if not isinstance(name, str) or not isinstance(stated, dict):
            continue
        with noted(wrong):
            _refuse_others(name, where, endings)
            known = _folder(name, where, folder)
            with located_in(where):
                keys = read(name, known, unit if isinstance(unit, str) else "", stated)
                for other in keys.keys() & stated.keys() - {key}:
                    if keys[other] not in (None, stated[other]):
                        raise ProblemError(f"{name} has {other}, which is given besides; give one of them")
            given = {name: value for name, value in (stated | keys).items() if value is not None}
            found = _with_table(found, table.split("."), given)
    refuse(wrong)
    return found


def region_of(name: str, where: str, folder: Path | None, length_unit: str) -> list[list[float]]:
    """Corners of the only closed line of a drawing, which a key names; parameters as for `areas_of`."""
    _refuse_others(name, where, DRAWINGS)
    known = _folder(name, where, folder)
    with located_in(where):
        return _only_area(name, known, length_unit, "region")


def _refuse_others(name: str, where: str, endings: tuple[str, ...]) -> None:
    if _ending(name) not in endings:
        raise ProblemError(f"{where} is {shown(name)}; it must be a list, or a file {listing(endings)}")


def _folder(name: str, where: str, folder: Path | None) -> Path:
    if folder is None:
        raise ProblemError(f"{where} is the file {name}; here it must be a list instead")
    return folder


def _inner(table: Any, key: str) -> Any:
    return table.get(key) if isinstance(table, dict) else None


def _with_table(document: dict[str, Any], path: list[str], table: dict[str, Any]) -> dict[str, Any]:
    """A copy of a document with another table at a path."""
    head, *rest = path
    return {**document, head: _with_table(document[head], rest, table) if rest else table}
