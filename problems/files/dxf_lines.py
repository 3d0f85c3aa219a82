"""Lines of a foreign DXF drawing."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from io import BytesIO
from typing import Any

import numpy as np

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
    installed("ezdxf", "DXF needs")
    from ezdxf import recover
    from ezdxf.bbox import extents
    from ezdxf.lldxf.const import DXFError
    from ezdxf.path import make_path

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
        unit = document.header.get("$INSUNITS", 0)
    if not found:
        where = f"on the layer {shown(layer)}" if layer else "in its model space"
        raise ProblemError(f"the drawing has no lines {where}")
    if not all(np.isfinite(each).all() for each in found):
        raise ProblemError("the drawing has coordinates that are not finite")
    if unit and unit not in _METRES:
        raise ProblemError(f"the drawing is in unit {unit} of DXF; it must be one of {_NAMES}, or none")
    return found, _METRES.get(unit)


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
