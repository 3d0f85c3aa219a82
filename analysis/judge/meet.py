"""How a linkage does a task in the plane: where it meets each target, and the motion between them."""

from __future__ import annotations

import numpy as np

from grashof.analysis.judge.meeting.points import met_in_order, met_singly
from grashof.analysis.judge.meeting.poses import nearest_to_poses, poses_in_order
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion, task_motion
from grashof.analysis.judge.meeting.timed_targets import met_in_time
from grashof.analysis.mechanism.mobility import branch_index
from grashof.problems import Linkage, Requirements, Task
from grashof.problems.values.arrays import TURN


def meet(linkage: Linkage, task: Task, wanted: Requirements) -> tuple[Targets, TaskMotion]:
    """Driver angle, assembly and error at each target, and the motion, of the least weighted squares.

    With `order` in sequence in either sense within one turn, otherwise each by itself; with `same_branch`
    points keep to the own assembly and one range; of equal motions the shortest. Points and timed targets
    begin at `theta2_start_deg`, where it is given.
    """
    if task.is_timed or task.only_points:
        targets, motion = _points_or_timed(linkage, task, wanted)
    else:
        targets, motion = _poses(linkage, task, wanted)
    return targets, motion.closed() if task.closed else motion


def _points_or_timed(linkage: Linkage, task: Task, wanted: Requirements) -> tuple[Targets, TaskMotion]:
    start = None if wanted.theta2_start_deg is None else float(np.radians(wanted.theta2_start_deg))
    method = met_in_time if task.is_timed else met_in_order if wanted.order else met_singly
    anywhere = (start or 0.0) + np.nan_to_num(task.driver_turns), np.full(len(task), int(linkage.assembly)), 1
    theta2, assembly, sense = method(linkage, task, wanted.same_branch, start) or anywhere
    if start is None:
        theta2 = theta2 - TURN * np.round(theta2[0] / TURN)
    motion = TaskMotion.ordered(theta2, sense) if sense else task_motion(linkage, theta2, False)
    return Targets.of(linkage, task, theta2, assembly), motion


def _poses(linkage: Linkage, task: Task, wanted: Requirements) -> tuple[Targets, TaskMotion]:
    targets = nearest_to_poses(linkage, task)
    motion = task_motion(linkage, targets.theta2, wanted.order)
    if wanted.order and not (wanted.is_exact(task) and task.is_whole):
        branch = branch_index(linkage, targets.theta2, targets.assembly)
        joined = (branch == branch[0]).all() and targets.assembly[0] == int(linkage.assembly)
        if not motion.in_order or (wanted.same_branch and not joined):
            return poses_in_order(linkage, task, targets, motion)
    return targets, motion
