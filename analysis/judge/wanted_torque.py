"""The deviation of the drive torque of a judged linkage from a wanted one."""

from __future__ import annotations

import warnings

import numpy as np

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.from_spec import BeyondLoadError, stated_loads, stated_masses
from grashof.analysis.judge.over_task import as_used, driver_law, joins, motion_ends, sampled
from grashof.analysis.judge.verdict import Verdict
from grashof.problems import DeadPositionWarning, Linkage, Problem, WantedTorque
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.dynamics_spec import metres


def places_of(torque: WantedTorque, problem: Problem, verdict: Verdict) -> FloatArray:
    """Driver angles of the rows of a wanted torque, shape (K,), rad."""
    start, end = motion_ends(problem.task, verdict)
    found: FloatArray
    if torque.over == "target":
        found = verdict.theta2[torque.places.astype(np.int64)]
    elif torque.over == "share":
        found = start + (end - start) * torque.places
    else:
        found = start + verdict.direction * torque.places
    return found


def torque_misses(linkage: Linkage, problem: Problem, verdict: Verdict) -> FloatArray:
    """The drive torque minus the wanted one at each of its rows.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    problem : Problem
        A problem with dynamics and a wanted torque.
    verdict : Verdict
        Of `verify`: the driver angle at every target.

    Returns
    -------
    ndarray, shape (K,), N m
        Positive where the drive torque, in the sense of link 2 from the first target to the last, is greater
        than the wanted one; NaN where no motion joins the targets or a slide travels beyond the rows of a
        load.

    Examples
    --------
    >>> from grashof.analysis.judge.planted import planted_motion
    >>> from grashof.analysis.judge.verify import verify
    >>> from grashof.problems import DynamicsSpec
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=4)
    >>> problem = Problem(
    ...     task=task,
    ...     length_unit="m",
    ...     dynamics=DynamicsSpec(mass_per_length=2.0),
    ...     torque=WantedTorque([(0, 1), (1, 1)], over="share"),
    ... )
    >>> torque_misses(linkage, problem, verify(linkage, task, problem.requirements)).shape
    (2,)
    """
    spec, torque = problem.dynamics, problem.torque
    if spec is None or torque is None:
        raise TypeError("a problem without dynamics, or a wanted torque, has no deviation from it")
    used, ends = as_used(linkage, verdict), motion_ends(problem.task, verdict)
    missing = np.full(len(torque.wanted), np.nan)
    if not joins(used, verdict, sampled(used, *ends)):
        return missing
    law, metre = driver_law(problem, *ends), metres(problem.length_unit)
    try:
        with warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
            state = law.state(used, places_of(torque, problem, verdict))
            loads = stated_loads(spec, metre, lambda at: law.time_at(at.theta2))
            found = inverse_dynamics(state, stated_masses(used, spec, metre), loads)
    except BeyondLoadError:
        return missing
    misses: FloatArray = verdict.direction * metre**2 * found.torque - torque.torques
    return misses
