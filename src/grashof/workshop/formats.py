"""The drawing as DXF and as SVG."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO
from types import ModuleType
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import numpy as np

from grashof.problems.files.on_disk import installed
from grashof.problems.values.arrays import FloatArray
from grashof.workshop.sheet import CUT, ENGRAVE, NOTES, PINS, Circle, Outline, Sheet, Text

if TYPE_CHECKING:
    from ezdxf.layouts.layout import Modelspace

_RED, _YELLOW, _GREEN, _CYAN, _MAGENTA, _GREY = 1, 2, 3, 4, 6, 8
_DXF_COLOURS = {CUT: _RED, ENGRAVE: _CYAN, PINS: _MAGENTA, NOTES: _GREY}
_SVG_COLOURS = {CUT: "#ff0000", ENGRAVE: "#0000ff", PINS: "#c000c0", NOTES: "#606060"}
_SVG_LEVELS = ("#008040", "#0080a0")
_HAIRLINE, _DRAWN = 0.1, 0.4  # mm


def dxf(drawing: Sheet) -> str:
    """A drawing as DXF text: in mm, outlines as polylines with true arcs, holes as circles.

    The same text each time, without time or random identifier; ProblemError where ezdxf is not installed.
    """
    ezdxf = installed("ezdxf", "DXF needs")
    with _without_times(ezdxf):
        document = ezdxf.new("R2010", units=ezdxf.units.MM)
        for index, name in enumerate(drawing.layers):
            colour = _DXF_COLOURS.get(name, (_GREEN, _YELLOW)[index % 2])
            document.layers.add(name, color=colour)
        space = document.modelspace()
        for shape in drawing.shapes:
            _add_to_dxf(space, shape)
        space.reset_extents((0, 0, 0), (drawing.width, drawing.height, 0))
        middle = (drawing.width / 2, drawing.height / 2)
        document.set_modelspace_vport(max(drawing.height, drawing.width / 2), middle)  # the first view
        text = StringIO()
        document.write(text)
    return text.getvalue()


def _add_to_dxf(space: Modelspace, shape: Outline | Circle | Text) -> None:
    from ezdxf.enums import TextEntityAlignment

    style = {"layer": shape.layer}
    if isinstance(shape, Outline):
        space.add_lwpolyline(shape.vertices.tolist(), format="xyb", close=True, dxfattribs=style)
    elif isinstance(shape, Circle):
        space.add_circle((shape.x, shape.y), shape.radius, dxfattribs=style)
    else:
        rotation = float(np.degrees(shape.angle))
        text = space.add_text(shape.words, height=shape.height, rotation=rotation, dxfattribs=style)
        place = TextEntityAlignment.MIDDLE_CENTER if shape.centred else TextEntityAlignment.LEFT
        text.set_placement((shape.x, shape.y), align=place)


@contextmanager
def _without_times(ezdxf: ModuleType) -> Iterator[None]:
    """The library's own switch for files that can be compared."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def svg(drawing: Sheet) -> str:
    """A drawing as SVG text in mm, true arcs, red to cut, blue to engrave, each layer a group by its name."""
    size = (_number(drawing.width), _number(drawing.height))
    root = ET.Element("svg", xmlns="http://www.w3.org/2000/svg", version="1.1")
    root.attrib |= {"width": f"{size[0]}mm", "height": f"{size[1]}mm", "viewBox": f"0 0 {size[0]} {size[1]}"}
    if drawing.title:
        ET.SubElement(root, "title").text = drawing.title
    for index, name in enumerate(drawing.layers):
        colour = _SVG_COLOURS.get(name, _SVG_LEVELS[index % 2])
        group = ET.SubElement(root, "g", id=name, fill="none", stroke=colour)
        group.set("stroke-width", _number(_HAIRLINE if name in (CUT, ENGRAVE) else _DRAWN))
        for shape in drawing.shapes:
            if shape.layer == name:
                _add_to_svg(group, shape, drawing.height, colour)
    ET.indent(root, "")
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _add_to_svg(group: ET.Element, shape: Outline | Circle | Text, top: float, colour: str) -> None:
    """A shape with y turned down, as SVG has it."""
    if isinstance(shape, Outline):
        ET.SubElement(group, "path", d=_path(shape.vertices, top))
        return
    x, y = _number(shape.x), _number(top - shape.y)
    if isinstance(shape, Circle):
        ET.SubElement(group, "circle", cx=x, cy=y, r=_number(shape.radius))
        return
    text = ET.SubElement(group, "text", x=x, y=y, fill=colour, stroke="none")
    text.text = shape.words
    # Capitals, which DXF's height is of, are 0.7 of the font's size.
    text.attrib |= {"font-family": "sans-serif", "font-size": _number(shape.height / 0.7)}
    if shape.centred:
        text.attrib |= {"text-anchor": "middle", "dominant-baseline": "central"}
    if shape.angle:
        text.set("transform", f"rotate({_number(-np.degrees(shape.angle))} {x} {y})")


def _path(vertices: FloatArray, top: float) -> str:
    """Path data of a closed outline."""
    points = [f"{_number(x)} {_number(top - y)}" for x, y, _ in vertices]
    parts = [f"M {points[0]}"]
    ends = np.roll(vertices, -1, axis=0)
    for start, end, point in zip(vertices, ends, [*points[1:], points[0]], strict=True):
        bulge = start[2]
        if bulge:
            # Counter-clockwise in the drawing; no arc here is longer than half a circle.
            radius = np.hypot(*(end - start)[:2]) / (2 * np.sin(2 * np.arctan(bulge)))
            parts.append(f"A {_number(radius)} {_number(radius)} 0 0 0 {point}")
        else:
            parts.append(f"L {point}")
    return " ".join([*parts, "Z"])


def _number(value: float) -> str:
    return f"{float(value) + 0.0:.15g}"
