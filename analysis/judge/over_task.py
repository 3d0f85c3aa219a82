"""What a linkage does in its task motion: greatest speeds, forces and torque."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from grashof.analysis.curves.fit import coupler_fit_r2
from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.joints import Joint
from grashof.analysis.forces.stated import BeyondLoadError, stated_loads, stated_masses
from grashof.analysis.four_bar.driver_law import DriverLaw
from grashof.analysis.four_bar.kinematics import solve_kinematics
from grashof.analysis.four_bar.means import mean_in_time
from grashof.analysis.four_bar.position import solve_position
from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import DeadPositionWarning, DynamicsSpec, Linkage, Problem, Task
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics_spec import metres
from grashof.problems.values.motor import MotorSpec

_SAMPLES = 361
_NEAR = np.logspace(-8, -2, 31)  # rad, about the positions that come closest to a dead one

Curves = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, slots=True)
class OverTask:
    """Figures of the motion from the first target to the last, the driver turning steadily.

    NaN where no motion joins the targets; infinite where the motion touches a dead position.

    Parameters
    ----------
    omega4_max : float, rad/s
        Greatest magnitude of the output link's angular velocity.
    point_speed_max, point_acceleration_max : float, length/s and length/s^2
        Of P.
    coupler_fit_r2 : float
        Of a polynomial of degree 4 in the driver angle that stands for the path of P.
    torque_peak, torque_rms : float, N m
        Greatest magnitude of the drive torque, and its root mean square over time; NaN without
        dynamics.
    joint_force_peak : float, N
        Greatest force in any joint; NaN without dynamics.
    """

    omega4_max: float
    point_speed_max: float
    point_acceleration_max: float
    coupler_fit_r2: float
    torque_peak: float = np.nan
    torque_rms: float = np.nan
    joint_force_peak: float = np.nan


_NONE = OverTask(np.nan, np.nan, np.nan, np.nan)


def over_task(linkage: Linkage, problem: Problem, verdict: Verdict) -> OverTask:
    """Figures of a single linkage over the motion from the first target to the last.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    problem : Problem
        Its task; its dynamics give the driver's speed (else 1 rad/s) and the masses.
    verdict : Verdict
        Of `verify`: the driver angle at every target.

    Returns
    -------
    OverTask

    Notes
    -----
    Dense samples, densest where the linkage comes closest to a dead position, then ever closer ones
    about the highest: the maxima are right to rounding where the quantity is smooth. The mean of
    the squared torque is a Gauss-Legendre sum refined until it converges.

    Examples
    --------
    >>> from grashof.analysis.judge.planted import planted_motion
    >>> from grashof.analysis.judge.verify import verify
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=4)
    >>> problem = Problem(task=task, length_unit="m", dynamics=DynamicsSpec(mass_per_length=2.0))
    >>> found = over_task(linkage, problem, verify(linkage, task, problem.requirements))
    >>> round(found.omega4_max, 6), round(found.coupler_fit_r2, 6), round(found.torque_peak, 3)
    (1.260659, 0.999996, 2.757)
    """
    linkage, spec = as_used(linkage, verdict), problem.dynamics
    start, end = motion_ends(problem.task, verdict)
    theta2 = sampled(linkage, start, end)
    if not joins(linkage, verdict, theta2):
        return _NONE
    forces: tuple[float, ...] = ()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeadPositionWarning)
        law = driver_law(problem, start, end)
        omega4, speed, acceleration = peaks(_speeds(linkage, law), law.stretches(theta2))[0]
        if spec is not None:
            with suppress(BeyondLoadError):  # a defect by itself
                forces = _forces(linkage, problem, spec, law, theta2)
    fit = float(coupler_fit_r2(linkage, start, end))
    return OverTask(float(omega4), float(speed), float(acceleration), fit, *forces)


def _forces(
    linkage: Linkage, problem: Problem, spec: DynamicsSpec, law: DriverLaw, theta2: FloatArray
) -> tuple[float, float, float]:
    """Peak and root mean square of the torque, N m, and the greatest joint force, N."""
    loaded, square = _loaded(linkage, spec, metres(problem.length_unit), law), np.inf
    peak, force = peaks(loaded, law.stretches(theta2))[0]
    if np.isfinite(peak):
        mean, _ = mean_in_time(linkage, law, lambda place: loaded(place)[0] ** 2, panels=8)
        square = float(mean)
    return float(peak), float(np.sqrt(square)), float(force)


def torque_peak(linkage: Linkage, problem: Problem, verdict: Verdict) -> float:
    """The drive torque's greatest magnitude as `over_task` has it, N m; NaN without dynamics."""
    if problem.dynamics is None:
        return np.nan
    linkage = as_used(linkage, verdict)
    ends = motion_ends(problem.task, verdict)
    theta2, law = sampled(linkage, *ends), driver_law(problem, *ends)
    if not joins(linkage, verdict, theta2):
        return np.nan
    loaded = _loaded(linkage, problem.dynamics, metres(problem.length_unit), law)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeadPositionWarning)
        with suppress(BeyondLoadError):
            return float(peaks(lambda place: loaded(place)[:1], law.stretches(theta2))[0][0])
    return np.nan


def as_used(linkage: Linkage, verdict: Verdict) -> Linkage:
    """The linkage on the assembly on which it meets the first target."""
    used = np.asarray(verdict.assembly[0], dtype=np.float64)
    return linkage if used == linkage.assembly else linkage.changed(assembly=used)


def joins(linkage: Linkage, verdict: Verdict, theta2: FloatArray) -> bool:
    """Whether a motion joins the targets; at its very ends rounding may open the loop."""
    return verdict.branch_ok and not np.isnan(solve_position(linkage, theta2[1:-1]).theta3).any()


def motion_ends(task: Task, verdict: Verdict) -> tuple[float, float]:
    """Driver angles at which the motion from the first target to the last begins and ends, rad."""
    low, high = float(verdict.theta2.min()), float(verdict.theta2.max())
    before, after = task.beyond
    start, end = (low, high) if verdict.direction > 0 else (high, low)
    start, end = start - verdict.direction * before, end + verdict.direction * after
    if task.closed:
        end = start + verdict.direction * TURN
    return start, end


def driver_law(problem: Problem, start: float, end: float) -> DriverLaw:
    """How the driver of a design goes from one angle to the other: as the problem's dynamics have it."""
    spec, rotation = problem.dynamics, end - start
    omega2 = np.copysign(1.0 if spec is None else spec.omega2, rotation)
    motor = spec.motor if spec is not None and rotation else None
    return DriverLaw(start, rotation, float(omega2), motor or MotorSpec())


def _speeds(linkage: Linkage, law: DriverLaw) -> Curves:
    """|omega4|, speed and acceleration of P, each a row, over places of the law."""

    def curves(place: FloatArray) -> FloatArray:
        state = solve_kinematics(linkage, *law.at_place(place))
        return np.stack([np.abs(state.omega4), state.p.speed, state.p.acceleration_magnitude])

    return curves


def _loaded(linkage: Linkage, spec: DynamicsSpec, metre: float, law: DriverLaw) -> Curves:
    """|torque| in N m and the greatest joint force in N, each a row, over places of the law."""
    masses = stated_masses(linkage, spec, metre)
    loads = stated_loads(spec, metre, lambda state: law.time_at(state.theta2))

    def curves(place: FloatArray) -> FloatArray:
        found = inverse_dynamics(solve_kinematics(linkage, *law.at_place(place)), masses, loads)
        force = np.max([found.joint_force(joint) for joint in Joint], axis=0)
        return np.stack([metre**2 * np.abs(found.torque), metre * force])

    return curves


def sampled(linkage: Linkage, start: float, end: float) -> FloatArray:
    """Driver angles from the lower end to the upper, close where a dead position is near."""
    low, high = min(start, end), max(start, end)
    spread = low + (high - low) * (1 - np.cos(np.linspace(0, np.pi, _SAMPLES))) / 2
    spread[[0, -1]] = low, high
    theta1 = float(linkage.theta1)
    # With O2A along the ground line the diagonal A-O4 is shortest or longest.
    turning = theta1 + np.pi * np.arange(
        np.ceil((low - theta1) / np.pi), np.floor((high - theta1) / np.pi) + 1
    )
    near = (turning[:, None] + np.concatenate([-_NEAR, [0.0], _NEAR])).ravel()
    return np.unique(np.concatenate([spread, near[(near > low) & (near < high)]]))
