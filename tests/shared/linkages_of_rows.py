"""Linkages of the rows of `MECHANISMS`: six-bars to look at, and linkages of any row with random numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from grashof.problems import SixBar
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.linkages.mechanisms import linkage_of

_CRANK_ROCKER: dict[str, Any] = {"o2": (0, 0), "o4": (4, 0), "r2": 1, "r3": 4, "r4": 3}


def _pins(c: Any, d: Any, r5: float, r6: float, *hosts: int, **given: Any) -> SixBar:
    given = {"coupler_point": (2, 1)} | given
    return SixBar(**_CRANK_ROCKER, c=c, d=d, r5=r5, r6=r6, hosts=hosts, **given)


def _press(c: Any, r5: float, angle: float, offset: float, *hosts: int, **given: Any) -> SixBar:
    given = {"coupler_point": (2, 1)} | given
    return SixBar(**_CRANK_ROCKER, c=c, r5=r5, slide_angle_2=angle, offset_2=offset, hosts=hosts, **given)


# Their drivers turn fully, and their loops stay well away from dead positions.
SIX_BARS = {
    "stephenson-3": _pins((5, 1), (6, 2), 3, 3, 3, 1, point_link=3, body_angle=0.3),
    "stephenson-1": _pins((1.5, 0.5), (3.5, 1.0), 4, 3.5, 2, 4, assembly_2=-1),
    "watt-1 on driver and coupler": _pins((1.5, 0.5), (5, 1.5), 5, 3.0, 2, 3),
    "watt-1 on coupler and output": _pins((5, 1), (4, 1.0), 3, 3, 3, 4, assembly=-1, point_link=6),
    "watt-2 on the driver": _pins((1.0, 0.8), (-4, 1), 5, 3, 2, 1, point_link=2),
    "watt-2 on the output": _pins((2, 1), (8, 1), 4, 2.5, 4, 1),
    "press of a stephenson-3": _press((2, 1.5), 4, 0.2, -0.5, 3, 1),
    "slide on the driver of a watt-2": _press((-1.2, 0.4), 4, 2.8, 0.3, 2, 1),
    "press of a watt-2": _press((3.5, 0.5), 5, 3.2, 1, 4, 1, coupler_point=(0.5, 0.3), point_link=6),
}


def row_name(value: Any) -> str | None:
    """The name of a row, to tell it in the name of a test from others of its word."""
    if not isinstance(value, Mechanism):
        return None
    return f"{value.word}-{value.dyads[-1].kind}-{value.dyads[-1].hosts}"


def linkage_of_row(row: Mechanism, point_link: int = 5) -> Linkage:
    """A linkage of a row with numbers of which no digit may be lost; of a six-bar `point_link` carries P."""
    rng = np.random.default_rng(7)
    sizes = {each.name: rng.uniform(0.5, 2.0, 2 if each.paired else ()) for each in row.parameters}
    signs = {each.name: -1 for each in row.parameters if each.kind == "sign"}
    choices = {"hosts": row.dyads[1].hosts, "point_link": point_link} if len(row.dyads) > 1 else {}
    return linkage_of(row.word, sizes | signs | choices)
