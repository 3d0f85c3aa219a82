"""Curvature, cusps and double points of the coupler curve."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.curves.coupler_curve import coupler_curve
from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.mobility import driver_ranges, full_rotation
from grashof.analysis.numerics.peaks import last_where
from grashof.problems import FourBar, Linkage, ProblemError
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray, frozen_array, turned_from
from grashof.problems.values.checks import number_within
from grashof.problems.values.value_bases import ReadOnly

_SAMPLES = 1440
_BEYOND = 1e-6  # rad: search beyond the ends, which finds a minimum at an end
SLACK = 1e-9  # rad: rounding of the ends of a motion
_REAL = 1e-6  # imaginary share up to which rounding may have split a double root
_ROUNDING = 1e-12  # share of the size: rounding of a gap
_CUSP = 1e-6  # rad: closer passages are one cusp
_STEPS = 8


def curvature(linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None) -> FloatArray:
    """Curvature of the coupler curve at given driver angles.

    Parameters
    ----------
    linkage, theta2, assembly
        As for `solve_position`.

    Returns
    -------
    ndarray, shape (...), 1/length
        Positive where the path turns left as the driver turns counter-clockwise. Not finite in a cusp and in
        a dead position of the driver, NaN where the linkage cannot close.

    Notes
    -----
    (x' y'' - y' x'') / (x'^2 + y'^2)^(3/2), with derivatives by the driver angle.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(4, 0))
    >>> np.abs(curvature(crank_rocker, [1.0, 2.0])).round(9).tolist()    # P is B: the rocker's arc
    [0.333333333, 0.333333333]
    """
    _, rate, bend = coupler_curve(linkage, theta2, assembly)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray((rate.conj() * bend).imag / np.abs(rate) ** 3)


def cusps(
    linkage: Linkage,
    theta2_start: float | None = None,
    theta2_end: float | None = None,
    tolerance: float = 1e-6,
) -> FloatArray:
    """Driver angles at which P stands still while the driver turns: the cusps of its curve.

    Parameters
    ----------
    linkage : Linkage
        A single linkage, on its own assembly.
    theta2_start, theta2_end : float, rad, optional
        Part of the motion; by default all of it.
    tolerance : float
        Greatest speed of P, at a minimum, as a share of that of A.

    Returns
    -------
    ndarray, shape (N,), rad
        Increasing; in [-pi, pi] if the driver turns fully, else within its ranges or the ends given.

    Raises
    ------
    ProblemError
        Only one end is given, or a tolerance outside 0 to 1.

    Notes
    -----
    In a cusp P is the instant centre of the coupler (Norton, *Design of Machinery*, ch. 6). Where P is B (or
    close to it) the limit positions of the rocker count as well, where its arc turns back.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(4, 0))
    >>> np.degrees(cusps(crank_rocker)).round(4).tolist()    # P is B, still at the ends of its swing
    [-131.8103, 36.8699]
    """
    tolerance = number_within(tolerance, 0.0, 1.0, "tolerance")
    still: list[float] = []
    for low, high in driver_intervals(linkage, theta2_start, theta2_end):
        angle = _slowest(linkage, low, high)
        angle = angle[(angle >= low - SLACK) & (angle <= high + SLACK)]
        for value in angle[np.abs(coupler_curve(linkage, angle)[1]) <= tolerance * linkage.r2]:
            # The end of a full turn repeats its start.
            if not any(abs(turned_from(value, other)) < 2 * SLACK for other in still):
                still.append(float(np.clip(value, low, high)))
    return np.sort(still)


def driver_intervals(
    linkage: Linkage, theta2_start: float | None, theta2_end: float | None
) -> list[tuple[float, float]]:
    """The part of the motion requested, low end first; all ranges of the driver without ends."""
    if theta2_start is not None and theta2_end is not None:
        low, high = sorted((float(theta2_start), float(theta2_end)))
        if not np.isfinite([low, high]).all():
            raise ProblemError(
                f"the driver angles are {theta2_start!r} and {theta2_end!r}; both must be finite"
            )
        return [(low, high)]
    if theta2_start is not None or theta2_end is not None:
        raise ProblemError("one end of the motion is given; give both or neither")
    if full_rotation(linkage):
        return [(-np.pi, np.pi)]
    ends = driver_ranges(linkage)
    return [(float(low), float(high)) for low, high in ends if high > low]


def _slowest(linkage: Linkage, low: float, high: float) -> FloatArray:
    """Driver angles at minima of the speed of P, ends included."""

    def slope(theta2: FloatArray) -> FloatArray:
        _, rate, bend = coupler_curve(linkage, theta2)
        with np.errstate(invalid="ignore", over="ignore"):
            return np.asarray((rate.conj() * bend).real)

    count = max(3, int(np.ceil(_SAMPLES * (high - low) / TURN)))
    inside = even_motion(linkage, low, high).theta2(np.linspace(0, 1, count))
    theta2 = np.concatenate([[low - _BEYOND], inside, [high + _BEYOND]])
    rising = slope(theta2)
    from_here = (rising[:-1] <= 0) & (rising[1:] > 0)
    left, right = theta2[:-1][from_here], theta2[1:][from_here]
    return last_where(lambda at: ~(slope(at) > 0), left, right)


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


_Passages: TypeAlias = tuple[FloatArray, FloatArray, IntArray]  # point, driver angles, assemblies; (2,) each


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
        return _collected([])
    found: list[_Passages] = []
    for place in _candidates(linkage, w):
        passage = _passages(linkage, w, place)
        if passage is None:
            continue
        theta2, sign = _polished(linkage, *passage), passage[1]
        gap = _gap(linkage, theta2, sign)
        same = sign[0] == sign[1] and abs(_wrapped(theta2[1] - theta2[0])) < _CUSP
        if not same and gap <= _ROUNDING * _size(linkage):
            order, p = np.argsort(theta2), coupler_curve(linkage, theta2[0], sign[0])[0]
            found.append((np.array([p.real, p.imag]), theta2[order], sign[order]))
    return _collected(found)


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
    found: list[_Passages] = []
    for low, high in intervals:
        inside = low - SLACK + (every.theta2 - low + SLACK) % TURN
        kept = own & (inside <= high + SLACK).all(axis=1)
        found += zip(every.points[kept], np.sort(inside[kept]), every.assembly[kept], strict=True)
    return _collected(found)


def _collected(found: list[_Passages]) -> DoublePoints:
    points, theta2, assembly = np.array(found, dtype=np.float64).reshape(-1, 3, 2).swapaxes(0, 1)
    return DoublePoints(frozen_array(points), frozen_array(theta2), assembly.astype(np.int64))


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
    return np.asarray(complex(*linkage.o2) + ground * turn * below[kept] / reach[kept])


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


def _polished(linkage: FourBar, theta2: FloatArray, sign: IntArray) -> FloatArray:
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
    return _wrapped(theta2)


def _gap(linkage: FourBar, theta2: FloatArray, sign: IntArray) -> float:
    p, _, _ = coupler_curve(linkage, theta2, sign)
    return float(np.nan_to_num(np.abs(p[0] - p[1]), nan=np.inf))


def _size(linkage: FourBar) -> float:
    places = [linkage.o2, linkage.o4, linkage.lengths, linkage.coupler_point]
    return float(max(np.abs(place).max() for place in places))


def _wrapped(angle: FloatArray) -> FloatArray:
    return np.asarray(angle - TURN * np.round(angle / TURN))
