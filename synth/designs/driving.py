"""The cylinder of a design: the best one for its task motion, where the problem requests one."""

from __future__ import annotations

import warnings
from contextlib import suppress

import numpy as np

from grashof.analysis import Verdict, inverse_dynamics, stated_loads, stated_masses
from grashof.analysis.cylinder.travel import Travel, travel
from grashof.analysis.forces.from_spec import BeyondLoadError
from grashof.analysis.judge.over_task import as_used, driver_law, motion_ends
from grashof.problems import Cylinder, DeadPositionWarning, Linkage, Problem
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.requirements.requirements import LIMITS

_SAMPLES = 129
_NEAR = np.array([1e-3, 3e-3, 0.01, 0.03, 0.1])  # rad, about angles that may be close to a dead position
_OWN = ("driver.cylinder", "cylinder_")  # defects that a cylinder may mend
_OF_LINK2 = {"same_branch", "order"}  # and one on link 3 or 4 alone


def cylinder_for(problem: Problem, linkage: Linkage, verdict: Verdict) -> Cylinder | None:
    """The best cylinder for a linkage judged without one, if one is requested and found."""
    left = {each.requirement for each in verdict.defects if not each.requirement.startswith(_OWN)}
    if problem.driver is None:
        return None
    if left - _OF_LINK2 or (left and verdict.branch_ok):  # it has other defects anyway
        return None
    ends = motion_ends(problem.task, verdict) if verdict.branch_ok else None
    moved = travel(linkage, verdict.theta2, verdict.assembly, ends)
    if moved is None or moved.start == moved.end:
        return None
    at = moved.at(_samples(moved))
    if np.isnan(at.theta3).any():
        return None
    from grashof.synth.cylinder.choice import best_cylinder  # few problems have cylinders

    limit, power = problem.requirements.cylinder_force_max, None
    if limit is not None and verdict.branch_ok:
        power = _power(problem, linkage, verdict, np.unwrap(at.theta2))
    return best_cylinder(
        linkage,
        (at.theta2, at.theta3, at.theta4),
        problem.driver,
        power=power,
        force=np.inf if limit is None or power is None else limit[1],
        rate=_rate(problem, linkage),
        one_branch=verdict.branch_ok,
    )


def _rate(problem: Problem, linkage: Linkage) -> Limits:
    """Limits of the cylinder's rate; linkages whose link 4 slides have none."""
    limits = problem.requirements.cylinder_rate
    has = linkage.mechanism.word in LIMITS["cylinder_rate"].quantity.kinds
    return (0.0, np.inf) if limits is None or not has else limits


def _samples(moved: Travel) -> FloatArray:
    """Places from the first target to the last."""
    way = moved.end - moved.start
    places = moved.start + way * (1 - np.cos(np.linspace(0, np.pi, _SAMPLES))) / 2
    places[-1] = moved.end
    if not moved.turns:
        return places
    theta1, (low, high) = float(moved.linkage.theta1), sorted((moved.start, moved.end))
    aligned = theta1 + np.pi * np.arange(
        np.ceil((low - theta1) / np.pi), np.floor((high - theta1) / np.pi) + 1
    )
    near = (aligned[:, None] + np.concatenate([-_NEAR, [0.0], _NEAR])).ravel()
    every = np.unique(np.concatenate([places, near[(near > low) & (near < high)]]))
    return every if way > 0 else every[::-1]


def _power(problem: Problem, linkage: Linkage, verdict: Verdict, theta2: FloatArray) -> FloatArray | None:
    """Drive torque at driver angles (M,), N times the length; None without dynamics or rows of a load."""
    spec = problem.dynamics
    if spec is None:
        return None
    metre, used = metres(problem.length_unit), as_used(linkage, verdict)
    law = driver_law(problem, *motion_ends(problem.task, verdict))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeadPositionWarning)
        state = law.state(used, theta2)
        loads = stated_loads(spec, metre, lambda moved: law.time_at(moved.theta2))
        with suppress(BeyondLoadError):  # beyond the rows of a load: a defect by itself
            return metre * inverse_dynamics(state, stated_masses(used, spec, metre), loads).torque
    return None
