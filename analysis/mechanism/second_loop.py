"""Driver ranges of six-bars: where the second loop closes, its dead positions, the extremes of its gap."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from grashof.analysis.mechanism.closing import close, dyad_of, operands_of
from grashof.analysis.mechanism.first_loop import CHANGE, first_ranges
from grashof.analysis.mechanism.first_motion import FirstMotion, first_motion, panel_edges
from grashof.analysis.numerics.peaks import Curve, last_where, with_extremes
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, turned_from

_PANELS = 480
_TOGETHER = 1e-7  # share of the lengths: error of the width where rounding misses a dead first loop
SAME = 1e-9  # rad: greatest difference of two values of one dead position


class Cut(NamedTuple):
    """Ranges in which both loops close, on the linkage's own assembly.

    The ranges, shape (K, 2), rad; which of the two loops is dead at each end, shape (K, 2, 2), meaningful
    without a limit of the transmission angle; driver angles at which the width of the second loop's gap has
    an extreme, closed or open; and its change points: dead positions with the loop closed on either side.
    """

    ranges: FloatArray
    dead: BoolArray
    extremes: FloatArray
    touched: FloatArray


_NOTHING = Cut(np.empty((0, 2)), np.empty((0, 2, 2), dtype=bool), np.empty(0), np.empty(0))


class Branches(NamedTuple):
    """Ranges of both assemblies of the first loop, (N, 2), rad; the sign of each, (N,); its circuits, (N, 2).

    A range has one circuit with `assembly_2` = +1 and one with -1.
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
    """The ranges of a single linkage in which both loops close.

    The gap is sampled over an even motion of the first loop with all its extremes among the samples, so that
    it meets a limit at most once between neighbours; halving then finds the place to rounding.
    """
    least, most = map(float, dyad_of(linkage, 2).limits(float(np.cos(transmission))))
    parts = [
        _part(linkage, low, high, (least, most))
        for low, high in first_ranges(linkage, transmission).tolist()
        if np.isfinite(low)
    ]
    return Cut(*map(np.concatenate, zip(_NOTHING, *parts, strict=True)))


def _part(linkage: Linkage, low: float, high: float, limits: tuple[float, float]) -> Cut:
    """The part of `cut` within one range of the first loop."""
    size, curve, motion = float(linkage.lengths.sum()), width(linkage), first_motion(linkage, low, high)
    full_turn = high - low > TURN - CHANGE
    share, extremes = _samples(curve, motion, full_turn)

    def missed(theta2: FloatArray) -> FloatArray:
        """Distance of the width from closing; below 0 where the loop closes."""
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
        # Begin where the loop is open.
        theta2 = motion.theta2(np.concatenate([share[seam:], share[: seam + 1] + 1]))
        missing = np.concatenate([missing[seam:], missing[: seam + 1]])
    closed, together = missing <= 0, [False, False]
    if not full_turn and len(theta2) > 1:  # both loops dead together, but for rounding
        for end, beside in ((0, 1), (-1, -2)):
            together[end] = bool(abs(missing[end]) <= _TOGETHER * size)
            closed[end] = closed[beside] if together[end] else closed[end]
    for first, last in _open_runs(closed):
        if missing[first:last].max() <= touching:
            closed[first:last] = True
    inner = closed[:-2] & closed[1:-1] & closed[2:] & (missing[1:-1] >= -touching)
    return Cut(*_ranges(missed, theta2, closed, full_turn, together), stationary, theta2[1:-1][inner])


def _samples(curve: Curve, motion: FirstMotion, full_turn: bool) -> tuple[FloatArray, FloatArray]:
    """Shares of a motion of the first loop that include all extremes of a curve, and the extremes."""
    share = panel_edges(_PANELS, motion.share(motion.ground_line()))

    def height(at: FloatArray) -> FloatArray:
        """The width times its size, which is smooth also where it vanishes."""
        values = curve(motion.theta2(at))
        return np.asarray(values * np.abs(values))

    finite = np.isfinite(height(share))
    return with_extremes(height, share[finite], periodic=full_turn)


def _open_runs(closed: BoolArray) -> list[tuple[int, int]]:
    """Begin and end (exclusive) of each run of open samples between closed ones."""
    change = np.flatnonzero(closed[1:] != closed[:-1]) + 1
    change = change[1:] if len(change) and closed[change[0]] else change
    return list(zip(change[:-1:2].tolist(), change[1::2].tolist(), strict=True))


def _ranges(
    missed: Curve, theta2: FloatArray, closed: BoolArray, full_turn: bool, together: list[bool]
) -> tuple[FloatArray, BoolArray]:
    """Ranges of the driver, and the loops that are dead at their ends."""
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
    """All ranges of a single linkage with their circuits, for either assembly of both loops.

    A dead position of the first loop joins the ranges that end in it; one of the second loop joins both of
    its assemblies.
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
    """Angles, repeated by full turns, that lie between two driver angles; ascending."""
    counts = np.arange(np.floor((low - TURN) / TURN), np.ceil((high + TURN) / TURN) + 1)
    every = np.sort((angles % TURN + TURN * counts[:, None]).ravel())
    return every[(every >= low) & (every <= high)]


def recurs(angles: FloatArray, low: FloatArray, high: FloatArray) -> BoolArray:
    """Which of angles (K,), but for full turns, lie between driver angles (N,), shape (N, K)."""
    first, last = (np.subtract.outer(each, angles) / TURN for each in (low, high))
    return np.asarray(np.floor(last) >= np.ceil(first))
