"""How the driver moves in time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy.typing as npt

from grashof.analysis.numerics.taylor import derivatives
from grashof.problems.values.arrays import FloatArray


class DriverMotion(NamedTuple):
    """Driver angle and its derivatives, as `solve_kinematics` takes them.

    Parameters
    ----------
    theta2, omega2, alpha2, jerk2 : ndarray, shape (...), rad over s^0 to s^3
    """

    theta2: FloatArray
    omega2: FloatArray
    alpha2: FloatArray
    jerk2: FloatArray


def driver_motion(theta2: Callable[[Any], Any], time: npt.ArrayLike) -> DriverMotion:
    """A driver that follows a function of time, which is differentiated exactly.

    Parameters
    ----------
    theta2 : callable, s -> rad
        Written with arithmetic, NumPy's functions and ``np.where``; or a SciPy spline or NumPy
        polynomial, as through measured angles.
    time : array_like, shape (...), s

    Returns
    -------
    DriverMotion

    Raises
    ------
    ProblemError
        The function cannot be differentiated.

    Examples
    --------
    >>> motion = driver_motion(lambda t: 2 * t + 0.1 * np.sin(5 * t), [0.0, 1.0])
    >>> motion.omega2.round(6).tolist(), motion.alpha2.round(6).tolist()
    ([2.5, 2.141831], [0.0, 2.397311])
    """
    return DriverMotion(*derivatives(theta2, time))
