"""Linkages placed within the zones of their targets, where least squares leave one of them."""

from __future__ import annotations

from functools import partial

import numpy as np

from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion, misses, task_motion
from grashof.analysis.judge.meeting.timed import STARTS, first_ranges
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import greatest
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, IntArray, turned_from

_BESIDE, _LOOKS = 0.5, 81  # rad to either side of a pose, and driver angles there
_CLOSER = 9  # rounds to the angle of the least share


def first_within(
    linkage: Linkage,
    task: Task,
    zones: FloatArray,
    targets: Targets,
    motion: TaskMotion,
    *,
    same_branch: bool,
) -> tuple[Targets, TaskMotion]:
    """Timed targets, where one misses its zone, from the first angle of the least greatest share of one."""
    if not (targets.shares(zones) > 1).any():
        return targets, motion
    own = int(linkage.assembly)
    signs = np.array([own] if same_branch else [own, -own])

    def placed(starts: FloatArray, turn: FloatArray) -> Targets:
        theta2 = starts[..., None] + turn
        by_side = misses(linkage, task, theta2, signs.reshape(-1, *[1] * theta2.ndim))
        return Targets.of(linkage, task, theta2, signs[np.argmin(by_side, axis=0)])

    found = list[tuple[float, float, int]]()
    for sense in (1, -1):
        turn = sense * task.driver_turns
        for low, high in first_ranges(linkage, float(turn[-1]), same_branch):
            least, at = greatest(
                lambda starts: -placed(starts, turn).shares(zones).max(axis=-1),  # noqa: B023
                np.linspace(low, high, STARTS + 1),
                rounds=_CLOSER,
            )
            found.append((-float(least[0]), float(at[0]), sense))
    if not found:
        return targets, motion
    _, first, sense = min(found)
    first -= TURN * np.round(first / TURN)
    there = placed(np.array(first), sense * task.driver_turns)
    return there, TaskMotion.ordered(there.theta2, sense)


def each_within(
    linkage: Linkage, task: Task, zones: FloatArray, targets: Targets, motion: TaskMotion, *, ordered: bool
) -> tuple[Targets, TaskMotion]:
    """Poses that miss a zone moved to the driver angle of the least share near by, in order if `ordered`."""
    missed = np.flatnonzero(targets.shares(zones) > 1)
    if not missed.size:
        return targets, motion
    ordered &= motion.in_order
    theta2, sense = (motion.theta2 if ordered else targets.theta2).copy(), motion.direction
    halves = missed[missed % 2 == 0], missed[missed % 2 == 1]  # so that no two in turn pass each other
    for some in (each for each in halves if each.size):
        low, high = theta2[some] - _BESIDE, theta2[some] + _BESIDE
        if ordered:
            around = np.concatenate([[theta2[-1] - sense * TURN], theta2, [theta2[0] + sense * TURN]])
            before, after = np.sort([around[some], around[some + 2]], axis=0)
            low, high = np.maximum(low, before), np.minimum(high, after)
        shares = partial(_shares, linkage, task, zones, targets.assembly, some)
        least, at = greatest(
            lambda angles: -shares(angles),  # noqa: B023
            np.linspace(low, high, _LOOKS, axis=-1),
            rounds=_CLOSER,
        )
        theta2[some] = np.where(-least[0] < shares(theta2[some][:, None])[:, 0], at[0], theta2[some])
    moved = TaskMotion.ordered(theta2, sense) if ordered else task_motion(linkage, theta2, False)
    return Targets.of(linkage, task, theta2, targets.assembly), moved


def _shares(
    linkage: Linkage, task: Task, zones: FloatArray, assembly: IntArray, some: IntArray, theta2: FloatArray
) -> FloatArray:
    """Shares of their zones by which some targets (K,) are missed at driver angles (..., K, n)."""
    state = solve_position(linkage, theta2, assembly[some, None])
    gap = np.linalg.norm(state.p - task.positions[some, None], axis=-1)
    off = np.abs(turned_from(state.carrying + linkage.body_angle, task.angles[some, None]))
    share = np.fmax(gap / zones[0, some, None], off / zones[1, some, None])
    known: FloatArray = np.nan_to_num(share, nan=np.inf)
    return known
