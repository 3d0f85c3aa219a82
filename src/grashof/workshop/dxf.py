"""The drawing as DXF."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from grashof.problems.files.dxf_lines import ezdxf_installed
from grashof.workshop.sheet import CUT, ENGRAVE, NOTES, PINS, Circle, Outline, Sheet, Text

if TYPE_CHECKING:
    from ezdxf.layouts.layout import Modelspace

_RED, _YELLOW, _GREEN, _CYAN, _MAGENTA, _GREY = 1, 2, 3, 4, 6, 8
_COLOURS = {CUT: _RED, ENGRAVE: _CYAN, PINS: _MAGENTA, NOTES: _GREY}


def dxf(drawing: Sheet) -> str:
    """A drawing as DXF text: in mm, outlines as polylines with true arcs, holes as circles.

    The same text each time, without time or random identifier; ProblemError where ezdxf is not installed.
    """
    ezdxf = ezdxf_installed()
    with _without_times(ezdxf):
        document = ezdxf.new("R2010", units=ezdxf.units.MM)
        for index, name in enumerate(drawing.layers):
            colour = _COLOURS.get(name, (_GREEN, _YELLOW)[index % 2])
            document.layers.add(name, color=colour)
        space = document.modelspace()
        for shape in drawing.shapes:
            _add(space, shape)
        space.reset_extents((0, 0, 0), (drawing.width, drawing.height, 0))
        middle = (drawing.width / 2, drawing.height / 2)
        document.set_modelspace_vport(max(drawing.height, drawing.width / 2), middle)  # what is seen at first
        text = StringIO()
        document.write(text)
    return text.getvalue()


def _add(space: Modelspace, shape: Outline | Circle | Text) -> None:
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
