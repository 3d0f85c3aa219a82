"""Lines of a foreign DXF drawing."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from io import BytesIO
from typing import Any

import numpy as np

from grashof.problems.files.curves import NODES, QUARTERS, chained, parts_of, straight_part, turned_back
from grashof.problems.files.on_disk import installed, read_by_others
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import GREATEST
from grashof.problems.values.errors import ProblemError, shown

MOST_POINTS = 20_000
_DEEPEST = 32  # blocks within blocks, groups within groups
FLAT = 1e-3  # share of the drawing's size by which a polyline may miss a curve
# By $INSUNITS: in, ft, mm, cm, m, yd, micrometre, dm.
_METRES = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 10: 0.9144, 13: 1e-6, 14: 0.1}
_NAMES = "in, ft, yd, mm, cm, dm, m and micrometres"
_MOST_ENTITIES = 20_000  # of the file, unseen ones among them
_ENTITY = re.compile(rb"^[ \t]*0[ \t]*\r?$", re.MULTILINE)
_PLACES = ("points", "vertices", "control_points", "fit_points", "knots", "weights")
_TURNS = ("start_param", "end_param", "start_angle", "end_angle")
_MOST_DEGREES, _MOST_DEGREE = 1e6, 11  # of an arc, and of a spline
_DRAWN = frozenset({"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE"})


class Budget:
    """The number of parts that a drawing may have once its repetitions are expanded.

    `part` names the parts, `level` those that may contain others, in the plural: "entities", "blocks".
    """

    def __init__(self, most: int, part: str, level: str) -> None:
        self._most, self._part, self._level = most, part, level
        self._left = most

    def spend(self, count: int = 1) -> None:
        """Count parts; `ProblemError` when they are too many."""
        self._left -= count
        if self._left < 0:
            raise ProblemError(f"the drawing has more than {self._most} {self._part}; that is the most")

    def enter(self, depth: int) -> None:
        """`ProblemError` for parts within parts that are nested too deep."""
        if depth > _DEEPEST:
            raise ProblemError(f"{self._level} are nested more than {_DEEPEST} deep, perhaps in themselves")


def dxf_polylines(text: str) -> list[FloatArray]:
    """Lines and curves of the model space as polylines (N, 2), in the units of the drawing.

    Blocks are exploded; text, dimensions and hatches are ignored. `ProblemError` where it is not a DXF file,
    has no lines or too many, or ezdxf is not installed.
    """
    return dxf_drawing(text.encode("utf-8", "surrogateescape"))[0]


def dxf_drawing(content: bytes, layer: str = "") -> tuple[list[FloatArray], float | None]:
    """The same of a layer, or of all, and the drawing's unit in metres, None where it states none."""
    entities, unit = _entities(content, layer)
    from ezdxf.bbox import extents
    from ezdxf.path import make_path

    with read_by_others("a DXF file"):
        box = extents(entities, fast=True)
        size = max(box.size.x, box.size.y) if box.has_data else 0.0
        found, budget = list[FloatArray](), Budget(MOST_POINTS, "points", "")
        for entity in entities:
            points = []
            for each in make_path(entity).flattening(FLAT * size or 1.0):
                budget.spend()
                points.append((each.x, each.y))
            if len(points) > 1:
                found.append(np.array(points, dtype=float))
    if not found:
        raise ProblemError(f"the drawing has no lines {_where(layer)}")
    if not all(np.isfinite(each).all() for each in found):
        raise ProblemError("the drawing has coordinates that are not finite")
    return found, unit


def dxf_curve(content: bytes, layer: str = "") -> tuple[FloatArray, float | None]:
    """The only curve of a DXF drawing, or of a layer, as parts (`curves`); else as `dxf_drawing`.

    Lines and curves that meet end to end are one. `ProblemError` where there are several.
    """
    entities, unit = _entities(content, layer)
    with read_by_others("a DXF file"), np.errstate(all="ignore"):
        budget = Budget(MOST_POINTS, "pieces", "")
        drawn = [curve for entity in entities if len(curve := _curve(entity, budget))]
        if not drawn:
            raise ProblemError(f"the drawing has no lines {_where(layer)}")
        curves = chained(drawn)
    if len(curves) > 1:
        other = "it must be one" if layer else "put one on a layer of its own and name it, as #layer"
        raise ProblemError(f"the drawing has {len(curves)} separate curves {_where(layer)}; {other}")
    return curves[0], unit


def _where(layer: str) -> str:
    return f"on the layer {shown(layer)}" if layer else "in its model space"


def _entities(content: bytes, layer: str) -> tuple[list[Any], float | None]:
    """What is drawn on a layer, or on all, with sound numbers, and the unit in metres."""
    installed("ezdxf", "DXF needs")
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError

    if len(_ENTITY.findall(content)) > _MOST_ENTITIES:
        raise ProblemError(f"the drawing has more than {_MOST_ENTITIES} entities; it must have at most that")
    with read_by_others("a DXF file", DXFError):
        document, _ = recover.read(BytesIO(content))
        every = _drawn(document.modelspace(), Budget(MOST_POINTS, "entities", "blocks"))
        entities = [
            each for each in every if not layer or each.dxf.get("layer", "0").casefold() == layer.casefold()
        ]
        if not all(_is_sound(each) for each in entities):
            raise ProblemError("the drawing has numbers that are not finite or beyond 1e20")
        unit = document.header.get("$INSUNITS", 0)
    if unit and unit not in _METRES:
        raise ProblemError(f"the drawing is in unit {unit} of DXF; it must be one of {_NAMES}, or none")
    return entities, _METRES.get(unit)


def _curve(entity: Any, budget: Budget) -> FloatArray:
    """The parts of an entity, in order; none of one without lines, such as a mesh."""
    kind = entity.dxftype()
    if kind in ("LWPOLYLINE", "POLYLINE"):
        pieces = [_curve(each, budget) for each in entity.virtual_entities() if each.dxftype() in _DRAWN]
        return _in_order([each for each in pieces if len(each)])
    if kind == "LINE":
        budget.spend()
        return straight_part((entity.dxf.start.x, entity.dxf.start.y), (entity.dxf.end.x, entity.dxf.end.y))
    places, knots = _SMOOTH[kind](entity)
    budget.spend(len(knots) - 1)

    def flat(at: FloatArray) -> FloatArray:
        return np.array([(each.x, each.y) for each in places(at.tolist())]).reshape(-1, 2)

    return parts_of(flat, knots)


def _in_order(pieces: list[FloatArray]) -> FloatArray:
    """Pieces that follow one another, each turned so that it begins where the one before it ends.

    Arcs of polylines are given counter-clockwise.
    """
    if not pieces:
        return np.empty((0, NODES, 2))
    first, *others = pieces
    if others and _gap(first[0, 0], others[0]) < _gap(first[-1, -1], others[0]):
        first = turned_back(first)
    found = [first]
    for piece in others:
        end = found[-1][-1, -1]
        backwards = np.hypot(*(piece[-1, -1] - end)) < np.hypot(*(piece[0, 0] - end))
        found.append(turned_back(piece) if backwards else piece)
    return np.concatenate(found)


def _gap(place: FloatArray, piece: FloatArray) -> float:
    """The distance of a place from the nearer end of a piece."""
    return float(min(np.hypot(*(end - place)) for end in (piece[0, 0], piece[-1, -1])))


_Smooth = tuple[Callable[[Sequence[float]], Iterable[Any]], FloatArray]  # places by parameters, and knots


def _circle(entity: Any) -> _Smooth:
    return entity.vertices, np.linspace(0, 360, QUARTERS + 1)


def _arc(entity: Any) -> _Smooth:
    start, end = entity.dxf.start_angle, entity.dxf.end_angle
    return entity.vertices, start + np.linspace(0, (end - start) % 360 or 360.0, QUARTERS + 1)


def _ellipse(entity: Any) -> _Smooth:
    start, end = entity.dxf.start_param, entity.dxf.end_param
    turn = (end - start) % math.tau or math.tau
    return entity.vertices, start + np.linspace(0, turn, QUARTERS + 1)


def _spline(entity: Any) -> _Smooth:
    tool = entity.construction_tool()
    knots = np.unique(np.asarray(tool.knots(), dtype=float)[tool.order - 1 : tool.count + 1])
    share = np.arange(QUARTERS if tool.is_rational else 1) / (QUARTERS if tool.is_rational else 1)
    inner = knots[:-1, None] + share * np.diff(knots)[:, None]
    return tool.points, np.append(inner.ravel(), knots[-1])


_SMOOTH: dict[str, Callable[[Any], _Smooth]] = {
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "SPLINE": _spline,
}


def _drawn(entities: Iterable[Any], budget: Budget, depth: int = 0) -> Iterator[Any]:
    """Lines and curves, those of blocks one by one: a few bytes may expand to millions."""
    budget.enter(depth)
    for entity in entities:
        budget.spend()
        if entity.dxftype() == "INSERT":
            budget.spend(entity.mcount)
            inside = entity.multi_insert() if entity.mcount > 1 else entity.virtual_entities()
            yield from _drawn(inside, budget, depth + 1)
        elif entity.dxftype() in _DRAWN:
            yield entity


def _is_sound(entity: Any) -> bool:
    """Whether all numbers of an entity are finite, and those that cost time are small."""
    given = entity.dxf.all_existing_dxf_attribs()
    places = [getattr(entity, name, ()) for name in _PLACES]
    turns = [given.get(name, 0.0) for name in _TURNS]
    small = _finite(turns, _MOST_DEGREES) and given.get("degree", 3) <= _MOST_DEGREE
    return small and _finite([*given.values(), *places], GREATEST)


def _finite(values: Any, most: float) -> bool:
    """Whether all numbers within nested sequences are finite and not beyond a size."""
    if isinstance(values, int | float):
        return abs(values) <= most
    if isinstance(values, str | bytes) or not hasattr(values, "__iter__"):
        return True
    return all(_finite(each, most) for each in values)
