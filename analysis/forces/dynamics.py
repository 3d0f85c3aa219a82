"""Inverse dynamics: the drive torque and joint forces of a motion, and the torque of its motor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.joint_forces import Frames, JointForces, Need, frames_of, joint_forces
from grashof.analysis.forces.joints import Joint, joint_motion, joints_of
from grashof.analysis.forces.loads import Loads, Wrench, known_joint_moments, wrenches
from grashof.analysis.forces.mass import Body, Masses
from grashof.analysis.forces.statics import joint_power, outside_power
from grashof.analysis.mechanism.dyad import Vector
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import wrong_value

_MOST_ROUNDS = 200
_SETTLED = 1e-14


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """Forces, moments and power of a motion. Counter-clockwise moments are positive.

    Parameters
    ----------
    torque : ndarray, shape (...), N length
        Of the drive, on link 2.
    forces : ndarray, shape (J, ..., 2), N
        In the joints, in the order of `Joint`: on the first link of each by the second, on the second where
        the first is the ground. f12, f32, f43 and f14 are those of the first loop: on link 2 by the ground
        at O2, on 2 by 3 at A, on 3 by 4 at B, on 4 by the ground at O4, or at B where it is a slider; those
        of a six-bar in C and E follow, on their host and on 5, and in D on 6 by the ground or on its host.
    joint_moments : ndarray, shape (J, ...), N length
        Of friction and torsion springs, on the second link of each joint: in O2, A, B, O4 on 2, 3, 4, 4. In
        a slide its friction instead, N: the force on that link along the slide.
    shaking_force : ndarray, shape (..., 2), N
        On the ground by everything that is fixed to it.
    shaking_moment : ndarray, shape (...), N length
        The same about O2, the reaction of the drive with it.
    power : ndarray, shape (...), N length/s
        Of the drive.
    slide_force : ndarray, shape (...), N
        Of the first slide, on link 4 at B (of a six-bar on 6 at E) and across it, positive to the left of the
        slide (of the rod): by the ground on a slider, by the rod on a block. NaN without a slide.
    slide_moment : ndarray, shape (...), N length
        Of the slide on that link, about B (E); the guide bears it where loads do not pass through B. NaN
        without a slide.
    """

    torque: FloatArray
    forces: FloatArray
    joint_moments: FloatArray
    shaking_force: FloatArray
    shaking_moment: FloatArray
    power: FloatArray
    slide_force: FloatArray
    slide_moment: FloatArray

    @property
    def f12(self) -> FloatArray:
        """On link 2 by the ground, shape (..., 2), N."""
        return np.asarray(self.forces[Joint.O2])

    @property
    def f32(self) -> FloatArray:
        """On link 2 by link 3, shape (..., 2), N."""
        return np.asarray(self.forces[Joint.A])

    @property
    def f43(self) -> FloatArray:
        """On link 3 by link 4, shape (..., 2), N."""
        return np.asarray(self.forces[Joint.B])

    @property
    def f14(self) -> FloatArray:
        """On link 4 by the ground, shape (..., 2), N."""
        return np.asarray(self.forces[Joint.O4])

    def joint_force(self, joint: Joint) -> FloatArray:
        """Magnitude of the force in a joint, shape (...), N; in a slide with its friction."""
        if joint >= len(self.forces):
            names = [each.name for each in Joint][: len(self.forces)]
            raise wrong_value("joint", Joint(joint).name, f"one of {', '.join(names)}")
        return np.asarray(np.hypot(self.forces[joint, ..., 0], self.forces[joint, ..., 1]))[()]


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
    senses : ndarray, shape (J,), optional
        +1 or -1: in which friction takes the joints to turn, or to slide; by default as they do.

    Returns
    -------
    Dynamics
        NaN where the linkage cannot close, not finite in dead positions. NaN also where friction
        that grows with the joint forces locks the linkage.

    Notes
    -----
    Of the last loop moments of its links about its joints with other links give the force between the
    two, two equations with the determinant sin(theta4 - theta3) in a four-bar; forces on other links
    follow, then those of the loop before, and last the torque (the same nine equations of a four-bar as
    Norton, *Design of Machinery*, sec. 11.4, and 11.5 of slider-cranks, solved in order). Friction that
    depends on the forces is found by repeating this.

    Examples
    --------
    >>> from grashof.analysis import solve_kinematics, uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> state = solve_kinematics(jack, np.radians(60), 2 * np.pi / 3)
    >>> bars = uniform_bars(jack, (312, 312, 314))
    >>> inverse_dynamics(state, bars, Loads(gravity=(0, -9.81))).torque.round(6)
    np.float64(5507.711124)
    """
    loads = Loads() if loads is None else loads
    bodies, frames = masses.by_link(state.linkage), frames_of(state)
    outside, gravity = wrenches(state, loads), loads.gravity_vector()
    needs = {link: _need(state, frames, link, body, outside[link], gravity) for link, body in bodies.items()}
    moments = known_joint_moments(state, loads, senses)
    radius = loads.friction.of(state.linkage, "radius")
    found = joint_forces(frames, needs, moments)
    if radius.any():
        turning = _turning(state, radius, senses)
        moments, found = _with_friction(frames, needs, moments, found, turning, loads.friction.slide_length)
    shaking = _shaking(frames, outside[1], moments, found)
    none = np.full(state.shape, np.nan)
    across, moment = next((found.slides[joint] for joint in sorted(found.slides)), (none, none))
    return Dynamics(
        torque=found.torque[()],
        forces=_stacked(found.forces),
        joint_moments=moments,
        shaking_force=shaking.force,
        shaking_moment=shaking.moment[()],
        power=(found.torque * state.omega2)[()],
        slide_force=across[()],
        slide_moment=(moment + np.zeros(state.shape))[()],
    )


def virtual_work_torque(
    state: Kinematics, masses: Masses, loads: Loads, joint_moments: FloatArray
) -> FloatArray:
    """Drive torque from virtual work, without any joint force.

    Parameters
    ----------
    state, masses, loads
        As for `inverse_dynamics`.
    joint_moments : ndarray, shape (J, ...)
        Of friction and torsion springs.

    Returns
    -------
    ndarray, shape (...), N length

    Notes
    -----
    For a unit of virtual driver rotation, the drive works against inertia, less the work of all forces
    and moments (d'Alembert; Norton, *Design of Machinery*, sec. 11.10).
    """
    unit = solve_kinematics(state.linkage, state.theta2)
    inertia, still = equation_of_motion(unit, state, masses, loads, joint_moments)
    return (still + inertia * state.alpha2)[()]


def equation_of_motion(
    unit: Kinematics, state: Kinematics, masses: Masses, loads: Loads, joint_moments: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Inertia felt by the driver, and the torque that keeps its speed, by virtual work, each (...).

    `unit` is the position with the driver at a steady 1 rad/s; accelerations go with omega2^2.
    """
    gravity, square = loads.gravity_vector(), np.asarray(state.omega2**2)
    inertia = np.zeros(state.shape)
    still = -outside_power(unit, state, loads) - joint_power(unit, joint_moments)
    for link, body in masses.by_link(state.linkage).items():
        _, omega, alpha, _ = unit.angular(link)
        centre = unit.point(link, body.centre)
        inertia = inertia + body.mass * (centre.velocity**2).sum(axis=-1) + body.inertia * omega**2
        push = square[..., None] * centre.acceleration - gravity
        still = still + body.mass * (push * centre.velocity).sum(axis=-1)
        still = still + square * body.inertia * alpha * omega
    return inertia, still


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


def friction_and_springs(
    state: Kinematics, masses: Masses, loads: Loads, senses: FloatArray | None = None
) -> FloatArray:
    """`Dynamics.joint_moments`, which need no joint forces where no friction grows with these."""
    if loads.friction.of(state.linkage, "radius").any():
        return inverse_dynamics(state, masses, loads, senses).joint_moments
    return known_joint_moments(state, loads, senses)


def _need(
    state: Kinematics, frames: Frames, link: int, body: Body, outside: Wrench, gravity: FloatArray
) -> Need:
    """Inertia of a link less its loads: the need of its joints and drive."""
    push, mass = state.point(link, body.centre).acceleration, np.asarray(body.mass)
    x, y = mass * (push[..., 0] - gravity[0]), mass * (push[..., 1] - gravity[1])
    arm_x, arm_y = frames.arm(link, (body.centre[..., 0], body.centre[..., 1]))
    turning = body.inertia * state.angular(link).alpha + (arm_x * y - arm_y * x)
    return Need(x - outside.force[..., 0], y - outside.force[..., 1], turning - outside.moment)


def _shaking(frames: Frames, ground: Wrench, moments: FloatArray, found: JointForces) -> Wrench:
    """Shaking force on the ground, and moment about O2, of everything fixed to it."""
    x, y = found.forces[0]
    force_x, force_y = ground.force[..., 0] - x, ground.force[..., 1] - y
    turning = ground.moment - found.torque - moments[0]
    for loop, (dyad, _, (_, (arm_x, arm_y))) in enumerate(frames.dyads):
        if dyad.row.hosts[1] != 1:
            continue
        joint = 3 * loop + 3
        x, y = found.forces[joint]
        guided = found.slides[joint][1] if joint in found.slides else moments[joint]
        force_x, force_y = force_x - x, force_y - y
        turning = turning - (arm_x * y - arm_y * x) - guided
    return Wrench(np.stack(np.broadcast_arrays(force_x, force_y), axis=-1), turning)


def _stacked(forces: list[Vector]) -> FloatArray:
    """Shape (J, ..., 2)."""
    shape = np.broadcast_shapes(*(np.shape(part) for force in forces for part in force))
    stacked = np.empty((len(forces), *shape, 2))
    for row, (x, y) in zip(stacked, forces, strict=True):
        row[..., 0], row[..., 1] = x, y
    return stacked


def _pressing(found: JointForces, slide_length: float) -> FloatArray:
    """Forces that friction in the joints grows with, in a slide that across it; shape (J, ...), N."""
    sizes = [np.hypot(x, y) for x, y in found.forces]
    for joint, (across, moment) in found.slides.items():
        sizes[joint] = np.abs(across)
        if slide_length:
            sizes[joint] = np.maximum(sizes[joint], 2 * np.abs(moment) / slide_length)
    return np.stack(np.broadcast_arrays(*sizes))


def _turning(state: Kinematics, radius: FloatArray, senses: FloatArray | None) -> FloatArray:
    """Radii of the friction circles, with the signs in which the joints turn; shape (J, ...)."""
    joints = joints_of(state.linkage)
    if senses is None:
        return np.stack([radius[joint] * np.sign(joint_motion(state, joint)[1]) for joint in joints])
    return np.stack([np.full(state.shape, radius[joint] * senses[joint]) for joint in joints])


def _with_friction(
    frames: Frames,
    needs: dict[int, Need],
    known: FloatArray,
    found: JointForces,
    turning: FloatArray,
    slide_length: float,
) -> tuple[FloatArray, JointForces]:
    """Joint moments with friction in proportion to the joint forces, and those forces; without it `found`."""
    settled = np.zeros(known.shape[1:], dtype=bool)
    for _ in range(_MOST_ROUNDS):
        sizes = _pressing(found, slide_length)
        moments = known - turning * sizes
        found = joint_forces(frames, needs, moments)
        again = _pressing(found, slide_length)
        settled = ~(np.abs(again - sizes) > _SETTLED * again.max(axis=0)).any(axis=0)
        if settled.all():
            break
    moments = np.where(settled, moments, np.nan)
    return moments, joint_forces(frames, needs, moments)
