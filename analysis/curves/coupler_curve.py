"""The coupler curve: P with its derivatives, its samples along the motions of a driver, and as a polygon."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import STEADY, closed_at, closes, coupler_point, move, point_rates
from grashof.analysis.mechanism.even_motion import closer_at_ends
from grashof.analysis.mechanism.mobility import closes_everywhere, driver_ranges, range_index
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray, Limits, turned_from

PIECES = 180  # of each range of the driver, for the search of points on the curve
_FINE = 180  # samples of half a turn, or of a range, from which the nodes are placed
_CHORD = 0.01  # longest chord, as a share of the extent of the curve
_BEND = np.radians(4)  # largest turn between chords
_VISIBLE = 0.002  # share of the extent: turns between shorter chords do not count, as at a cusp
_MOST = 2000
_ROUNDS = 24
_LENGTH_SAME, _LENGTH_MOST = 1e-11, 50_000  # share by which lengths may differ; samples of a turn at most


class CouplerMotion(NamedTuple):
    """P = x + i y and the direction of its link, with two derivatives by the driver angle, shape (...)."""

    p: ComplexArray
    rate: ComplexArray
    bend: ComplexArray
    theta: FloatArray
    omega: FloatArray
    alpha: FloatArray


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def coupler_motion(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> CouplerMotion:
    """P and its link with derivatives by the driver angle; finite as in `coupler_curve`."""
    loops, frames = closed_at(linkage, theta2, assembly)
    _, turns = move(loops, STEADY, dead_below=0.0, last_too=True)
    at, carries = coupler_point(linkage, frames), linkage.mechanism.carries
    (vx, vy), (ax, ay), _ = point_rates(at, turns)
    p = linkage.o2[..., 0] + at.x + 1j * (linkage.o2[..., 1] + at.y)
    frame, (omega, alpha, _) = frames[carries], turns[carries].tangential
    theta = np.arctan2(frame.sine, frame.cosine)
    found = CouplerMotion(p, vx + 1j * vy, ax + 1j * ay, theta, omega, alpha)
    if len(loops) == 1:
        return found
    closed = closes(loops)  # a loop that does not lead P may be open
    return CouplerMotion(*(np.where(closed, each, np.nan) for each in found))


def coupler_curve(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """P = x + i y (...) and two derivatives by theta2; NaN where open, not finite in dead positions."""
    return coupler_motion(linkage, theta2, assembly)[:3]


def closed_length(linkage: Linkage) -> float:
    """The length of the coupler curve over a full turn of the driver; NaN where it does not turn fully.

    By the trapezoidal rule, whose error falls exponentially on periodic functions.
    """
    length, count = np.inf, _FINE
    while count <= _LENGTH_MOST:
        theta2 = float(linkage.theta1) + np.arange(count) * TURN / count
        before, length = length, float(np.abs(coupler_curve(linkage, theta2)[1]).mean() * TURN)
        if not abs(length - before) > _LENGTH_SAME * length:
            break
        count *= 2
    return length


@dataclass(frozen=True, slots=True)
class Track:
    """A motion of the driver in M pieces on which the curve is nearly straight.

    Driver angles (M,) in rad and P (S, M) at the ends of each, on the assemblies `signs`. Floor and ceiling
    are the ends of the range of each piece, infinite where the driver turns fully; `cyclic` if the first
    piece follows the last.
    """

    low: FloatArray
    high: FloatArray
    start: ComplexArray
    end: ComplexArray
    signs: IntArray
    floor: FloatArray
    ceiling: FloatArray
    cyclic: bool


def tracks(linkage: Linkage, pieces: int, same_branch: bool) -> list[Track]:
    """All motions of the driver of a single linkage, in `pieces` per range.

    Without dead positions on its own assembly if `same_branch`; otherwise one over all ranges and assemblies.
    """
    if closes_everywhere(linkage):
        # Denser about the ground line, where a linkage near a change point moves fast.
        half = closer_at_ends(0.0, np.pi, _FINE + 1)
        fine = linkage.theta1 + np.concatenate([half, half[1:] + np.pi])
        return [_track(linkage, fine, (-np.inf, np.inf), pieces, same_branch, cyclic=True)]
    ends = [(low, high) for low, high in driver_ranges(linkage).tolist() if high > low]
    single = [between(linkage, *each, each, pieces, same_branch) for each in ends]
    return single if same_branch or len(single) < 2 else [_joined(single)]


def between(
    linkage: Linkage, start: float, end: float, ends: Limits, pieces: int, same_branch: bool
) -> Track:
    """The part of a range with these `ends` from `start` to `end` > `start`."""
    return _track(linkage, closer_at_ends(start, end, _FINE + 1), ends, pieces, same_branch, cyclic=False)


def _track(
    linkage: Linkage, fine: FloatArray, ends: Limits, pieces: int, same_branch: bool, *, cyclic: bool
) -> Track:
    """Pieces between `fine` angles, on which P and the driver, half and half, move equally far."""
    signs = int(linkage.assembly) * np.array([1] if same_branch else [1, -1])
    p = solve_position(linkage, fine, signs[:, None]).p
    step = np.hypot(*np.moveaxis(np.diff(p, axis=1), -1, 0)).max(axis=0)
    step = np.nan_to_num(step)
    turn = np.diff(fine)
    moved = np.concatenate([[0.0], np.cumsum(step / max(step.sum(), 1e-300) + turn / turn.sum())])
    nodes: FloatArray = np.interp(np.linspace(0, moved[-1], pieces + 1), moved, fine)
    if cyclic:
        nodes[-1] = nodes[0] + TURN
    z = solve_position(linkage, nodes, signs[:, None]).p @ np.array([1, 1j])
    floor, ceiling = (np.full(pieces, end) for end in ends)
    return Track(nodes[:-1], nodes[1:], z[:, :-1], z[:, 1:], signs, floor, ceiling, cyclic)


def range_around(linkage: Linkage, theta2: float) -> tuple[float, float]:
    """Ends of the range around an angle, counted from it, rad; NaN without one, infinite for a full turn."""
    if closes_everywhere(linkage):
        return -np.inf, np.inf
    index, inside = range_index(linkage, theta2)
    if index < 0:
        return np.nan, np.nan
    low, high = driver_ranges(linkage)[index] + (theta2 - inside)
    return float(min(low, theta2)), float(max(high, theta2))


def _joined(parts: list[Track]) -> Track:
    """Parts in order round the turn."""
    parts = sorted(parts, key=lambda part: part.low[0])
    low, high, start, end, floor, ceiling = (
        np.concatenate([getattr(part, name) for part in parts], axis=-1)
        for name in ("low", "high", "start", "end", "floor", "ceiling")
    )
    return Track(low, high, start, end, parts[0].signs, floor, ceiling, cyclic=True)


def smooth_polygon(
    curve: Callable[[FloatArray], FloatArray], places: npt.ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Places (M,) and points (M, 2) of a curve, dense enough to draw it as a polygon.

    Intervals of the places, in order, are halved while a chord exceeds a hundredth of the extent or turns by
    more than 4 deg, up to about 2000 places; points may be NaN.
    """
    places = np.asarray(places, dtype=np.float64)
    points = curve(places)
    for _ in range(_ROUNDS):
        cut = np.flatnonzero(_coarse(points))[: max(_MOST - len(places), 0)]
        if not cut.size:
            break
        between = (places[cut] + places[cut + 1]) / 2
        places = np.insert(places, cut + 1, between)
        points = np.insert(points, cut + 1, curve(between), axis=0)
    return places, points


def _coarse(points: FloatArray) -> npt.NDArray[np.bool_]:
    """Chords to halve, shape (N - 1,); none beside a gap."""
    known = points[np.isfinite(points).all(axis=1)]
    if len(known) < 2:
        return np.zeros(max(len(points) - 1, 0), dtype=bool)
    extent = np.ptp(known, axis=0).max()
    chords = np.diff(points, axis=0)
    lengths = np.hypot(*chords.T)
    coarse: npt.NDArray[np.bool_] = lengths > _CHORD * extent
    ways = np.arctan2(chords[:, 1], chords[:, 0])
    turns = np.abs(turned_from(ways[1:], ways[:-1]))
    longer = np.maximum(lengths[1:], lengths[:-1])
    bent = (turns > _BEND) & (longer > _VISIBLE * extent)
    coarse[1:] |= bent & (lengths[1:] > longer / 2)
    coarse[:-1] |= bent & (lengths[:-1] > longer / 2)
    return coarse
