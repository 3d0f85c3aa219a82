"""Designs that do a task exactly as another one: driven from its other side, or its cognates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import ComplexArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import ROUNDING, Steps, ToJudge, made_linkage
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import (
    GROUPS,
    Configurations,
    Screened,
    judge,
    met,
    violations_apart,
)
from grashof.synth.theory.stopping import overdue

# Requirements that one position cannot show.
_OF_MOTION = [
    GROUPS.index(name) for name in ("driver_sense", "driver_rotation_deg", "output_swing_deg", "stroke")
]


def verified_alike(
    scaled: ScaledProblem, candidate: Candidate, most_error: float = np.inf
) -> Steps[tuple[Candidate, ...]]:
    """Verified linkages that lead the coupler point, or the body, as a verified design does."""
    start = Start.of_linkage(scaled, candidate.linkage, candidate.verdict)
    body, found = scaled.has_angles, list[Candidate]()
    for points in scaled.kind.alike(start.points, timed=scaled.timed, body=body):
        if overdue():
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            turned = np.angle((start.b - start.a) / (points[3] - points[2]))
        if not np.isfinite([*points, turned]).all():
            continue
        at_once = _at_once(scaled, points)
        if met(np.delete(at_once.violations, _OF_MOTION, axis=1))[0]:
            angle = start.body_angle + turned if body else 0.0
            linkage = made_linkage(scaled, points, int(at_once.assembly[0]), float(angle))
            if linkage is None:
                continue
            other = yield ToJudge(linkage, candidate.start, candidate.iterations, most_error)
            if other.verdict.ok and _as_near(scaled, other, candidate):
                found.append(replace(other, cognate_of=candidate.id))
    return tuple(found)


def _as_near(scaled: ScaledProblem, other: Candidate, candidate: Candidate) -> bool:
    """Whether a design is as near to the targets: the cognate of a slider-crank may need both assemblies."""
    allowed = np.sqrt(candidate.verdict.square) * (1 + ROUNDING) + ROUNDING * scaled.problem.task.size
    return bool(np.sqrt(other.verdict.square) <= allowed)


def _at_once(scaled: ScaledProblem, points: ComplexArray) -> Screened:
    """A linkage screened in one position: lengths, pivots, rotatability, which are cheap to compute."""
    o2, o4, a, b, p = points[:, None]
    one, none = np.zeros((1, 1), dtype=np.int64), np.zeros(1)
    theta2 = np.angle(a - o2)[:, None]
    places = Configurations(o2, o4, a[:, None], b[:, None], one, theta2, none + 1, scaled.kind)
    violations = violations_apart(places, p, p[:, None], scaled.wanted)
    return judge(places, p, none, violations, scaled.wanted)
