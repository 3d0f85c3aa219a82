"""Straightness of a part of the coupler curve, and the half turn of the driver that draws it straightest."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis.curves.coupler_curve import coupler_curve
from grashof.analysis.curves.line_and_circle import BestLine
from grashof.analysis.mechanism.even_motion import EvenMotion, even_motion
from grashof.analysis.mechanism.kinematics import virtual_motion
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.transmission import transmission_angle
from grashof.analysis.numerics.peaks import greatest, own
from grashof.analysis.numerics.quadrature import Panels, gauss_legendre, integrate
from grashof.problems import AssemblyError, Linkage, ProblemError
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, frozen_array

_PANELS = 16
_SAMPLES = 121  # of each part, for the points furthest from its line
_STARTS = 144  # of half turns
_EVEN = 1e-9  # share of the straightness within which all half turns are equally straight
_STILL = 1e-13  # share of r2: P does not move
_AT_END = 1e-12
_EVENLY = 1e-5
_NARROW, _NARROW_AT_CHANGE = 1e-14, 1e-4  # shares of the motion: rates at change points have few digits
_NO_PANELS = Panels(np.zeros(1), np.zeros((6, 0)), np.zeros(6))
_ROUNDING = 4 * float(np.finfo(np.float64).eps)
_MOST_ROUNDS = 60
_LADDER = np.array([0.0, 1e-8, 1e-5, 1e-3, 0.03])
_BESIDE = np.concatenate([-_LADDER[:0:-1], _LADDER])  # shares of a gap, about its expected minimum
_COMPLEX = np.array([1, 1j])


def straightness(linkage: Linkage, theta2_start: float, theta2_end: float) -> BestLine:
    """Best line of the path of P between two driver angles.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    theta2_start, theta2_end : float, rad

    Returns
    -------
    BestLine
        Every piece of the path counts by its length, whatever the speed of the driver.

    Raises
    ------
    ProblemError
        The linkage cannot be assembled throughout, or P does not move.

    Notes
    -----
    The line of least squared distances (Pearson 1901), from integrals over the arc length.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> hoeken = FourBar(o2=(0, 0), o4=(2.2, 0), r2=1, r3=2.8, r4=2.8, coupler_point=(5.6, 0))
    >>> line = straightness(hoeken, np.pi / 2, 3 * np.pi / 2)
    >>> round(line.length, 3), round(100 * line.width / line.length, 3)
    (4.181, 0.096)
    """
    path = _Path.of(linkage, theta2_start, theta2_end)
    return path.line(path.fits(np.zeros(1), np.ones(1)))


def straightest_half_turn(linkage: Linkage) -> tuple[float, BestLine]:
    """Half a turn of the driver over which the path of P is straightest.

    Parameters
    ----------
    linkage : Linkage
        A single linkage whose driver turns fully.

    Returns
    -------
    start : float, rad
        Driver angle at its start, from 0 to 2 pi; 0 where all are equally straight.
    line : BestLine
        As of `straightness`, with the least width as a share of the length.

    Raises
    ------
    AssemblyError
        The driver does not turn fully.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> hoeken = FourBar(o2=(0, 0), o4=(2.2, 0), r2=1, r3=2.8, r4=2.8, coupler_point=(5.6, 0))
    >>> start, line = straightest_half_turn(hoeken)
    >>> round(float(np.degrees(start)), 6), round(100 * line.width / line.length, 3)
    (90.0, 0.096)
    """
    if not full_rotation(linkage):
        raise AssemblyError("the driver does not turn fully, so no half turn of it is the straightest")
    path = _Path.of(linkage, 0.0, TURN)
    start = path.straightest()
    return start, path.line(path.half_turns(np.array([start])))


@dataclass(frozen=True, slots=True, eq=False)
class _Fits:
    """Lines fitted to K parts of a path, each from one share of the motion to another.

    `centre` and `along` are a point of each line and its direction, `spread` (3, K) the means of x^2, x y and
    y^2 about it; `reach` (4, K) the extent of the path ahead, back, left and right, at the shares `where` of
    the part.
    """

    first: FloatArray
    last: FloatArray
    length: FloatArray
    centre: ComplexArray
    along: ComplexArray
    spread: FloatArray
    reach: FloatArray
    where: FloatArray

    @property
    def ratio(self) -> FloatArray:
        """Width of the strip that holds each part, as a share of its length."""
        return np.asarray((self.reach[2] + self.reach[3]) / (self.reach[0] + self.reach[1]))


@dataclass(frozen=True, slots=True, eq=False)
class _Path:
    """The path of P over a motion, from a point on it, with integrals over its length."""

    linkage: Linkage
    motion: EvenMotion
    origin: complex
    pace: float
    panels: Panels

    @classmethod
    def of(cls, linkage: Linkage, start: float, end: float) -> _Path:
        motion = even_motion(linkage, start, end)
        origin = complex(solve_position(linkage, motion.theta2(0.5)).p @ _COMPLEX)
        bare = cls(linkage, motion, origin, _pace(linkage, motion), _NO_PANELS)
        narrowest = _NARROW_AT_CHANGE if np.isnan(bare.pace) else _NARROW
        panels = integrate(bare.moments, motion.edges(_PANELS), narrowest)
        if not np.isfinite(panels.total).all():
            raise ProblemError("the linkage cannot be assembled at all driver angles between the two given")
        if panels.total[0] <= _STILL * float(linkage.r2):
            raise ProblemError("the points are all one; a line needs two different ones")
        return replace(bare, panels=panels)

    def straightest(self) -> float:
        """Driver angle at which the straightest half turn begins."""
        theta2 = self.motion.theta2(np.arange(_STARTS) / _STARTS)
        fits = self.half_turns(theta2, rounds=1)
        ratio, slope, after = fits.ratio, self.slope(fits), np.roll(np.arange(_STARTS), -1)
        least = int(np.argmin(ratio))
        best, where = float(ratio[least]), float(theta2[least])
        if np.ptp(ratio) <= _EVEN * best:
            return 0.0
        gap = (theta2[after] - theta2) % TURN
        lowest = np.minimum(ratio, ratio[after]) - np.minimum(-slope, slope[after]) * gap
        bottoms = (slope < 0) & (slope[after] > 0) & (lowest <= best)
        for index in np.flatnonzero(bottoms):
            start, value = self._bottom(float(theta2[index]), float(theta2[index] + gap[index]))
            if value < best:
                best, where = value, start
        return where % TURN

    def _bottom(self, low: float, high: float) -> tuple[float, float]:
        """Start of the half turn with a least ratio, smooth or at a kink, and the ratio."""
        places = np.array([2 * low - high, low, high, 2 * high - low])  # a kink may lie just outside
        fits = self.half_turns(places)
        places, ratio, slope = _lowest_bracket(places, fits.ratio, self.slope(fits))
        for _ in range(_MOST_ROUNDS):
            gap = places[1] - places[0]
            if gap <= _ROUNDING * TURN:
                break
            with np.errstate(divide="ignore", invalid="ignore"):
                flat = slope[0] / (slope[0] - slope[1])
                kink = ((ratio[1] - ratio[0]) / gap - slope[1]) / (slope[0] - slope[1])  # tangents meet
            shares = np.concatenate([[0.5], kink + _BESIDE, flat + _BESIDE])
            tried = np.sort(places[0] + gap * shares[(shares > 0) & (shares < 1)])
            fits = self.half_turns(tried)
            places, ratio, slope = _lowest_bracket(
                np.concatenate([places[:1], tried, places[1:]]),
                np.concatenate([ratio[:1], fits.ratio, ratio[1:]]),
                np.concatenate([slope[:1], self.slope(fits), slope[1:]]),
            )
        least = int(np.argmin(ratio))
        return float(places[least]), float(ratio[least])

    def half_turns(self, theta2: FloatArray, rounds: int = 3) -> _Fits:
        """Lines fitted to the half turns that begin at driver angles, shape (K,)."""
        return self.fits(self.motion.share(theta2), self.motion.share(theta2 + np.pi), rounds)

    def fits(self, first: FloatArray, last: FloatArray, rounds: int = 3) -> _Fits:
        """Lines fitted to the parts between shares of the motion, shape (K,)."""
        length, x, y, *squares = self._gone(last) - self._gone(first)
        x, y = x / length, y / length
        spread = np.stack(squares) / length - np.stack([x * x, x * y, y * y])
        angle = np.arctan2(2 * spread[1], spread[0] - spread[2]) / 2
        centre, along = x + 1j * y, np.exp(1j * angle)

        def sides(place: FloatArray) -> FloatArray:
            """Distance of P ahead, back, left and right on each line."""
            part = place.reshape(-1, 1 if len(place) == 1 else len(first), place.shape[1])
            z = self._p(first[:, None] + (last - first)[:, None] * part)
            turned = (z - centre[:, None]) * along.conj()[:, None]
            each = np.stack([turned.real, -turned.real, turned.imag, -turned.imag])
            return own(each).reshape(-1, place.shape[1])

        reach, where = greatest(sides, np.linspace(0, 1, _SAMPLES), rounds=rounds)
        return _Fits(first, last, length, centre, along, spread, reach.reshape(4, -1), where.reshape(4, -1))

    def slope(self, fits: _Fits) -> FloatArray:
        """Derivative of the ratio of half turns by the driver angle at their start, shape (K,).

        The distances of the furthest points change with the line alone; at an end of the part with the end,
        too.
        """
        ends = self.motion.theta2(np.stack([fits.first, fits.last]))
        p, rate, _ = coupler_curve(self.linkage, ends)
        z = p - self.origin
        grows = np.diff(_rows(z, np.abs(rate)), axis=1)[:, 0]
        x, y = fits.centre.real, fits.centre.imag
        dx, dy = (grows[1:3] - np.stack([x, y]) * grows[0]) / fits.length
        squares = fits.spread + np.stack([x * x, x * y, y * y])
        dxx, dxy, dyy = (grows[3:] - squares * grows[0]) / fits.length - np.stack(
            [2 * x * dx, x * dy + y * dx, 2 * y * dy]
        )
        wide = fits.spread[0] - fits.spread[2]
        turning = (wide * dxy - fits.spread[1] * (dxx - dyy)) / (wide**2 + 4 * fits.spread[1] ** 2)
        back = fits.along.conj()
        place = fits.first + (fits.last - fits.first) * fits.where
        off = (self._p(place) - fits.centre) * back
        moves = -(dx + 1j * dy) * back - 1j * turning * off
        moves = moves + np.where(fits.where <= _AT_END, rate[0] * back, 0.0)
        moves = moves + np.where(fits.where >= 1 - _AT_END, rate[1] * back, 0.0)
        length, width = moves[0].real - moves[1].real, moves[2].imag - moves[3].imag
        long = fits.reach[0] + fits.reach[1]
        return np.asarray((width - fits.ratio * length) / long)

    def line(self, fits: _Fits) -> BestLine:
        """The first of the lines."""
        centre, along = complex(fits.centre[0]), complex(fits.along[0])
        first, last = self._p(np.array([fits.first[0], fits.last[0]])).tolist()
        along = -along if ((last - first) * along.conjugate()).real < 0 else along
        ahead, back, left, right = fits.reach[:, 0].tolist()
        inside = self.panels.edges
        turned = np.concatenate([inside, inside[1:] + 1])
        between = turned[(turned > fits.first[0]) & (turned < fits.last[0])]
        share, weight = gauss_legendre(np.concatenate([fits.first, between, fits.last]))
        off = ((self._p(share) - centre) * along.conjugate()).imag
        square = weight @ (off**2 * self.moments(share)[0])
        at = centre + self.origin
        return BestLine(
            point=frozen_array([at.real, at.imag]),
            angle=float(np.angle(along)),
            length=ahead + back,
            deviation_max=max(left, right),
            deviation_rms=float(np.sqrt(square / fits.length[0])),
            width=left + right,
        )

    def _p(self, share: FloatArray) -> ComplexArray:
        p: ComplexArray = solve_position(self.linkage, self.motion.theta2(share)).p @ _COMPLEX - self.origin
        return p

    def _gone(self, share: FloatArray) -> FloatArray:
        """Length of the path from its start, and integrals over it, shape (6, K)."""
        turns = np.floor(share)
        return self.panels.until(self.moments, share - turns) + self.panels.total[:, None] * turns

    def moments(self, share: FloatArray) -> FloatArray:
        """Rates by the share of the integrals of 1, x, y, x^2, x y, y^2 over the length, shape (6, N)."""
        theta2 = self.motion.theta2(share)
        if np.isnan(self.pace):
            p, rate, _ = coupler_curve(self.linkage, theta2)
            with np.errstate(invalid="ignore"):
                return _rows(p - self.origin, np.abs(rate * self.motion.rate(share)))
        # d theta2 = pace sin mu dt, and d theta3 by d theta2 is divided by sin mu.
        moved = virtual_motion(self.linkage, theta2)[0].p
        return _rows(moved.position @ _COMPLEX - self.origin, np.abs(self.pace) * moved.speed)


def _pace(linkage: Linkage, motion: EvenMotion) -> float:
    """D theta2 over sin mu dt, a constant; NaN at a change point, where the motion omits it."""
    share = np.array([0.2, 0.45, 0.7])
    each = motion.rate(share) / np.sin(transmission_angle(linkage, motion.theta2(share)))
    return float(each[1]) if np.ptp(each) <= _EVENLY * np.abs(each).min() else np.nan


def _lowest_bracket(
    places: FloatArray, ratio: FloatArray, slope: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The two neighbours in order, falling and rising, that enclose the least ratio."""
    turns = (slope[:-1] < 0) & (slope[1:] >= 0)
    lower = np.where(turns, np.minimum(ratio[:-1], ratio[1:]), np.inf)
    first = int(np.argmin(lower))
    kept = slice(first, first + 2)
    return places[kept], ratio[kept], slope[kept]


def _rows(z: ComplexArray, speed: FloatArray) -> FloatArray:
    x, y = z.real, z.imag
    return np.stack([speed, speed * x, speed * y, speed * x * x, speed * x * y, speed * y * y])
