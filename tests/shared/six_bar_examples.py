"""A six-bar of every row, whose driver turns fully and whose loops stay well away from dead positions."""

from __future__ import annotations

from typing import Any

from grashof.problems import SixBar

_CRANK_ROCKER: dict[str, Any] = {"o2": (0, 0), "o4": (4, 0), "r2": 1, "r3": 4, "r4": 3}


def _pins(c: Any, d: Any, r5: float, r6: float, *hosts: int, **given: Any) -> SixBar:
    given = {"coupler_point": (2, 1)} | given
    return SixBar(**_CRANK_ROCKER, c=c, d=d, r5=r5, r6=r6, hosts=hosts, **given)


def _press(c: Any, r5: float, angle: float, offset: float, *hosts: int, **given: Any) -> SixBar:
    given = {"coupler_point": (2, 1)} | given
    return SixBar(**_CRANK_ROCKER, c=c, r5=r5, slide_angle_2=angle, offset_2=offset, hosts=hosts, **given)


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
