"""Linkages of two or three poses near a wanted torque: many at once, by their free numbers.

The deviation has many local minima, and perhaps no sampled linkage lies in the best one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.quantities.along_motion import torque_misses
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Screened
from grashof.synth.quantities.wanted_torque import DEVIATIONS, rms
from grashof.synth.starts.dyad_pairs import judged_pairs
from grashof.synth.theory.burmester import Displacements, Dyads, bisector_dyads, circle_dyads
from grashof.synth.theory.stopping import raise_if_overdue

# Linkages that are improved: the nearest, and some of the others, since the best may be far from its minimum;
# numbers of those that continue, and their steps before that.
KEPT, OTHERS = 300, 1200
STAGES = ((300, 6), (300, 20))
LONGEST = 0.3  # greatest change of a number in a step
NUDGE = 1e-6
_HEAVY, _NONE = 10.0, 1e6  # weight of violations; residuals of a linkage that has no torque
NEARLY = 0.05  # violations of linkages that the programme brings within their limits
_FREE = [number for number, name in enumerate(GROUPS) if name not in DEVIATIONS]


def seeks_torque(scaled: ScaledProblem) -> bool:
    """Whether a deviation from a wanted torque is a goal, or limited."""
    limited = {limit.quantity.key for limit in scaled.wanted.limited.values()}
    return not DEVIATIONS.keys().isdisjoint(limited | set(scaled.problem.objective.goals))


def nearer_to_torque(scaled: ScaledProblem, motion: Displacements, linkages: Screened) -> Screened:
    """Linkages through two or three poses, improved by Levenberg-Marquardt, and the best unchanged.

    They keep all limits except those of the deviation, or nearly, so that the programme can correct them. The
    numbers are the logarithms of AP and BP and, for two poses, the distances of the ground pivots from the
    chords of A and B.
    """
    kept = linkages[_sound(linkages)]
    deviation = _deviations(scaled, kept)
    order = np.argsort(deviation, kind="stable")
    best = kept[order[:KEPT]]
    if not len(best):
        return best
    x = _numbers(scaled, motion, kept[np.concatenate([order[:KEPT], order[KEPT:][:: _stride(len(order))]])])
    for keep, steps in STAGES:
        x, deviation = _improved(scaled, motion, x, steps)
        x = x[np.argsort(deviation, kind="stable")[:keep]]
    found = _linkages(scaled, motion, x)
    nearly = found.violations[:, _FREE].max(axis=1, initial=0.0) < NEARLY
    violations = np.where(nearly[:, None], 0.0, found.violations)
    return Screened.joined([replace(found, violations=violations)[nearly], best])


def _stride(count: int) -> int:
    """Step by which the other linkages are thinned."""
    return max(1, -(-(count - KEPT) // OTHERS))


def _improved(
    scaled: ScaledProblem, motion: Displacements, x: FloatArray, steps: int
) -> tuple[FloatArray, FloatArray]:
    """Numbers of linkages (n, M) after steps, and the sums of their squared residuals (n,)."""
    rows = _residuals(scaled, motion, x)
    cost, damping = (rows**2).sum(axis=1), np.full(len(x), 1e-2)
    for _ in range(steps):
        raise_if_overdue()
        slopes = _slopes(scaled, motion, x, rows)
        normal = slopes @ slopes.swapaxes(1, 2)
        scale = damping[:, None] * (np.einsum("sii->si", normal) + 1e-12)
        damped = normal + scale[..., None] * np.eye(x.shape[1])
        step = np.linalg.solve(damped, slopes @ rows[..., None])[..., 0]
        tried = x - np.clip(step, -LONGEST, LONGEST)
        new = _residuals(scaled, motion, tried)
        better = (new**2).sum(axis=1) < cost
        x, rows = (np.where(better[:, None], one, other) for one, other in ((tried, x), (new, rows)))
        cost = (rows**2).sum(axis=1)
        damping = np.clip(np.where(better, damping / 4, damping * 4), 1e-12, 1e8)
    return x, cost


def _residuals(scaled: ScaledProblem, motion: Displacements, x: FloatArray) -> FloatArray:
    """Misses and violations (n, R), the largest number where a linkage has no torque."""
    there = _linkages(scaled, motion, x)
    misses = _misses(scaled, there)
    rows = np.concatenate([misses, _HEAVY * there.violations[:, _FREE]], axis=1)
    return np.where(np.isfinite(rows).all(axis=1)[:, None], rows, _NONE)


def _sound(linkages: Screened) -> BoolArray:
    """Which keep all limits but those of the deviation."""
    sound: BoolArray = linkages.violations[:, _FREE].max(axis=1, initial=0.0) <= 0
    return sound


def _misses(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    ways = linkages.theta2, linkages.direction, linkages.assembly
    return torque_misses(scaled, linkages.points, *ways)


def _deviations(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    return rms(_misses(scaled, linkages))


def _slopes(scaled: ScaledProblem, motion: Displacements, x: FloatArray, rows: FloatArray) -> FloatArray:
    """Derivatives of the residuals by the numbers, (n, M, R)."""
    slopes = []
    for column in range(x.shape[1]):
        moved = x.copy()
        moved[:, column] += NUDGE
        slopes.append((_residuals(scaled, motion, moved) - rows) / NUDGE)
    return np.clip(np.stack(slopes, axis=1), -_NONE, _NONE)


def _numbers(scaled: ScaledProblem, motion: Displacements, linkages: Screened) -> FloatArray:
    """The numbers of linkages (n, M)."""
    o2, o4, a, b, _ = linkages.points.T
    columns = []
    for joint, ground in ((a, o2), (b, o4)):
        arm = np.log(joint - scaled.targets[0])
        columns += [arm.real, arm.imag]
        if len(motion.shift) == 2:
            columns.append(np.arcsinh(((ground - _middle(motion, joint)) / _across(motion, joint)).real))
    return np.stack(columns, axis=1)


def _linkages(scaled: ScaledProblem, motion: Displacements, x: FloatArray) -> Screened:
    """Linkages of numbers, and their violations."""
    driver, driven = (_dyads(scaled, motion, part) for part in np.split(x, 2, axis=1))
    with np.errstate(all="ignore"):
        return fully_screened(scaled, judged_pairs(motion, scaled.targets[0], driver, driven, scaled.wanted))


def _dyads(scaled: ScaledProblem, motion: Displacements, x: FloatArray) -> Dyads:
    joint = scaled.targets[0] + np.exp(x[:, 0] + 1j * x[:, 1])
    return circle_dyads(motion, joint) if x.shape[1] == 2 else bisector_dyads(motion, joint, np.sinh(x[:, 2]))


def _middle(motion: Displacements, joint: ComplexArray) -> ComplexArray:
    """The middle between the two places of a joint."""
    return bisector_dyads(motion, joint, np.zeros(len(joint))).ground


def _across(motion: Displacements, joint: ComplexArray) -> ComplexArray:
    """The unit vector perpendicular to the line between the two places."""
    return bisector_dyads(motion, joint, np.ones(len(joint))).ground - _middle(motion, joint)
