"""What slides in pictures: blocks, the rod that one slides on, and the guide of one on the ground."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from grashof.analysis import Position
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import LOOP_POINTS, DyadKind

# Of a block: half of its length in lengths of the driver, its width in that half.
_HALF, _WIDE = 0.22, 0.6
_TICKS = 14  # of the hatching, at least
CORNERS = ("block1", "block2", "block3", "block4", "block1")  # all round
ROD, ARM = ("rod1", "rod2"), ("foot", "p")  # ends of the rod; from the rod to P beside it


class Travel(NamedTuple):
    """Where a slide goes: along the slide from O2, or along the rod from A."""

    low: float
    high: float


def half_block(linkage: Linkage) -> float:
    """Half the length of a block as drawn."""
    return _HALF * float(linkage.r2)


def slide_points(linkage: Linkage, state: Position, travel: Travel) -> dict[str, FloatArray]:
    """Corners of the block and ends of the rod in N positions, by their names, each of shape (N, 2)."""
    for (_, _, name), loop in zip(LOOP_POINTS, state.loops, strict=False):
        if loop.dyad.row.kind is DyadKind.RRP:
            angle, _ = _line(linkage)
            return _block(linkage, state.point(name), np.broadcast_to(angle, np.shape(state.theta2)))
        if loop.dyad.row.kind is DyadKind.RPR:
            return _block(linkage, state.point(name), state.theta3) | _rod(linkage, state, travel)
    return {}


def _rod(linkage: Linkage, state: Position, travel: Travel) -> dict[str, FloatArray]:
    """Ends of the rod in every position, and the foot of P on it."""
    over, half = float(linkage.coupler_point[0]), half_block(linkage)
    ends = np.stack([np.minimum(state.travel, travel.low), np.maximum(state.travel, travel.high)])
    low = np.where(ends[0] < 0, ends[0] - half, 0.0)
    high = np.where(ends[1] > 0, ends[1] + half, 0.0)
    places = {"rod1": np.minimum(low, over), "rod2": np.maximum(high, over), "foot": np.asarray(over)}
    return {name: state.a + _turned(far, 0.0, state.theta3) for name, far in places.items()}


def _line(linkage: Linkage) -> tuple[FloatArray, FloatArray]:
    """Direction of a slide on the ground, and its distance from O2."""
    slides = (row.name for row in linkage.mechanism.parameters if row.name.startswith("slide_angle"))
    name = next(slides)
    return getattr(linkage, name), getattr(linkage, name.replace("slide_angle", "offset"))


def _block(linkage: Linkage, centre: FloatArray, angle: FloatArray) -> dict[str, FloatArray]:
    half = half_block(linkage)
    sides = zip(CORNERS, ((-1, -1), (1, -1), (1, 1), (-1, 1)), strict=False)
    return {name: centre + _turned(half * u, _WIDE * half * v, angle) for name, (u, v) in sides}


def _turned(u: FloatArray | float, v: float, angle: FloatArray) -> FloatArray:
    """Vectors (u, v) turned by angles, shape (..., 2)."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([u * cos - v * sin, u * sin + v * cos], axis=-1)


def draw_guide(axes: Axes, linkage: Linkage, travel: Travel, look: Mapping[str, Any]) -> None:
    """The guide below the block of a slide on the ground, hatched on its far side."""
    if not any(1 in pair for pair in linkage.mechanism.slides):
        return
    half, (angle, offset) = half_block(linkage), _line(linkage)
    below = float(offset) - _WIDE * half
    first, last = travel.low - 1.5 * half, travel.high + 1.5 * half
    ends = np.array([first, last])
    axes.plot(*(linkage.o2 + _turned(ends, below, angle)).T, linewidth=1.6, **look)
    step = min((last - first) / _TICKS, 0.4 * half)
    at = np.arange(first + step, last, step)
    tops, feet = _turned(at, below, angle), _turned(at - 0.7 * step, below - 0.7 * step, angle)
    gaps = np.full_like(tops, np.nan)
    ticks = linkage.o2 + np.stack([tops, feet, gaps], axis=1).reshape(-1, 2)
    axes.plot(*ticks.T, linewidth=0.7, **look)
