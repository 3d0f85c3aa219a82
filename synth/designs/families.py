"""Families: designs that are alike, so that a list shows each kind once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.analysis import rotatability, solve_position
from grashof.problems import FourBar, Objective, Problem, Task
from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.problems.values.linkages.linkage import by_kind
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.requirements.modes import Rotatability, TransmissionOver
from grashof.problems.values.specs.problem import SMALLEST
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.ranking import ranked
from grashof.synth.theory.cognates import same_curve
from grashof.synth.theory.distinct import apart, mirrored, signatures
from grashof.synth.theory.symmetry import symmetries

ALIKE = 0.05  # share of the largest number of two designs by which they differ at most
# Of the size of the task, between joints: near one another, and as good as in one place; deg.
AKIN, SHARED, SAME_ANGLE = 0.15, 0.03, 1.0
OBJECTIVE = "objective"
# In sizes of the task; rad of the driver; rad over the turn of a full crank; as `rotatability_margin`.
MOST_SIZE, LEAST_ROTATION, LEAST_TRANSMISSION, LEAST_MARGIN = 3.0, np.radians(15.0), np.radians(15.0), 0.01


def listed(problem: Problem, candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Distinct designs with their families: the best of each, best first, then all others, best first."""
    best_first = [replace(each, caution=caution(problem, each)) for each in ranked(problem, candidates)]
    if not best_first:
        return ()
    if best_first[0].caution and problem.by_objective and not all(each.caution for each in best_first):
        # the best one by the objective says so where it has a caution
        best_first[0] = replace(best_first[0], best_at=best_first[0].best_at or OBJECTIVE)
    best_first.sort(key=lambda each: bool(each.caution))  # those with a caution come after all others
    first = best_related(problem, best_first)
    named = [
        replace(candidate, family=best_first[best].id)
        for candidate, best in zip(best_first, first.tolist(), strict=True)
    ]
    heads = first == np.arange(len(named))
    doubted = np.array([bool(each.caution) for each in named])
    return tuple(named[i] for i in np.lexsort((np.arange(len(named)), ~heads, doubted)))


def best_related(problem: Problem, best_first: Sequence[Candidate]) -> IntArray:
    """Index of the best design of the family of each, shape (n,): one that is like it or akin to it.

    Like it are those of `best_alike`. Akin are four-bars whose pivots and moving joints at the first target
    are near those of the other, in sizes of the task, also with driver and output exchanged; and those that
    share one of its dyads and its transmission angle, which that dyad then decides.
    """
    task, first = problem.task, np.arange(len(best_first))
    for alike_in_kind in by_kind([candidate.linkage for candidate in best_first]):
        mine, kind = np.array(alike_in_kind), best_first[alike_in_kind[0]].linkage.mechanism
        alike = best_alike(task, signatures(task, [best_first[k].linkage for k in mine]), kind)
        if len(kind.loops) == 1 and not kind.slides and problem.task.limits_size:
            heads = np.flatnonzero(alike == np.arange(len(mine)))
            akin = _akin([best_first[k] for k in mine[heads]], problem.task.size)
            alike = heads[akin][np.searchsorted(heads, alike)]
        first[mine] = mine[alike]
    return first


def _akin(heads: Sequence[Candidate], size: float) -> IntArray:
    """Index of the first design, best first, that each one is akin to, shape (n,)."""
    dyads = np.array([_dyads(each) for each in heads]) / size
    mu = np.degrees([each.verdict.transmission_min_task for each in heads])
    best = np.arange(len(heads))
    left = best.copy()
    while left.size:
        one, left = left[0], left[1:]
        apart_by = np.abs(dyads[left, None] - np.stack([dyads[one], dyads[one][::-1]])).max(axis=-1)
        near = (apart_by.max(axis=-1) < AKIN).any(axis=-1)
        shared = (apart_by.min(axis=-1) < SHARED).any(axis=-1) & (np.abs(mu[left] - mu[one]) < SAME_ANGLE)
        best[left[near | shared]] = one
        left = left[best[left] != one]
    return best


def _dyads(candidate: Candidate) -> FloatArray:
    """Ground pivot and moving joint at the first target, of the driver and of the output, shape (2, 4)."""
    linkage, verdict = candidate.linkage, candidate.verdict
    at = solve_position(linkage, verdict.theta2[:1], int(verdict.assembly[0]))
    ends = (getattr(linkage, name) for name in linkage.mechanism.ground)
    return np.array([[*pivot, *joint[0]] for pivot, joint in zip(ends, (at.a, at.b), strict=True)])


def best_alike(task: Task, signatures: FloatArray, kind: Mechanism = FourBar.mechanism) -> IntArray:
    """Index of the best design of those like each one, all of one kind.

    Alike are designs less than 5 % apart in all dimensions, and on paths those that trace the same coupler
    curve (cognates); also after a reflection or rotation that the task allows (`symmetries`).
    All members of a family are like its best one; a design like another member alone is not in it.
    Signatures (n, 9), best first, have pivots measured from the middle of the task.
    """
    one_loop = len(kind.loops) == 1
    maps = symmetries(task) if one_loop else symmetries(task)[:1]
    best = np.arange(len(signatures))
    left = best.copy()
    while left.size:
        first, left = left[0], left[1:]
        one = signatures[first]
        cognates = one_loop and not kind.slides and not (task.has_angle.any() or task.has_output.any())
        curves = same_curve(one, task.is_timed) if cognates else one[None]
        near = left[_alike_in_shape(curves, signatures[left])] if one_loop else left
        images = np.concatenate([each.of(curves, mirrored(kind)) for each in maps])
        best[near[(apart(images, signatures[near]) < ALIKE).any(axis=0)]] = first
        left = left[best[left] != first]
    return best


def _alike_in_shape(curves: FloatArray, others: FloatArray) -> BoolArray:
    """Whether each of others (n, 9) may be like any of the curves (k, 9)."""
    # by invariants of rotations and reflections: far fewer are left for the full comparison
    (one, reach), (other, others_reach) = _shape(curves), _shape(others)
    differ = np.abs(one[:, None] - other).max(axis=-1)
    alike: BoolArray = (differ < ALIKE * np.maximum(reach[:, None], others_reach)).any(axis=0)
    return alike


def _shape(signatures: FloatArray) -> tuple[FloatArray, FloatArray]:
    """r2, r3, abs(r4), u, abs(v), and the most that any number can be after a rotation; (n, 5) and (n,)."""
    shape = np.concatenate([signatures[:, [4, 5, 7]], np.abs(signatures[:, [6, 8]])], axis=1)
    pivots = np.hypot(signatures[:, [0, 2]], signatures[:, [1, 3]])
    reach: FloatArray = np.abs(np.concatenate([shape, pivots], axis=1)).max(axis=1)
    return shape, reach


def caution(problem: Problem, candidate: Candidate) -> str:
    """Why a design is hard to build or to drive, in words; else empty. Such designs come last in a list."""
    # designs for an objective that the user states are judged by that
    if candidate.own_objective is not None or problem.objective not in (Objective(), SMALLEST):
        return ""
    wanted, verdict, found = problem.requirements, candidate.verdict, list[str]()
    # functions and strokes have no size to compare with, lists by least squares offer small designs anyway
    sized = problem.task.in_plane and problem.by_objective and wanted.size is None
    if sized and verdict.size > MOST_SIZE * problem.task.size:
        found.append(f"{verdict.size / problem.task.size:.1f} times the size of the task")
    turned = float(np.ptp(verdict.theta2))
    # quantities that the user limits are judged by those limits alone
    chosen = wanted.driver_rotation_deg is not None or problem.task.is_timed
    if not chosen and turned < LEAST_ROTATION:
        found.append(f"the driver turns by {np.degrees(turned):.1f} deg alone")
    if wanted.rotatability is not Rotatability.ANY and verdict.full_rotation:
        limited = wanted.transmission_over is TransmissionOver.CYCLE and wanted.transmission_min_deg > 0
        if not limited and verdict.transmission_min_cycle < LEAST_TRANSMISSION:
            worst = np.degrees(verdict.transmission_min_cycle)
            found.append(f"transmission angle {worst:.1f} deg somewhere in the turn")
        margin = float(rotatability(candidate.linkage).min())
        if wanted.rotatability_margin == problem.task.usual_margin and margin < LEAST_MARGIN:
            found.append(f"it nearly folds: {margin:.4f} left of its lengths")
    return "; ".join(found)
