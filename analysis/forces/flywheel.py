"""The flywheel that keeps a driver's speed even."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.four_bar.extremes import extremes_of
from grashof.analysis.four_bar.kinematics import solve_kinematics
from grashof.analysis.four_bar.mobility import full_rotation
from grashof.problems import AssemblyError, FourBar, ProblemError

_SAMPLES = 1440


@dataclass(frozen=True, slots=True)
class Flywheel:
    """A flywheel on the driver's shaft.

    Parameters
    ----------
    inertia : float, kg length^2
    energy : float, N length
        That it takes up and gives back each turn.
    mean_torque : float, N length
        What a drive of constant torque has to give.
    slowest, fastest : float, rad
        Driver angles at which the speed is least and largest.
    """

    inertia: float
    energy: float
    mean_torque: float
    slowest: float
    fastest: float


def size_flywheel(
    linkage: FourBar, masses: Masses, omega2: float, fluctuation: float, loads: Loads | None = None
) -> Flywheel:
    """Flywheel for a given fluctuation of the driver's speed.

    Parameters
    ----------
    linkage : FourBar
        A single linkage whose driver turns fully.
    masses : Masses
    omega2 : float, rad/s
        Mean speed.
    fluctuation : float
        Largest less least speed, as a share of the mean.
    loads : Loads, optional

    Returns
    -------
    Flywheel

    Raises
    ------
    AssemblyError
        The driver does not turn fully.

    Notes
    -----
    The drive gives the mean of the torque that a steady turn takes; the flywheel gives the rest.
    Its energy is the range of the integral of torque less mean over the turn, and
    inertia = energy / (fluctuation omega2^2) (Norton, *Design of Machinery*, sec. 11.11). As the
    torque is that of a steady speed this holds for small fluctuations.

    Examples
    --------
    >>> from grashof.analysis.forces.mass import uniform_bars
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> bars = uniform_bars(jack, (312, 312, 314))
    >>> wheel = size_flywheel(jack, bars, 2 * np.pi / 3, 0.05, Loads(gravity=(0, -9.81)))
    >>> round(wheel.inertia)
    194026
    """
    if not full_rotation(linkage):
        raise AssemblyError("the driver does not turn fully, so a flywheel cannot keep its speed")
    if not (omega2 != 0 and 0 < fluctuation < 2):
        raise ProblemError(
            f"omega2 is {omega2!r} and fluctuation {fluctuation!r}; they must be a speed other than 0 and "
            "a share above 0 and below 2"
        )
    theta2 = np.linspace(0, 2 * np.pi, _SAMPLES + 1)
    torque = inverse_dynamics(solve_kinematics(linkage, theta2, omega2), masses, loads).torque
    torque[-1] = torque[0]
    mean = float(torque[:-1].mean())
    # What the drive gives beyond what the turn takes, added up, is the energy of the flywheel.
    gained = scipy.interpolate.CubicSpline(theta2, mean - torque, bc_type="periodic").antiderivative()
    found = extremes_of(gained, 0.0, 2 * np.pi)
    return Flywheel(found.stroke / (fluctuation * omega2**2), found.stroke, mean, found.at_low, found.at_high)
