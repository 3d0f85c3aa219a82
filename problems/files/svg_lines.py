"""Lines of a foreign SVG drawing."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from typing import Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from grashof.problems.files.curves import QUARTERS, parts_of, straight_part
from grashof.problems.files.dxf_lines import FLAT, MOST_POINTS, Budget
from grashof.problems.files.on_disk import installed, read_by_others
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import ProblemError, listing, shown

_CURVE = 129  # points of a curve before it is simplified
_KEPT = 0.8  # share of that for omitted points; the rest is for the curve between points
_MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6, "Q": 0.25}
_FLOAT = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_WIDTH = re.compile(rf"\s*({_FLOAT})\s*(mm|cm|in|pt|pc|Q)\s*")
_SIZE = re.compile(rf"\s*({_FLOAT})\s*([A-Za-z]*)\s*")
# Nothing else decides where the lines of a drawing are; long ones of the first kind would be slow to read.
_SHORT = {
    "id", "class", "display", "transform", "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry",
    "x1", "y1", "x2", "y2", "viewBox", "preserveAspectRatio",
}  # fmt: skip
_COORDINATES = ("d", "points")
_LONGEST = 1000
_MOST_NAMED = 5  # paths in a message
_WITHOUT_LINES = {"text", "tspan", "desc", "title", "metadata", "image", "script", "filter", "foreignObject"}
_HIDDEN = re.compile(r"display\s*:\s*none\b")
_SVG = "{http://www.w3.org/2000/svg}"


def svg_drawing(content: bytes, group: str = "") -> tuple[list[FloatArray], float | None]:
    """Lines of an SVG, or of a group, with y upwards, in mm (and a mm in metres) where its size is stated so.

    `ProblemError` where it is not an SVG file, has no lines or too many, or svgelements is not installed.
    """
    shapes, scale = _shapes(content, group)
    with read_by_others("an SVG file"), np.errstate(all="ignore"):
        lines = [(scale or 1.0) * _polyline(part) for shape in shapes for part in _subpaths(shape)]
    if not lines:
        raise ProblemError(f"the drawing has no lines{f' in the group {shown(group)}' if group else ''}")
    if not all(np.isfinite(each).all() for each in lines):
        raise ProblemError("the drawing has coordinates that are not finite")
    lines = _simplified(lines)
    if (count := sum(map(len, lines))) > MOST_POINTS:
        raise ProblemError(f"the drawing has {count} points; it must have at most {MOST_POINTS}")
    return lines, None if scale is None else 1e-3


def svg_curve(content: bytes, name: str = "") -> tuple[FloatArray, float | None]:
    """The only path of an SVG, or that with an id, as parts of a curve (`curves`); else as `svg_drawing`.

    `ProblemError` where there are several paths, or several lines in it.
    """
    shapes, scale = _shapes(content, name)
    with read_by_others("an SVG file"), np.errstate(all="ignore"):
        every = [(shape.id, lines) for shape in shapes if (lines := _subpaths(shape))]
        if len(every) != 1:
            raise ProblemError(_not_one([str(each) for each, _ in every if each], len(every), name))
        ((_, lines),) = every
        if len(lines) > 1:
            raise ProblemError(f"the path has {len(lines)} separate lines; it must be one")
        curve = (scale or 1.0) * np.concatenate([_parts(segment) for segment in lines[0]])
    return curve, None if scale is None else 1e-3


def _not_one(ids: list[str], count: int, name: str) -> str:
    where = f" in {shown(name)}" if name else ""
    if not count:
        return f"the drawing has no path{where}"
    named = [f"#{each}" for each in ids[:_MOST_NAMED]]
    wanted = f"name one, such as {listing(named)}" if ids else "give one an id, and name it #id"
    return f"the drawing has {count} paths{where}; {wanted}"


def _shapes(content: bytes, group: str) -> tuple[list[Any], float | None]:
    """The shapes of a drawing, or of a group, and the mm of its unit, None where it states no size."""
    svgelements = installed("svgelements", "SVG needs")
    with read_by_others("an SVG file"), np.errstate(all="ignore"):
        # Without reify, which turns arcs that are skewed into others.
        drawing = svgelements.SVG.parse(BytesIO(_plain(content)), reify=False)
        drawn = _inside(drawing, group) if group else drawing.elements()
        shapes = [each for each in drawn if isinstance(each, svgelements.Shape)]
        width = _WIDTH.fullmatch(str(drawing.values.get("attributes", {}).get("width", "")))
        if width and not (float(width[1]) > 0 and float(drawing.width) > 0):
            raise ProblemError(f"the drawing has the width {shown(width[0])}; it must be positive")
    return shapes, float(width[1]) * _MILLIMETRES[width[2]] / float(drawing.width) if width else None


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
    _complete_size(plain)
    named = {each.get("id", ""): each for each in reversed(list(plain.iter()))}
    _spend(plain, named, Budget(2 * MOST_POINTS, "places", "groups"), 0)
    return ElementTree.tostring(plain)


def _complete_size(drawing: ElementTree.Element) -> None:
    """State the height that follows from the width, or the width, where it is left out.

    svgelements takes 1000 instead.
    """
    box = [float(number) for number in re.findall(_FLOAT, drawing.get("viewBox", ""))]
    if len(box) != 4 or not box[2] > 0 or not box[3] > 0:
        return
    for stated, absent, ratio in (("width", "height", box[3] / box[2]), ("height", "width", box[2] / box[3])):
        size = _SIZE.fullmatch(drawing.get(stated, ""))
        if size and drawing.get(absent) is None:
            drawing.set(absent, f"{float(size[1]) * ratio!r}{size[2]}")


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
        raise ProblemError(f"the drawing has no group or path {shown(group)}")
    return list(found.select()) if hasattr(found, "select") else [found]


@dataclass(frozen=True, slots=True)
class _Segment:
    """From one place to another, straight or through `places` at parameters from 0 to 1."""

    start: FloatArray
    end: FloatArray
    places: Callable[[FloatArray], FloatArray] | None = None


def _subpaths(shape: Any) -> list[list[_Segment]]:
    """The segments of each line of a shape, with y upwards."""
    svgelements = installed("svgelements", "SVG needs")
    turn = shape.transform
    matrix, origin = np.array([[turn.a, -turn.b], [turn.c, -turn.d]]), np.array([turn.e, -turn.f])

    def placed(places: npt.ArrayLike) -> FloatArray:
        given = np.asarray(places, dtype=np.float64).reshape(-1, 2)
        return np.asarray(given @ matrix + origin)

    found: list[list[_Segment]] = []
    # Not Path(shape): that leaves out the transform of a rectangle or an ellipse that is turned.
    for line in svgelements.Path(*shape.segments(transformed=False)).as_subpaths():
        segments, at = list[_Segment](), None
        for given in line:
            if given.end is None:
                continue
            (end,) = placed([given.end.x, given.end.y])
            if at is not None and (kind := type(given).__name__) != "Move":
                curved = None if kind in ("Line", "Close") else _through(given.npoint, placed)
                segments.append(_Segment(at, end, curved))
            at = end
        if segments:
            found.append(segments)
    return found


def _through(
    places: Callable[[FloatArray], npt.ArrayLike], placed: Callable[[npt.ArrayLike], FloatArray]
) -> Callable[[FloatArray], FloatArray]:
    return lambda at: placed(places(at))


def _polyline(segments: list[_Segment]) -> FloatArray:
    """A line, its curves by many points."""
    at = np.linspace(0, 1, _CURVE)[1:]
    ends = (each.end[None] if each.places is None else each.places(at) for each in segments)
    return np.concatenate([segments[0].start[None], *ends])


def _parts(segment: _Segment) -> FloatArray:
    if segment.places is None:
        return straight_part(segment.start, segment.end)
    return parts_of(segment.places, np.linspace(0, 1, QUARTERS + 1))


def _simplified(lines: list[FloatArray]) -> list[FloatArray]:
    import shapely

    size = float(np.ptp(np.concatenate(lines), axis=0).max())
    if not size or not math.isfinite(size):
        raise ProblemError("the drawing has no size")
    return [
        np.asarray(shapely.get_coordinates(shapely.simplify(shapely.linestrings(line), _KEPT * FLAT * size)))
        for line in lines
    ]
