"""Power that friction and dampers take out of a motion."""

from __future__ import annotations

import numpy as np

from grashof.analysis.forces.dynamics import Dynamics
from grashof.analysis.forces.loads import Joint, Loads, joint_rotation, spring_ends, torsion_moments
from grashof.analysis.four_bar.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray


def friction_power(state: Kinematics, loads: Loads, dynamics: Dynamics) -> FloatArray:
    """Power lost in each joint, shape (4, ...), in the order of `Joint`; N length/s, never negative.

    Parameters
    ----------
    state : Kinematics
    loads : Loads
    dynamics : Dynamics
        Of `inverse_dynamics` under these loads.

    Notes
    -----
    The moment of friction in a joint times the rate at which the joint opens.

    Examples
    --------
    >>> from grashof.analysis import Friction, given_masses, inverse_dynamics, solve_kinematics
    >>> from grashof.problems import FourBar
    >>> rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> masses, loads = given_masses(rocker, (0, 0, 0), (0, 0, 0)), Loads(friction=Friction(viscous=2.0))
    >>> state = solve_kinematics(rocker, 1.0, 3.0)
    >>> lost = friction_power(state, loads, inverse_dynamics(state, masses, loads))
    >>> float(lost[Joint.O2]), bool(np.isclose(lost.sum(), inverse_dynamics(state, masses, loads).power))
    (18.0, True)
    """
    moments = dynamics.joint_moments - torsion_moments(state, loads)
    rates = np.stack([np.broadcast_to(joint_rotation(state, joint)[1], state.shape) for joint in Joint])
    lost: FloatArray = -moments * rates
    return lost


def damper_power(state: Kinematics, loads: Loads) -> FloatArray:
    """Power that the dampers take up, shape (...), N length/s."""
    lost = np.zeros(state.shape)
    for spring in loads.springs:
        if spring.damping:
            first, second = spring_ends(state, spring)
            way, rate = second.position - first.position, second.velocity - first.velocity
            length = np.hypot(way[..., 0], way[..., 1])
            with np.errstate(invalid="ignore", divide="ignore"):
                along = np.where(length > 0, (way * rate).sum(axis=-1) / length, 0.0)
            lost = lost + spring.damping * along**2
    return lost
