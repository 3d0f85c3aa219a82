"""Inverse dynamics: the drive torque and joint forces that a motion takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from grashof.analysis.forces.closing import closing, direction
from grashof.analysis.forces.joints import (
    Joint,
    joint_motion,
    slide_normal,
    slide_of,
)
from grashof.analysis.forces.loads import Loads, Wrench, cross, known_joint_moments, turned, wrenches
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
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
        ground at O4, or at B where it is a slider.
    joint_moments : ndarray, shape (4, ...), N length
        Of friction and torsion springs in O2, A, B, O4, on the second link of each (2, 3, 4, 4). In a
        slide its friction instead, N: the force on link 4 along the slide.
    shaking_force : ndarray, shape (..., 2), N
        On the ground by everything that is fixed to it.
    shaking_moment : ndarray, shape (...), N length
        The same about O2, the reaction of the drive with it.
    power : ndarray, shape (...), N length/s
        Of the drive.
    slide_force : ndarray, shape (...), N
        Of the slide on link 4, at B and across it, positive to the left of the slide (of the rod): by the
        ground on a slider, by the rod on a block. NaN without a slide.
    slide_moment : ndarray, shape (...), N length
        Of the slide on link 4, about B; the guide bears it where loads do not pass through B. NaN
        without a slide.
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
    slide_force: FloatArray
    slide_moment: FloatArray

    def joint_force(self, joint: Joint) -> FloatArray:
        """Magnitude of the force in a joint, shape (...), N; in a slide with its friction."""
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
        +1 or -1: in which friction takes the joints to turn, or to slide; by default as they do.

    Returns
    -------
    Dynamics
        NaN where the linkage cannot close, not finite in dead positions. NaN also where friction
        that grows with the joint forces locks the linkage.

    Notes
    -----
    Moments of link 3 about A and of link 4 about O4 give the force at B, two equations with the
    determinant sin(theta4 - theta3); the other forces and the torque follow one by one (the same
    nine equations as Norton, *Design of Machinery*, sec. 11.4, and 11.5 of slider-cranks, solved in
    order; see `closing`). Friction that depends on the forces is found by repeating this.

    Examples
    --------
    >>> from grashof.analysis.mechanism.kinematics import solve_kinematics
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
    radius = loads.friction.of(state.linkage, "radius")
    forces = _joint_forces(state, demands, moments)
    if radius.any():
        turning = _turning(state, radius, senses)
        moments, forces = _with_friction(state, demands, moments, turning, loads.friction.slide_length)
    f12, f32, f43, f14, slide_moment = forces
    a = np.asarray(state.linkage.r2)[..., None] * direction(state.theta2)
    torque = demands[2].moment - cross(a, f32) - moments[0] + moments[1]
    ground, on_slider = outside[1], slide_of(state.linkage) is Joint.O4
    base = state.origin(4).position - state.linkage.o2
    guided = moments[3] if not on_slider else slide_moment
    return Dynamics(
        torque=torque[()],
        f12=f12,
        f32=f32,
        f43=f43,
        f14=f14,
        joint_moments=moments,
        shaking_force=ground.force - f12 - f14,
        shaking_moment=(ground.moment - cross(base, f14) - torque - moments[0] - guided)[()],
        power=(torque * state.omega2)[()],
        slide_force=_across(state, forces)[()],
        slide_moment=slide_moment[()],
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
    torque = np.zeros(state.shape)
    for link in (2, 3, 4):
        body = masses.of(link)
        rate, moving = per_turn.angular(link)[1], per_turn.origin(link).velocity
        moved, push = per_turn.point(link, body.centre), state.point(link, body.centre).acceleration
        inertia = np.asarray(body.mass) * ((push - gravity) * moved.velocity).sum(axis=-1)
        torque = torque + inertia + body.inertia * state.angular(link)[2] * rate
        torque = torque - (outside[link].force * moving).sum(axis=-1) - outside[link].moment * rate
    for joint in Joint:
        torque = torque - joint_moments[joint] * joint_motion(per_turn, joint)[1]
    return torque[()]


def _demand(state: Kinematics, masses: Masses, link: int, outside: Wrench, gravity: FloatArray) -> Wrench:
    """Force, and moment about the link's origin, that joints and drive must still exert."""
    body, theta, alpha = masses.of(link), state.frame_angle(link), state.angular(link)[2]
    inertia = np.asarray(body.mass)[..., None] * (state.point(link, body.centre).acceleration - gravity)
    turning = body.inertia * alpha + cross(turned(body.centre, theta), inertia)
    return Wrench(inertia - outside.force, turning - outside.moment)


class _JointForces(NamedTuple):
    """The four joint forces, and the moment of a slide, for given moments in the joints."""

    f12: FloatArray
    f32: FloatArray
    f43: FloatArray
    f14: FloatArray
    slide_moment: FloatArray


def _joint_forces(state: Kinematics, demands: dict[int, Wrench], moments: FloatArray) -> _JointForces:
    with np.errstate(divide="ignore", invalid="ignore"):
        f43, slide_moment = closing(state, demands, moments)
    f14 = demands[4].force + f43
    f32 = f43 - demands[3].force
    return _JointForces(demands[2].force - f32, f32, f43, f14, slide_moment)


def _across(state: Kinematics, forces: _JointForces) -> FloatArray:
    """Force of the slide on link 4 across it, shape (...); NaN without a slide."""
    slide = slide_of(state.linkage)
    if slide is None:
        return np.full(state.shape, np.nan)
    on_output = forces.f14 if slide is Joint.O4 else -forces.f43
    return np.asarray((on_output * slide_normal(state)).sum(axis=-1))


def _pressing(state: Kinematics, forces: _JointForces, slide_length: float) -> FloatArray:
    """What friction in the joints grows with: the forces, in a slide that across it; shape (4, ...), N."""
    sizes = np.stack([np.hypot(force[..., 0], force[..., 1]) for force in forces[:4]])
    if (slide := slide_of(state.linkage)) is not None:
        sizes[slide] = np.abs(_across(state, forces))
        if slide_length:
            sizes[slide] = np.maximum(sizes[slide], 2 * np.abs(forces.slide_moment) / slide_length)
    return sizes


def _turning(state: Kinematics, radius: FloatArray, senses: FloatArray | None) -> FloatArray:
    """Radii of the friction circles, with the signs in which the joints turn; shape (4, ...)."""
    if senses is None:
        return np.stack([radius[joint] * np.sign(joint_motion(state, joint)[1]) for joint in Joint])
    return np.stack([np.full(state.shape, radius[joint] * senses[joint]) for joint in Joint])


def _with_friction(
    state: Kinematics,
    demands: dict[int, Wrench],
    known: FloatArray,
    turning: FloatArray,
    slide_length: float,
) -> tuple[FloatArray, _JointForces]:
    """Joint moments with friction in proportion to the joint forces, and those forces."""
    forces = _joint_forces(state, demands, known)
    settled = np.zeros(state.shape, dtype=bool)
    for _ in range(_MOST_ROUNDS):
        sizes = _pressing(state, forces, slide_length)
        moments = known - turning * sizes
        forces = _joint_forces(state, demands, moments)
        again = _pressing(state, forces, slide_length)
        settled = ~(np.abs(again - sizes) > _SETTLED * again.max(axis=0)).any(axis=0)
        if settled.all():
            break
    moments = np.where(settled, moments, np.nan)
    return moments, _joint_forces(state, demands, moments)
