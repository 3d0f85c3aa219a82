"""The flywheel for an even speed of the driver, and the fluctuation of the speed with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.even_motion import EvenMotion, even_motion
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.numerics.peaks import Curve
from grashof.analysis.numerics.quadrature import Panels, gauss_legendre, held, integrate
from grashof.problems import AssemblyError, Linkage, ProblemError
from grashof.problems.values.arrays import TURN, FloatArray

_PANELS = 36
_HALVINGS = 60


@dataclass(frozen=True, slots=True)
class Flywheel:
    """A flywheel on the driver's shaft.

    Parameters
    ----------
    inertia : float, kg length^2
    energy : float, N length
        That it takes up and gives back each turn.
    mean_torque : float, N length
        Of a drive of constant torque.
    slowest, fastest : float, rad
        Driver angles at which the speed is least and largest.
    """

    inertia: float
    energy: float
    mean_torque: float
    slowest: float
    fastest: float


def size_flywheel(
    linkage: Linkage, masses: Masses, omega2: float, fluctuation: float, loads: Loads | None = None
) -> Flywheel:
    """Flywheel for a given fluctuation of the driver's speed.

    Parameters
    ----------
    linkage : Linkage
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
    torque is that of a steady speed this holds for small fluctuations. Integrals are refined until they
    stay as they are; the energy is greatest and least where the torque passes through its mean.

    Examples
    --------
    >>> from grashof.analysis import uniform_bars
    >>> from grashof.problems import FourBar
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
    motion, torque, panels, taken = _turn(linkage, masses, omega2, loads)
    mean = held(float(panels.total) / TURN, 2 * float(panels.error) / TURN)
    samples = np.concatenate([[0.0], gauss_legendre(panels.edges)[0], [1.0]])
    at = np.append(0.0, _passages(lambda share: mean - torque(share), samples))
    # The integral of the torque of the drive less that of the turn is the energy of the flywheel.
    theta2 = motion.theta2(at)
    gained = mean * theta2 - taken(at)
    least, most = (int(choose(gained)) for choose in (np.argmin, np.argmax))
    energy = float(gained[most] - gained[least])
    slowest, fastest = theta2[[least, most]].tolist()
    return Flywheel(energy / (fluctuation * omega2**2), energy, mean, slowest, fastest)


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
    >>> from grashof.analysis import size_flywheel, uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> bars, weight = uniform_bars(jack, (312, 312, 314)), Loads(gravity=(0, -9.81))
    >>> wheel = size_flywheel(jack, bars, 2.0, 0.05, weight)
    >>> at = np.sort([wheel.slowest, wheel.fastest])
    >>> sorted(flywheel_speed(jack, bars, 2.0, wheel, at, weight).round(6).tolist())
    [1.95, 2.05]
    """
    if not wheel.inertia > 0:
        return np.full(np.shape(theta2), omega2)
    motion, _, _, taken = _turn(linkage, masses, omega2, loads)

    def gained(angle: FloatArray) -> FloatArray:
        return wheel.mean_torque * angle - taken(motion.share(angle))

    fluctuation = wheel.energy / (wheel.inertia * omega2**2)
    most = float(gained(np.array([wheel.fastest]))[0])
    lost = np.maximum(most - gained(np.asarray(theta2)), 0.0)
    square = ((1 + fluctuation / 2) * omega2) ** 2 - 2 * lost / wheel.inertia
    return np.asarray(np.sign(omega2) * np.sqrt(np.maximum(square, 0.0)))


def _turn(
    linkage: Linkage, masses: Masses, omega2: float, loads: Loads | None
) -> tuple[EvenMotion, Curve, Panels, Curve]:
    """A steady turn; by shares of it the torque required, panels of the work, and the work up to there."""
    motion = even_motion(linkage, 0.0, TURN)

    def torque(share: FloatArray) -> FloatArray:
        state = solve_kinematics(linkage, motion.theta2(share), omega2)
        return inverse_dynamics(state, masses, loads).torque

    def work(share: FloatArray) -> FloatArray:
        return torque(share) * motion.rate(share)

    panels = integrate(work, motion.edges(_PANELS))
    return motion, torque, panels, lambda share: panels.until(work, share)


def _passages(curve: Curve, places: FloatArray) -> FloatArray:
    """Where a curve changes sign, smoothly or not, by halving between places where it is sampled."""
    positive = curve(places) > 0
    changes = np.flatnonzero(positive[1:] != positive[:-1])
    low, high, rises = places[changes], places[changes + 1], positive[changes + 1]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        beyond = (curve(middle) > 0) == rises
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return np.asarray((low + high) / 2)
