"""Positions by Newton-Raphson on the loop equation: an independent second method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.problems import FourBar
from grashof.problems.values.arrays import BoolArray, FloatArray

_LONGEST_STEP = 0.5  # rad


@dataclass(frozen=True, slots=True, eq=False)
class NewtonPosition:
    """Results of Newton-Raphson steps.

    Parameters
    ----------
    theta3, theta4 : ndarray, shape (...), rad
        In [-pi, pi]; NaN where the steps did not converge.
    gap : ndarray, shape (...), length
        Remaining gap of the loop.
    steps : ndarray of int, shape (...)
        Newton steps taken.
    converged : ndarray of bool, shape (...)
    """

    theta3: FloatArray
    theta4: FloatArray
    gap: FloatArray
    steps: npt.NDArray[np.int64]
    converged: BoolArray


def newton_position(
    linkage: FourBar,
    theta2: npt.ArrayLike,
    guess: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    max_steps: int = 50,
) -> NewtonPosition:  # closure: RRR
    """Directions of coupler and output by Newton-Raphson.

    Parameters
    ----------
    linkage : FourBar
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad
    guess : pair of array_like, shape (...), rad, optional
        Initial theta3 and theta4; by default both links are off the line A-O4 on the side of the assembly.
    max_steps : int

    Returns
    -------
    NewtonPosition
        The guess decides the assembly, which is not checked.

    Notes
    -----
    The two components of r2 + r3 = r1 + r4 in two unknowns (Norton, *Design of Machinery*, sec. 4.14), with
    steps limited to half a radian.

    Examples
    --------
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> found = newton_position(norton, np.radians(40))
    >>> np.degrees([found.theta3, found.theta4]).round(6).tolist(), int(found.steps)
    ([20.297883, 57.32488], 5)
    """
    angle = np.asarray(theta2, dtype=np.float64)
    r3, r4 = linkage.r3, linkage.r4
    x = linkage.o2[..., 0] + linkage.r2 * np.cos(angle) - linkage.o4[..., 0]
    y = linkage.o2[..., 1] + linkage.r2 * np.sin(angle) - linkage.o4[..., 1]
    if guess is None:
        guess = np.arctan2(-y, -x) + linkage.assembly, np.arctan2(y, x) - linkage.assembly
    theta3, theta4, x, y = (np.array(part) for part in np.broadcast_arrays(*guess, x, y))
    closed = 1e-14 * (linkage.lengths.sum(axis=-1) + np.abs(linkage.o2).max(axis=-1))
    steps = np.zeros(np.shape(x), dtype=np.int64)
    for step in range(max_steps + 1):
        gap_x = x + r3 * np.cos(theta3) - r4 * np.cos(theta4)
        gap_y = y + r3 * np.sin(theta3) - r4 * np.sin(theta4)
        gap = np.hypot(gap_x, gap_y)
        moving = gap > closed
        if step == max_steps or not moving.any():
            break
        sine = np.sin(theta4 - theta3)
        sine = np.where(np.abs(sine) < 1e-12, np.copysign(1e-12, sine), sine)
        step3 = (gap_x * np.cos(theta4) + gap_y * np.sin(theta4)) / (r3 * sine)
        step4 = (gap_x * np.cos(theta3) + gap_y * np.sin(theta3)) / (r4 * sine)
        theta3 = theta3 - np.where(moving, np.clip(step3, -_LONGEST_STEP, _LONGEST_STEP), 0.0)
        theta4 = theta4 - np.where(moving, np.clip(step4, -_LONGEST_STEP, _LONGEST_STEP), 0.0)
        steps = steps + moving
    converged = gap <= 100 * closed
    theta3, theta4 = (
        np.where(converged, np.arctan2(np.sin(found), np.cos(found)), np.nan) for found in (theta3, theta4)
    )
    return NewtonPosition(theta3[()], theta4[()], gap[()], steps[()], converged)
