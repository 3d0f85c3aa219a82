"""Lines of a DXF drawing that others made."""

from __future__ import annotations

from io import BytesIO

import numpy as np

from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.workshop.dxf import ezdxf_installed

MOST_POINTS = 20_000
_SHARE = 1e-3  # of the drawing's size: how far a polyline may be from a curve


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
    ezdxf = ezdxf_installed()
    from ezdxf import recover
    from ezdxf.bbox import extents
    from ezdxf.disassemble import recursive_decompose
    from ezdxf.path import make_path

    try:
        document, _ = recover.read(BytesIO(text.encode("utf-8", "surrogateescape")))
    except (ezdxf.DXFError, OSError, ValueError, LookupError) as error:
        raise ProblemError(f"the drawing is not a DXF file: {error}") from None
    entities = list(recursive_decompose(document.modelspace()))
    box = extents(entities, fast=True)
    size = max(box.size.x, box.size.y) if box.has_data else 0.0
    found: list[FloatArray] = []
    for entity in entities:
        if entity.dxftype() not in _DRAWN:
            continue
        points = [(each.x, each.y) for each in make_path(entity).flattening(_SHARE * size or 1.0)]
        if len(points) > 1:
            found.append(np.array(points, dtype=float))
    count = sum(map(len, found))
    if not found:
        raise ProblemError("the drawing has no lines in its model space")
    if count > MOST_POINTS:
        raise ProblemError(f"the drawing has {count} points; at most {MOST_POINTS} are shown")
    if not all(np.isfinite(each).all() for each in found):
        raise ProblemError("the drawing has places that are no finite numbers")
    return found


_DRAWN = frozenset({"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE"})
