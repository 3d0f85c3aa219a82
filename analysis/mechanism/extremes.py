"""Extremes of a quantity over a motion, to rounding, and the box that a linkage needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.mechanism.even_motion import angles_at_shares, closer_at_ends, even_motion
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
from grashof.analysis.mechanism.mobility import dead_ends, driver_ranges, full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.transmission import quality, transmission_at_extremes
from grashof.analysis.numerics.peaks import Curve, greatest
from grashof.problems import AssemblyError, Linkage, ProblemError
from grashof.problems.values.arrays import TURN, FloatArray

Quantity: TypeAlias = Callable[[Kinematics], FloatArray]

_SAMPLES = 2881
_BOX_SAMPLES = 361
_BOX_ROUNDS = 2  # further ones change nothing
_DEGREE = 16
_CANDIDATES = 6
_DEAD = 1e-7  # rad
_NODES = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))


@dataclass(frozen=True, slots=True)
class Extremes:
    """Least and largest value of a quantity, and where.

    Parameters
    ----------
    low, high : float
    at_low, at_high : float
        Driver angle in rad, or whatever the curve runs over.
    """

    low: float
    high: float
    at_low: float
    at_high: float

    @property
    def stroke(self) -> float:
        """Largest minus least value."""
        return self.high - self.low


def extremes(
    linkage: Linkage,
    quantity: Quantity,
    omega2: float = 1.0,
    start: float | None = None,
    end: float | None = None,
    period: float | None = None,
) -> Extremes:
    """Least and largest value of any quantity while the driver turns steadily.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    quantity : callable
        Function of a `Kinematics`, such as ``lambda state: state.b.speed``.
    omega2 : float, rad/s
    start, end : float, rad, optional
        Driver angles; by default a full turn, or the first of `driver_ranges`.
    period : float, optional
        By which the quantity is unwrapped: 2 pi for an angle.

    Returns
    -------
    Extremes

    Raises
    ------
    AssemblyError
        The linkage cannot close in between.

    Notes
    -----
    Dense samples, then stationary points of Chebyshev polynomials about the outermost ones: right to rounding
    where the quantity is smooth.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> swing = extremes(norton, lambda state: state.theta4)
    >>> np.degrees([swing.stroke, swing.at_low, swing.at_high]).round(4).tolist()
    [73.7818, 24.1468, 231.3178]
    """
    start, end, closed = motion_between(linkage, start, end)

    motion = even_motion(linkage, start, end)

    def curve(share: FloatArray) -> FloatArray:
        return np.asarray(quantity(solve_kinematics(linkage, motion.theta2(share), omega2)), dtype=np.float64)

    at = dense_samples(0.0, 1.0, closed)
    values = unwrapped(motion.theta2(at), curve(at), period)
    found = refined(curve, at, values, closed, period)
    at_low, at_high = motion.theta2([found.at_low, found.at_high]).tolist()
    return Extremes(found.low, found.high, at_low, at_high)


def transmission_extremes(linkage: Linkage, start: float, end: float, loop: int | None = None) -> Extremes:
    """Least and largest transmission angle between two driver angles, in closed form.

    Parameters
    ----------
    linkage : Linkage
        A single linkage that closes throughout.
    start, end : float, rad
        In either order.
    loop : int, optional
        1 or 2; by default both loops of a six-bar together.

    Returns
    -------
    Extremes
        In rad; exactly 0 or pi where an end is a dead position, folded or stretched.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    >>> found = transmission_extremes(rocker, *driver_ranges(rocker)[0])
    >>> np.degrees([found.low, found.high]).round(4).tolist()
    [41.4096, 180.0]
    """
    loops = range(1, len(linkage.mechanism.dyads) + 1) if loop is None else [loop]
    parts = [transmission_at_extremes(linkage, start, end, number) for number in loops]
    at, mu = map(np.concatenate, zip(*parts, strict=True))
    if not full_rotation(linkage):  # an end that is dead but for rounding
        mu = np.where(quality(mu) <= _DEAD, np.where(mu < 1, 0.0, np.pi), mu)
    least, most = int(np.argmin(mu)), int(np.argmax(mu))
    return Extremes(float(mu[least]), float(mu[most]), float(at[least]), float(at[most]))


def extremes_of(
    curve: Curve, start: float, end: float, closed: bool = False, period: float | None = None
) -> Extremes:
    """Least and largest value of a function of one variable between two ends.

    Parameters
    ----------
    curve : callable
        Takes and returns arrays of shape (N,).
    start, end : float
    closed : bool
        The curve is periodic, with the ends one period apart.
    period : float, optional
        By which its values are unwrapped.

    Returns
    -------
    Extremes
    """
    at = dense_samples(start, end, closed)
    values = unwrapped(at, np.asarray(curve(at), dtype=np.float64), period)
    return refined(curve, at, values, closed, period)


def refined(
    curve: Curve, at: FloatArray, values: FloatArray, closed: bool = False, period: float | None = None
) -> Extremes:
    """Extremes, as of `extremes_of`, from samples (N,) of a curve and its values there, unwrapped."""
    low, at_low = _outermost(curve, at, -values, closed, period, -1.0)
    high, at_high = _outermost(curve, at, values, closed, period, 1.0)
    return Extremes(-low, high, at_low, at_high)


def motion_between(linkage: Linkage, start: float | None, end: float | None) -> tuple[float, float, bool]:
    """Ends of the motion, and whether it is a full turn."""
    turns = bool(full_rotation(linkage))
    if start is None or end is None:
        if start is not end:
            raise ProblemError("one of start and end is given; give both or neither")
        low, high = driver_ranges(linkage)[0].tolist()
        if np.isnan(low):
            raise AssemblyError("the linkage cannot close at any driver angle")
        start, end = (0.0, TURN) if turns else dead_ends(linkage, low, high)
    if not end > start:
        raise ProblemError(f"start is {start:.6g} and end {end:.6g}; start must be less than end")
    return start, end, turns and abs(end - start - TURN) < 1e-12


def dense_samples(start: float, end: float, closed: bool) -> FloatArray:
    """Samples of a curve whose extremes are sought, shape (N,)."""
    if closed:
        return np.linspace(start, end, _SAMPLES)
    at = closer_at_ends(start, end, _SAMPLES)  # which may be dead positions
    at[-1] = end
    return at


def unwrapped(theta2: FloatArray, values: FloatArray, period: float | None) -> FloatArray:
    """Values at driver angles, unwrapped by `period`, shape (N,); AssemblyError where one is NaN."""
    if values.shape != theta2.shape:
        raise ProblemError(f"the quantity has shape {values.shape}; it must have one value for each angle")
    if np.isnan(values).any():
        angle = np.degrees(theta2[np.isnan(values)][0])
        raise AssemblyError(f"the quantity has no value at driver angle {angle:.6g} deg")
    return values if period is None else np.unwrap(values, period=period)


def _outermost(
    curve: Curve, at: FloatArray, heights: FloatArray, closed: bool, period: float | None, sign: float
) -> tuple[float, float]:
    """Largest height (the curve's value times sign) and where it is."""
    top = int(np.argmax(heights))
    best, where = float(heights[top]), float(at[top])
    beyond = (heights[-2], heights[1]) if closed else (-np.inf, -np.inf)
    padded = np.concatenate([beyond[:1], heights, beyond[1:]])
    before, after = padded[:-2], padded[2:]
    with np.errstate(invalid="ignore"):
        bend = heights - before + heights - after  # a peak rises by less
        inside = np.isfinite(bend) & (heights >= before) & (heights >= after)
    peaks = np.flatnonzero(inside & (heights + bend >= best))
    for peak in peaks[np.argsort(-heights[peaks], kind="stable")[:_CANDIDATES]]:
        near = sign * heights[peak]

        def counted(theta2: FloatArray, near: float = near) -> FloatArray:
            values = np.asarray(curve(theta2), dtype=np.float64)
            if period is not None:
                values = values - period * np.round((values - near) / period)
            return sign * values

        places = np.array(_stationary(counted, at, int(peak), closed))
        for place, height in zip(places.tolist(), counted(places).tolist(), strict=True):
            if height >= best or (height >= best - 4e-16 * abs(best) and abs(place - where) < 1e-3):
                best, where = max(height, best), place
    return best, where


def _stationary(curve: Curve, at: FloatArray, peak: int, closed: bool) -> list[float]:
    """Stationary points about a sample, from the widest window in which a polynomial is exact."""
    chebyshev = np.polynomial.chebyshev  # NumPy loads it when it is asked for
    middle, (least, most) = at[peak], (-np.inf, np.inf) if closed else (at[0], at[-1])
    step = max(at[min(peak + 1, len(at) - 1)] - middle, middle - at[max(peak - 1, 0)])
    for width in (16.0, 4.0, 1.0):
        low, high = max(middle - width * step, least), min(middle + width * step, most)
        values = curve((low + high) / 2 + (high - low) / 2 * _NODES)
        if not np.isfinite(values).all():
            if closed:  # undefined beyond its ends
                return _stationary(curve, at, peak, closed=False)
            continue
        terms = chebyshev.chebfit(_NODES, values, _DEGREE)
        if np.abs(terms[-3:]).max() <= 1e-14 * np.abs(values).max() + 1e-9 * np.ptp(values) * (width == 1):
            terms = chebyshev.chebtrim(terms, 1e-15 * np.abs(values).max())
            roots = chebyshev.chebroots(chebyshev.chebder(terms))
            roots = roots.real[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) <= 1)]
            return [float((low + high) / 2 + (high - low) / 2 * root) for root in roots]
    found = scipy.optimize.minimize_scalar(
        lambda place: -float(curve(np.array([place]))[0]), bounds=(low, high), method="bounded",
        options={"xatol": 1e-12},
    )  # fmt: skip
    return [float(found.x)]


def reach_box(linkage: Linkage, start: npt.ArrayLike, end: npt.ArrayLike) -> FloatArray:
    """Box around the ground pivots and the paths of all moving points between two driver angles.

    Parameters
    ----------
    linkage : Linkage
    start, end : array_like, shape (...), rad

    Returns
    -------
    ndarray, shape (..., 2, 2), length
        Lower left and upper right corner.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> reach_box(crank_rocker, 0.0, 2 * np.pi).round(6).tolist()
    [[-1.0, -1.0], [4.0, 3.0]]
    """
    angles, many = angles_at_shares(linkage, start, end), linkage[..., None]
    rows = [(name, axis) for name in linkage.mechanism.moving for axis in (0, 1)]

    def tracks(share: FloatArray) -> FloatArray:
        """Coordinates of the moving points, and their negatives, each at its own shares."""
        state, every = solve_position(many, angles(share)), range(2 * len(rows))
        places = [state.point(name)[..., axis] for name, axis in rows]
        closed = np.isfinite(np.sum(places, axis=0))
        found = np.stack([places[row % len(rows)][row % len(share)] for row in every])
        found[len(rows) :] *= -1
        return np.where(closed, found, -np.inf)

    shares = np.broadcast_to(np.linspace(0, 1, _BOX_SAMPLES), (*linkage.shape, _BOX_SAMPLES))
    found, _ = greatest(tracks, shares, most=2, rounds=_BOX_ROUNDS)
    furthest = np.where(np.isfinite(found), found, -np.inf).reshape(2, -1, 2, *linkage.shape)
    corners = np.stack([np.moveaxis(getattr(linkage, pivot), -1, 0) for pivot in linkage.mechanism.ground])
    most = np.concatenate([corners, furthest[0]]).max(axis=0)
    least = np.concatenate([corners, -furthest[1]]).min(axis=0)
    return np.moveaxis(np.stack([least, most]), (0, 1), (-2, -1))


def diagonal(box: FloatArray) -> FloatArray:
    """Diagonals of boxes of two corners, shape (..., 2, 2)."""
    across = box[..., 1, :] - box[..., 0, :]
    return np.asarray(np.hypot(across[..., 0], across[..., 1]))
