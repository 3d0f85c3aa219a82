"""Contradictions of a wanted torque with the task, the requirements or the drive."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grashof.problems.values.arrays import TURN
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.wanted_torque import WantedTorque
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.linkages.mechanisms import joined
from grashof.problems.values.requirements.requirements import Requirements
from grashof.problems.values.tasks.task import Task

MOST_TARGETS = 40  # with which a search also fits a torque
_ROUNDING = 1e-9  # rad


def wrong(
    torque: WantedTorque,
    task: Task,
    wanted: Requirements,
    dynamics: DynamicsSpec | None,
    kinds: Sequence[str],
) -> list[str]:
    """Contradictions, a line each.

    Examples
    --------
    >>> from grashof.problems import PathTask
    >>> points = PathTask([[0, 0], [1, 0], [2, 0]])
    >>> wrong(WantedTorque([(3, 1), (4, 2)], over="target"), points, Requirements(), None, ["four-bar"])
    ['dynamics is missing; torque.wanted needs it', 'torque.wanted[1] has target 4; the task has 3']
    """
    found = []
    if dynamics is None:
        found.append("dynamics is missing; torque.wanted needs it")
    elif dynamics.motor is not None and not dynamics.motor.steady and torque.over != "share":
        found.append(f'torque.over is "{torque.over}"; it must be "share" where [motor] has a profile')
    if not wanted.same_branch:
        found.append("requirements.same_branch is false; it must be true with torque.wanted")
    last = len(torque.wanted) - 1
    if torque.over == "target" and torque.places[-1] >= len(task):
        found.append(f"torque.wanted[{last}] has target {torque.wanted[-1][0]:g}; the task has {len(task)}")
    if torque.over == "target" and not wanted.order:
        found.append('requirements.order is false; it must be true with torque.over = "target"')
    if torque.over == "driver":
        found += _beyond(
            torque, task, wanted, f"torque.wanted[{last}] has driver {torque.wanted[-1][0]:g} deg"
        )
    if torque.weight and (wanted.is_exact(task) or task.zones is not None or not task.in_plane):
        found.append(
            f"torque.weight is {torque.weight:g}; it must be 0 unless targets with places or angles are met "
            "by least squares (requirements.exact = false)"
        )
    elif torque.weight and len(task) > MOST_TARGETS:
        found.append(
            f"torque.weight is {torque.weight:g}; it must be 0 for more than {MOST_TARGETS} targets, "
            f"and the task has {len(task)}"
        )
    elif torque.weight and not set(kinds) <= set(ONE_LOOP):
        others = joined([kind for kind in kinds if kind not in ONE_LOOP])
        found.append(f"torque.weight is {torque.weight:g}; it must be 0 with mechanism {others}")
    return found


def _beyond(torque: WantedTorque, task: Task, wanted: Requirements, given: str) -> list[str]:
    """Rows that the motion of the driver may not reach."""
    farthest = float(torque.places[-1])
    if task.closed or task.is_timed:
        reach = TURN if task.closed else float(np.nanmax(task.driver_turns))
        beyond = farthest > reach + _ROUNDING
        return [f"{given}; the task turns the driver by {np.degrees(reach):.6g} deg"] if beyond else []
    limits = wanted.driver_rotation_deg
    if limits is not None and np.radians(limits[0]) >= farthest - _ROUNDING:
        return []
    return [
        f"{given}; requirements.driver_rotation_deg must be from {np.degrees(farthest):.6g} or more, "
        'or torque.over "share"'
    ]
