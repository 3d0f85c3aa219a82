"""How the driver's speed goes up and down with a flywheel."""

from __future__ import annotations

import numpy as np

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.flywheel import Flywheel
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.numerics.quadrature import integrate
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.linkages.linkage import Linkage

_PANELS = 36


def flywheel_speed(
    linkage: Linkage,
    masses: Masses,
    omega2: float,
    wheel: Flywheel,
    theta2: FloatArray,
    loads: Loads | None = None,
) -> FloatArray:
    """Speed of the driver over a turn with a flywheel, the drive giving the mean torque.

    Parameters
    ----------
    linkage, masses, omega2, loads
        As for `size_flywheel`.
    wheel : Flywheel
        That was sized with them.
    theta2 : ndarray, shape (N,), rad
        Driver angles from 0 to 2 pi, rising.

    Returns
    -------
    ndarray, shape (N,), rad/s
        Its least and largest value lie evenly about the mean speed.

    Notes
    -----
    inertia (omega^2 - omega_max^2) / 2 is the energy that the flywheel has given since it was fastest
    (Norton, *Design of Machinery*, sec. 11.11). As the torque is that of a steady speed this holds for
    small fluctuations.

    Examples
    --------
    >>> from grashof.analysis.forces.flywheel import size_flywheel
    >>> from grashof.analysis.forces.mass import uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> bars, weight = uniform_bars(jack, (312, 312, 314)), Loads(gravity=(0, -9.81))
    >>> wheel = size_flywheel(jack, bars, 2.0, 0.05, weight)
    >>> at = np.sort([wheel.slowest, wheel.fastest])
    >>> sorted(flywheel_speed(jack, bars, 2.0, wheel, at, weight).round(6).tolist())
    [1.95, 2.05]
    """
    motion = even_motion(linkage, 0.0, TURN)

    def work(share: FloatArray) -> FloatArray:
        state = solve_kinematics(linkage, motion.theta2(share), omega2)
        return inverse_dynamics(state, masses, loads).torque * motion.rate(share)

    panels = integrate(work, motion.edges(_PANELS))

    def gained(angle: FloatArray) -> FloatArray:
        return wheel.mean_torque * angle - panels.until(work, motion.share(angle))

    if not wheel.inertia > 0:
        return np.full(np.shape(theta2), omega2)
    fluctuation = wheel.energy / (wheel.inertia * omega2**2)
    most = float(gained(np.array([wheel.fastest]))[0])
    lost = np.maximum(most - gained(np.asarray(theta2)), 0.0)
    square = ((1 + fluctuation / 2) * omega2) ** 2 - 2 * lost / wheel.inertia
    return np.asarray(np.sign(omega2) * np.sqrt(np.maximum(square, 0.0)))
