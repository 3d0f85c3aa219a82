"""Designs moved by the least amount that brings the coupler onto its targets: points, angles, or both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.loop.dimensions import dimensions_of, sized_loop
from grashof.synth.loop.dyad import ClosingDyad

STEPS, DONE = 12, 1e-10  # on short arcs many are needed
MANY = 64  # targets: of more, each driver angle is eliminated by itself


@dataclass(frozen=True, slots=True)
class ExactTargets:
    """N targets to be met exactly."""

    points: ComplexArray  # (N,), sizes
    has_point: BoolArray  # (N,)
    turns: FloatArray  # (N,), rad: angles of the body
    has_turn: BoolArray  # (N,)
    timed: bool  # the driver angles move together
    dyad: ClosingDyad  # of the kind of linkage


@dataclass(frozen=True, slots=True)
class Polished:
    """A design on its targets."""

    points: ComplexArray  # (5,), sizes: O2, O4, and A, B, P at the first target
    theta2: FloatArray  # (N,), rad
    coupler: ComplexArray  # (N,), sizes: from A to B at each target
    body_angle: float  # rad
    error: float  # greatest miss of a target, sizes or rad; NaN where the loop does not close


def polish_path(
    points: ComplexArray, theta2: FloatArray, body_angle: float, assembly: FloatArray, targets: ExactTargets
) -> Polished:
    """Newton's method for the targets, each step of least norm, from a design as `Polished` has it.

    `theta2` and `assembly` (N,) are those at each target, the first one first.
    """
    _, _, a, b, p = points
    arm = (p - a) * abs(b - a) / (b - a)
    unknowns = np.concatenate([
        dimensions_of(targets.dyad, points), [arm.real, arm.imag, body_angle],
        theta2[:1] if targets.timed else theta2,
    ])  # fmt: skip
    gaps = theta2 - theta2[0]
    before = np.inf
    for step in range(STEPS + 1):
        (moved, coupler), residual, jacobian = _linearised(unknowns, gaps, assembly, targets)
        worst = float(np.abs(residual).max(initial=0.0))
        # One step more than enough leads to rounding.
        if before < DONE or step == STEPS or not (np.isfinite(worst) and np.isfinite(jacobian).all()):
            break
        before = worst
        if targets.timed or len(theta2) <= MANY:
            jacobian = jacobian if targets.timed else _spread(jacobian, targets)
            unknowns = unknowns - np.linalg.lstsq(jacobian, residual, rcond=1e-12)[0]
        else:
            unknowns = unknowns - _eliminated(jacobian, residual, targets)
    theta2 = unknowns[10] + gaps if targets.timed else unknowns[10:]
    return Polished(moved, theta2, coupler, float(unknowns[9]), worst)


def _linearised(
    unknowns: FloatArray, gaps: FloatArray, assembly: FloatArray, targets: ExactTargets
) -> tuple[tuple[ComplexArray, ComplexArray], FloatArray, FloatArray]:
    """Points at the first target, coupler at all; misses (M,), and their derivative (M, 11).

    By the unknowns that all targets share (10), and by the driver angle of each row's own target, or of all
    where timed.
    """
    o2, r2 = complex(*unknowns[:2]), unknowns[4]
    arm, body_angle = complex(*unknowns[7:9]), unknowns[9]
    theta2 = unknowns[10] + gaps if targets.timed else unknowns[10:]
    e2 = np.exp(1j * theta2)
    a = o2 + r2 * e2
    with np.errstate(invalid="ignore", divide="ignore"):
        loop = sized_loop(targets.dyad, unknowns[:7], e2, assembly)
        e3, e4 = loop.e3, loop.e4
        p = a + arm * e3
        # The loop, projected on e4, gives the turn of the coupler.
        below = loop.rod * (e3 * e4.conj()).imag
        by_turn, by_move = np.zeros((len(a), 11)), np.zeros((len(a), 11), dtype=np.complex128)
        for column, moved in enumerate(loop.moved):
            by_turn[:, column] = moved / below
        turning = 1j * r2 * e2
        by_turn[:, 10] = (turning * e4.conj()).real / below
        for column, move in {0: 1, 1: 1j, 4: e2, 7: e3, 8: 1j * e3, 10: turning}.items():
            by_move[:, column] = move
        by_point = by_move + 1j * (arm * e3)[:, None] * by_turn
        by_turn[:, 9] = 1.0
    off = (p - targets.points)[targets.has_point]
    turned = np.angle(e3 * np.exp(1j * (body_angle - targets.turns)))[targets.has_turn]
    slope = by_point[targets.has_point]
    return (
        (np.array([o2, loop.o4, a[0], a[0] + loop.coupler[0], p[0]]), loop.coupler),
        np.concatenate([off.real, off.imag, turned]),
        np.concatenate([slope.real, slope.imag, by_turn[targets.has_turn]]),
    )


def _target_of_rows(targets: ExactTargets) -> IntArray:
    """The target that each miss is of, shape (M,)."""
    points, turns = np.flatnonzero(targets.has_point), np.flatnonzero(targets.has_turn)
    return np.concatenate([points, points, turns])


def _spread(jacobian: FloatArray, targets: ExactTargets) -> FloatArray:
    """The derivative by each driver angle in a column of its own, shape (M, 10 + N)."""
    by_angles = np.zeros((len(jacobian), len(targets.points)))
    by_angles[np.arange(len(jacobian)), _target_of_rows(targets)] = jacobian[:, 10]
    return np.concatenate([jacobian[:, :10], by_angles], axis=1)


def _eliminated(jacobian: FloatArray, residual: FloatArray, targets: ExactTargets) -> FloatArray:
    """The step of least squares for many targets, shape (10 + N,): without driver angles, then these.

    The effect of a driver angle is eliminated from the rows of its target, in time and memory proportional to
    the targets.
    """
    target, common, own = _target_of_rows(targets), jacobian[:, :10], jacobian[:, 10]
    square = np.bincount(target, own**2, len(targets.points))
    share = np.divide(1.0, square, out=np.zeros_like(square), where=square > 0)

    def along(rows: FloatArray) -> FloatArray:
        """The part of each column that the driver angles can produce, shape (N, columns)."""
        columns = [np.bincount(target, own * column, len(square)) * share for column in rows.T]
        return np.stack(columns, axis=1)

    both = np.concatenate([common, residual[:, None]], axis=1)
    left = both - own[:, None] * along(both)[target]
    shared = np.linalg.lstsq(left[:, :10], left[:, 10], rcond=1e-12)[0]
    return np.concatenate([shared, along((residual - common @ shared)[:, None])[:, 0]])
