"""Greatest speeds and loads of judged linkages in their task motions, of many at once."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.from_spec import BeyondLoadError, stated_loads, stated_masses
from grashof.analysis.forces.joints import joints_of
from grashof.analysis.judge.sampled_motion import as_used, driver_law, joins, motion_ends, sampled
from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.driver_law import DriverLaw, SteadyDrivers
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import DeadPositionWarning, DynamicsSpec, Linkage, Problem
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.linkages.linkage import by_kind

_TOGETHER = 32  # more at a time are no faster

Curves = Callable[[FloatArray], FloatArray]


class _Motion(NamedTuple):
    linkage: Linkage
    law: DriverLaw
    theta2: FloatArray


def task_peaks(
    linkages: Sequence[Linkage], problem: Problem, verdicts: Sequence[Verdict], *, torque_alone: bool = False
) -> FloatArray:
    """Greatest magnitudes over the task motions, shape (n, 5).

    omega4 in rad/s, speed and acceleration of P, torque in N m and force in any joint in N; all but the
    torque NaN with `torque_alone`. At the speed of the problem's dynamics, else 1 rad/s; NaN where no motion
    joins the targets, of the last two also without dynamics or where a slide travels beyond the rows of a
    load.
    """
    found = np.full((len(linkages), 5), np.nan)
    motions = {}
    for k, (linkage, verdict) in enumerate(zip(linkages, verdicts, strict=True)):
        used, ends = as_used(linkage, verdict), motion_ends(problem.task, verdict)
        theta2 = sampled(used, *ends)
        if joins(used, verdict, theta2):
            motions[k] = _Motion(used, driver_law(problem, *ends), theta2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeadPositionWarning)
        for group in _groups(motions):
            some = [motions[k] for k in group]
            if not torque_alone:
                batch, law, stretches = _together(some)
                found[group, :3] = peaks(_speeds(batch, law), stretches)[0].reshape(3, -1).T
            if problem.dynamics is not None:
                metre, rows = metres(problem.length_unit), 1 if torque_alone else 2
                found[group, 3 : 3 + rows] = _loads(some, problem.dynamics, metre, rows).T
    return found


def load_curves(linkage: Linkage, spec: DynamicsSpec, metre: float, law: DriverLaw | SteadyDrivers) -> Curves:
    """|torque| in N m and the greatest joint force in N, each a row, over places of the law."""
    masses = stated_masses(linkage, spec, metre)
    loads = stated_loads(spec, metre, lambda state: law.time_at(state.theta2))

    def curves(place: FloatArray) -> FloatArray:
        found = inverse_dynamics(solve_kinematics(linkage, *law.at_place(place)), masses, loads)
        force = np.max([found.joint_force(joint) for joint in joints_of(linkage)], axis=0)
        return np.stack([metre**2 * np.abs(found.torque), metre * force])

    return curves


def _speeds(linkage: Linkage, law: DriverLaw | SteadyDrivers) -> Curves:
    """|omega4|, speed and acceleration of P, each a row, over places of the law."""

    def curves(place: FloatArray) -> FloatArray:
        state = solve_kinematics(linkage, *law.at_place(place))
        return np.stack([np.abs(state.omega4), state.p.speed, state.p.acceleration_magnitude])

    return curves


def _loads(some: Sequence[_Motion], spec: DynamicsSpec, metre: float, rows: int) -> FloatArray:
    """The first rows of `load_curves` where they are greatest, shape (rows, n)."""
    batch, law, stretches = _together(some)
    try:
        curves = load_curves(batch, spec, metre, law)
        return peaks(lambda place: curves(place)[:rows], stretches)[0].reshape(rows, -1)
    except BeyondLoadError:  # a defect by itself, of one of them
        each = np.full((rows, 1), np.nan)
        return each if len(some) == 1 else np.hstack([_loads([one], spec, metre, rows) for one in some])


def _groups(motions: Mapping[int, _Motion]) -> Iterator[list[int]]:
    """Those of a kind, so many at a time; each by itself where the driver is not steady."""
    steady = [k for k, motion in motions.items() if motion.law.motor.steady]
    groups = [[steady[row] for row in rows] for rows in by_kind([motions[k].linkage for k in steady])]
    for group in (*groups, *([k] for k in motions if k not in set(steady))):
        for first in range(0, len(group), _TOGETHER):
            yield group[first : first + _TOGETHER]


def _together(some: Sequence[_Motion]) -> tuple[Linkage, DriverLaw | SteadyDrivers, list[FloatArray]]:
    """Linkages as a batch with its driver and its samples, shape (n, N); rows repeat their last sample."""
    linkage, law, theta2 = some[0]
    if not law.motor.steady:
        return linkage, law, law.stretches(theta2)
    batch = linkage.stacked([each.linkage for each in some])[:, None]
    start, omega2 = np.array([(each.law.start, each.law.omega2) for each in some]).T[..., None]
    most = max(len(each.theta2) for each in some)
    rows = [np.pad(each.theta2, (0, most - len(each.theta2)), mode="edge") for each in some]
    return batch, SteadyDrivers(start, omega2), [np.stack(rows)]
