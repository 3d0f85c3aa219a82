"""Double points of the coupler curve in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from grashof.analysis.curves.coupler_curve import coupler_curve
from grashof.analysis.curves.curvature import SLACK, driver_intervals
from grashof.problems import FourBar
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray, frozen_array
from grashof.problems.values.read_only import ReadOnly

_REAL = 1e-6  # imaginary share up to which rounding may have split a double root
_ROUNDING = 1e-12  # share of the size: gaps below it are rounding
_CUSP = 1e-6  # rad: passages so close are one, a cusp
_STEPS = 8


@dataclass(frozen=True, slots=True, eq=False)
class DoublePoints(ReadOnly):
    """Points through which the coupler curve passes twice.

    Parameters
    ----------
    points : ndarray, shape (N, 2), length
    theta2 : ndarray, shape (N, 2), rad
        Driver angles of both passages, ascending.
    assembly : ndarray of int, shape (N, 2)
        Assemblies of both passages.
    """

    points: FloatArray
    theta2: FloatArray
    assembly: IntArray

    def __len__(self) -> int:
        return len(self.points)


def all_double_points(linkage: FourBar) -> DoublePoints:
    """Double points of the complete coupler curve, both assemblies together: at most three.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.

    Returns
    -------
    DoublePoints
        theta2 in [-pi, pi]; without cusps (see `cusps`), and empty where P is A or B, which move along arcs.

    Notes
    -----
    With p = D - O2, q = D - O4 and w = u + i v the closures |p - w e| = r2, |q - (w - r3) e| = r4 are two
    linear equations for the direction e of the coupler, Re(conj(p) w e) = s and
    Re(conj(q) (w - r3) e) = t. A second unit e solves both only where they are one equation. Their left
    sides are in proportion on the circle on which O2O4 is seen under the angle A-P-B (Roberts 1875; Hunt,
    *Kinematic Geometry of Mechanisms*, 1978): q / p = k |w| |w - r3| / (w conj(w - r3)) with k real.
    The right sides then leave a cubic in k. Newton steps on P(theta2) = P(theta2') refine the roots.

    Examples
    --------
    >>> watt = FourBar(o2=(0, 0), o4=(4, 0), r2=2.5, r3=2, r4=2.5, coupler_point=(1, 0))
    >>> np.abs(all_double_points(watt).points.round(9)).tolist()
    [[2.0, 0.0]]
    """
    w = complex(*linkage.coupler_point)
    if min(abs(w), abs(w - float(linkage.r3))) <= _ROUNDING * float(linkage.r3):
        return _collected([], [], [])
    points, angles, signs = [], [], []
    for place in _candidates(linkage, w):
        passage = _passages(linkage, w, place)
        if passage is None:
            continue
        theta2, sign = _polished(linkage, *passage)
        gap = _gap(linkage, theta2, sign)
        same = sign[0] == sign[1] and abs(_wrapped(theta2[1] - theta2[0])) < _CUSP
        if not same and gap <= _ROUNDING * _size(linkage):
            order = np.argsort(theta2)
            points.append(complex(coupler_curve(linkage, theta2[0], sign[0])[0]))
            angles.append(theta2[order])
            signs.append(sign[order])
    return _collected(points, angles, signs)


def double_points(
    linkage: FourBar, theta2_start: float | None = None, theta2_end: float | None = None
) -> DoublePoints:
    """Double points of the path of P in one motion of the linkage.

    Parameters
    ----------
    linkage : FourBar
        A single linkage, on its own assembly.
    theta2_start, theta2_end : float, rad, optional
        Part of the motion, up to one turn; by default each range of the driver by itself.

    Returns
    -------
    DoublePoints
        Both passages on the linkage's own assembly and in the same range, theta2 counted in it.

    Raises
    ------
    ProblemError
        Only one end of the motion is given.

    Examples
    --------
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(2, 0), r2=1, r3=2.5, r4=2.5, coupler_point=(1, -2))
    >>> eight = double_points(crank_rocker)
    >>> np.abs(eight.points.round(9)).tolist(), np.degrees(eight.theta2).round(9).tolist()
    ([[2.0, 0.0]], [[-90.0, 90.0]])
    """
    intervals = driver_intervals(linkage, theta2_start, theta2_end)
    every = all_double_points(linkage)
    own = (every.assembly == int(linkage.assembly)).all(axis=1)
    points, angles, signs = [], [], []
    for low, high in intervals:
        inside = low - SLACK + (every.theta2 - low + SLACK) % TURN
        for row in np.flatnonzero(own & (inside <= high + SLACK).all(axis=1)):
            points.append(complex(*every.points[row]))
            angles.append(np.sort(inside[row]))
            signs.append(every.assembly[row])
    return _collected(points, angles, signs)


def _collected(points: list[complex], angles: list[FloatArray], signs: list[IntArray]) -> DoublePoints:
    z = np.array(points, dtype=np.complex128)
    return DoublePoints(
        points=frozen_array(np.stack([z.real, z.imag], axis=-1)),
        theta2=frozen_array(np.reshape(angles, (-1, 2))),
        assembly=np.reshape(np.array(signs, dtype=np.int64), (-1, 2)),
    )


def _candidates(linkage: FourBar, w: complex) -> ComplexArray:
    """Points at which the two equations for the direction of the coupler coincide."""
    r1, r2, r3, r4 = map(float, linkage.lengths)
    arm, other = abs(w), abs(w - r3)
    turn = w * (w - r3).conjugate() / (arm * other)
    # arm (k^2 r1^2 + (other^2 - r4^2) f) = other k (r1^2 + (arm^2 - r2^2) f), f = |turn - k|^2
    f = np.array([1.0, -2 * turn.real, 1.0])  # of 1, k, k^2
    left = arm * (np.array([0, 0, r1**2]) + (other**2 - r4**2) * f)
    right = other * (np.array([r1**2, 0, 0]) + (arm**2 - r2**2) * f)
    cubic = np.append(left, 0.0) - np.append(0.0, right)
    above, below = _projective_roots(cubic / np.abs(cubic).max())
    ground = complex(*(linkage.o4 - linkage.o2))
    reach = below * turn - above  # p = ground * turn / (turn - k)
    kept = np.abs(reach) > _ROUNDING
    places: ComplexArray = complex(*linkage.o2) + ground * turn * below[kept] / reach[kept]
    return places


def _projective_roots(cubic: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Real roots as quotients above / below, which include infinity."""
    companion, scale = np.eye(3, k=1), np.eye(3)
    companion[2], scale[2, 2] = -cubic[:3], cubic[3]
    roots = scipy.linalg.eigvals(companion, scale, homogeneous_eigvals=True)
    above, below = roots / np.linalg.norm(roots, axis=0)
    phase = np.where(np.abs(below) > np.abs(above), below, above)
    above, below = above * phase.conj(), below * phase.conj()
    real = np.abs(above.imag) + np.abs(below.imag) <= _REAL * np.abs(phase) ** 2
    return above.real[real], below.real[real]


def _passages(linkage: FourBar, w: complex, place: complex) -> tuple[FloatArray, IntArray] | None:
    """Driver angles and assemblies with P at a double point; None if they are not real."""
    o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
    p, q, beyond = place - o2, place - o4, w - float(linkage.r3)
    through2 = (p.conjugate() * w, abs(p) ** 2 + abs(w) ** 2 - float(linkage.r2) ** 2)
    through4 = (q.conjugate() * beyond, abs(q) ** 2 + abs(beyond) ** 2 - float(linkage.r4) ** 2)
    factor, twice = max(through2, through4, key=lambda equation: abs(equation[0]))
    cosine = twice / (2 * abs(factor)) if factor else np.inf
    if abs(cosine) > 1:
        return None
    turn = np.arccos(cosine) * np.array([1, -1])
    e = factor.conjugate() / abs(factor) * np.exp(1j * turn)
    a = place - w * e
    side = ((o4 - a).conjugate() * e).imag
    return np.angle(a - o2), np.where(side >= 0, 1, -1)


def _polished(linkage: FourBar, theta2: FloatArray, sign: IntArray) -> tuple[FloatArray, IntArray]:
    """Newton steps towards equal P at both driver angles, while they improve."""
    gap = _gap(linkage, theta2, sign)
    for _ in range(_STEPS):
        p, rate, _ = coupler_curve(linkage, theta2, sign)
        slope = np.array([[rate[0].real, -rate[1].real], [rate[0].imag, -rate[1].imag]])
        if not np.isfinite(slope).all():
            break
        miss = p[0] - p[1]
        trial = theta2 - np.linalg.lstsq(slope, [miss.real, miss.imag], rcond=None)[0]
        left = _gap(linkage, trial, sign)
        if not left < gap:
            break
        theta2, gap = trial, left
    return _wrapped(theta2), sign


def _gap(linkage: FourBar, theta2: FloatArray, sign: IntArray) -> float:
    p, _, _ = coupler_curve(linkage, theta2, sign)
    return float(np.nan_to_num(np.abs(p[0] - p[1]), nan=np.inf))


def _size(linkage: FourBar) -> float:
    places = [linkage.o2, linkage.o4, linkage.lengths, linkage.coupler_point]
    return float(max(np.abs(place).max() for place in places))


def _wrapped(angle: FloatArray) -> FloatArray:
    return np.asarray(angle - TURN * np.round(angle / TURN))
