"""The judge of a cylinder as driver: whether it drives the linkage through its task, within its limits."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress

import numpy as np

from grashof.analysis.cylinder.lengths import CylinderFigures, cylinder_figures, cylinder_force
from grashof.analysis.cylinder.travel import Travel, travel
from grashof.analysis.forces.from_spec import BeyondLoadError, stated_loads, stated_masses
from grashof.analysis.judge.over_task import as_used, driver_law, motion_ends, sampled
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import Cylinder, CylinderSpec, DeadPositionWarning, Linkage, Problem, Task
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.box import Box
from grashof.problems.values.dynamics.dynamics_spec import metres

SLACK = 1e-9  # share of a limit, or of the size of the task
_KEY = "driver.cylinder"


def cylinder_travel(linkage: Linkage, task: Task, verdict: Verdict) -> Travel | None:
    """The task motion as a cylinder drives it, on links 3 and 4 through dead positions; else None."""
    if verdict.branch_ok:
        return travel(linkage, verdict.theta2, verdict.assembly, motion_ends(task, verdict))
    if verdict.cylinder is None or verdict.cylinder.link == 2:
        return None
    return travel(linkage, verdict.theta2, verdict.assembly)


def cylinder_defects(
    spec: CylinderSpec, cylinder: Cylinder | None, moved: Travel | None, size: float
) -> Iterator[Defect]:
    """Limits that a cylinder misses; `cylinder` is None where none was found.

    `moved` is None where no motion joins the targets, which another defect reports; `size` is the length of
    the task.
    """
    if cylinder is None:
        yield Defect(_KEY, "the number of cylinders that drive the linkage within these limits", 0, "1", 1.0)
        return
    if cylinder.on not in spec.on:
        yield Defect(f"{_KEY}.on", "the link driven", cylinder.link, ", ".join(spec.on), 1.0)
    for axis, place in zip("xy", cylinder.base, strict=True):
        allowed = getattr(spec.base or Box(), axis)
        yield from _beyond(f"{_KEY}.base", f"the base's {axis}", place, allowed, size)
    if moved is None:
        return
    found = cylinder_figures(cylinder, moved)
    if not found.monotone:
        what = "the number of senses in which the length changes, or 2 where it is stationary,"
        yield Defect(_KEY, what, 2, "1 (longer all the way, or shorter)", 1.0)
    yield from _beyond(
        f"{_KEY}.closed", "the closed length", found.closed, spec.closed or (0.0, np.inf), size
    )
    ratio = (1.0, spec.ratio_max)
    yield from _beyond(f"{_KEY}.ratio_max", "the greatest length over the least", found.ratio, ratio, 1.0)


def _beyond(key: str, what: str, value: float, allowed: Limits, scale: float) -> Iterator[Defect]:
    low, high = allowed
    miss = max(low - value, value - high) / scale
    if miss > SLACK:
        words = f"up to {high:.6g}" if value > high else f"from {low:.6g}"
        yield Defect(key, what, value, words, miss)


def figures_of(linkage: Linkage, task: Task, verdict: Verdict) -> CylinderFigures | None:
    """Figures of the cylinder of a verdict in the task motion; None without a cylinder or a motion."""
    if verdict.cylinder is None:
        return None
    moved = cylinder_travel(linkage, task, verdict)
    return None if moved is None else cylinder_figures(verdict.cylinder, moved)


def cylinder_force_peak(linkage: Linkage, problem: Problem, verdict: Verdict) -> float:
    """Greatest magnitude of the cylinder's force over the task motion, N; infinite at a stationary length.

    NaN without dynamics, through a dead position of link 2 (whose speed the problem states), or beyond the
    rows of a load.
    """
    force, ends = _force_in(problem, verdict), motion_ends(problem.task, verdict)
    if force is None:
        return np.nan
    theta2, law = sampled(linkage, *ends), driver_law(problem, *ends)

    def size(place: FloatArray) -> FloatArray:
        return np.abs(force(solve_kinematics(as_used(linkage, verdict), *law.at_place(place))))[None]

    # A load that does not cover the travel is a defect by itself.
    with suppress(BeyondLoadError), warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
        return float(peaks(size, law.stretches(theta2))[0][0])
    return np.nan


def cylinder_forces(
    linkage: Linkage, problem: Problem, verdict: Verdict, theta2: FloatArray | None = None
) -> FloatArray:
    """Force of the cylinder that drives a linkage.

    Parameters
    ----------
    linkage : Linkage
    problem : Problem
        Its dynamics give masses, loads and the driver's speed.
    verdict : Verdict
        Of `verify`, with the cylinder.
    theta2 : ndarray, shape (N,), rad, optional
        Driver angles of the task motion; by default those at the targets.

    Returns
    -------
    ndarray, shape (N,), N
        Positive where it pushes; NaN without dynamics or cylinder, and where the motion is torn or a dead
        position requires an infinite force.

    Notes
    -----
    By virtual work, F dL/dtheta2 = T of the inverse dynamics (Norton, *Design of Machinery*, sec. 11.10);
    see `cylinder_force` for friction.

    Examples
    --------
    A jack turns the crank of a parallelogram that lifts 100 kg without tilting it; slowly, it pushes with
    2 m g cos(theta2) / cos(theta2 / 2), as its length is 2 sin(theta2 / 2):

    >>> from grashof.analysis import verify
    >>> from grashof.problems import Cylinder, DynamicsSpec, FourBar, MotionTask, Problem
    >>> linkage = FourBar(o2=(0, 0), o4=(1, 0), r2=2, r3=1, r4=2, coupler_point=(0.5, 0))
    >>> theta2 = np.radians([30, 60])
    >>> lifted = np.stack([0.5 + 2 * np.cos(theta2), 2 * np.sin(theta2)], axis=1)
    >>> slow = DynamicsSpec(payload=100, gravity=(0, -9.81), speed_rpm=1e-4)
    >>> problem = Problem(task=MotionTask(lifted, [0, 0]), dynamics=slow, length_unit="m")
    >>> jack = Cylinder("driver", base=(1, 0), point=(1, 0))
    >>> verdict = verify(linkage, problem.task, problem.requirements, problem=problem, cylinder=jack)
    >>> cylinder_forces(linkage, problem, verdict).round(1).tolist()
    [1759.1, 1132.8]
    """
    theta2 = verdict.theta2 if theta2 is None else theta2
    force, law = _force_in(problem, verdict), driver_law(problem, *motion_ends(problem.task, verdict))
    if force is not None:
        with (
            suppress(BeyondLoadError),
            warnings.catch_warnings(action="ignore", category=DeadPositionWarning),
        ):
            return force(law.state(as_used(linkage, verdict), theta2))
    return np.full(len(theta2), np.nan)


def _force_in(problem: Problem, verdict: Verdict) -> Callable[[Kinematics], FloatArray] | None:
    """The cylinder's force, N, in states of the task motion; None without dynamics, cylinder or motion."""
    spec, cylinder = problem.dynamics, verdict.cylinder
    if spec is None or cylinder is None or not verdict.branch_ok:
        return None
    metre = metres(problem.length_unit)
    law = driver_law(problem, *motion_ends(problem.task, verdict))
    loads = stated_loads(spec, metre, lambda moved: law.time_at(moved.theta2))

    def force(state: Kinematics) -> FloatArray:
        masses = stated_masses(state.linkage, spec, metre)
        return metre * cylinder_force(state, cylinder, masses, loads)

    return force
