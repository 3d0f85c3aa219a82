"""Zones that are too small: how large they would have to be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.analysis import verify
from grashof.analysis.judge.design import Constraint
from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.zones import MISSED, shares
from grashof.synth.results.relaxed_limits import Relaxation


def wider(
    problem: Problem, constraints: Sequence[Constraint], known: Sequence[Candidate]
) -> list[Relaxation]:
    """Larger zones, or a greater tolerance, by which the nearest of some designs would do; one at most.

    The `known` designs are judged against all requirements; the judge has accepted the one named under
    the larger zones.
    """
    if problem.zones is None:
        return []
    near = [one for one in known if {defect.requirement for defect in one.verdict.defects} <= MISSED]
    for one in sorted(near, key=lambda one: (max(shares(problem, one.verdict)), one.id)):
        asked, words = _enlarged(problem, shares(problem, one.verdict))
        if verify(
            one.linkage,
            asked.task,
            asked.requirements,
            constraints,
            problem=asked,
            cylinder=one.verdict.cylinder,
        ).ok:
            miss = max(defect.miss for defect in one.verdict.defects)
            own = tuple(constraints)
            return [Relaxation("within", words, asked.requirements, own, one, miss, words.count(" and ") + 1)]
    return []


def _enlarged(problem: Problem, times: tuple[float, float]) -> tuple[Problem, str]:
    """The problem with zones so many times as large, and what changes in its file, in words."""
    task, wanted = problem.task, problem.requirements
    if task.zones is None:  # a tolerance
        tolerance = up(wanted.tolerance * max(times))
        words = f"tolerance {tolerance:g} instead of {wanted.tolerance:g}"
        changed = replace(wanted, tolerance=min(tolerance, 1.0))
        return replace(problem, requirements=changed), words
    given = task.stated_zones
    least = dict(zip(("within", "angle_within"), times, strict=True))
    if len(given) == 1:  # it stands for both
        (only,) = given
        least = {only: max(times)}
    larger, changes = dict[str, FloatArray](), list[str]()
    for name, zone in given.items():
        if least[name] <= 1:
            continue
        unit, key = (np.degrees(1.0), "angle_within_deg") if name == "angle_within" else (1.0, name)
        if np.ptp(zone) == 0:
            size = up(float(zone[0] * unit * least[name]))
            larger[name] = np.full(len(zone), size / unit)
            changes.append(f"{key} {size:g} instead of {zone[0] * unit:.6g}")
        else:
            factor = up(least[name])
            larger[name] = zone * factor
            changes.append(f"{key} {factor:g} times as large")
    if "angle_within" in larger:
        larger["angle_within"] = np.minimum(larger["angle_within"], np.pi)
    return replace(problem, task=task.with_zones(**larger)), " and ".join(changes)


def up(value: float) -> float:
    """A number rounded up to three digits."""
    if not 0 < value < np.inf:
        return value
    step = 10.0 ** (np.floor(np.log10(value)) - 2)
    return float(f"{np.ceil(value / step * (1 - 1e-12)) * step:.3g}")
