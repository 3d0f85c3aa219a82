"""Outlines and areas out of drawings, DXF and SVG."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from grashof.problems.files.dxf_lines import dxf_drawing
from grashof.problems.files.svg_lines import svg_drawing
from grashof.problems.files.toml_file import file_bytes
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.dynamics_spec import METRES
from grashof.problems.values.errors import ProblemError

ENDINGS = (".dxf", ".svg")
_ENDS_MEET = 1e-6  # share of a drawing's size, of what is one place


def areas_of(name: str, folder: Path, length_unit: str) -> list[list[list[float]]]:
    """What the lines of a drawing enclose, each a polygon; `ProblemError` where they enclose nothing.

    In `name` ``machine.dxf#KEEP_OUT`` are the lines of a layer, of an SVG those of a group; a drawing that
    states its own unit is converted to that of the problem, `length_unit`.
    """
    import shapely

    lines, size = _lines(name, folder, length_unit)
    grid = _ENDS_MEET * size
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
    file, _, part = name.partition("#")
    path = folder / file
    read: Callable[[bytes, str], tuple[list[FloatArray], float | None]]
    read = dxf_drawing if path.suffix.lower() == ".dxf" else svg_drawing
    try:
        lines, metre = read(file_bytes(path, "a drawing"), part)
    except ProblemError as error:
        raise ProblemError(str(error) if str(error).startswith(str(path)) else f"{name}: {error}") from None
    factor = metre / METRES[length_unit] if metre is not None and length_unit in METRES else 1.0
    lines = [factor * line for line in lines]
    every = np.concatenate(lines)
    return lines, float(np.ptp(every, axis=0).max())
