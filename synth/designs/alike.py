"""Designs that do a task exactly as another one: driven from its other side, or its cognates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import ROUNDING, Steps, ToJudge, made_linkage
from grashof.synth.programme.start import Start
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.quantities.driver_motion import meeting_order, shorter_way
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Configurations, Screened, judge, violations_apart
from grashof.synth.theory.stopping import overdue

SLIGHT = 1e-6  # sizes, rad or ratio: violations that the judge decides on


def verified_alike(
    scaled: ScaledProblem, candidate: Candidate, most_error: float = np.inf
) -> Steps[tuple[Candidate, ...]]:
    """Verified linkages that lead the coupler point, or the body, as a verified design does."""
    start = Start.of_linkage(scaled, candidate.linkage, candidate.verdict)
    found = list[Candidate]()
    for one in _hopeful(scaled, start):
        if overdue():
            break
        (points,), (assembly,), (angle,) = one.points, one.assembly, one.body_angle
        linkage = made_linkage(scaled, points, int(assembly), float(angle))
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


def _hopeful(scaled: ScaledProblem, start: Start) -> list[Screened]:
    """Linkages that move alike, each by itself, without those that break a requirement at these targets."""
    visit = np.argsort(start.visit)
    a, b, p = start.track[:, visit]
    still = np.ones_like(a)
    with np.errstate(divide="ignore", invalid="ignore"):
        every = scaled.kind.alike(
            np.stack([start.o2 * still, start.o4 * still, a, b, p]),
            timed=scaled.timed,
            body=scaled.has_angles,
        )
        alike = np.array([one for one in every if np.isfinite(one).all()]).reshape(-1, 5, len(a))
        turned = np.angle((b[0] - a[0]) / (alike[:, 3, 0] - alike[:, 2, 0]))
    alike, turned = alike[np.isfinite(turned)], turned[np.isfinite(turned)]
    if not len(alike):
        return []
    angle = start.body_angle + turned if scaled.has_angles else np.zeros(len(turned))
    found = fully_screened(scaled, _screened(scaled, alike, angle))
    hopeful = np.flatnonzero(found.violations.max(axis=1) <= SLIGHT).tolist()
    return [found[k : k + 1] for k in hopeful]


def _screened(scaled: ScaledProblem, places: ComplexArray, angle: FloatArray) -> Screened:
    """Linkages by O2, O4, A, B, P at every target (n, 5, N), and the angle of the body (n,), rad."""
    o2, o4, a, b, p = places.swapaxes(0, 1)
    theta2 = np.angle(a - o2)
    if scaled.wanted.order:
        visit, (theta2, direction) = np.broadcast_to(np.arange(a.shape[1]), a.shape), shorter_way(theta2)
    else:
        visit, theta2, direction = meeting_order(theta2)
    found = Configurations(o2[:, 0], o4[:, 0], a, b, visit, theta2, direction, scaled.kind)
    violations = violations_apart(found, p[:, 0], p, scaled.wanted)
    return judge(found, p[:, 0], np.zeros(len(p)), violations, scaled.wanted, angle)
