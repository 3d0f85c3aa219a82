"""Lines of a DXF drawing that others made."""

from __future__ import annotations

from io import BytesIO
from types import ModuleType

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import ProblemError

MOST_POINTS = 20_000
FLAT = 1e-3  # share of the drawing's size by which a polyline may miss a curve
# By $INSUNITS: in, ft, mm, cm, m, yd, micrometre, dm.
_METRES = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 10: 0.9144, 13: 1e-6, 14: 0.1}
_NAMES = "in, ft, yd, mm, cm, dm, m and micrometres"
_DRAWN = frozenset({"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE"})


def dxf_polylines(text: str) -> list[FloatArray]:
    """Lines and curves of the model space as polylines, in the units of the drawing.

    Blocks are taken apart; text, dimensions and hatches are left out.

    Parameters
    ----------
    text : str
        The file.

    Returns
    -------
    list of ndarray, shape (N, 2)

    Raises
    ------
    ProblemError
        It is no DXF file, has no lines, or too many; or ezdxf is not installed.
    """
    return dxf_drawing(text.encode("utf-8", "surrogateescape"))[0]


def dxf_drawing(content: bytes, layer: str = "") -> tuple[list[FloatArray], float | None]:
    """The same of a layer, or of all, and the drawing's unit in metres, None where it states none."""
    ezdxf = ezdxf_installed()
    from ezdxf import recover
    from ezdxf.bbox import extents
    from ezdxf.disassemble import recursive_decompose
    from ezdxf.path import make_path

    try:
        document, _ = recover.read(BytesIO(content))
    except (ezdxf.DXFError, OSError, ValueError, LookupError) as error:
        raise ProblemError(f"the drawing is not a DXF file: {error}") from None
    entities = list(recursive_decompose(document.modelspace()))
    if layer:
        entities = [each for each in entities if each.dxf.get("layer", "0").casefold() == layer.casefold()]
    box = extents(entities, fast=True)
    size = max(box.size.x, box.size.y) if box.has_data else 0.0
    found: list[FloatArray] = []
    for entity in entities:
        if entity.dxftype() not in _DRAWN:
            continue
        points = [(each.x, each.y) for each in make_path(entity).flattening(FLAT * size or 1.0)]
        if len(points) > 1:
            found.append(np.array(points, dtype=float))
    count = sum(map(len, found))
    if not found:
        where = f"on the layer {layer!r}" if layer else "in its model space"
        raise ProblemError(f"the drawing has no lines {where}")
    if count > MOST_POINTS:
        raise ProblemError(f"the drawing has {count} points; it must have at most {MOST_POINTS}")
    if not all(np.isfinite(each).all() for each in found):
        raise ProblemError("the drawing has places that are no finite numbers")
    unit = document.header.get("$INSUNITS", 0)
    if unit and unit not in _METRES:
        raise ProblemError(f"the drawing is in unit {unit} of DXF; it must be one of {_NAMES}, or none")
    return found, _METRES.get(unit)


def ezdxf_installed() -> ModuleType:
    """The library that reads and writes DXF; `ProblemError` where it is not installed."""
    try:
        import ezdxf
    except ModuleNotFoundError:
        raise ProblemError(
            "DXF needs ezdxf: pip install 'grashof[export]' (in a clone '.[export]')"
        ) from None
    return ezdxf
