"""Torques and forces that hold a linkage at rest, and its mechanical advantage at the output and at P."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.joints import joint_motion, joints_of, output_rate
from grashof.analysis.forces.loads import Friction, Loads, known_joint_moments, wrenches
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.kinematics import Kinematics, virtual_motion
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Advantage:
    """Ratios of output to driver in speed, torque and force, without friction; each of shape (...).

    Parameters
    ----------
    velocity_ratio : ndarray
        omega4 / omega2, of a six-bar that of link 6; infinite in a dead position of the driver. Of a slider
        its velocity over omega2, length/rad.
    torque_ratio : ndarray
        T4 / T2 = omega2 / omega4, the mechanical advantage; infinite where link 4 (6) is at rest. Of a slider
        the force on it along its slide for a unit of torque, rad/length.
    way : ndarray, length/rad
        Of P for each radian of the driver.
    force_ratio : ndarray
        Force at P along its path for a force on A across link 2; infinite where P is at rest.
    """

    velocity_ratio: FloatArray
    torque_ratio: FloatArray
    way: FloatArray
    force_ratio: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Holding:
    """Torque, moment or force, each by itself, that holds a linkage against weight and loads; no friction.

    Parameters
    ----------
    torque : ndarray, shape (...), N length
        On link 2, counter-clockwise; the other two are for a free driver.
    moment : ndarray, shape (...), N length
        On link 4, of a six-bar on link 6, counter-clockwise; of a slider the force on it along its slide, N.
    force : ndarray, shape (...), N
        At P, along `direction`.
    direction : ndarray, shape (..., 2)
        Of the path of P as the driver turns counter-clockwise; NaN where P is at rest.
    """

    torque: FloatArray
    moment: FloatArray
    force: FloatArray
    direction: FloatArray


def advantage(linkage: Linkage, theta2: npt.ArrayLike) -> Advantage:
    """Velocity ratio, mechanical advantage and force ratio at given driver angles.

    Parameters
    ----------
    linkage : Linkage
    theta2 : array_like, shape (...), rad

    Returns
    -------
    Advantage
        NaN where the linkage cannot close.

    Notes
    -----
    Power in is power out: T2 omega2 = T4 omega4, and F2 r2 omega2 = F v_P for a force F2 on A across
    link 2 (Norton, *Design of Machinery*, sec. 6.4).

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> found = advantage(norton, np.radians([40, 250]))
    >>> found.velocity_ratio.round(6).tolist(), found.torque_ratio.round(4).tolist()
    ([0.279919, -0.116888], [3.5725, -8.5552])
    """
    virtual, _ = virtual_motion(linkage, theta2)
    way, crank, output = virtual.p.speed, virtual.omega2, output_rate(virtual)
    with np.errstate(divide="ignore", invalid="ignore"):
        return Advantage(
            velocity_ratio=output / crank,
            torque_ratio=crank / output,
            way=way / crank,
            force_ratio=linkage.r2 * crank / way,
        )


def holding(linkage: Linkage, theta2: npt.ArrayLike, masses: Masses, loads: Loads) -> Holding:
    """The torque, the moment on the last link, or the force at P that holds a linkage at given driver angles.

    Parameters
    ----------
    linkage : Linkage
    theta2 : array_like, shape (...), rad
    masses : Masses
    loads : Loads
        Its friction is left out: at rest it may act either way.

    Returns
    -------
    Holding
        NaN where the linkage cannot close. Infinite where it cannot be held: by a torque in a dead
        position of the driver, by a moment on the last link where this is at rest.

    Notes
    -----
    Virtual work (Norton, *Design of Machinery*, sec. 11.10), in a virtual motion that has a limit in
    dead positions.

    Examples
    --------
    A bar of 3 kg as the output of a square, P at B: half of its weight times the length.

    >>> from grashof.analysis import Body
    >>> from grashof.problems import FourBar
    >>> square = FourBar(o2=(0, 0), o4=(2, 0), r2=2, r3=2, r4=2, coupler_point=(2, 0), assembly=1)
    >>> bar = Masses(Body(0), Body(0), Body(3.0, 0.0, (1.0, 0.0)))
    >>> held = holding(square, np.radians(60), bar, Loads(gravity=(0, -10)))
    >>> float(held.torque.round(9)), float(held.moment.round(9)), float(held.force.round(9))
    (15.0, 15.0, 7.5)
    """
    virtual, rest = virtual_motion(linkage, theta2)
    power = virtual_power(virtual, rest, masses, replace(loads, friction=Friction()))
    speed = virtual.p.speed
    with np.errstate(divide="ignore", invalid="ignore"):
        return Holding(
            torque=-power / virtual.omega2,
            moment=-power / output_rate(virtual),
            force=-power / speed,
            direction=virtual.p.velocity / speed[..., None],
        )


def virtual_power(virtual: Kinematics, state: Kinematics, masses: Masses, loads: Loads) -> FloatArray:
    """Power of weights and loads of a state in velocities that the linkage allows, shape (...)."""
    gravity = loads.gravity_vector()
    power = load_power(virtual, state, loads)
    for link, body in masses.by_link(state.linkage).items():
        if np.any(body.mass > 0) and gravity.any():
            power = power + body.mass * (virtual.point(link, body.centre).velocity * gravity).sum(axis=-1)
    return power


def load_power(virtual: Kinematics, state: Kinematics, loads: Loads) -> FloatArray:
    """The same of forces, moments, springs and known friction alone, without weights."""
    return outside_power(virtual, state, loads) + joint_power(virtual, known_joint_moments(state, loads))


def outside_power(virtual: Kinematics, state: Kinematics, loads: Loads) -> FloatArray:
    """Power of forces, moments and straight springs of a state in such velocities, shape (...)."""
    outside, power = wrenches(state, loads), np.zeros(state.shape)
    for link in range(2, len(outside) + 1):
        power = power + outside[link].moment * virtual.angular(link)[1]
    kind = state.linkage.mechanism
    for link in (row.number for row in kind.links[1:] if row.points[0] not in kind.ground):
        if outside[link].force.any():
            power = power + (outside[link].force * virtual.origin(link).velocity).sum(axis=-1)
    return power


def joint_power(virtual: Kinematics, moments: FloatArray) -> FloatArray:
    """Power of moments (J, ...) in the joints, as in `Dynamics`, in such velocities, shape (...)."""
    power = np.zeros(virtual.shape)
    for joint in joints_of(virtual.linkage):
        if moments[joint].any():
            power = power + moments[joint] * joint_motion(virtual, joint)[1]
    return power
