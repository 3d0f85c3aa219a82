"""Positions of a four-bar linkage in closed form, on either assembly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.problems import FourBar
from grashof.problems.checks import FloatArray


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
    sign = linkage.assembly if assembly is None else np.asarray(assembly, dtype=np.float64)
    r3, r4 = linkage.r3, linkage.r4
    ax = linkage.o2[..., 0] + linkage.r2 * np.cos(angle)
    ay = linkage.o2[..., 1] + linkage.r2 * np.sin(angle)
    x, y = linkage.o4[..., 0] - ax, linkage.o4[..., 1] - ay
    s = _kept_closed(np.hypot(x, y), r3, r4, np.abs(ax) + np.abs(ay) + np.abs(linkage.o4).sum(axis=-1))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        along = (s + (r3 - r4) * (r3 + r4) / s) / 2
        beside = sign * np.sqrt((r3 + r4 - s) * (r3 + r4 + s) * (s - (r3 - r4)) * (s + (r3 - r4))) / (2 * s)
        cos3, sin3 = (along * x - beside * y) / s, (along * y + beside * x) / s
    bx, by = ax + cos3, ay + sin3
    cos3, sin3 = cos3 / r3, sin3 / r3
    u, v = linkage.coupler_point[..., 0], linkage.coupler_point[..., 1]
    return Position(
        theta2=np.broadcast_to(angle, np.shape(bx)),
        theta3=np.arctan2(sin3, cos3),
        theta4=np.arctan2(by - linkage.o4[..., 1], bx - linkage.o4[..., 0]),
        a=np.stack(np.broadcast_arrays(ax, ay), axis=-1),
        b=np.stack([bx, by], axis=-1),
        p=np.stack([ax + u * cos3 - v * sin3, ay + u * sin3 + v * cos3], axis=-1),
    )


def _kept_closed(diagonal: FloatArray, r3: FloatArray, r4: FloatArray, reach: FloatArray) -> FloatArray:
    """The diagonal A-O4, put back where only rounding carries it past a dead position."""
    nearest = np.clip(diagonal, np.abs(r3 - r4), r3 + r4)
    rounding = 8 * np.finfo(np.float64).eps * (reach + r3 + r4)
    return np.where(np.abs(diagonal - nearest) <= rounding, nearest, diagonal)
