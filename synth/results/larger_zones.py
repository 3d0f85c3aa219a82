"""Zones that are too small, and the size that would suffice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from grashof.analysis.judge.design import Constraint
from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import MISSED, shares
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.relaxed_limits import Relaxation, accepted
from grashof.synth.results.trade_offs import started_at
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.run import Run

HALF = 0.5  # of the enlargement needed at first: near it the sum of the misses is made small
CLOSER = (0.8, 0.95)  # of the enlargement needed so far: the shares that are tried, the first and the last


def nearest_zones(
    scaled: ScaledProblem, starts: Sequence[Start], known: Sequence[Candidate], first: int, run: Run
) -> tuple[list[Attempt], int]:
    """Designs for which zones need little enlargement, the `known` ones too, and the number of solves."""
    problem, zones = scaled.problem, scaled.zones
    made, solved = [Attempt("", one) for one in known], 0

    def tried(share: float, begun: Sequence[Start], need: FloatArray) -> Candidate | None:
        nonlocal made, solved
        larger = replace(scaled, zones=zones * np.maximum(1.0, share * need)[:, None])
        attempts = run.solve(larger, list(begun), first + solved)
        made, solved = attempts + made, solved + len(attempts)
        found = _missing_zones(problem, [one.candidate for one in made if one.candidate is not None])
        return found[0] if found else None

    if zones is None or not starts or run.ended():
        return made, solved
    need = min((_need(problem, one) for one in known), key=np.max, default=np.ones(2))
    nearest = tried(HALF, [start.under(relaxed=("within",)) for start in starts], need)
    share, last = CLOSER
    # reduced while a design is found, by less where none is
    while nearest is not None and share <= last and not run.ended():
        need = _need(problem, nearest)
        if need.max() <= 1:
            break
        like = starts[0]
        here = started_at(scaled, nearest, like.terms.objective, most_error=like.terms.most_error, zoned=True)
        nearest = tried(share, [*starts, here], need) or nearest
        if _need(problem, nearest).max() > (1 + share) / 2 * need.max():
            share = float(np.sqrt(share))
    return made, solved


def wider(
    problem: Problem, constraints: Sequence[Constraint], known: Sequence[Candidate]
) -> list[Relaxation]:
    """Larger zones, or a greater tolerance, under which the nearest of some designs would do; at most one."""
    if problem.zones is None:
        return []
    # designs are judged by all requirements, the one named also under the larger zones
    for one in _missing_zones(problem, known):
        asked, words = _enlarged(problem, shares(problem, one.verdict))
        if accepted(one, asked, asked.requirements, constraints):
            miss = max(defect.miss for defect in one.verdict.defects)
            own = tuple(constraints)
            return [Relaxation("within", words, asked.requirements, own, one, miss, words.count(" and ") + 1)]
    return []


def _missing_zones(problem: Problem, known: Sequence[Candidate]) -> list[Candidate]:
    """Designs that miss nothing but their zones, the nearest first."""
    near = [one for one in known if {defect.requirement for defect in one.verdict.defects} <= MISSED]
    return sorted(near, key=lambda one: (max(shares(problem, one.verdict)), one.id))


def _need(problem: Problem, one: Candidate) -> FloatArray:
    """Factors by which zones of positions and of angles would have to grow."""
    need = np.array(shares(problem, one.verdict))
    return need if len(problem.task.stated_zones) == 2 else np.full(2, need.max())


def _enlarged(problem: Problem, times: tuple[float, float]) -> tuple[Problem, str]:
    """The problem with zones enlarged by two factors, and the change of its file in words."""
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
