"""What a linkage does in its task motion: greatest speeds, forces and torque."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from grashof.analysis.curves.fit import coupler_fit_r2
from grashof.analysis.judge.sampled_motion import as_used, driver_law, motion_ends
from grashof.analysis.judge.task_peaks import load_curves, task_peaks
from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.driver_law import DriverLaw, mean_in_time
from grashof.problems import DeadPositionWarning, DynamicsSpec, Linkage, Problem
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.dynamics_spec import metres


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


def over_task(
    linkage: Linkage, problem: Problem, verdict: Verdict, greatest: FloatArray | None = None
) -> OverTask:
    """Figures of a single linkage over the motion from the first target to the last.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    problem : Problem
        Its task; its dynamics give the driver's speed (else 1 rad/s) and the masses.
    verdict : Verdict
        Of `verify`: the driver angle at every target.
    greatest : ndarray, shape (5,), optional
        Its row of `task_peaks`, where that is known.

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
    known = task_peaks([linkage], problem, [verdict])[0] if greatest is None else greatest
    omega4, speed, acceleration, torque, force = known.tolist()
    if np.isnan(omega4):
        return _NONE
    linkage, ends = as_used(linkage, verdict), motion_ends(problem.task, verdict)
    fit, rms = float(coupler_fit_r2(linkage, *ends)), torque
    if problem.dynamics is not None and np.isfinite(torque):
        rms = _torque_rms(linkage, problem.dynamics, metres(problem.length_unit), driver_law(problem, *ends))
    return OverTask(omega4, speed, acceleration, fit, torque, rms, force)


def _torque_rms(linkage: Linkage, spec: DynamicsSpec, metre: float, law: DriverLaw) -> float:
    """Root mean square of the torque over time, N m."""
    curves = load_curves(linkage, spec, metre, law)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeadPositionWarning)
        mean, _ = mean_in_time(linkage, law, lambda place: curves(place)[0] ** 2, panels=8)
    return float(np.sqrt(mean))
