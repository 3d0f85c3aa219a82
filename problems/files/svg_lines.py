"""Lines of a foreign SVG drawing."""

from __future__ import annotations

import math
import re
from io import BytesIO
from typing import Any
from xml.etree import ElementTree

import numpy as np

from grashof.problems.files.dxf_lines import FLAT, MOST_POINTS, Budget
from grashof.problems.files.on_disk import installed, read_by_others
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import ProblemError, shown

_CURVE = 129  # points of a curve before it is simplified
_KEPT = 0.8  # share of that for omitted points; the rest is for the curve between points
_MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6, "Q": 0.25}
_FLOAT = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_WIDTH = re.compile(rf"\s*({_FLOAT})\s*(mm|cm|in|pt|pc|Q)\s*")
# Nothing else decides where the lines of a drawing are; long ones of the first kind would be slow to read.
_SHORT = {
    "id", "class", "display", "transform", "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry",
    "x1", "y1", "x2", "y2", "viewBox", "preserveAspectRatio",
}  # fmt: skip
_COORDINATES = ("d", "points")
_LONGEST = 1000
_WITHOUT_LINES = {"text", "tspan", "desc", "title", "metadata", "image", "script", "filter", "foreignObject"}
_HIDDEN = re.compile(r"display\s*:\s*none\b")
_SVG = "{http://www.w3.org/2000/svg}"


def svg_drawing(content: bytes, group: str = "") -> tuple[list[FloatArray], float | None]:
    """Lines of an SVG, or of a group, with y upwards, in mm (and a mm in metres) where its size is stated so.

    `ProblemError` where it is not an SVG file, has no lines or too many, or svgelements is not installed.
    """
    svgelements = installed("svgelements", "SVG needs")
    with read_by_others("an SVG file"), np.errstate(all="ignore"):
        drawing = svgelements.SVG.parse(BytesIO(_plain(content)), reify=True)
        drawn = _inside(drawing, group) if group else drawing.elements()
        shapes = [each for each in drawn if isinstance(each, svgelements.Shape)]
        width = _WIDTH.fullmatch(str(drawing.values.get("attributes", {}).get("width", "")))
        if width and not (float(width[1]) > 0 and float(drawing.width) > 0):
            raise ProblemError(f"the drawing has the width {shown(width[0])}; it must be positive")
        scale = float(width[1]) * _MILLIMETRES[width[2]] / float(drawing.width) if width else 1.0
        # Not Path(shape): that leaves out the transform of a rectangle or an ellipse that is turned.
        paths = [svgelements.Path(*shape.segments(transformed=True)) for shape in shapes]
        lines = [scale * line * np.array([1, -1]) for path in paths for line in _polylines(path)]
    if not lines:
        raise ProblemError(f"the drawing has no lines{f' in the group {shown(group)}' if group else ''}")
    if not all(np.isfinite(line).all() for line in lines):
        raise ProblemError("the drawing has coordinates that are not finite")
    lines = _simplified(lines)
    if (count := sum(map(len, lines))) > MOST_POINTS:
        raise ProblemError(f"the drawing has {count} points; it must have at most {MOST_POINTS}")
    return lines, 1e-3 if width else None


def _plain(content: bytes) -> bytes:
    """The drawing reduced to its lines; refused if it is too large to be read in about a second."""
    budget, depth = Budget(2 * MOST_POINTS, "places", "groups"), 0
    found: ElementTree.Element | None = None
    # Expat itself limits the expansion of entities.
    for event, element in ElementTree.iterparse(BytesIO(content), events=("start", "end")):  # noqa: S314
        depth += 1 if event == "start" else -1
        if event == "start":
            found = element if found is None else found
            budget.spend()
            budget.enter(depth)
    if found is None or _name(found) != "svg":
        raise ProblemError("is not an SVG file: it does not begin with <svg>")
    plain = _copied(found)
    named = {each.get("id", ""): each for each in reversed(list(plain.iter()))}
    _spend(plain, named, Budget(2 * MOST_POINTS, "places", "groups"), 0)
    return ElementTree.tostring(plain)


def _name(element: ElementTree.Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _copied(element: ElementTree.Element) -> ElementTree.Element:
    given = {key.rpartition("}")[2]: text for key, text in element.attrib.items()}
    kept = {key: text for key, text in given.items() if key in _SHORT and len(text) <= _LONGEST}
    kept |= {key: given[key] for key in _COORDINATES if key in given}
    if _name(element) == "use" and "href" in given:
        kept["href"] = given["href"][:_LONGEST]
    if _HIDDEN.search(given.get("style", "")[:_LONGEST]):
        kept["display"] = "none"
    copied = ElementTree.Element(_SVG + _name(element), kept)
    if _name(element) == "style":
        rules = (rule.partition("{") for rule in (element.text or "").split("}"))
        hidden = [selectors.strip() for selectors, _, rule in rules if _HIDDEN.search(rule[:_LONGEST])]
        copied.text = "".join(f"{each[-_LONGEST:]} {{display: none}}" for each in hidden[:100])
    else:
        copied.extend(_copied(each) for each in element if _name(each) not in _WITHOUT_LINES)
    return copied


def _spend(
    element: ElementTree.Element, named: dict[str, ElementTree.Element], budget: Budget, depth: int
) -> None:
    """Count the points that an element draws, those of elements that it uses included."""
    budget.enter(depth)
    budget.spend(4)
    for key in _COORDINATES:
        budget.spend(len(re.findall(_FLOAT, element.get(key, ""))) // 2)
    used = named.get(element.get("href", "").removeprefix("#")) if _name(element) == "use" else None
    for each in (*element, *([] if used is None else [used])):
        _spend(each, named, budget, depth + 1)


def _inside(drawing: Any, group: str) -> list[Any]:
    found = drawing.get_element_by_id(group)
    if found is None:
        raise ProblemError(f"the drawing has no group {shown(group)}")
    return list(found.select()) if hasattr(found, "select") else [found]


def _polylines(path: Any) -> list[FloatArray]:
    """The parts of a path, its curves by many points."""
    found: list[FloatArray] = []
    for part in path.as_subpaths():
        points: list[FloatArray] = []
        for segment in part:
            if type(segment).__name__ in ("Move", "Line", "Close"):
                if segment.end is not None:
                    points.append(np.array([[segment.end.x, segment.end.y]]))
            else:
                points.append(np.reshape(segment.npoint(np.linspace(0, 1, _CURVE)[1:]), (-1, 2)))
        line = np.concatenate(points) if points else np.empty((0, 2))
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
