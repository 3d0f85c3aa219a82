"""Path designs moved by the least amount that brings the coupler point onto its targets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.checks import ComplexArray, FloatArray

STEPS = 4


@dataclass(frozen=True, slots=True)
class Polished:
    """A design on its targets.

    Parameters
    ----------
    points : ndarray of complex, shape (5,), sizes
        O2, O4, and A, B, P at the first target.
    theta2 : ndarray, shape (N,), rad
    coupler : ndarray of complex, shape (N,), sizes
        From A to B at each target.
    error : float, sizes
        Greatest distance from a target; NaN where the loop does not close.
    """

    points: ComplexArray
    theta2: FloatArray
    coupler: ComplexArray
    error: float


def polish_path(
    points: ComplexArray,
    theta2: FloatArray,
    assembly: FloatArray,
    targets: ComplexArray,
    timed: bool,
) -> Polished:
    """Newton's method for P_k = target_k, each step of least norm.

    Parameters
    ----------
    points : ndarray of complex, shape (5,), sizes
        O2, O4, and A, B, P at the first target.
    theta2 : ndarray, shape (N,), rad
        Driver angle at each target, the first one first.
    assembly : ndarray, shape (N,)
    targets : ndarray of complex, shape (N,), sizes
    timed : bool
        The driver angles move together.

    Returns
    -------
    Polished
    """
    o2, o4, a, b, p = points
    arm = (p - a) * abs(b - a) / (b - a)
    unknowns = np.concatenate([
        [o2.real, o2.imag, o4.real, o4.imag, abs(a - o2), abs(b - a), abs(b - o4), arm.real, arm.imag],
        theta2[:1] if timed else theta2,
    ])  # fmt: skip
    gaps = theta2 - theta2[0]
    for _ in range(STEPS):
        _, residual, jacobian = _linearised(unknowns, gaps, assembly, targets, timed)
        if not (np.isfinite(residual).all() and np.isfinite(jacobian).all()):
            break
        unknowns = unknowns - np.linalg.lstsq(jacobian, residual, rcond=1e-12)[0]
    (moved, coupler), residual, _ = _linearised(unknowns, gaps, assembly, targets, timed)
    theta2 = unknowns[9] + gaps if timed else unknowns[9:]
    return Polished(moved, theta2, coupler, float(np.hypot(*residual.reshape(2, -1)).max()))


def _linearised(
    unknowns: FloatArray, gaps: FloatArray, assembly: FloatArray, targets: ComplexArray, timed: bool
) -> tuple[tuple[ComplexArray, ComplexArray], FloatArray, FloatArray]:
    """Points at the first target, coupler at all; P - target as (2N,), and its derivative (2N, unknowns)."""
    o2, o4 = complex(*unknowns[:2]), complex(*unknowns[2:4])
    r2, r3, r4 = unknowns[4:7]
    arm = complex(*unknowns[7:9])
    theta2 = unknowns[9] + gaps if timed else unknowns[9:]
    e2 = np.exp(1j * theta2)
    a = o2 + r2 * e2
    diagonal = o4 - a
    s = np.abs(diagonal)
    along = (s**2 + r3**2 - r4**2) / (2 * s)
    with np.errstate(invalid="ignore", divide="ignore"):
        coupler = (along + 1j * assembly * np.sqrt(r3**2 - along**2)) * diagonal / s
        e3, e4 = coupler / r3, (a + coupler - o4) / r4
        p = a + arm * e3
        by_theta2 = 1j * r2 * e2
        below = r3 * (e3 * e4.conj()).imag
        columns = []
        for move, third, fourth, at_p in (
            (1, 0, 0, 0), (1j, 0, 0, 0), (-1, 0, 0, 1), (-1j, 0, 0, 1j),
            (e2, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0),
        ):  # fmt: skip
            # The loop O2-A-B-O4, projected on O4B, gives the turn of the coupler (move: of A - O4).
            turn = ((move + third * e3) * e4.conj()).real - fourth
            columns.append(move + at_p + 1j * arm * e3 * turn / below)
        columns += [e3, 1j * e3]
        along_path = by_theta2 + 1j * arm * e3 * (by_theta2 * e4.conj()).real / below
    slope = np.stack([np.broadcast_to(column, p.shape) for column in columns], axis=1)
    angles = along_path[:, None] if timed else np.diag(along_path)
    slope = np.concatenate([slope, angles], axis=1)
    residual = p - targets
    first = np.array([o2, o4, a[0], a[0] + coupler[0], p[0]])
    return (
        (first, coupler),
        np.concatenate([residual.real, residual.imag]),
        np.concatenate([slope.real, slope.imag]),
    )
