"""Counterweights: against the force that shakes the ground, and for an even drive torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.loads import Loads, cross, turned
from grashof.analysis.forces.mass import Body, Masses
from grashof.analysis.four_bar.kinematics import Kinematics
from grashof.problems import FourBar, ProblemError, SolverError
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.errors import wrong_value


@dataclass(frozen=True, slots=True, eq=False)
class ForceBalance:
    """Counterweights that keep the centre of mass of the moving links at rest.

    Parameters
    ----------
    crank_weight, output_weight : Body
        Point masses on links 2 and 4.
    masses : Masses
        The links with them.
    """

    crank_weight: Body
    output_weight: Body
    masses: Masses


@dataclass(frozen=True, slots=True, eq=False)
class TorqueBalance:
    """A counterweight on the crank that evens out the drive torque.

    Parameters
    ----------
    crank_weight : Body
    masses : Masses
        The links with it.
    torque_before, torque_after : ndarray, shape (N,), N length
        Of the drive, over the turn.
    """

    crank_weight: Body
    masses: Masses
    torque_before: FloatArray
    torque_after: FloatArray


def balance_force(
    linkage: FourBar,
    masses: Masses,
    crank_radius: npt.ArrayLike | None = None,
    output_radius: npt.ArrayLike | None = None,
) -> ForceBalance:
    """Counterweights on crank and output that remove the shaking force for every motion.

    Parameters
    ----------
    linkage : FourBar
    masses : Masses
    crank_radius, output_radius : array_like, shape (...), length, optional
        Distances of the counterweights from O2 and O4; by default r2 and r4.

    Returns
    -------
    ForceBalance

    Notes
    -----
    Linearly independent vectors (Berkof & Lowen 1969, *A new method for completely force balancing
    simple linkages*): with the coupler's direction eliminated by the loop equation, the system's
    centre of mass stays where it is when the factors of the two remaining directions vanish.
    Shaking moment and drive torque usually grow.

    Examples
    --------
    >>> from grashof.analysis.four_bar.kinematics import solve_kinematics
    >>> from grashof.analysis.forces.mass import system_centre, uniform_bars
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> balanced = balance_force(jack, uniform_bars(jack, 300.0))
    >>> centre = system_centre(balanced.masses, solve_kinematics(jack, np.linspace(0, 6, 7)))
    >>> bool(np.abs(centre.acceleration).max() < 1e-14)
    True
    """
    share = _complex(masses.coupler.centre) / linkage.r3
    crank = masses.crank.mass * _complex(masses.crank.centre)
    crank = crank + masses.coupler.mass * linkage.r2 * (1 - share)
    output = masses.output.mass * _complex(masses.output.centre)
    output = output + masses.coupler.mass * linkage.r4 * share
    crank_weight = _counterweight(-crank, linkage.r2 if crank_radius is None else crank_radius)
    output_weight = _counterweight(-output, linkage.r4 if output_radius is None else output_radius)
    whole = Masses(masses.crank + crank_weight, masses.coupler, masses.output + output_weight)
    return ForceBalance(crank_weight, output_weight, whole)


def balance_torque(
    state: Kinematics, masses: Masses, loads: Loads, radius: float, measure: str = "rms"
) -> TorqueBalance:
    """The counterweight on the crank that makes the drive torque most even, as on a pumpjack.

    Parameters
    ----------
    state : Kinematics
        One linkage over a turn of its driver at steady speed, in equal steps.
    masses : Masses
    loads : Loads
        With gravity, which is what the counterweight works by.
    radius : float, length
        Its distance from O2.
    measure : str
        "rms": least root mean square of the torque; "peak": least peak.

    Returns
    -------
    TorqueBalance

    Raises
    ------
    ProblemError
        No gravity, an uneven driver, or another measure.

    Notes
    -----
    At steady speed a weight on the crank adds -(r x m g) to the torque, linear in the two
    components of m r: least squares, or a linear programme for the peak. With friction in
    proportion to the joint forces the result is optimal only nearly.
    """
    gravity = loads.gravity_vector()
    if not gravity.any():
        raise ProblemError("gravity is zero, so no counterweight can work against the torque")
    if np.ndim(state.theta2) != 1 or np.any(state.alpha2 != 0):
        raise ProblemError("state is not a turn of a single linkage at steady speed")
    before = inverse_dynamics(state, masses, loads).torque
    effects = np.stack(
        [-cross(turned(np.array(unit), state.theta2), gravity) for unit in ((1.0, 0.0), (0.0, 1.0))], axis=-1
    )
    if measure == "rms":
        moment = np.linalg.lstsq(effects, -before, rcond=None)[0]
    elif measure == "peak":
        moment = _least_peak(effects, before)
    else:
        raise wrong_value("measure", measure, "'rms' or 'peak'")
    weight = _counterweight(moment[0] + 1j * moment[1], radius)
    whole = Masses(masses.crank + weight, masses.coupler, masses.output)
    return TorqueBalance(weight, whole, before, inverse_dynamics(state, whole, loads).torque)


def _least_peak(effects: FloatArray, torque: FloatArray) -> FloatArray:
    """Moment m r with the least peak of |torque + effects m r|, by a linear programme."""
    scale = float(np.abs(torque).max()) or 1.0
    ones = np.ones((len(torque), 1))
    rows = np.block([[effects, -ones], [-effects, -ones]])
    sides = np.concatenate([-torque, torque]) / scale
    found = scipy.optimize.linprog(
        [0.0, 0.0, 1.0], A_ub=rows, b_ub=sides, bounds=[(None, None), (None, None), (0, None)]
    )
    if found.x is None:
        raise SolverError(f"no counterweight for the least peak was found: {found.message}")
    return np.asarray(found.x[:2] * scale)


def _counterweight(moment: ComplexArray, radius: npt.ArrayLike) -> Body:
    """Point mass with a given moment (mass times place) at a given radius."""
    radius = np.asarray(radius, dtype=np.float64)
    if not np.all(radius > 0):
        raise ProblemError(f"the counterweight's radius is {radius}; it must be greater than zero")
    place = radius * np.exp(1j * np.angle(moment))
    return Body(np.abs(moment) / radius, 0.0, np.stack([place.real, place.imag], axis=-1))


def _complex(at: FloatArray) -> ComplexArray:
    return at[..., 0] + 1j * at[..., 1]
