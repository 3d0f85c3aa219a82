"""Lengths that are feasible by construction.

O2A is seen under an angle phi from the ground line, as in `ClosingDyad.reach`. Random numbers choose shares
of the possible lengths; the loop closes at every phi demanded, with at least the transmission angle mu
demanded there, without trial and error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias

import numpy as np

from grashof.problems.values.arrays import TURN, BoolArray, FloatArray
from grashof.synth.loop.dyad import Bars, Block, ClosingDyad, Sizes, Slider

Numbers: TypeAlias = FloatArray | float

INSIDE = 1e-6  # share left at both ends of the possible lengths: there are dead positions or zero lengths


@dataclass(frozen=True, slots=True)
class Demand:
    """Demands on loops, by numbers for all of a batch or for each; see `turning` and `covering`."""

    transmission: Numbers  # least min(mu, pi - mu), rad, from 0 and below pi / 2
    margin: Numbers = 0.0  # of a driver that turns fully, as `ClosingDyad.margins` has it, below 1
    least: Numbers = -1.0  # cosine of phi
    most: Numbers = 1.0
    transmitting: tuple[Numbers, Numbers] | None = None  # such cosines where the angle counts; by default all

    @classmethod
    def turning(cls, transmission: Numbers = 0.0, margin: Numbers = 0.0) -> Demand:
        """The driver turns fully, with a margin."""
        return cls(transmission, margin)

    @classmethod
    def covering(cls, low: Numbers, high: Numbers, transmission: Numbers = 0.0) -> Demand:
        """The driver covers a range of phi from `low` to `high`, rad."""
        ends = np.cos(low), np.cos(high)
        folded, stretched = (_passes(low, high, at) for at in (0.0, np.pi))
        least, most = np.minimum(*ends), np.maximum(*ends)
        return cls(transmission, 0.0, np.where(stretched, -1.0, least), np.where(folded, 1.0, most))

    def over(self, other: Demand) -> Demand:
        """The same with the transmission angle of another one, over its range alone."""
        return replace(self, transmission=other.transmission, transmitting=(other.least, other.most))

    def diagonals(self, r2: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Least and greatest distance A-O4 with r1 = 1."""
        return _diagonals(r2, self.least, self.most)

    def crank(self, share: FloatArray, longer_driver: BoolArray, narrowest: Numbers) -> FloatArray:
        """r2 with r1 = 1, so that the least of the `diagonals` is at least that share of the greatest.

        With g = (r2 + 1 / r2) / 2 the square of the share is (g - most) / (g - least): g has a lower limit,
        and r2 an upper one, or a lower one where the driver is to be longer. NaN for shares from 1 on.
        """
        square = np.square(np.where(np.asarray(narrowest) < 1, narrowest, np.nan))
        bound = np.maximum(self.most + (self.most - self.least) * square / (1 - square), 1.0)
        shorter = share / (bound + np.sqrt(bound**2 - 1))
        r2: FloatArray = np.where(longer_driver, 1 / shorter, shorter)
        return r2


def _diagonals(r2: FloatArray, least: Numbers, most: Numbers) -> tuple[FloatArray, FloatArray]:
    """Least and greatest distance A-O4, by the law of cosines."""
    # (1 - r2)^2 + 2 r2 (1 - cos phi), which loses no digits where r2 is near 1
    near, far = (np.sqrt((1 - r2) ** 2 + 2 * r2 * (1 - cosine)) for cosine in (most, least))
    return near, far


def _passes(low: Numbers, high: Numbers, at: float) -> BoolArray:
    passed: BoolArray = np.floor((high - at) / TURN) >= np.ceil((low - at) / TURN)
    return passed


def feasible(dyad: ClosingDyad, shares: FloatArray, longer_driver: BoolArray, demand: Demand) -> Sizes:
    """Lengths of loops from random numbers in [0, 1), shape (..., 3).

    r1 = 1, of a slider-crank r3 = 1; `longer_driver`, shape (...), requires r2 > r1 where O4 is a pivot. Of
    dyads with a slide the last number has no effect. NaN where no loop meets the demands.
    """
    return _LENGTHS[type(dyad)](INSIDE + (1 - 2 * INSIDE) * shares, longer_driver, demand)


def _of_bars(shares: FloatArray, longer_driver: BoolArray, demand: Demand) -> Sizes:
    """Two bars over a diagonal from `near` to `far`, by their sum T and difference D.

    With h = mu / 2 the law of cosines, mu being least at the ends, requires

        T^2 cos^2(h) + D^2 sin^2(h) >= far^2 and T^2 sin^2(h) + D^2 cos^2(h) <= near^2,

    which is possible where near / far >= tan(h). A margin requires T >= (1 + margin) / (1 - margin) far and
    |D| <= near - margin (T + far) (Grashof's criterion, McCarthy & Soh 2011, section 2.2, with a margin).
    T is greatest by the right sides at D = 0, and least where the limits of |D| meet; their existence limits
    near / far, and so r2. Derived here; tests show that no loops are left out.
    """
    margin, half = np.asarray(demand.margin), np.asarray(demand.transmission) / 2
    sine, cosine = np.sin(half), np.cos(half)
    more = (1 + margin) / (1 - margin)
    of_angle = np.maximum(sine / cosine, more * sine)
    of_margin = np.maximum(2 * margin / (1 - margin), margin * (1 + 1 / cosine))
    if demand.transmitting is not None:  # over a range of its own the angle does not limit r2 like that
        of_angle = 0.0 * of_angle
    r2 = demand.crank(shares[..., 0], longer_driver, np.maximum(of_angle, of_margin))
    near, far = demand.diagonals(r2)
    within = None if demand.transmitting is None else _diagonals(r2, *demand.transmitting)
    return Sizes(np.ones_like(r2), r2, *bars_between(near, far, shares[..., 1:], demand, within))


def bars_between(
    near: FloatArray,
    far: FloatArray,
    shares: FloatArray,
    demand: Demand,
    transmitting: tuple[FloatArray, FloatArray] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Lengths of two bars that close diagonals from `near` to `far`, from shares (..., 2); see `_of_bars`.

    The transmission angle counts at diagonals within `transmitting`, by default all. NaN where no two bars
    do.
    """
    limits = _BarLimits.of(near, far, demand, transmitting or (near, far))
    shortest, longest = limits.inverse_totals
    with np.errstate(invalid="ignore"):
        total = 1 / (shortest + shares[..., 0] * np.where(longest <= shortest, longest - shortest, np.nan))
        low, high = limits.differences(total)
        side = 2 * shares[..., 1] - 1
        room = np.where(low <= high, high - low, np.nan)
    difference = np.copysign(low + np.abs(side) * room, side)
    return (total + difference) / 2, (total - difference) / 2


def shares_of_bars(
    near: FloatArray, far: FloatArray, bars: tuple[FloatArray, FloatArray], demand: Demand
) -> FloatArray:
    """The shares from which `bars_between` makes two bars, (..., 2); outside 0 to 1 where it cannot."""
    total, difference = bars[0] + bars[1], bars[0] - bars[1]
    limits = _BarLimits.of(near, far, demand, (near, far))
    shortest, longest = limits.inverse_totals
    low, high = limits.differences(total)
    side = (np.abs(difference) - low) / (high - low)
    side = np.where(side < 0, np.inf, side)
    return np.stack(
        [(1 / total - shortest) / (longest - shortest), (1 + np.copysign(side, difference)) / 2], axis=-1
    )


class _BarLimits(NamedTuple):
    """Limits of the sum T and the difference D of two bars; see `_of_bars`."""

    far: FloatArray
    near_mu: FloatArray  # least and greatest diagonal at which the transmission angle counts
    far_mu: FloatArray
    margin: Numbers
    sine: Numbers  # of half the transmission angle
    cosine: Numbers
    room: FloatArray  # near - margin far

    @classmethod
    def of(
        cls, near: FloatArray, far: FloatArray, demand: Demand, transmitting: tuple[FloatArray, FloatArray]
    ) -> _BarLimits:
        """The limits of bars over diagonals from `near` to `far`."""
        margin, half = np.asarray(demand.margin), np.asarray(demand.transmission) / 2
        return cls(far, *transmitting, margin, np.sin(half), np.cos(half), near - margin * far)

    @property
    def inverse_totals(self) -> tuple[FloatArray, FloatArray]:
        """1 / T of the shortest and of the longest sum T."""
        far, near_mu, far_mu, margin, sine, cosine, room = self
        # where the lower limit of |D| meets the upper one by the angle, and by the margin
        by_angle = np.sqrt(((far_mu * cosine) ** 2 - (near_mu * sine) ** 2) / (cosine**2 - sine**2))
        square, middle = (margin * sine) ** 2 + cosine**2, margin * room * sine**2
        root = np.maximum(middle**2 + square * (far_mu**2 - (room * sine) ** 2), 0.0)
        by_margin = (middle + np.sqrt(root)) / square
        least = np.maximum((1 + margin) / (1 - margin) * far, np.maximum(by_angle, by_margin))
        return 1 / least, np.maximum(sine / near_mu, margin / room)

    def differences(self, total: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Bounds of |D| for a sum T."""
        below = np.sqrt(np.maximum(self.far_mu**2 - (total * self.cosine) ** 2, 0.0))
        above = np.sqrt(np.maximum(self.near_mu**2 - (total * self.sine) ** 2, 0.0)) / self.cosine
        low = below / np.maximum(self.sine, 1e-300)
        return low, np.minimum(above, self.room - self.margin * total)


def _of_slider(shares: FloatArray, _longer: BoolArray, demand: Demand) -> Sizes:
    """|offset - r2 cos(phi)| <= cos(mu) r3; with a margin r2 + |offset| <= (1 - margin) / (1 + margin) r3.

    One number is a share of r2 / (r2 + r3), another a share of the remaining range of the offset.
    """
    widest = np.minimum(np.cos(demand.transmission), (1 - demand.margin) / (1 + demand.margin))
    apart = np.subtract(demand.most, demand.least)
    share = shares[..., 0] * 2 * widest / (2 * widest + apart)
    r2 = share / (1 - share)
    offset = r2 * demand.most - widest + shares[..., 1] * (2 * widest - r2 * apart)
    return Sizes(np.zeros_like(r2), r2, np.ones_like(r2), offset)


def _of_block(shares: FloatArray, longer_driver: BoolArray, demand: Demand) -> Sizes:
    """|offset| <= cos(mu) near, and with a margin |offset| <= (near - margin far) / (1 + margin)."""
    margin = np.asarray(demand.margin)
    r2 = demand.crank(shares[..., 0], longer_driver, margin)
    near, far = demand.diagonals(r2)
    most = np.minimum(np.cos(demand.transmission) * near, (near - margin * far) / (1 + margin))
    return Sizes(np.ones_like(r2), r2, np.zeros_like(r2), most * (2 * shares[..., 1] - 1))


_LENGTHS: dict[type[ClosingDyad], Callable[[FloatArray, BoolArray, Demand], Sizes]] = {
    Bars: _of_bars,
    Slider: _of_slider,
    Block: _of_block,
}
