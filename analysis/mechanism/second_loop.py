"""Where the second loop of a linkage closes while the first one moves, and the extremes of its gap."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from grashof.analysis.mechanism.closing import close, dyad_of, operands_of
from grashof.analysis.mechanism.first_loop import CHANGE, first_ranges
from grashof.analysis.mechanism.first_motion import FirstMotion, first_motion, panel_edges
from grashof.analysis.numerics.peaks import last_where, with_extremes
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, turned_from

_PANELS = 480
_TOGETHER = 1e-7  # share of the lengths: what rounding of a first loop's dead position leaves of the width
SAME = 1e-9  # rad: so far apart two counts of one dead position may be

Curve = Callable[[FloatArray], FloatArray]


class Cut(NamedTuple):
    """What the second loop leaves of the ranges of the first, on the linkage's own assembly.

    The ranges, shape (K, 2), rad; which of the two loops is dead at each end, shape (K, 2, 2); driver angles
    at which the width of the second loop's gap has an extreme, also where it is open; and those at which it
    has a change point: it comes to a dead position there and is closed on either side. Without a limit of
    the transmission angle alone ends are dead positions.
    """

    ranges: FloatArray
    dead: BoolArray
    extremes: FloatArray
    touched: FloatArray


_NOTHING = Cut(np.empty((0, 2)), np.empty((0, 2, 2), dtype=bool), np.empty(0), np.empty(0))


class Branches(NamedTuple):
    """All ranges of both assemblies of the first loop, shape (N, 2), rad, and the sign of each, shape (N,).

    The circuit that each lies on with `assembly_2` = +1 and -1, shape (N, 2).
    """

    ranges: FloatArray
    assembly: FloatArray
    circuits: IntArray


def width(linkage: Linkage) -> Curve:
    """The width of the second loop's gap at driver angles, NaN where the first loop is open."""
    kind, operands = linkage.mechanism, operands_of(linkage)
    return lambda theta2: close(kind, operands, theta2)[0][1].width


@lru_cache(maxsize=256)
def cut(linkage: Linkage, transmission: float = 0.0) -> Cut:
    """What the second loop of a single linkage leaves of the ranges of the first.

    Its gap is sampled over an even motion of the first loop and each extreme refined, so that between two
    such places it meets a limit at most once; where it does is halved down to rounding.
    """
    limits = dyad_of(linkage, 2).limits(float(np.cos(transmission)))
    least, most = map(float, limits)
    size = float(linkage.lengths.sum())
    parts = [
        _part(linkage, low, high, (least, most), size)
        for low, high in first_ranges(linkage, transmission).tolist()
        if np.isfinite(low)
    ]
    return Cut(*map(np.concatenate, zip(_NOTHING, *parts, strict=True)))


def _part(linkage: Linkage, low: float, high: float, limits: tuple[float, float], size: float) -> Cut:
    """Of one range of the first loop."""
    curve, motion = width(linkage), first_motion(linkage, low, high)
    full_turn = high - low > TURN - CHANGE
    share, extremes = _samples(curve, motion, full_turn)

    def missed(theta2: FloatArray) -> FloatArray:
        """How far the loop is from closing; below 0 where it closes."""
        at = curve(theta2)
        return np.maximum(limits[0] - at, at - limits[1])

    if not len(share):
        return _NOTHING
    theta2, stationary, touching = motion.theta2(share), motion.theta2(extremes), CHANGE * size
    missing = missed(theta2)
    if full_turn:
        seam = int(missing.argmax())
        if missing[seam] <= touching:
            never = np.zeros((1, 2, 2), dtype=bool)
            return Cut(np.array([[low, high]]), never, stationary, theta2[missing >= -touching])
        # It begins where it is open.
        theta2 = motion.theta2(np.concatenate([share[seam:], share[: seam + 1] + 1]))
        missing = np.concatenate([missing[seam:], missing[: seam + 1]])
    closed, together = missing <= 0, [False, False]
    if not full_turn and len(theta2) > 1:  # what rounding leaves of both loops dead together
        for end, beside in ((0, 1), (-1, -2)):
            together[end] = bool(abs(missing[end]) <= _TOGETHER * size)
            closed[end] = closed[beside] if together[end] else closed[end]
    for first, last in _open_runs(closed):
        if missing[first:last].max() <= touching:
            closed[first:last] = True
    inner = closed[:-2] & closed[1:-1] & closed[2:] & (missing[1:-1] >= -touching)
    return Cut(*_ranges(missed, theta2, closed, full_turn, together), stationary, theta2[1:-1][inner])


def _samples(curve: Curve, motion: FirstMotion, full_turn: bool) -> tuple[FloatArray, FloatArray]:
    """Shares of a motion of the first loop, with all extremes of a curve among them, and these alone."""
    share = panel_edges(_PANELS, motion.share(motion.ground_line()))

    def height(at: FloatArray) -> FloatArray:
        """The width times its size, which is smooth also where it vanishes."""
        values = curve(motion.theta2(at))
        return np.asarray(values * np.abs(values))

    finite = np.isfinite(height(share))
    return with_extremes(height, share[finite], periodic=full_turn)


def _open_runs(closed: BoolArray) -> list[tuple[int, int]]:
    """First and beyond the last of all samples between two closed ones."""
    change = np.flatnonzero(closed[1:] != closed[:-1]) + 1
    change = change[1:] if len(change) and closed[change[0]] else change
    return list(zip(change[:-1:2].tolist(), change[1::2].tolist(), strict=True))


def _ranges(
    missed: Curve, theta2: FloatArray, closed: BoolArray, full_turn: bool, together: list[bool]
) -> tuple[FloatArray, BoolArray]:
    """Ranges of the driver, and which loops are dead at their ends."""
    change = np.flatnonzero(closed[1:] != closed[:-1])
    inside = np.where(closed[change], theta2[change], theta2[change + 1])
    outside = np.where(closed[change], theta2[change + 1], theta2[change])
    ends = last_where(lambda angle: missed(angle) <= 0, inside, outside).tolist()
    dead = [(False, True)] * len(ends)
    if closed[0]:
        ends, dead = [float(theta2[0]), *ends], [(not full_turn, together[0]), *dead]
    if closed[-1]:
        ends, dead = [*ends, float(theta2[-1])], [*dead, (not full_turn, together[1])]
    ranges = np.array(ends).reshape(-1, 2)
    turns = np.round(ranges.mean(axis=-1, keepdims=True) / TURN)
    return ranges - TURN * turns, np.array(dead, dtype=bool).reshape(-1, 2, 2)


@lru_cache(maxsize=64)
def branches(linkage: Linkage) -> Branches:
    """All ranges of a single linkage, and the circuits that they lie on with either assembly of both loops.

    Two ranges are joined where they end in one dead position of the first loop, and both assemblies of the
    second loop where a range ends in one of its own.
    """
    cuts = [cut(linkage.changed(assembly=sign)) for sign in (1, -1)]
    ranges, dead = (np.concatenate([getattr(found, name) for found in cuts]) for name in ("ranges", "dead"))
    assembly = np.repeat([1.0, -1.0], [len(found.ranges) for found in cuts])
    circuits = np.arange(2 * len(ranges)).reshape(-1, 2)

    def join(one: int, other: int) -> None:
        circuits[circuits == max(one, other)] = min(one, other)

    for number, end in np.ndindex(len(ranges), 2):
        in_first, in_second = dead[number, end]
        if in_second:
            join(*circuits[number])
        if in_first:
            away = np.abs(turned_from(ranges[:, end], ranges[number, end]))
            for other in np.flatnonzero(dead[:, end, 0] & (away <= SAME)):
                for side in (0, 1):
                    join(circuits[number, side], circuits[other, side])
    return Branches(ranges, assembly, np.unique(circuits, return_inverse=True)[1].reshape(-1, 2))


def recurring(angles: FloatArray, low: float, high: float) -> FloatArray:
    """All counts of some angles between two driver angles, ascending."""
    counts = np.arange(np.floor((low - TURN) / TURN), np.ceil((high + TURN) / TURN) + 1)
    every = np.sort((angles % TURN + TURN * counts[:, None]).ravel())
    return every[(every >= low) & (every <= high)]
