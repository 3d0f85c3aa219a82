"""Polishing: starts and solves moved onto their targets by the least amount."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.synth.programme.nonlinear_programme import Solve
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import Dyads, polish
from grashof.synth.theory.polish import ExactTargets, Polished, polish_path

NUDGE = 0.1  # sizes: a polish that moves a start farther has lost it
CLOSE = 1e-4  # sizes: error up to which a least-squares design can be made exact


def polished_start(scaled: ScaledProblem, start: Start) -> Start:
    """A start of an exact task moved onto the targets, where that takes no more than a nudge."""
    if not scaled.exact or scaled.motion is not None:  # those of whole poses are there already
        return start
    polished = _on_targets(scaled, start, start)
    if polished is None or np.abs(polished.points - start.points).max() > NUDGE:
        return start
    visit = list(start.visit)
    theta3 = np.unwrap(np.angle(polished.coupler[visit]))
    theta3 += 2 * np.pi * np.round((start.theta3[0] - theta3[0]) / (2 * np.pi))
    theta2 = tuple(polished.theta2[visit].tolist())
    return start.at(polished.points.tolist(), theta2, tuple(theta3.tolist()), polished.body_angle)


def polished_solve(scaled: ScaledProblem, start: Start, solve: Solve) -> Solve:
    """A solve moved onto the targets; unchanged where that leads astray, or targets may be missed."""
    if scaled.motion is not None:
        points = np.array(solve.points)
        dyads = polish(scaled.motion, Dyads(moving=points[2:4], ground=points[:2]))
        return replace(solve, points=(*dyads.ground, *dyads.moving, points[4]))
    polished = None if start.terms.bounded else _on_targets(scaled, start, solve)
    if polished is None:
        return solve
    return replace(solve, points=tuple(polished.points), body_angle=polished.body_angle)


def _on_targets(scaled: ScaledProblem, start: Start, linkage: Start | Solve) -> Polished | None:
    """A linkage polished, with its angles in the order of the targets; None where that leads astray."""
    if not scaled.has_targets:
        return None
    order = np.argsort(start.visit)
    theta2, theta3 = np.array(linkage.theta2)[order], np.array(linkage.theta3)[order]
    points = np.array(linkage.points)
    o2, o4, a, b, p = points
    at_a, turned = o2 + abs(a - o2) * np.exp(1j * theta2), np.exp(1j * theta3)
    at_p = at_a + (p - a) * turned / turned[0]
    if not scaled.exact and scaled.missed(at_p, theta3 + linkage.body_angle) > CLOSE:
        return None
    if scaled.kind.dyad.one_assembly:
        assembly = np.ones(len(theta2))
    else:
        assembly = np.where((turned.conj() * (at_a + abs(b - a) * turned - o4)).imag >= 0, 1.0, -1.0)
    targets = ExactTargets(
        points=scaled.targets,
        has_point=scaled.weights > 0,
        turns=scaled.turns,
        has_turn=scaled.turn_weights > 0,
        timed=scaled.timed,
        dyad=scaled.kind.dyad,
    )
    polished = polish_path(points, theta2, linkage.body_angle, assembly, targets)
    return polished if polished.error < CLOSE and np.isfinite(polished.points).all() else None
