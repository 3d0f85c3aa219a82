"""Inverse dynamics: the drive torque and joint forces that a motion takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.forces.loads import (
    Joint,
    Loads,
    Wrench,
    cross,
    joint_rotation,
    known_joint_moments,
    turned,
    wrenches,
)
from grashof.analysis.forces.mass import Masses
from grashof.analysis.four_bar.kinematics import Kinematics, solve_kinematics
from grashof.problems.values.arrays import FloatArray

_MOST_ROUNDS = 200
_SETTLED = 1e-14


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """Forces, moments and power of a motion. Counter-clockwise moments are positive.

    Parameters
    ----------
    torque : ndarray, shape (...), N length
        Of the drive, on link 2.
    f12, f32, f43, f14 : ndarray, shape (..., 2), N
        Joint forces: on link 2 by the ground at O2, on 2 by 3 at A, on 3 by 4 at B, on 4 by the
        ground at O4.
    joint_moments : ndarray, shape (4, ...), N length
        Of friction and torsion springs in O2, A, B, O4, on the second link of each (2, 3, 4, 4).
    shaking_force : ndarray, shape (..., 2), N
        On the ground by everything that is fixed to it.
    shaking_moment : ndarray, shape (...), N length
        The same about O2, the reaction of the drive with it.
    power : ndarray, shape (...), N length/s
        Of the drive.
    """

    torque: FloatArray
    f12: FloatArray
    f32: FloatArray
    f43: FloatArray
    f14: FloatArray
    joint_moments: FloatArray
    shaking_force: FloatArray
    shaking_moment: FloatArray
    power: FloatArray

    def joint_force(self, joint: Joint) -> FloatArray:
        """Magnitude of the force in a joint, shape (...), N."""
        force = (self.f12, self.f32, self.f43, self.f14)[joint]
        return np.hypot(force[..., 0], force[..., 1])


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def inverse_dynamics(
    state: Kinematics, masses: Masses, loads: Loads | None = None, senses: FloatArray | None = None
) -> Dynamics:
    """Drive torque and joint forces of a motion, by Newton and Euler.

    Parameters
    ----------
    state : Kinematics
        The motion; the driver's acceleration in it is that of an uneven drive.
    masses : Masses
        Of all links, the payload with the coupler (`Masses.with_payload`).
    loads : Loads, optional
        Gravity, forces, springs, friction; none by default.
    senses : ndarray, shape (4,), optional
        +1 or -1: in which friction takes the joints to turn; by default as they do.

    Returns
    -------
    Dynamics
        NaN where the linkage cannot close, not finite in dead positions. NaN also where friction
        that grows with the joint forces locks the linkage.

    Notes
    -----
    Moments of link 3 about A and of link 4 about O4 give the force at B, two equations with the
    determinant sin(theta4 - theta3); the other forces and the torque follow one by one (the same
    nine equations as Norton, *Design of Machinery*, sec. 11.4, solved in order). Friction that
    depends on the forces is found by repeating this.

    Examples
    --------
    >>> from grashof.analysis.four_bar.kinematics import solve_kinematics
    >>> from grashof.analysis.forces.mass import uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> state = solve_kinematics(jack, np.radians(60), 2 * np.pi / 3)
    >>> bars = uniform_bars(jack, (312, 312, 314))
    >>> inverse_dynamics(state, bars, Loads(gravity=(0, -9.81))).torque.round(6)
    np.float64(5507.711124)
    """
    loads = Loads() if loads is None else loads
    outside, gravity = wrenches(state, loads), loads.gravity_vector()
    demands = {link: _demand(state, masses, link, outside[link], gravity) for link in (2, 3, 4)}
    moments = known_joint_moments(state, loads, senses)
    radius = loads.friction.each("radius")
    forces = _joint_forces(state, demands, moments)
    if radius.any():
        moments, forces = _with_pin_friction(state, demands, moments, forces, _turning(state, radius, senses))
    f12, f32, f43, f14 = forces
    a = np.asarray(state.linkage.r2)[..., None] * _direction(state.theta2)
    torque = demands[2].moment - cross(a, f32) - moments[0] + moments[1]
    ground = outside[1]
    base = state.linkage.o4 - state.linkage.o2
    return Dynamics(
        torque=torque[()],
        f12=f12,
        f32=f32,
        f43=f43,
        f14=f14,
        joint_moments=moments,
        shaking_force=ground.force - f12 - f14,
        shaking_moment=(ground.moment - cross(base, f14) - torque - moments[0] - moments[3])[()],
        power=(torque * state.omega2)[()],
    )


def virtual_work_torque(
    state: Kinematics, masses: Masses, loads: Loads, joint_moments: FloatArray
) -> FloatArray:
    """Drive torque from virtual work, without any joint force.

    Parameters
    ----------
    state, masses, loads
        As for `inverse_dynamics`.
    joint_moments : ndarray, shape (4, ...)
        Of friction and torsion springs.

    Returns
    -------
    ndarray, shape (...), N length

    Notes
    -----
    For a unit of virtual driver rotation, the drive works against inertia, less what all forces
    and moments do (d'Alembert; Norton, *Design of Machinery*, sec. 11.10).
    """
    per_turn = solve_kinematics(state.linkage, state.theta2)  # velocities for 1 rad/s
    outside, gravity = wrenches(state, loads), loads.gravity_vector()
    origins = {2: np.zeros(2), 3: per_turn.a.velocity, 4: np.zeros(2)}
    torque = np.zeros(state.shape)
    for link, origin in origins.items():
        body = masses.of(link)
        rate = per_turn.angular(link)[1]
        moved, push = per_turn.point(link, body.centre), state.point(link, body.centre).acceleration
        inertia = np.asarray(body.mass) * ((push - gravity) * moved.velocity).sum(axis=-1)
        torque = torque + inertia + body.inertia * state.angular(link)[2] * rate
        torque = torque - (outside[link].force * origin).sum(axis=-1) - outside[link].moment * rate
    for joint in Joint:
        torque = torque - joint_moments[joint] * joint_rotation(per_turn, joint)[1]
    return torque[()]


def _demand(state: Kinematics, masses: Masses, link: int, outside: Wrench, gravity: FloatArray) -> Wrench:
    """Force, and moment about the link's origin, that joints and drive must still exert."""
    body, (theta, _, alpha, _) = masses.of(link), state.angular(link)
    inertia = np.asarray(body.mass)[..., None] * (state.point(link, body.centre).acceleration - gravity)
    turning = body.inertia * alpha + cross(turned(body.centre, theta), inertia)
    return Wrench(inertia - outside.force, turning - outside.moment)


def _direction(theta: FloatArray) -> FloatArray:
    return np.stack([np.cos(theta), np.sin(theta)], axis=-1)


def _joint_forces(
    state: Kinematics, demands: dict[int, Wrench], moments: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Forces f12, f32, f43, f14 for given moments in the joints."""
    linkage = state.linkage
    turn3 = demands[3].moment - moments[1] + moments[2]
    turn4 = demands[4].moment - moments[2] - moments[3]
    sine = np.sin(state.theta4 - state.theta3)
    with np.errstate(divide="ignore", invalid="ignore"):
        along3, along4 = turn4 / (linkage.r4 * sine), turn3 / (linkage.r3 * sine)
        f43 = along3[..., None] * _direction(state.theta3) + along4[..., None] * _direction(state.theta4)
    f14 = demands[4].force + f43
    f32 = f43 - demands[3].force
    return demands[2].force - f32, f32, f43, f14


def _turning(state: Kinematics, radius: FloatArray, senses: FloatArray | None) -> FloatArray:
    """Radii of the friction circles, with the signs in which the joints turn; shape (4, ...)."""
    if senses is None:
        return np.stack([radius[joint] * np.sign(joint_rotation(state, joint)[1]) for joint in Joint])
    return np.stack([np.full(state.shape, radius[joint] * senses[joint]) for joint in Joint])


def _with_pin_friction(
    state: Kinematics,
    demands: dict[int, Wrench],
    known: FloatArray,
    forces: tuple[FloatArray, ...],
    turning: FloatArray,
) -> tuple[FloatArray, tuple[FloatArray, FloatArray, FloatArray, FloatArray]]:
    """Joint moments with friction in proportion to the joint forces, and those forces."""
    settled = np.zeros(state.shape, dtype=bool)
    for _ in range(_MOST_ROUNDS):
        sizes = np.stack([np.hypot(force[..., 0], force[..., 1]) for force in forces])
        moments = known - turning * sizes
        forces = _joint_forces(state, demands, moments)
        again = np.stack([np.hypot(force[..., 0], force[..., 1]) for force in forces])
        settled = ~(np.abs(again - sizes) > _SETTLED * again.max(axis=0)).any(axis=0)
        if settled.all():
            break
    moments = np.where(settled, moments, np.nan)
    return moments, _joint_forces(state, demands, moments)
