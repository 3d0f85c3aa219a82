"""How far a linkage of inexact dimensions is from its nominal motion, at any driver angle."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.sensitivity import sensitivity, turn_sensitivity
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class MadeMoves:
    """How far P and the output link are off, linearised, where dimensions are off by a tolerance.

    Parameters
    ----------
    point : ndarray, shape (..., D), length
        Distance of P where one of the `DIMENSIONS` is off.
    theta4 : ndarray, shape (..., D), rad
        The same of the angle of the output link, signed: of link 4, of a six-bar link 6.
    point_worst, theta4_worst : ndarray, shape (...), length and rad
        All dimensions off, in the worst combination of senses.
    point_rms, theta4_rms : ndarray, shape (...), length and rad
        Root of the sum of squares: all off independently, the tolerance being so many times the standard
        deviation of a dimension as these are of the result.
    """

    point: FloatArray
    theta4: FloatArray
    point_worst: FloatArray
    theta4_worst: FloatArray
    point_rms: FloatArray
    theta4_rms: FloatArray


def made_moves(linkage: Linkage, theta2: npt.ArrayLike, tolerance: float) -> MadeMoves:
    """Moves of P and of the output link at held driver angles, where dimensions are off by a tolerance.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    theta2 : array_like, shape (...), rad
    tolerance : float, length
        Of each dimension.

    Returns
    -------
    MadeMoves
        NaN where the linkage cannot close, without bound towards a dead position.

    Notes
    -----
    O2 and the direction of the ground line are held, as in `sensitivity`. The worst combination of senses
    is one of the corners of the box of deviations, as distance is convex.

    Examples
    --------
    A square, P at B: a longer output link lifts P by as much, and link 4 stays upright.

    >>> from grashof.problems import FourBar
    >>> square = FourBar(o2=(0, 0), o4=(2, 0), r2=2, r3=2, r4=2, coupler_point=(2, 0), assembly=1)
    >>> moves = made_moves(square, np.pi / 2, 0.1)
    >>> float(moves.point[3].round(9)), float(moves.theta4_worst.round(9))
    (0.1, 0.1)
    """
    slope = sensitivity(linkage, theta2) * tolerance
    turns = turn_sensitivity(linkage, theta2, linkage.mechanism.links[-1].number) * tolerance
    senses = np.array(list(product((1.0, -1.0), repeat=len(linkage.mechanism.dimensions) - 1)))
    senses = np.concatenate([np.ones((len(senses), 1)), senses], axis=1)  # the others are their opposites
    with np.errstate(invalid="ignore", over="ignore"):
        moved = slope[..., :2, :] @ senses.T
        point = np.hypot(slope[..., 0, :], slope[..., 1, :])
        return MadeMoves(
            point=point,
            theta4=turns,
            point_worst=np.hypot(moved[..., 0, :], moved[..., 1, :]).max(axis=-1),
            theta4_worst=np.abs(turns).sum(axis=-1),
            point_rms=np.sqrt((point**2).sum(axis=-1)),
            theta4_rms=np.sqrt((turns**2).sum(axis=-1)),
        )


def output_sensitivity(linkage: Linkage, theta2: npt.ArrayLike) -> FloatArray:
    """Derivatives of theta4 by the dimensions, of a four-bar r1, r2, r3, r4, u, v, at held driver angles.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad

    Returns
    -------
    ndarray, shape (..., D), rad/length

    Notes
    -----
    See `sensitivity`; zeros of a slider-crank, whose link 4 does not turn.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> square = FourBar(o2=(0, 0), o4=(2, 0), r2=2, r3=2, r4=2, assembly=1)
    >>> (output_sensitivity(square, np.pi / 2).round(9) + 0.0).tolist()
    [0.5, 0.0, -0.5, 0.0, 0.0, 0.0]
    """
    return turn_sensitivity(linkage, theta2, 4)
