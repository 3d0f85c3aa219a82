"""Instant centres: points that two links have in common for a moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.loads import cross
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class InstantCentres:
    """The six instant centres, link 1 being the ground; each of shape (..., 2), length.

    Parameters
    ----------
    i12, i23, i34, i14 : ndarray
        The joints O2, A, B, O4; NaN for that of a slide, which is at infinity, square to it.
    i13 : ndarray
        About which the coupler turns: where lines O2A and O4B meet, or their like through infinity.
    i24 : ndarray
        Where driver and output have the same velocity: where lines AB and O2O4 meet, likewise.
    """

    i12: FloatArray
    i23: FloatArray
    i34: FloatArray
    i14: FloatArray
    i13: FloatArray
    i24: FloatArray


def instant_centres(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> InstantCentres:
    """Instant centres for given driver angles.

    Parameters
    ----------
    linkage : Linkage
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
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> instant_centres(norton, np.radians(40)).i24.round(4).tolist()
    [-38.8733, 0.0]
    """
    state = solve_position(linkage, theta2, assembly)
    o2 = np.broadcast_to(linkage.o2, state.a.shape)
    none = np.full(state.a.shape, np.nan)
    o4 = np.broadcast_to(getattr(linkage, "o4", none), state.a.shape)
    across = np.stack([np.cos(state.theta4), np.sin(state.theta4)], axis=-1)  # square to a slide
    of4 = state.b - o4, o4 - o2, state.b - state.a  # along I14-I34, I12-I14, I23-I34
    if (1, 4) in linkage.mechanism.slides:
        of4 = across, across, state.b - state.a
    if (3, 4) in linkage.mechanism.slides:
        of4 = across, o4 - o2, across
    return InstantCentres(
        i12=o2,
        i23=state.a,
        i34=none if (3, 4) in linkage.mechanism.slides else state.b,
        i14=o4,
        i13=_meeting(o2, state.a - o2, state.b if (1, 4) in linkage.mechanism.slides else o4, of4[0]),
        i24=_meeting(o2, of4[1], state.a, of4[2]),
    )


def _meeting(first: FloatArray, along: FloatArray, second: FloatArray, beside: FloatArray) -> FloatArray:
    """Where two lines meet, each given by a point and a direction."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = cross(second - first, beside) / cross(along, beside)
        meeting: FloatArray = first + share[..., None] * along
    return meeting
