"""Instant centres: points that two links have in common for a moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.four_bar.position import solve_position
from grashof.problems import FourBar
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class InstantCentres:
    """The six instant centres, link 1 being the ground; each of shape (..., 2), length.

    Parameters
    ----------
    i12, i23, i34, i14 : ndarray
        The joints O2, A, B, O4.
    i13 : ndarray
        About which the coupler turns: where lines O2A and O4B meet.
    i24 : ndarray
        Where driver and output have the same velocity: where lines AB and O2O4 meet.
    """

    i12: FloatArray
    i23: FloatArray
    i34: FloatArray
    i14: FloatArray
    i13: FloatArray
    i24: FloatArray


def instant_centres(
    linkage: FourBar, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> InstantCentres:
    """Instant centres for given driver angles.

    Parameters
    ----------
    linkage : FourBar
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad
    assembly : array_like, shape (...), optional
        The linkage's own by default.

    Returns
    -------
    InstantCentres
        Not finite where the lines that meet in a centre are parallel, and where the linkage cannot
        close.

    Notes
    -----
    Kennedy's rule: the centres of three links lie in one line (Norton, *Design of Machinery*,
    sec. 6.3).

    Examples
    --------
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> instant_centres(norton, np.radians(40)).i24.round(4).tolist()
    [-38.8733, 0.0]
    """
    state = solve_position(linkage, theta2, assembly)
    o2, o4 = (np.broadcast_to(pivot, state.a.shape) for pivot in (linkage.o2, linkage.o4))
    return InstantCentres(
        i12=o2,
        i23=state.a,
        i34=state.b,
        i14=o4,
        i13=_meeting(o2, state.a - o2, o4, state.b - o4),
        i24=_meeting(o2, o4 - o2, state.a, state.b - state.a),
    )


def _meeting(first: FloatArray, along: FloatArray, second: FloatArray, beside: FloatArray) -> FloatArray:
    """Where two lines meet, each given by a point and a direction."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = _cross(second - first, beside) / _cross(along, beside)
        meeting: FloatArray = first + share[..., None] * along
    return meeting


def _cross(first: FloatArray, second: FloatArray) -> FloatArray:
    cross: FloatArray = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    return cross
