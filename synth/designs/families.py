"""Families: designs that are alike, so that a list shows each kind once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.problems import FourBar, Linkage, Problem, Task
from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.ranking import ranked
from grashof.synth.theory.cognates import same_curve
from grashof.synth.theory.distinct import MIRRORED, apart, signature
from grashof.synth.theory.symmetry import middle_of, symmetries

ALIKE = 0.05  # share of the largest number of two designs by which they differ at most


def listed(problem: Problem, candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Distinct designs with their families: the best of each, best first, then all others, best first."""
    best_first = ranked(problem, candidates)
    if not best_first:
        return ()
    middle, first = middle_of(problem.task), np.arange(len(best_first))
    for kind in dict.fromkeys(type(candidate.linkage) for candidate in best_first):
        mine = [k for k, candidate in enumerate(best_first) if type(candidate.linkage) is kind]
        signatures = np.array([signature(best_first[k].linkage, middle) for k in mine])
        first[mine] = np.array(mine)[best_alike(problem.task, signatures, kind)]
    named = [
        replace(candidate, family=best_first[best].id)
        for candidate, best in zip(best_first, first.tolist(), strict=True)
    ]
    heads = first == np.arange(len(named))
    return tuple(named[i] for i in np.argsort(~heads, kind="stable"))


def best_alike(task: Task, signatures: FloatArray, kind: type[Linkage] = FourBar) -> IntArray:
    """Which design is the best of those like each one, all of one kind.

    Alike are designs less than 5 % apart in all dimensions, and on paths those that trace the same
    coupler curve (cognates); also when the one has first to be mirrored or turned as the task allows
    (`symmetries`). All members of a family are like its best one; what is only like another member
    is not in it.

    The `signatures` of the designs, best first, shape (n, 9), have pivots measured from the middle of
    the task.
    """
    maps = symmetries(task)
    best = np.arange(len(signatures))
    left = best.copy()
    while left.size:
        first, left = left[0], left[1:]
        one = signatures[first]
        cognates = kind is FourBar and not (task.has_angle.any() or task.has_output.any())
        curves = same_curve(one, task.is_timed) if cognates else one[None]
        near = left[_alike_in_shape(curves, signatures[left])]
        images = np.concatenate([each.of(curves, MIRRORED[kind]) for each in maps])
        best[near[(apart(images, signatures[near]) < ALIKE).any(axis=0)]] = first
        left = left[best[left] != first]
    return best


def _alike_in_shape(curves: FloatArray, others: FloatArray) -> BoolArray:
    """Which designs any of the curves' may be like, by what rotations and reflections leave as it is.

    Far fewer are left for the closer look; shapes (k, 9) and (n, 9) to (n,).
    """
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
