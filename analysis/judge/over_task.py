"""The task motion of judged linkages, and their greatest speeds, forces and torque in it."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from grashof.analysis.curves.fit import coupler_fit_r2
from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.from_spec import TRAVEL_ROUNDING, BeyondLoadError, stated_loads, stated_masses
from grashof.analysis.forces.joints import joints_of
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.mechanism.driver_law import DriverLaw, SteadyDrivers, mean_in_time
from grashof.analysis.mechanism.even_motion import close_samples, with_edges
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import SMOOTH, Curve, peaks
from grashof.analysis.numerics.quadrature import settled_sums
from grashof.problems import DeadPositionWarning, DynamicsSpec, Linkage, Problem, Task
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.linkages.linkage import by_kind

_SAMPLES = 361
_PANELS = 8  # over a motion, for means
TORQUE = 4  # place of the torque among the peaks of a motion, behind those of places and angles
_TOGETHER = 32  # linkages in a batch; more are no faster


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
    output_acceleration_max : float, rad/s^2
        Greatest magnitude of the angular acceleration of the last link, of a task with two outputs of both;
        NaN where it slides.
    coupler_fit_r2 : float
        Of a polynomial of degree 4 in the driver angle fitted to the path of P.
    torque_peak, torque_rms : float, N m
        Greatest magnitude of the drive torque, and its root mean square over time; NaN without
        dynamics.
    joint_force_peak : float, N
        Greatest force in any joint; NaN without dynamics.
    """

    omega4_max: float
    point_speed_max: float
    point_acceleration_max: float
    output_acceleration_max: float
    coupler_fit_r2: float
    torque_peak: float = np.nan
    torque_rms: float = np.nan
    joint_force_peak: float = np.nan


def as_used(linkage: Linkage, verdict: Verdict) -> Linkage:
    """The linkage on the assembly on which it meets the first target."""
    used = np.asarray(verdict.assembly[0], dtype=np.float64)
    return linkage if used == linkage.assembly else linkage.changed(assembly=used)


def joins(linkage: Linkage, verdict: Verdict, theta2: FloatArray) -> bool:
    """Whether a motion joins the targets; at its very ends rounding may open the loop."""
    return verdict.branch_ok and not np.isnan(solve_position(linkage, theta2[1:-1]).p).any()


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
    """The driver's motion from one angle to the other, by the dynamics of the problem."""
    spec, rotation = problem.dynamics, end - start
    omega2 = np.copysign(1.0 if spec is None else spec.omega2, rotation)
    motor = spec.motor if spec is not None and rotation else None
    return DriverLaw(start, rotation, float(omega2), motor or MotorSpec())


def sampled(linkage: Linkage, start: float, end: float) -> FloatArray:
    """Driver angles from the lower end to the upper, close where a dead position is near."""
    return close_samples(linkage, start, end, _SAMPLES, second=False)


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
    return each_over_task([linkage], problem, [verdict])[0]


def each_over_task(
    linkages: Sequence[Linkage], problem: Problem, verdicts: Sequence[Verdict]
) -> list[OverTask]:
    """Figures of several linkages as of `over_task`, and equal to them to the last bit."""
    found = [OverTask(*[np.nan] * 5)] * len(linkages)
    for rows, some in joined_motions(linkages, problem, verdicts):
        peaks = _peaks_of(some, problem)
        fits = coupler_fit_r2(batch_of(some), *_ends(some))
        rms = _rms_torques(some, problem, peaks[:, TORQUE])
        columns = (*peaks[:, :TORQUE].T, fits, peaks[:, TORQUE], rms, peaks[:, TORQUE + 1])
        for row, figures in zip(rows, np.stack(columns, axis=1).tolist(), strict=True):
            found[row] = OverTask(*figures)
    return found


class Motion(NamedTuple):
    """A linkage on the assembly that it uses, the driver's law, and angles of the driver to sample at."""

    linkage: Linkage
    law: DriverLaw
    theta2: FloatArray


def task_peaks(
    linkages: Sequence[Linkage], problem: Problem, verdicts: Sequence[Verdict], *, torque_alone: bool = False
) -> FloatArray:
    """Greatest magnitudes over the task motions, shape (n, 6).

    omega4 in rad/s, speed and acceleration of P, angular acceleration of the output in rad/s^2, torque (at
    `TORQUE`) in N m and force in any joint in N; all but the torque NaN with `torque_alone`, the acceleration
    where no output turns. At the speed of the problem's dynamics, else 1 rad/s; NaN where no motion joins the
    targets, of the last two also without dynamics or where a slide travels beyond the rows of a load.
    """
    found = np.full((len(linkages), TORQUE + 2), np.nan)
    for rows, some in joined_motions(linkages, problem, verdicts):
        found[rows] = _peaks_of(some, problem, torque_alone=torque_alone)
    return found


def joined_motions(
    linkages: Sequence[Linkage], problem: Problem, verdicts: Sequence[Verdict]
) -> Iterator[tuple[list[int], list[Motion]]]:
    """Motions that join the targets, with their rows: those of a kind together where the driver is steady."""
    motions = {}
    for k, (linkage, verdict) in enumerate(zip(linkages, verdicts, strict=True)):
        used, ends = as_used(linkage, verdict), motion_ends(problem.task, verdict)
        theta2 = sampled(used, *ends)
        if joins(used, verdict, theta2):
            motions[k] = Motion(used, driver_law(problem, *ends), theta2)
    steady = [k for k, motion in motions.items() if motion.law.motor.steady]
    groups = [[steady[row] for row in rows] for rows in by_kind([motions[k].linkage for k in steady])]
    for group in (*groups, *([k] for k in motions if k not in set(steady))):
        for first in range(0, len(group), _TOGETHER):
            rows = group[first : first + _TOGETHER]
            yield rows, [motions[k] for k in rows]


def _peaks_of(some: Sequence[Motion], problem: Problem, *, torque_alone: bool = False) -> FloatArray:
    """Rows of `task_peaks`."""
    found = np.full((len(some), TORQUE + 2), np.nan)
    with warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
        if not torque_alone:
            batch, law, stretches = _together(some)
            outputs = problem.task.output_links(batch.mechanism)
            curves = _speeds(batch, law, outputs)
            found[:, :TORQUE] = peaks(curves, stretches, SMOOTH)[0].reshape(TORQUE, -1).T
            if not outputs:
                found[:, TORQUE - 1] = np.nan
        if problem.dynamics is not None:
            metre, rows = metres(problem.length_unit), 1 if torque_alone else 2
            found[:, TORQUE : TORQUE + rows] = _loads(some, problem.dynamics, metre, rows).T
    return found


def _rms_torques(some: Sequence[Motion], problem: Problem, peak: FloatArray) -> FloatArray:
    """Root mean squares (n,) over time of drive torques with these peaks, whose NaN and infinity stay."""
    found, rows = peak.copy(), np.flatnonzero(np.isfinite(peak))
    if problem.dynamics is not None and rows.size:
        with warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
            loaded = [some[row] for row in rows.tolist()]
            found[rows] = np.sqrt(_mean_squares(loaded, problem.dynamics, metres(problem.length_unit)))
    return found


def _mean_squares(some: Sequence[Motion], spec: DynamicsSpec, metre: float) -> FloatArray:
    """Means (n,) of the squared torques; of some only by panels that are split where one is not smooth."""
    found, rough = np.empty(len(some)), set(range(len(some)))
    if some[0].law.motor.steady:
        start, end = _ends(some)
        for rows, motion, edges in with_edges(batch_of(some), start, end, _PANELS):
            batch, law, _ = _together([some[row] for row in rows.tolist()])
            squares, at = _squares(batch, spec, metre, law), motion.theta2
            sums, settled = settled_sums(lambda t: squares(at(t)) * motion.rate(t), edges)  # noqa: B023
            moved = settled & (start != end)[rows]
            found[rows[moved]] = sums[moved] / (end - start)[rows[moved]]
            rough -= set(rows[moved].tolist())
    for row in rough:
        linkage, law, _ = some[row]
        found[row] = mean_in_time(linkage, law, _squares(linkage, spec, metre, law), _PANELS)[0]
    return found


def _squares(linkage: Linkage, spec: DynamicsSpec, metre: float, law: DriverLaw | SteadyDrivers) -> Curve:
    curves = load_curves(linkage, spec, metre, law)
    return lambda place: curves(place)[0] ** 2


def load_curves(linkage: Linkage, spec: DynamicsSpec, metre: float, law: DriverLaw | SteadyDrivers) -> Curve:
    """|torque| in N m and the greatest joint force in N, each a row, over places of the law."""
    masses = stated_masses(linkage, spec, metre)
    loads = stated_loads(spec, metre, lambda state: law.time_at(state.theta2))

    def curves(place: FloatArray) -> FloatArray:
        found = inverse_dynamics(solve_kinematics(linkage, *law.at_place(place)), masses, loads)
        force = np.max([found.joint_force(joint) for joint in joints_of(linkage)], axis=0)
        return np.stack([metre**2 * np.abs(found.torque), metre * force])

    return curves


def _speeds(linkage: Linkage, law: DriverLaw | SteadyDrivers, outputs: Sequence[int]) -> Curve:
    """|omega4|, speed and acceleration of P, |alpha| of the outputs, each a row, over places of the law."""

    def curves(place: FloatArray) -> FloatArray:
        state = solve_kinematics(linkage, *law.at_place(place))
        alphas = [np.abs(state.angular(link).alpha) for link in outputs] or [np.zeros(state.shape)]
        rows = np.abs(state.omega4), state.p.speed, state.p.acceleration_magnitude, np.max(alphas, axis=0)
        return np.stack(rows)

    return curves


def _loads(some: Sequence[Motion], spec: DynamicsSpec, metre: float, rows: int) -> FloatArray:
    """The first rows of `load_curves` where they are greatest, shape (rows, n)."""
    batch, law, stretches = _together(some)
    try:
        curves = load_curves(batch, spec, metre, law)
        return peaks(lambda place: curves(place)[:rows], stretches)[0].reshape(rows, -1)
    except BeyondLoadError:  # a defect by itself, of one of them
        each = np.full((rows, 1), np.nan)
        return each if len(some) == 1 else np.hstack([_loads([one], spec, metre, rows) for one in some])


def batch_of(some: Sequence[Motion]) -> Linkage:
    """The linkages of motions as a batch (n,)."""
    return some[0].linkage.stacked([each.linkage for each in some])


def _ends(some: Sequence[Motion]) -> FloatArray:
    """Driver angles at the beginnings and the ends of motions, shape (2, n), rad."""
    return np.array([(each.law.start, each.law.start + each.law.rotation) for each in some]).T


def _together(some: Sequence[Motion]) -> tuple[Linkage, DriverLaw | SteadyDrivers, list[FloatArray]]:
    """Linkages as a batch with its driver and its samples, shape (n, N); rows repeat their last sample."""
    linkage, law, theta2 = some[0]
    if not law.motor.steady:
        return linkage, law, law.stretches(theta2)
    batch = batch_of(some)[:, None]
    start, omega2 = np.array([(each.law.start, each.law.omega2) for each in some]).T[..., None]
    return batch, SteadyDrivers(start, omega2), [samples_of(some)]


def samples_of(some: Sequence[Motion]) -> FloatArray:
    """Driver angles of motions, shape (n, N), rad; rows repeat their last sample."""
    most = max(len(each.theta2) for each in some)
    return np.stack([np.pad(each.theta2, (0, most - len(each.theta2)), mode="edge") for each in some])


def uncovered_loads(linkage: Linkage, problem: Problem, verdict: Verdict) -> Iterator[Defect]:
    """Loads over the travel of a slide that do not cover all of it."""
    loads = () if problem.dynamics is None else problem.dynamics.loads
    over = {index: load.values for index, load in enumerate(loads) if load.over == "travel" and load.values}
    if not over or not linkage.mechanism.slides:
        return
    linkage = as_used(linkage, verdict)
    theta2 = sampled(linkage, *motion_ends(problem.task, verdict))
    if not joins(linkage, verdict, theta2):
        return

    def travels(angles: FloatArray) -> FloatArray:
        travel = solve_position(linkage, angles).travel
        return np.stack([travel, -travel])

    high, low = peaks(travels, [theta2])[0] * [1.0, -1.0]
    for index, rows in over.items():
        least, most = rows[0][0], rows[-1][0]
        slack = TRAVEL_ROUNDING * max(abs(least), abs(most))
        for found, miss in ((low, least - low), (high, high - most)):
            if miss > slack:
                what = f"the travel of the slide under loads[{index}]"
                yield Defect(
                    "loads", what, float(found), f"{least:g} to {most:g}", float(miss / problem.task.size)
                )
