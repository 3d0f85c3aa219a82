"""Outlines and areas out of drawings, DXF and SVG."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from grashof.problems.files.dxf_lines import MOST_POINTS, dxf_drawing
from grashof.problems.files.toml_file import file_bytes
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics_spec import METRES
from grashof.problems.values.errors import ProblemError

ENDINGS = (".dxf", ".svg")
FLAT = 1e-3  # share of a drawing's size by which a polyline may miss a curve
_ENDS_MEET = 1e-6  # likewise, of what is one place
_CURVE = 129  # points of a curve in SVG, of which those are kept that it takes
_KEPT = 0.8  # of that, what leaving points out may take; the rest is between the points
_MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6, "Q": 0.25}
_WIDTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(mm|cm|in|pt|pc|Q)\s*")


def areas_of(name: str, folder: Path, length_unit: str) -> list[list[list[float]]]:
    """Areas of a drawing: what its lines enclose, each a polygon.

    Parameters
    ----------
    name : str
        A file, .dxf or .svg; ``machine.dxf#KEEP_OUT`` are the lines of a layer, of an SVG those of a group.
    folder : Path
    length_unit : str
        Of the problem; a drawing that states its own is converted.

    Raises
    ------
    ProblemError
        It cannot be read, has no lines, or lines that enclose nothing.
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
    read = dxf_drawing if path.suffix.lower() == ".dxf" else _svg_drawing
    try:
        lines, metre = read(file_bytes(path, "a drawing"), part)
    except ProblemError as error:
        raise ProblemError(str(error) if str(error).startswith(str(path)) else f"{name}: {error}") from None
    factor = metre / METRES[length_unit] if metre is not None and length_unit in METRES else 1.0
    lines = [factor * line for line in lines]
    every = np.concatenate(lines)
    return lines, float(np.ptp(every, axis=0).max())


def _svg_drawing(content: bytes, group: str) -> tuple[list[FloatArray], float | None]:
    """Lines of an SVG with y upwards, in mm (and a mm in metres) where its size is stated so."""
    try:
        import svgelements  # type: ignore[import-untyped]
    except ModuleNotFoundError:
        raise ProblemError(
            "SVG needs svgelements: pip install 'grashof[export]' (in a clone '.[export]')"
        ) from None
    from xml.etree.ElementTree import ParseError

    try:
        drawing = svgelements.SVG.parse(io.BytesIO(content), reify=True)
    except (ParseError, ValueError, TypeError, AttributeError) as error:
        raise ProblemError(f"is not an SVG file: {error}") from None
    width = _WIDTH.fullmatch(str(drawing.values.get("attributes", {}).get("width", "")))
    shapes = [each for each in drawing.elements() if isinstance(each, svgelements.Shape)]
    if group:
        shapes = [each for each in _inside(drawing, group) if isinstance(each, svgelements.Shape)]
    if width and not (float(width[1]) > 0 and float(drawing.width) > 0):
        raise ProblemError(f"the drawing has the width {width[0]!r}; it must be positive")
    scale = float(width[1]) * _MILLIMETRES[width[2]] / float(drawing.width) if width else 1.0
    # Not Path(shape): that leaves out the transform of a rectangle or an ellipse that is turned.
    paths = [svgelements.Path(*shape.segments(transformed=True)) for shape in shapes]
    lines = [scale * line * np.array([1, -1]) for path in paths for line in _polylines(path)]
    if not lines:
        raise ProblemError(f"the drawing has no lines{f' in the group {group!r}' if group else ''}")
    if not all(np.isfinite(line).all() for line in lines):
        raise ProblemError("the drawing has places that are no finite numbers")
    lines = _simplified(lines)
    if (count := sum(map(len, lines))) > MOST_POINTS:
        raise ProblemError(f"the drawing has {count} points; it must have at most {MOST_POINTS}")
    return lines, 1e-3 if width else None


def _inside(drawing: Any, group: str) -> list[Any]:
    found = drawing.get_element_by_id(group)
    if found is None:
        raise ProblemError(f"the drawing has no group {group!r}")
    return list(found.select()) if hasattr(found, "select") else [found]


def _polylines(path: Any) -> list[FloatArray]:
    """The parts of a path, its curves by many points."""
    found: list[FloatArray] = []
    for part in path.as_subpaths():
        points: list[complex] = []
        for segment in part:
            name = type(segment).__name__
            if name == "Move":
                points.append(complex(segment.end.x, segment.end.y))
            elif name in ("Line", "Close"):
                if segment.end is not None:
                    points.append(complex(segment.end.x, segment.end.y))
            else:
                at = (segment.point(share) for share in np.linspace(0, 1, _CURVE)[1:].tolist())
                points += [complex(each.x, each.y) for each in at]
        line = np.array([[each.real, each.imag] for each in points])
        if len(line) > 1:
            found.append(line)
    return found


def _simplified(lines: list[FloatArray]) -> list[FloatArray]:
    import shapely

    size = float(np.ptp(np.concatenate(lines), axis=0).max())
    if not size or not math.isfinite(size):
        raise ProblemError("the drawing has no size")
    return [
        np.asarray(shapely.get_coordinates(shapely.simplify(shapely.linestrings(line), _KEPT * FLAT * size)))
        for line in lines
    ]
