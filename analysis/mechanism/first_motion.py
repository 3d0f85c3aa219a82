"""A variable over which the first loop moves evenly, near dead positions and change points too."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.first_loop import first_loop, first_ranges
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray

SLACK = 1e-9  # rad: rounding of the end of a range
SHORT = 1e-6  # rad: shorter ranges are ignored


class _Swing(Enum):
    """Motion of the driver with respect to the ground line."""

    TURNS = "turns fully"
    THROUGH = "swings through it"
    BESIDE = "swings beside it"
    PLAIN = "over a part where the linkage does not close everywhere"


@dataclass(frozen=True, slots=True)
class FirstMotion:
    """Driver angle as a function of a share t, 0 to 1, over which links 3 and 4 move evenly.

    Half angles are counted from `centre` (rad); `scale` is c or X and `modulus` the k' of `first_motion`;
    `first` and `last` are the elliptic integral at both ends, as shares of half its period.
    """

    start: float
    end: float
    swing: _Swing = _Swing.PLAIN
    centre: float = 0.0
    scale: float = 1.0
    modulus: float = 1.0
    first: float = 0.0
    last: float = 1.0

    def theta2(self, share: npt.ArrayLike) -> FloatArray:
        """Driver angle (...) in rad at shares, which may exceed [0, 1] where the driver turns fully."""
        t = np.asarray(share, dtype=np.float64)
        if self.swing is _Swing.PLAIN:
            angle = self.start + (self.end - self.start) * np.sin(np.pi / 2 * t) ** 2
        else:
            angle = self.centre + 2 * self._half_angle(self._amplitude(t))
        if self.swing is not _Swing.TURNS:
            angle = np.clip(angle, min(self.start, self.end), max(self.start, self.end))
        return np.where(t == 0, self.start, np.where(t == 1, self.end, angle))

    def rate(self, share: npt.ArrayLike) -> FloatArray:
        """Derivative of `theta2` by the share, shape (...), rad; 0 in dead positions."""
        t = np.asarray(share, dtype=np.float64)
        if self.swing is _Swing.PLAIN:
            return np.asarray((self.end - self.start) * np.pi / 2 * np.sin(np.pi * t))
        psi = self._amplitude(t)
        sine, cosine, size = np.sin(psi), np.cos(psi), self.scale
        dn = np.hypot(cosine, self.modulus * sine)
        if self.swing is _Swing.TURNS:
            slope = size * dn / (cosine**2 + (size * sine) ** 2)
        elif self.swing is _Swing.THROUGH:
            slope = size * sine * dn / (1 + (size * cosine) ** 2)
        else:
            slope = -size * (1 - self.modulus**2) * sine * cosine / (1 + (size * dn) ** 2)
        return np.asarray(4 * _quarter_period(self.modulus) * (self.last - self.first) * slope)

    def share(self, theta2: npt.ArrayLike) -> FloatArray:
        """Share of the motion at driver angles between its ends, shape (...)."""
        angle = np.asarray(theta2, dtype=np.float64)
        if self.swing is _Swing.PLAIN:
            done = np.clip((angle - self.start) / (self.end - self.start), 0, 1)
            return np.asarray(2 / np.pi * np.arcsin(np.sqrt(done)))
        return np.asarray((self._integral(angle) - self.first) / (self.last - self.first))

    def ground_line(self) -> FloatArray:
        """Driver angles of the motion at which O2A lies along the ground line; none where it is plain."""
        if self.swing is _Swing.PLAIN:
            return np.empty(0)
        ends = (np.array([self.start, self.end]) - self.centre) / np.pi
        return self.centre + np.pi * np.arange(np.ceil(ends.min()), np.floor(ends.max()) + 1)

    def _amplitude(self, t: FloatArray) -> FloatArray:
        return _amplitude(self.first + (self.last - self.first) * t, self.modulus)

    def _half_angle(self, psi: FloatArray) -> FloatArray:
        sine, cosine = np.sin(psi), np.cos(psi)
        if self.swing is _Swing.TURNS:  # tan f = c tan psi, unwrapped
            c = self.scale
            return np.asarray(psi + np.arctan2((c - 1) * sine * cosine, cosine**2 + c * sine**2))
        if self.swing is _Swing.THROUGH:
            return np.asarray(np.arctan(-self.scale * cosine))
        return np.asarray(np.arctan(self.scale * np.hypot(cosine, self.modulus * sine)))

    def _integral(self, theta2: FloatArray) -> FloatArray:
        """Elliptic integral at driver angles, as a share of half its period."""
        half = (theta2 - self.centre) / 2
        if self.swing is _Swing.TURNS:
            sine, cosine, c = np.sin(half), np.cos(half), self.scale
            psi = half + np.arctan2((1 - c) * sine * cosine, c * cosine**2 + sine**2)
        elif self.swing is _Swing.THROUGH:
            psi = np.arccos(np.clip(-np.tan(half) / self.scale, -1, 1))
        else:
            dn = np.clip(np.tan(half) / self.scale, self.modulus, 1)
            psi = np.arctan2(np.sqrt(1 - dn**2), -np.sqrt(dn**2 - self.modulus**2))
        return _share(psi, self.modulus)


def first_motion(linkage: Linkage, start: float, end: float) -> FirstMotion:
    """A variable over which links 3 and 4 move evenly between two driver angles; see `even_motion`.

    Notes
    -----
    The positions of a four-bar are elliptic functions, without branch points, of the integral of
    d theta2 / sin mu (Darboux 1879, *Bull. Sci. Math.* 3, 109-128), so rates and forces have poles
    alone, far from the real axis. With phi = theta2 - theta1, x = tan(phi / 2) and

        sin^2 mu ~ (sin^2(phi / 2) + a) (cos^2(phi / 2) + b),
        4 r1 r2 a = (r1 - r2)^2 - (r3 - r4)^2,    4 r1 r2 b = (r3 + r4)^2 - (r1 + r2)^2,

    x is c sn / cn where the driver turns fully (a, b > 0), X cn where it swings through the ground line
    (b < 0 < a; the other way round phi is counted from its back), and X dn where it swings on one side of
    it (a, b < 0); c^2 = a / (1 + a), X^2 = -(1 + b) / b, and k' is
    c / X, c / sqrt(c^2 + X^2) and |c| / X. At a change point (a or b = 0) that factor is left out.

    Slider-cranks have the same form with a and b of their own (`first_loop`). For an inverted one b is
    infinite, and sin mu has the diagonal A-O4 as denominator.
    """
    plain = FirstMotion(float(start), float(end))
    home = _home(linkage, min(start, end), max(start, end))
    if home is None:
        return plain
    swing, centre, a, b = home
    c = 1.0 if np.isinf(a) else float(np.sqrt(abs(a) / (1 + a)))
    x = 1.0 if np.isinf(b) else float(np.sqrt((1 + b) / abs(b)))
    modulus = {_Swing.TURNS: c / x, _Swing.THROUGH: c / np.hypot(c, x), _Swing.BESIDE: c / x}[swing]
    size = c if swing is _Swing.TURNS else -x if swing is _Swing.BESIDE and start + end < 2 * centre else x
    motion = replace(plain, swing=swing, centre=centre, scale=size, modulus=float(modulus))
    first, last = motion._integral(np.array([start, end])).tolist()
    return replace(motion, first=first, last=last)


def panel_edges(panels: int, shares: FloatArray) -> FloatArray:
    """Ends of equal panels of a motion, with further shares added."""
    edges = np.sort(np.concatenate([np.linspace(0, 1, panels + 1), np.clip(shares, 0, 1)]))
    return edges[np.diff(edges, prepend=-1) > 1e-12]


def turns_into(least: float, most: float, low: float, high: float) -> float | None:
    """Full turns (rad) that move a range over a part; None where it does not hold it."""
    turned = float(TURN * np.round((low + high - least - most) / (2 * TURN)))
    return turned if least + turned - SLACK <= low <= high <= most + turned + SLACK else None


def _home(linkage: Linkage, low: float, high: float) -> tuple[_Swing, float, float, float] | None:
    """Motion of the driver between two angles, the angle it is counted from, and a and b."""
    a, b = first_loop(linkage).even()
    if np.isnan(a):
        return None
    theta1 = float(linkage.theta1)
    if a > 0 and b > 0:
        return _Swing.TURNS, theta1, a, b
    for least, most in first_ranges(linkage).tolist():
        turned = turns_into(least, most, low, high)
        if turned is not None and most - least > SHORT:
            half_turns = ((least + most) / 2 - theta1) / np.pi
            if a < 0 and b < 0:
                return _Swing.BESIDE, theta1 + turned + TURN * np.round(half_turns / 2), a, b
            folded = a < 0  # about the back of the ground, an odd number of half turns away
            return (
                _Swing.THROUGH,
                theta1 + turned + np.pi * np.round(half_turns),
                *((b, a) if folded else (a, b)),
            )
    return None


def _quarter_period(modulus: float) -> float:
    """Complete elliptic integral of the first kind, by the arithmetic-geometric mean."""
    return np.pi / 2 / _means(modulus)[-1][0]


def _means(modulus: float) -> list[tuple[float, float]]:
    """The arithmetic and geometric means from 1 and k' until they are equal."""
    a, g = 1.0, modulus
    found = [(a, g)]
    while abs(a - g) > 1e-15 * a:
        a, g = (a + g) / 2, float(np.sqrt(a * g))
        found.append((a, g))
    return found


def _amplitude(share: FloatArray, modulus: float) -> FloatArray:
    """Jacobi's amplitude at a share of half the period, descending by Landen's transformation."""
    *means, _ = _means(modulus)
    psi = np.pi * 2 ** len(means) * share
    for a, g in reversed(means):
        psi = (psi + np.arcsin((a - g) / (a + g) * np.sin(psi))) / 2
    return np.asarray(psi)


def _share(psi: FloatArray, modulus: float) -> FloatArray:
    """The share of half the period at which the amplitude is psi: the same steps back."""
    *means, _ = _means(modulus)
    for a, g in means:  # psi + arctan(g / a tan psi), unwrapped
        sine, cosine = np.sin(psi), np.cos(psi)
        psi = 2 * psi + np.arctan2((g - a) * sine * cosine, a * cosine**2 + g * sine**2)
    return np.asarray(psi / (np.pi * 2 ** len(means)))
