"""Positions of a four-bar linkage in closed form, on either assembly."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.problems import FourBar
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Position:
    """Where a linkage stands, for each driver angle; NaN where it cannot close.

    Parameters
    ----------
    theta2, theta3, theta4 : ndarray, shape (...), rad
        Directions O2->A, A->B, O4->B; theta3 and theta4 in [-pi, pi].
    a, b, p : ndarray, shape (..., 2), length
        Moving pivots and coupler point.
    """

    theta2: FloatArray
    theta3: FloatArray
    theta4: FloatArray
    a: FloatArray
    b: FloatArray
    p: FloatArray


def solve_position(
    linkage: FourBar, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> Position:
    """Position of every link for given driver angles.

    Parameters
    ----------
    linkage : FourBar
        One, or a batch whose axes broadcast against `theta2` (``batch[:, None]`` for all
        linkages at all angles).
    theta2 : array_like, shape (...), rad
        Driver angle, global.
    assembly : array_like, shape (...), optional
        +1 or -1; the linkage's own by default.

    Returns
    -------
    Position

    Notes
    -----
    B is an intersection of the circles about A and O4 (Norton, *Design of Machinery*, sec. 4.5);
    its distance from the diagonal A-O4 comes from Heron's product, which keeps its digits near
    the dead positions where the usual r3^2 - x^2 loses them.

    Examples
    --------
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> state = solve_position(norton, np.radians(40))
    >>> np.degrees([state.theta3, state.theta4]).round(6).tolist()
    [20.297883, 57.32488]
    """
    angle = np.asarray(theta2, dtype=np.float64)
    loop = close_loop(sides(linkage, assembly), angle)
    ax, ay = linkage.o2[..., 0] + loop.ax, linkage.o2[..., 1] + loop.ay
    u, v = linkage.coupler_point[..., 0], linkage.coupler_point[..., 1]
    return Position(
        theta2=np.broadcast_to(angle, np.shape(loop.cos3)),
        theta3=np.arctan2(loop.sin3, loop.cos3),
        theta4=np.arctan2(loop.sin4, loop.cos4),
        a=np.stack(np.broadcast_arrays(ax, ay), axis=-1),
        b=np.stack([ax + linkage.r3 * loop.cos3, ay + linkage.r3 * loop.sin3], axis=-1),
        p=np.stack([ax + u * loop.cos3 - v * loop.sin3, ay + u * loop.sin3 + v * loop.cos3], axis=-1),
    )


def places(linkage: FourBar, state: Position) -> dict[str, FloatArray]:
    """Where the points of a linkage are in some of its positions, each of shape (..., 2), by their names."""
    return {
        point: np.broadcast_to(getattr(linkage if point in linkage.GROUND else state, point), state.a.shape)
        for point in linkage.POINTS
    }


class Loop(NamedTuple):
    """The closed loop in components, each of shape (...); those of links 3 and 4 NaN where it is open.

    `ax` and `ay` lead from O2 to A. `sine` is sin(theta4 - theta3) from the area of the triangle
    A-B-O4, which keeps its digits near a dead position.
    """

    cos2: FloatArray
    sin2: FloatArray
    cos3: FloatArray
    sin3: FloatArray
    cos4: FloatArray
    sin4: FloatArray
    sine: FloatArray
    ax: FloatArray
    ay: FloatArray


class Sides(NamedTuple):
    """What closes a loop: the ground vector, lengths, assembly sign, and what is rounding of a length."""

    gx: FloatArray
    gy: FloatArray
    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    sign: FloatArray
    rounding: FloatArray


def sides(linkage: FourBar, assembly: npt.ArrayLike | None = None) -> Sides:
    """The sides of a linkage's loop, on its own assembly by default."""
    ground = linkage.o4 - linkage.o2
    sign = linkage.assembly if assembly is None else np.asarray(assembly, dtype=np.float64)
    reach = np.abs(linkage.o2).sum(axis=-1) + np.abs(linkage.o4).sum(axis=-1)
    rounding = 8 * np.finfo(np.float64).eps * (reach + linkage.r2 + linkage.r3 + linkage.r4)
    return Sides(ground[..., 0], ground[..., 1], linkage.r2, linkage.r3, linkage.r4, sign, rounding)


def close_loop(sides: Sides, theta2: FloatArray) -> Loop:
    """Close the loop at given driver angles; the method of `solve_position`."""
    gx, gy, r2, r3, r4, sign, rounding = sides
    cos2, sin2 = np.cos(theta2), np.sin(theta2)
    ax, ay = r2 * cos2, r2 * sin2
    x, y = gx - ax, gy - ay
    square = x * x + y * y
    product = ((r3 + r4) ** 2 - square) * (square - (r3 - r4) ** 2)
    if np.any(product < 0):
        product = _kept_closed(product, np.sqrt(square), r3, r4, rounding)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        half = 0.5 / square
        root = sign * np.sqrt(product)
        along, beside = 0.5 + (r3 - r4) * (r3 + r4) * half, root * half
        x3, y3 = along * x - beside * y, along * y + beside * x
        return Loop(cos2, sin2, x3 / r3, y3 / r3, (x3 - x) / r4, (y3 - y) / r4, root / (2 * r3 * r4), ax, ay)


def _kept_closed(
    product: FloatArray, diagonal: FloatArray, r3: FloatArray, r4: FloatArray, rounding: FloatArray
) -> FloatArray:
    """Heron's product, put back to 0 where only rounding carries the diagonal A-O4 past a dead position."""
    past = np.abs(diagonal - np.clip(diagonal, np.abs(r3 - r4), r3 + r4))
    return np.where((product < 0) & (past <= rounding), 0.0, product)
