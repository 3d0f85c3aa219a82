"""What a motor has to give behind its gear."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray


def motor_torque(
    torque: npt.ArrayLike,
    omega2: npt.ArrayLike,
    alpha2: npt.ArrayLike,
    gear_ratio: float,
    gear_efficiency: float = 1.0,
    inertia: float = 0.0,
) -> FloatArray:
    """Torque of a motor that drives link 2 through a gear.

    Parameters
    ----------
    torque : array_like, shape (...), N length
        Of the drive on link 2.
    omega2, alpha2 : array_like, shape (...), rad/s and rad/s^2
    gear_ratio : float
        Speed of the motor over that of link 2.
    gear_efficiency : float
        Power out of the gear over power into it, whichever side drives.
    inertia : float, kg length^2
        Of the motor.

    Returns
    -------
    ndarray, shape (...), N length
        Counter-clockwise, as the torque on link 2; at rest as of a motor that drives.

    Notes
    -----
    Behind the gear the torque is T / (n eta) where the motor drives (T omega2 > 0) and T eta / n where
    the load does; the motor's own inertia takes I n alpha2 besides.

    Examples
    --------
    >>> motor_torque([90.0, -90.0], 2.0, 0.0, 30, 0.9).round(6).tolist()
    [3.333333, -2.7]
    >>> float(motor_torque(0.0, 2.0, 5.0, 30, inertia=0.02))
    3.0
    """
    torque = np.asarray(torque, dtype=np.float64)
    driven = torque * np.asarray(omega2) >= 0
    geared = np.where(driven, torque / gear_efficiency, torque * gear_efficiency) / gear_ratio
    found: FloatArray = geared + inertia * gear_ratio * np.asarray(alpha2)
    return found
