"""Watt II linkages whose links 4 and 6 have given swings, many at once in closed form.

The first four-bar is a crank-rocker with a swing (`crank_rockers`). The second one is another such, driven
by the crank, or it is driven by link 4, which carries C from C1 to C2. Then with D = 0 and the unit vectors
u1, u2 along link 6 in its limit positions r5 = |r6 u1 - C1| = |r6 u2 - C2|, so that

    r6 = (|C2|² - |C1|²) / (2 (C2 · u2 - C1 · u1))

Between these positions link 6 has to move in one sense.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray
from grashof.problems.values.tasks.tandem_task import TANDEM_HOSTS
from grashof.synth.loop.dyad import Bars, Closed, Rates, as_complex, as_vector, root_or_zero
from grashof.synth.theory.limit_positions import StrokeLinkages, crank_rockers, lag_of, worst_between
from grashof.synth.theory.sampled import highest

SAMPLES = 73  # of a turn
DRIVEN_BY_4, DRIVEN_BY_CRANK = TANDEM_HOSTS
SHAPE = 5  # numbers of a shape in the unit interval
ARMS = (0.1, 3.0)  # lengths O4C, over O4D, of those driven by link 4
SHARES = (0.005, 0.995)  # r2 / r3


class Swings(NamedTuple):
    """Swings of links 4 and 6, rad, and their time ratios where these are stated."""

    swings: tuple[float, float]
    time_ratios: tuple[float | None, float | None]

    @property
    def together(self) -> bool:
        """Whether both outputs may turn back at once, as they do where link 4 drives the second four-bar."""
        first, second = self.time_ratios
        return None in (first, second) or first == second

    def ratios(self, hosts: tuple[int, int]) -> tuple[float | None, float | None]:
        """Those that the four-bars have: where link 4 drives, both outputs have that of the first."""
        first, second = self.time_ratios
        if hosts == DRIVEN_BY_CRANK:
            return first, second
        return (second if first is None else first), None


@dataclass(frozen=True, slots=True)
class Tandems:
    """Linkages (n,) with the parameters of `SixBar`, places as complex numbers.

    `margins` are positive where the driver turns fully and each four-bar swings on one assembly.
    """

    hosts: tuple[int, int]
    o2: ComplexArray
    o4: ComplexArray
    d: ComplexArray
    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    c: ComplexArray
    r5: FloatArray
    r6: FloatArray
    side: FloatArray
    side_2: FloatArray
    margins: FloatArray  # (n, k)

    def __len__(self) -> int:
        return len(self.r2)

    @property
    def lengths(self) -> dict[str, FloatArray]:
        """Of links, by name."""
        bars = {name: getattr(self, name) for name in ("r2", "r3", "r4", "r5", "r6")}
        return {"r1": np.abs(self.o4 - self.o2), **bars}

    def motion(self) -> TandemMotion:
        """All round the turn."""
        return TandemMotion.of(self)


class Chains(NamedTuple):
    """A four-bar in motion: its loop, and angular velocity and acceleration of its output."""

    loop: Closed
    ratio: FloatArray  # of the angular velocities of output and driver
    speed: FloatArray
    bend: FloatArray

    @classmethod
    def of(
        cls, ground: ComplexArray, crank: ComplexArray, bars: tuple[FloatArray, FloatArray], side: FloatArray,
        speed: FloatArray | float = 1.0, bend: FloatArray | float = 0.0,
    ) -> Chains:  # fmt: skip
        """Of a driver with an angular velocity and acceleration, in units of those of the crank."""
        r3, r4 = (each[:, None] for each in bars)
        loop = Bars().closed(as_vector(ground), as_vector(crank), r3, r4, side[:, None], root_or_zero)
        rates: Rates = Bars().rates(loop, as_vector(crank), r4)
        return cls(loop, rates.speed4, speed * rates.speed4, speed**2 * rates.rate4 + bend * rates.speed4)


@dataclass(frozen=True, slots=True)
class TandemMotion:
    """Linkages at even driver angles of a turn, (n, SAMPLES), the last one the first again."""

    first: Chains
    second: Chains
    a: ComplexArray
    b: ComplexArray
    c: ComplexArray
    e: ComplexArray

    @classmethod
    def of(cls, made: Tandems) -> TandemMotion:
        """All round the turn."""
        along = np.exp(1j * np.linspace(0, TURN, SAMPLES))
        o2, o4, d = (each[:, None] for each in (made.o2, made.o4, made.d))
        crank = made.r2[:, None] * along
        first = Chains.of(o4 - o2, crank, (made.r3, made.r4), made.side)
        across = as_complex(first.loop.across)
        if made.hosts == DRIVEN_BY_4:
            base, arm = o4, made.c[:, None] * across / made.r4[:, None]
            moved = first.speed, first.bend
        else:
            base, arm = o2, made.c[:, None] * along
            moved = np.ones_like(first.speed), np.zeros_like(first.bend)
        second = Chains.of(d - base, arm, (made.r5, made.r6), made.side_2, *moved)
        e = d + as_complex(second.loop.across)
        return cls(first, second, o2 + crank, o4 + across, base + arm, e)

    @property
    def accelerations(self) -> FloatArray:
        """Greatest angular acceleration of either output, at 1 rad/s, (n,)."""
        found: FloatArray = np.maximum(_peak(np.abs(self.first.bend)), _peak(np.abs(self.second.bend)))
        return found

    def synchrony_errors(self, swings: tuple[float, float]) -> FloatArray:
        """Greatest difference of the shares of their swings, in the sense that fits better, (n,)."""
        shares = []
        for chain, swing in zip((self.first, self.second), swings, strict=True):
            across = as_complex(chain.loop.across)
            turned = np.unwrap(np.angle(across), axis=1)
            middle = (_peak(turned) - _peak(-turned)) / 2
            shares.append((turned - middle[:, None]) / swing)
        one, other = shares
        found: FloatArray = np.minimum(_peak(np.abs(one - other)), _peak(np.abs(one + other)))
        return found

    def sizes(self, made: Tandems) -> FloatArray:
        """Diagonals of the boxes round all joints over the turn, (n,)."""
        pivots = np.stack([made.o2, made.o4, made.d], axis=1)
        every = np.concatenate([pivots, self.a, self.b, self.c, self.e], axis=1)
        found: FloatArray = np.hypot(np.ptp(every.real, axis=1), np.ptp(every.imag, axis=1))
        return found


def _peak(values: FloatArray) -> FloatArray:
    """The greatest of samples of a turn whose last is the first again, (n,)."""
    return highest(values[:, :-1])


def tandems(
    wanted: Swings,
    hosts: tuple[int, int],
    pivots: ComplexArray,
    shape: FloatArray,
    sides: BoolArray,
) -> Tandems:
    """Linkages by their pivots O2, O4, D (n, 3), numbers of their shape (n, SHAPE) in [0, 1], and two signs.

    The shape is the lag and the share r2 / r3 of the first four-bar (`crank_rockers`), then of one driven by
    the crank the same of the second, and the angle from O2A to O2C; of one driven by link 4 the length O4C,
    and in the middle of the swing the angles from O4D to O4C and to link 6. `sides` (n, 2) are the assembly
    of the first four-bar, and that of the second or whether links 4 and 6 turn in one sense.
    """
    o2, o4, d = pivots.T
    way, ratios = o4 - o2, wanted.ratios(hosts)
    first = _crank_rockers(wanted.swings[0], ratios[0], shape)
    r2, r3, r4 = np.abs(way) * first.lengths.T[1:]
    side, other = np.where(sides, 1.0, -1.0).T
    if hosts == DRIVEN_BY_CRANK:
        second = _crank_rockers(wanted.swings[1], ratios[1], shape[:, 2:])
        length, r5, r6 = np.abs(d - o2) * second.lengths.T[1:]
        c = length * np.exp(1j * TURN * shape[:, 4])
        margins = np.stack([first.margin, second.margin], axis=1)
        return Tandems(hosts, o2, o4, d, r2, r3, r4, c, r5, r6, side, other, margins)
    theta4 = np.angle(way) + np.pi - side * sum(limit_angles(first.lengths)) / 2
    c, r5, r6, side_2, margin = _driven_by_4(wanted.swings, d - o4, theta4, shape[:, 2:], other)
    margins = np.stack([first.margin, margin], axis=1)
    return Tandems(hosts, o2, o4, d, r2, r3, r4, c, r5, r6, side, side_2, margins)


def _crank_rockers(swing: float, ratio: float | None, shape: FloatArray) -> StrokeLinkages:
    """Those with a swing, and a time ratio where one is stated, by two numbers in [0, 1]."""
    low, high = lags(swing)
    if ratio is None:
        lag = low + shape[:, 0] * (high - low)
    else:
        least = lag_of(ratio)
        lag = np.where((shape[:, 0] < 0.5) & (-least > low), -least, least)
    share = SHARES[0] + shape[:, 1] * (SHARES[1] - SHARES[0])
    with np.errstate(all="ignore"):
        return crank_rockers(swing, lag, share)


def lags(swing: float) -> tuple[float, float]:
    """Least and greatest lag of a crank-rocker with a swing whose driver turns fully, rad."""
    return (-np.pi + swing) / 2, (np.pi + swing) / 2


def limit_angles(lengths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The angles from O4O2 to O4B in the limit positions, each (n,), by the triangles O2-B-O4."""
    r1, r2, r3, r4 = lengths.T
    far, near = (
        np.arccos(np.clip((r1**2 + r4**2 - side**2) / (2 * r1 * r4), -1, 1)) for side in (r3 + r2, r3 - r2)
    )
    return far, near


def _driven_by_4(
    swings: tuple[float, float],
    ground: ComplexArray,
    theta4: FloatArray,
    shape: FloatArray,
    sense: FloatArray,
) -> tuple[ComplexArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """C in the frame of link 4, r5, r6, the assembly and a margin, by O4D and the middle angle of link 4."""
    length = np.abs(ground) * np.exp(np.log(ARMS[0]) + shape[:, 0] * np.log(ARMS[1] / ARMS[0]))
    arm = length * ground / np.abs(ground) * np.exp(1j * TURN * shape[:, 1])  # O4C in the middle
    along = ground / np.abs(ground) * np.exp(1j * TURN * shape[:, 2])  # link 6 there
    turns = [np.exp(1j * sign * swings[0] / 2) for sign in (-1, 1)]
    c1, c2 = (arm * turn - ground for turn in turns)
    u1, u2 = (along * np.exp(1j * sense * sign * swings[1] / 2) for sign in (-1, 1))
    with np.errstate(all="ignore"):
        r6 = (np.abs(c2) ** 2 - np.abs(c1) ** 2) / (2 * (c2 * u2.conj() - c1 * u1.conj()).real)
        flip = np.sign(r6)
        u1, u2, r6 = flip * u1, flip * u2, np.abs(r6)
        e1, e2 = r6 * u1, r6 * u2
        r5 = np.abs(e1 - c1)
        # E left of C-D, in either limit position
        left = [((-each).conj() * (e - each)).imag / (r5 * r6) for each, e in ((c1, e1), (c2, e2))]
        # link 6 turns back where O4, C and E are in line
        still = [
            ((arm * turn).conj() * (e - each)).imag / (r5 * length)
            for turn, each, e in zip(turns, (c1, c2), (e1, e2), strict=True)
        ]
        margin = np.minimum(left[0] * left[1], still[0] * still[1])
    margin = np.nan_to_num(margin, nan=-1.0)
    sound = np.isfinite(r5) & np.isfinite(r6) & (r6 > 0) & (r5 > 0)
    r5, r6 = (np.where(sound, each, 1.0) for each in (r5, r6))
    return arm * np.exp(-1j * theta4), r5, r6, np.where(left[0] > 0, 1.0, -1.0), np.where(sound, margin, -1.0)


def transmissions(made: Tandems, motion: TandemMotion) -> FloatArray:
    """Worst transmission angle of both loops over the turn, rad, (n,); 0 where one does not close."""
    lengths = made.lengths
    first = worst_between(made.r3, made.r4, np.abs(lengths["r1"] - made.r2), lengths["r1"] + made.r2)
    gap = np.abs(motion.c - made.d[:, None])
    low, high = -_peak(-gap), _peak(gap)
    return np.minimum(first, worst_between(made.r5, made.r6, low, high))
