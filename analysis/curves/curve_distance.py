"""Hausdorff and Frechet distance of a closed coupler curve from a closed target."""

from __future__ import annotations

import numpy as np

from grashof.analysis.curves.coupler_curve import coupler_curve, tracks
from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import greatest
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray

_CURVE = 720
_EVERY = 4  # of the samples of the curve, for the Frechet distance
_TARGET = 64
_POLYGON = 256
_NEAREST = 3  # samples of the curve from which the nearest point is sought
_NEWTON = 6
_FLAT = 1e-3
_FURTHEST = 6
_ROUNDS = 9
_COMPLEX = np.array([1, 1j])


def curve_distances(linkage: Linkage, points: FloatArray, direction: int) -> tuple[float, float]:
    """Distances between the polygon through points and the coupler curve over a turn of the driver.

    Parameters
    ----------
    linkage : Linkage
        A single linkage whose driver turns fully.
    points : ndarray, shape (N, 2), length
        Corners of the polygon; the last may repeat the first.
    direction : int
        Sense of the driver for which the curve runs as the points do.

    Returns
    -------
    hausdorff : float, length
        Greatest distance of a point of either from the other, to 1e-9 of the size.
    frechet : float, length
        Shortest leash of two walkers, one on each curve, who never go back; to about 1e-3 of the size, in
        most cases to 1e-6.

    Notes
    -----
    The Hausdorff distance comes from samples of both, refined about the furthest ones; the Frechet distance
    is that of the polygons through the samples.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)  # P is A: a circle of radius 1
    >>> angle = np.linspace(0, 2 * np.pi, 1000)
    >>> circle = 1.5 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    >>> [round(distance, 3) for distance in curve_distances(linkage, circle, 1)]
    [0.5, 0.5]
    """
    corners = points @ np.array([1, 1j])
    if corners[0] == corners[-1]:
        corners = corners[:-1]
    (track,) = tracks(linkage, _CURVE, same_branch=True)
    curve = track.start[0][::_EVERY][::direction]
    target = _even(corners, _TARGET)
    hausdorff = max(_from_curve(linkage, corners), _from_target(linkage, corners))
    return hausdorff, max(hausdorff, _frechet(_distances(target, curve), _distances(curve, target).T))


def _from_curve(linkage: Linkage, corners: ComplexArray) -> float:
    """Greatest distance of a point of the curve from the polygon."""
    motion = even_motion(linkage, 0.0, TURN)

    def distance(share: FloatArray) -> FloatArray:
        p: ComplexArray = solve_position(linkage, motion.theta2(share[0])).p @ _COMPLEX
        return np.asarray(_distances(p, corners).min(axis=1)[None])

    places = np.linspace(0, 1, _CURVE + 1)
    return float(greatest(distance, places, most=_FURTHEST, rounds=_ROUNDS)[0][0])


def _from_target(linkage: Linkage, corners: ComplexArray) -> float:
    """Greatest distance of a point of the polygon from the curve."""
    length = np.abs(np.roll(corners, -1) - corners)
    gone = np.concatenate([[0.0], np.cumsum(length)])
    round_trip = np.append(corners, corners[0])
    motion = even_motion(linkage, 0.0, TURN)
    theta2 = motion.theta2(np.arange(_CURVE) / _CURVE)
    steps = np.diff(theta2, append=TURN)
    curve = solve_position(linkage, theta2).p @ _COMPLEX

    def distance(place: FloatArray) -> FloatArray:
        points = np.interp(place[0], gone, round_trip)
        far = np.abs(points[:, None] - curve)
        beside = np.minimum(np.roll(far, 1, axis=1), np.roll(far, -1, axis=1))
        nearest = np.argpartition(np.where(far <= beside, far, np.inf), _NEAREST, axis=1)[:, :_NEAREST]
        far = _nearest(linkage, points[:, None], theta2[nearest], steps[nearest])
        return np.asarray(far.min(axis=1)[None])

    places = np.unique(np.concatenate([np.linspace(0, gone[-1], _POLYGON + 1), gone]))
    return float(greatest(distance, places, most=_FURTHEST, rounds=_ROUNDS)[0][0])


def _nearest(linkage: Linkage, points: ComplexArray, theta2: FloatArray, reach: FloatArray) -> FloatArray:
    """Distance of points from the curve near given driver angles, by Newton steps."""
    best = np.full(theta2.shape, np.inf)
    for _ in range(_NEWTON):
        p, rate, bend = coupler_curve(linkage, theta2)
        gap = p - points
        best = np.minimum(best, np.abs(gap))
        speed, slope = np.abs(rate) ** 2, (rate.conj() * gap).real
        second = speed + (bend.conj() * gap).real
        with np.errstate(divide="ignore", invalid="ignore"):  # in a cusp
            step = np.nan_to_num(slope / np.where(second > _FLAT * speed, second, speed))
        theta2 = theta2 - np.clip(step, -reach, reach)
    return best


def _even(corners: ComplexArray, count: int) -> ComplexArray:
    """Corners of a closed polygon and points between them, about `count` in all."""
    edges = np.roll(corners, -1) - corners
    length = np.abs(edges)
    pieces = np.maximum(np.ceil(length / length.sum() * count), 1).astype(np.int64)
    first = np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = (np.arange(pieces.sum()) - first) / np.repeat(pieces, pieces)
    return np.asarray(np.repeat(corners, pieces) + share * np.repeat(edges, pieces))


def _distances(points: ComplexArray, polygon: ComplexArray) -> FloatArray:
    """Distance of each point from each edge of a closed polygon, shape (points, edges)."""
    edge = np.roll(polygon, -1) - polygon
    offset = points[:, None] - polygon
    share = np.clip((offset * edge.conj()).real / np.maximum(np.abs(edge) ** 2, 1e-300), 0.0, 1.0)
    return np.asarray(np.abs(offset - share * edge))


def _frechet(to_edge: FloatArray, from_edge: FloatArray) -> float:
    """Frechet distance of two closed polygons, over all starting pairs.

    `to_edge` (n, m) is from corner i of the first to edge j of the second, `from_edge` from corner j of the
    second to edge i of the first. The leash is longest where one walker passes a corner and the other is on
    an edge (Alt & Godau 1995). Going back inside an edge is not excluded: an error of the order of the
    sagitta.
    """
    # All walks pass every corner of the first: start at the one close to the fewest edges.
    limit = _leash(to_edge, from_edge, np.array([np.argmin(to_edge[0])]))
    corner = int(np.argmin((to_edge < limit).sum(axis=1)))
    to_edge, from_edge = np.roll(to_edge, -corner, axis=0), np.roll(from_edge, -corner, axis=0)
    begin = np.flatnonzero(to_edge[0] < limit)
    return min(limit, _leash(to_edge, from_edge, begin)) if begin.size else limit


def _leash(to_edge: FloatArray, from_edge: FloatArray, begin: IntArray) -> float:
    """Shortest leash of walks from corner 0 and given edges: dynamic programming over pairs of edges."""
    n, m = to_edge.shape
    row = np.arange(n + 1)
    column = (np.arange(n + 2 * m + 1)[:, None] - row) % m
    entered_first, entered_second = to_edge[row % n, column], from_edge[row % n, column]
    walked = np.full((len(begin), n + 1), np.inf)
    walked[:, 0] = to_edge[0, begin % m]
    for k in range(1, n + m + 1):
        onward = np.maximum(walked, entered_second[begin + k])
        np.minimum(onward[:, 1:], np.maximum(walked[:, :-1], entered_first[begin + k, 1:]), out=onward[:, 1:])
        onward[:, (row > k) | (row < k - m)] = np.inf
        walked = onward
    return float(walked[:, n].min())
