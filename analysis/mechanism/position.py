"""Positions of a linkage in closed form, on either assembly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.loops.kinds import kind_of
from grashof.analysis.loops.loop import Loop, Sides
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Position:
    """Where a linkage stands, for each driver angle; NaN where it cannot close.

    Parameters
    ----------
    theta2, theta3, theta4 : ndarray, shape (...), rad
        Directions of links 2, 3 and 4, of a four-bar O2->A, A->B, O4->B; theta3 and theta4 in [-pi, pi].
    a, b, p : ndarray, shape (..., 2), length
        Moving pivots and coupler point; of an inverted slider-crank B is the foot of O4 on the rod.
    """

    theta2: FloatArray
    theta3: FloatArray
    theta4: FloatArray
    a: FloatArray
    b: FloatArray
    p: FloatArray


def solve_position(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> Position:
    """Position of every link for given driver angles.

    Parameters
    ----------
    linkage : Linkage
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
    How the loop closes is in `grashof.analysis.loops`, a file each kind.

    Examples
    --------
    >>> from grashof.problems import FourBar
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
        b=np.stack([ax + loop.ab * loop.cos3, ay + loop.ab * loop.sin3], axis=-1),
        p=np.stack([ax + u * loop.cos3 - v * loop.sin3, ay + u * loop.sin3 + v * loop.cos3], axis=-1),
    )


def places(linkage: Linkage, state: Position) -> dict[str, FloatArray]:
    """Where the points of a linkage are in some of its positions, each of shape (..., 2), by their names."""
    return {
        point: np.broadcast_to(
            getattr(linkage if point in linkage.mechanism.ground else state, point), state.a.shape
        )
        for point in linkage.mechanism.points
    }


def sides(linkage: Linkage, assembly: npt.ArrayLike | None = None) -> Sides:
    """The sides of a linkage's loop, on its own assembly by default."""
    sign = linkage.assembly if assembly is None else np.asarray(assembly, dtype=np.float64)
    return kind_of(linkage).sides_of(linkage, sign)


def close_loop(sides: Sides, theta2: FloatArray) -> Loop:
    """Close the loop at given driver angles; the method of `solve_position`."""
    return sides.close(theta2)
