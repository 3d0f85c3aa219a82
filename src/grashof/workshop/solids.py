"""The parts as solids: STEP and STL, by build123d."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.workshop.plan import Plan
from grashof.workshop.plates import Plate, outline
from grashof.workshop.stacking import Pin, placed

TOLERANCE = 0.01  # mm, by which the flats of an STL file may miss the arcs
_ANGLE = 0.1  # rad, between such flats


def step(plan: Plan) -> bytes:
    """The assembly as a STEP file: every part and pin a body with its name, in mm, z across the layers.

    ProblemError where build123d is not installed.
    """
    cad = _build123d()
    return _written(lambda path: cad.export_step(assembly(plan), path, timestamp=""), ".step")


def stl(plan: Plan) -> bytes:
    """The same as STL, arcs as flats within `TOLERANCE`; parameters as for `step`."""
    cad = _build123d()
    return _written(lambda path: cad.export_stl(assembly(plan), path, TOLERANCE, _ANGLE), ".stl")


def assembly(plan: Plan) -> Any:
    """A Compound of every part and pin in place, named solids in mm, O2 in the origin of the lowest layer."""
    cad = _build123d()
    thick, children = plan.sizes.thickness, []
    for part in plan.parts:
        flat = plate_solid(part.plate, thick)
        for layer, (x, y, angle) in zip(part.layers, part.places.tolist(), strict=True):
            at = cad.Location((x, y, layer * thick), (0, 0, math.degrees(angle)))
            children.append(_named(flat.moved(at), part.plate.name))
    for pin in plan.pins:
        cylinder = cad.Solid.make_cylinder(plan.sizes.hole / 2, plan.pin_length(pin))
        x, y = _place(plan, pin)
        children.append(_named(cylinder.moved(cad.Location((x, y, pin.low * thick))), pin.title))
    return cad.Compound(label="linkage", children=children)


def plate_solid(plate: Plate, thickness: float) -> Any:
    """A plate as a solid that lies on the x-y plane of its own frame, mm."""
    cad = _build123d()
    holes = [
        cad.Wire([cad.Edge.make_circle(plate.hole / 2).moved(cad.Location((x, y)))]) for x, y in plate.holes
    ]
    slots = [_wire(outline(ends, plate.hole / 2)) for _, ends in plate.slots]
    return cad.Solid.extrude(cad.Face(_wire(plate.outline), [*holes, *slots]), (0, 0, thickness))


def _wire(vertices: FloatArray) -> Any:
    """A closed line of straight parts and arcs, whose bulges are tangents of a quarter of their angles."""
    cad = _build123d()
    edges = []
    for (*start, bulge), (*end, _) in pairwise([*vertices.tolist(), vertices[0].tolist()]):
        if bulge:
            (x, y), (dx, dy) = start, np.subtract(end, start).tolist()
            top = (x + dx / 2 + bulge * dy / 2, y + dy / 2 - bulge * dx / 2)
            edges.append(cad.Edge.make_three_point_arc((*start, 0), (*top, 0), (*end, 0)))
        else:
            edges.append(cad.Edge.make_line((*start, 0), (*end, 0)))
    return cad.Wire(edges)


def _place(plan: Plan, pin: Pin) -> tuple[float, float]:
    """Place of a pin, mm: in its joint, or as a post in its hole of the base."""
    if pin.name in plan.joints:
        return plan.joints[pin.name]
    base = plan.parts[0]
    hole = base.plate.holes[base.plate.joints.index(pin.name)]
    x, y = placed(hole[None], base.places[0])[0].tolist()
    return x, y


def _named(solid: Any, name: str) -> Any:
    solid.label = name
    return solid


def _written(write: Callable[[str], object], ending: str) -> bytes:
    """Output of the library, which requires a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"linkage{ending}"
        write(str(path))
        return path.read_bytes()


def _build123d() -> ModuleType:
    try:
        import build123d
    except ModuleNotFoundError:
        raise ProblemError(
            "STEP and STL need build123d: pip install 'grashof[cad]' (in a clone '.[cad]')"
        ) from None
    module: ModuleType = build123d
    return module
