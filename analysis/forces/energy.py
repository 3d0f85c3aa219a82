"""The energy in a moving linkage, and the powers that change it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.joints import joint_motion
from grashof.analysis.forces.loads import Friction, Loads, spring_ends, torsion_moments
from grashof.analysis.forces.mass import Masses
from grashof.analysis.forces.statics import joint_power, load_power
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Energies:
    """Energy of a linkage; N length.

    Parameters
    ----------
    kinetic : ndarray, shape (N, ...)
        Of links 2, 3 and 4, of a six-bar to 6.
    weight : ndarray, shape (...)
        Of weights, from the origin of the global frame.
    springs : ndarray, shape (...)
        Of straight and torsion springs.
    """

    kinetic: FloatArray
    weight: FloatArray
    springs: FloatArray

    @property
    def total(self) -> FloatArray:
        """Kinetic and potential energy together, shape (...)."""
        total: FloatArray = (self.kinetic.sum(axis=0) + self.weight + self.springs)[()]
        return total


@dataclass(frozen=True, slots=True, eq=False)
class Powers:
    """Powers that change the energy of a linkage, each of shape (...), N length/s; negative is taken out.

    Parameters
    ----------
    drive, loads, friction : ndarray
        Of the drive; of forces, moments and dampers; of friction in the joints.
    """

    drive: FloatArray
    loads: FloatArray
    friction: FloatArray


def energies(state: Kinematics, masses: Masses, loads: Loads | None = None) -> Energies:
    """Kinetic energy of each link, and that of weights and springs.

    Parameters
    ----------
    state : Kinematics
    masses : Masses
    loads : Loads, optional

    Returns
    -------
    Energies

    Examples
    --------
    >>> from grashof.analysis import Body, solve_kinematics
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> at_a = Masses(Body(2.0, 0.0, (1.0, 0.0)), Body(0.0), Body(0.0))
    >>> found = energies(solve_kinematics(crank_rocker, np.pi / 2, 3.0), at_a, Loads(gravity=(0, -10)))
    >>> found.kinetic.tolist(), float(found.weight)
    ([9.0, 0.0, 0.0], 20.0)
    """
    loads = Loads() if loads is None else loads
    gravity = loads.gravity_vector()
    kinetic, weight, springs = [], np.zeros(state.shape), np.zeros(state.shape)
    for link, body in masses.by_link(state.linkage).items():
        omega = state.angular(link)[1]
        centre = state.point(link, body.centre)
        moving = body.mass * (centre.velocity**2).sum(axis=-1) + body.inertia * omega**2
        kinetic.append(moving / 2 + np.zeros(state.shape))
        weight = weight - body.mass * (centre.position * gravity).sum(axis=-1)
    for spring in loads.springs:
        first, second = spring_ends(state, spring)
        way = second.position - first.position
        stretch = np.hypot(way[..., 0], way[..., 1]) - spring.free_length
        springs = springs + spring.stiffness * stretch**2 / 2
    for torsion in loads.torsion_springs:
        wound = torsion.wound(joint_motion(state, torsion.joint)[0])
        springs = springs + torsion.stiffness * wound**2 / 2
    return Energies(np.stack(kinetic), weight[()], springs[()])


def powers(state: Kinematics, masses: Masses, loads: Loads | None = None) -> Powers:
    """Power of the drive, of the loads and of friction: together the rate of `Energies.total`.

    Parameters
    ----------
    state : Kinematics
        The motion, with the driver's acceleration.
    masses : Masses
    loads : Loads, optional

    Returns
    -------
    Powers
        NaN and infinite as in `inverse_dynamics`.
    """
    loads = Loads() if loads is None else loads
    found = inverse_dynamics(state, masses, loads)
    lossless = tuple(replace(spring, damping=0.0) for spring in loads.springs)
    outside = replace(loads, friction=Friction(), torsion_springs=())
    given = load_power(state, state, outside) - load_power(state, state, Loads(springs=lossless))
    lost = joint_power(state, found.joint_moments - torsion_moments(state, loads))
    return Powers(found.power, given[()], lost[()])


def mechanical_energy(state: Kinematics, masses: Masses, loads: Loads | None = None) -> FloatArray:
    """Kinetic energy and that of weights and springs, shape (...), N length."""
    return energies(state, masses, loads).total
