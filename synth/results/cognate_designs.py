"""Cognates of a design that do the task, too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import ComplexArray
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import Configurations, dyad_violations, judge, met
from grashof.synth.results.candidate import Candidate
from grashof.synth.results.judging import judged, linkage_of
from grashof.synth.theory.cognates import assembly_of, cognate_points, position_of


def verified_cognates(scaled: ScaledProblem, candidate: Candidate) -> tuple[Candidate, ...]:
    """The cognates of a design without defects."""
    position = position_of(candidate.linkage, float(candidate.verdict.theta2[0]))
    found = []
    for points in cognate_points(position, scaled.timing is not None):
        points = (points - scaled.frame.origin) / scaled.frame.scale
        if not (np.isfinite(points).all() and _worth_judging(scaled, points)):
            continue
        linkage = linkage_of(scaled, points, assembly_of(points), 0.0)
        if linkage is None:
            continue
        other = judged(scaled, linkage, candidate.start, candidate.iterations)
        if other.verdict.ok:
            found.append(replace(other, cognate_of=candidate.id))
    return tuple(found)


def _worth_judging(scaled: ScaledProblem, points: ComplexArray) -> bool:
    """Whether lengths, pivots and rotatability of a linkage are as required: cheap to know beforehand."""
    o2, o4, a, b, p = points[:, None]
    one, none = np.zeros((1, 1), dtype=np.int64), np.zeros(1)
    theta2 = np.angle(a - o2)[:, None]
    places = Configurations(o2, o4, a[:, None], b[:, None], one, theta2, none + 1)
    violations = dyad_violations("o2", o2, a[:, None], p, scaled.wanted)
    violations += dyad_violations("o4", o4, b[:, None], p, scaled.wanted)
    return bool(met(judge(places, p, none, violations, scaled.wanted).violations)[0])
