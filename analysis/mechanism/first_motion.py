"""A variable over which the first loop moves evenly, near dead positions and change points too."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields, replace
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.first_loop import first_loop, first_ranges
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

SLACK = 1e-9  # rad: rounding of the end of a range
SHORT = 1e-6  # rad: shorter ranges are ignored


class _Swing(IntEnum):
    """Motion of the driver with respect to the ground line."""

    PLAIN = 0  # over a part where the linkage does not close everywhere
    TURNS = 1
    THROUGH = 2
    BESIDE = 3


_PLAIN = np.array(int(_Swing.PLAIN))
_WHOLE, _ZERO = np.ones(()), np.zeros(())


@dataclass(frozen=True, slots=True, eq=False)
class FirstMotion:
    """Driver angle as a function of a share t, 0 to 1, over which links 3 and 4 move evenly.

    Of one linkage or a batch: fields of shape (...) that broadcast against shares. Half angles are counted
    from `centre` (rad); `scale` is c or X and `modulus` the k' of `first_motion`; `first` and `last` are the
    elliptic integral at both ends, as shares of half its period; `ratios` (K, ...) and `period` are of
    `_landen`.
    """

    start: FloatArray
    end: FloatArray
    swing: IntArray = field(default_factory=lambda: _PLAIN)
    centre: FloatArray = field(default_factory=lambda: _ZERO)
    scale: FloatArray = field(default_factory=lambda: _WHOLE)
    modulus: FloatArray = field(default_factory=lambda: _WHOLE)
    first: FloatArray = field(default_factory=lambda: _ZERO)
    last: FloatArray = field(default_factory=lambda: _WHOLE)
    ratios: FloatArray = field(default_factory=lambda: np.empty(0))
    period: FloatArray = field(default_factory=lambda: _WHOLE)

    @classmethod
    def stacked(cls, motions: Sequence[FirstMotion]) -> FirstMotion:
        """Motions of single linkages as a batch."""
        names, most = cls._of_members(), max(len(each.ratios) for each in motions)
        picked = {name: np.stack([getattr(each, name) for each in motions]) for name in names}
        ratios = np.ones((most, len(motions)))  # a step with ratio 1 only doubles
        for row, each in enumerate(motions):
            ratios[: len(each.ratios), row] = each.ratios
        return cls(**picked, ratios=ratios)

    @classmethod
    def _of_members(cls) -> list[str]:
        """The names of fields of shape (...)."""
        return [each.name for each in fields(cls) if each.name != "ratios"]

    def __getitem__(self, index: Any) -> FirstMotion:
        """Some of a batch, or with further axes, as of an array."""
        index = index if isinstance(index, tuple) else (index,)
        picked = {name: getattr(self, name)[index] for name in self._of_members()}
        return FirstMotion(**picked, ratios=self.ratios[(slice(None), *index)])

    def theta2(self, share: npt.ArrayLike) -> FloatArray:
        """Driver angle (...) in rad at shares, which may exceed [0, 1] where the driver turns fully."""
        t = np.asarray(share, dtype=np.float64)
        angle = self._by_swing(FirstMotion._angle, t)
        low, high = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        angle = np.where(self.swing == _Swing.TURNS, angle, np.clip(angle, low, high))
        return np.where(t == 0, self.start, np.where(t == 1, self.end, angle))

    def rate(self, share: npt.ArrayLike) -> FloatArray:
        """Derivative of `theta2` by the share, shape (...), rad; 0 in dead positions."""
        return self._by_swing(FirstMotion._rate, np.asarray(share, dtype=np.float64))

    def share(self, theta2: npt.ArrayLike) -> FloatArray:
        """Share of the motion at driver angles between its ends, shape (...)."""
        return self._by_swing(FirstMotion._share, np.asarray(theta2, dtype=np.float64))

    def ground_line(self) -> FloatArray:
        """Driver angles (..., K) at which O2A lies along the ground line; NaN where a motion has fewer."""
        ends = (np.stack([self.start, self.end]) - self.centre) / np.pi
        first, last = np.ceil(ends.min(axis=0)), np.floor(ends.max(axis=0))
        turned = first[..., None] + np.arange(np.max(last - first) + 1)
        there = (turned <= last[..., None]) & (self.swing != _Swing.PLAIN)[..., None]
        return np.where(there, self.centre[..., None] + np.pi * turned, np.nan)

    def _by_swing(
        self, formula: Callable[[FirstMotion, _Swing, FloatArray], FloatArray], values: FloatArray
    ) -> FloatArray:
        """Values of a formula that differs between swings; those of each member as of it alone."""
        kinds = np.unique(self.swing).tolist()
        if len(kinds) == 1:
            return formula(self, _Swing(kinds[0]), values)
        shape = np.broadcast_shapes(self.swing.shape, values.shape)
        swing, values = np.broadcast_to(self.swing, shape), np.broadcast_to(values, shape)
        ratios = np.moveaxis(
            np.broadcast_to(np.moveaxis(self.ratios, 0, -1), (*shape, len(self.ratios))), -1, 0
        )
        every = {name: np.broadcast_to(getattr(self, name), shape) for name in self._of_members()}
        whole, found = FirstMotion(**every, ratios=ratios), np.empty(shape)
        for kind in kinds:
            rows = swing == kind
            found[rows] = formula(whole[rows], _Swing(kind), values[rows])
        return found

    def _angle(self, swing: _Swing, t: FloatArray) -> FloatArray:
        if swing is _Swing.PLAIN:
            return np.asarray(self.start + (self.end - self.start) * np.sin(np.pi / 2 * t) ** 2)
        psi = self._amplitude(t)
        sine, cosine = np.sin(psi), np.cos(psi)
        if swing is _Swing.TURNS:  # tan f = c tan psi, unwrapped
            c = self.scale
            half = psi + np.arctan2((c - 1) * sine * cosine, cosine**2 + c * sine**2)
        elif swing is _Swing.THROUGH:
            half = np.arctan(-self.scale * cosine)
        else:
            half = np.arctan(self.scale * np.hypot(cosine, self.modulus * sine))
        return np.asarray(self.centre + 2 * half)

    def _rate(self, swing: _Swing, t: FloatArray) -> FloatArray:
        if swing is _Swing.PLAIN:
            return np.asarray((self.end - self.start) * np.pi / 2 * np.sin(np.pi * t))
        psi = self._amplitude(t)
        sine, cosine, size = np.sin(psi), np.cos(psi), self.scale
        dn = np.hypot(cosine, self.modulus * sine)
        if swing is _Swing.TURNS:
            slope = size * dn / (cosine**2 + (size * sine) ** 2)
        elif swing is _Swing.THROUGH:
            slope = size * sine * dn / (1 + (size * cosine) ** 2)
        else:
            slope = -size * (1 - self.modulus**2) * sine * cosine / (1 + (size * dn) ** 2)
        return np.asarray(4 * self.period * (self.last - self.first) * slope)

    def _share(self, swing: _Swing, angle: FloatArray) -> FloatArray:
        if swing is _Swing.PLAIN:
            done = np.clip((angle - self.start) / (self.end - self.start), 0, 1)
            return np.asarray(2 / np.pi * np.arcsin(np.sqrt(done)))
        return np.asarray((self._integral(swing, angle) - self.first) / (self.last - self.first))

    def _amplitude(self, t: FloatArray) -> FloatArray:
        """Jacobi's amplitude at shares, descending by Landen's transformation."""
        psi = np.pi * 2 ** len(self.ratios) * (self.first + (self.last - self.first) * t)
        for ratio in self.ratios[::-1]:
            psi = (psi + np.arcsin((1 - ratio) / (1 + ratio) * np.sin(psi))) / 2
        return np.asarray(psi)

    def _share_at(self, psi: FloatArray) -> FloatArray:
        """The share of half the period at which the amplitude is psi: the same steps back."""
        for ratio in self.ratios:  # psi + arctan(ratio tan psi), unwrapped
            sine, cosine = np.sin(psi), np.cos(psi)
            psi = 2 * psi + np.arctan2((ratio - 1) * sine * cosine, cosine**2 + ratio * sine**2)
        return np.asarray(psi / (np.pi * 2 ** len(self.ratios)))

    def _integral(self, swing: _Swing, theta2: FloatArray) -> FloatArray:
        """Elliptic integral at driver angles, as a share of half its period."""
        if swing is _Swing.PLAIN:
            return np.zeros(np.shape(theta2))
        half = (theta2 - self.centre) / 2
        if swing is _Swing.TURNS:
            sine, cosine, c = np.sin(half), np.cos(half), self.scale
            psi = half + np.arctan2((1 - c) * sine * cosine, c * cosine**2 + sine**2)
        elif swing is _Swing.THROUGH:
            psi = np.arccos(np.clip(-np.tan(half) / self.scale, -1, 1))
        else:
            dn = np.clip(np.tan(half) / self.scale, self.modulus, 1)
            psi = np.arctan2(np.sqrt(1 - dn**2), -np.sqrt(dn**2 - self.modulus**2))
        return self._share_at(psi)


def first_motion(linkage: Linkage, start: npt.ArrayLike, end: npt.ArrayLike) -> FirstMotion:
    """A variable over which links 3 and 4 move evenly between driver angles (...); see `even_motion`.

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
    start, end = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    swing, centre, a, b = _home(linkage, np.minimum(start, end), np.maximum(start, end))
    with np.errstate(invalid="ignore", divide="ignore"):
        c = np.where(np.isinf(a), 1.0, np.sqrt(np.abs(a) / (1 + a)))
        x = np.where(np.isinf(b), 1.0, np.sqrt((1 + b) / np.abs(b)))
        modulus = np.where(swing == _Swing.THROUGH, c / np.hypot(c, x), c / x)
    plain = swing == _Swing.PLAIN
    mirrored = (swing == _Swing.BESIDE) & (start + end < 2 * centre)
    size = np.where(swing == _Swing.TURNS, c, np.where(mirrored, -x, x))
    modulus, size = np.where(plain, 1.0, modulus), np.where(plain, 1.0, size)
    ratios, period = _landen(modulus)
    motion = FirstMotion(start, end, swing, centre, size, modulus, ratios=ratios, period=period)
    first, last = (motion._by_swing(FirstMotion._integral, each) for each in (start, end))
    return replace(motion, first=first, last=np.where(plain, 1.0, last))


def panel_edges(panels: int, shares: FloatArray) -> FloatArray:
    """Ends of equal panels of a motion, with further shares added; without NaN."""
    edges = np.sort(np.concatenate([np.linspace(0, 1, panels + 1), np.clip(shares, 0, 1)]))
    return edges[np.diff(edges, prepend=-1) > 1e-12]


def turns_into(least: FloatArray, most: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Full turns (rad) that move ranges over parts, shape (...); NaN where they do not hold them."""
    turned = TURN * np.round((low + high - least - most) / (2 * TURN))
    holds = (least + turned - SLACK <= low) & (low <= high) & (high <= most + turned + SLACK)
    return np.where(holds, turned, np.nan)


def _home(
    linkage: Linkage, low: FloatArray, high: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Motions of the driver between two angles, the angles they are counted from, and a and b; each (...)."""
    a, b = first_loop(linkage).even()
    theta1 = linkage.theta1
    turns = (a > 0) & (b > 0)
    swing, centre = np.where(turns, int(_Swing.TURNS), int(_Swing.PLAIN)), np.where(turns, theta1, 0.0)
    folded = ~turns & (a < 0) & (b > 0)  # about the back of the ground, an odd number of half turns away
    a, b = np.where(folded, b, a), np.where(folded, a, b)
    if turns.all():
        return swing, centre, a, b
    beside = (a < 0) & (b < 0)
    for least, most in np.moveaxis(first_ranges(linkage), (-2, -1), (0, 1)):
        turned = turns_into(least, most, low, high)
        holds = (swing == _Swing.PLAIN) & ~np.isnan(a) & np.isfinite(turned) & (most - least > SHORT)
        half_turns = ((least + most) / 2 - theta1) / np.pi
        way = np.where(beside, TURN * np.round(half_turns / 2), np.pi * np.round(half_turns))
        swing = np.where(holds, np.where(beside, int(_Swing.BESIDE), int(_Swing.THROUGH)), swing)
        centre = np.where(holds, theta1 + turned + way, centre)
    return swing, centre, a, b


def _landen(modulus: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ratios of the geometric to the arithmetic means from 1 and k', (K, ...), and a quarter of the period.

    A ratio is 1 once the means have converged: such a step of Landen's transformation only doubles.
    """
    a, g, found = np.ones(np.shape(modulus)), np.asarray(modulus), list[FloatArray]()
    while (apart := np.abs(a - g) > 1e-15 * a).any():
        found.append(np.where(apart, g / a, 1.0))
        a, g = np.where(apart, (a + g) / 2, a), np.where(apart, np.sqrt(a * g), g)
    return np.array(found).reshape(len(found), *np.shape(modulus)), np.pi / 2 / a
