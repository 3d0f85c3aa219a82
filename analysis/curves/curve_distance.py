"""Hausdorff and Frechet distance of a closed coupler curve from a closed target."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.curves.coupler_curve import coupler_curve, tracks
from grashof.analysis.mechanism.even_motion import angles_of_rows
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import highest, summits
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray

_CURVE = 720
_EVERY = 4  # of the samples of the curve, for the Frechet distance
_TARGET = 64
_POLYGON = 256
_LONGER = 1.5  # most length of the curve between neighbouring samples, over their distance
_NEWTON = 6
_SETTLED = 1e-7  # of the distance, along the curve; the distance is right to the square
_FLAT = 1e-3
_FURTHEST = 6
_ROUNDS = 9
_POINTS = 17
_WALKED = 8  # steps between looks at the walks that remain
_TOGETHER = 8  # curves whose distances from a polygon fit well into a cache
_COMPLEX = np.array([1, 1j])


def curve_distances(
    linkage: Linkage, points: FloatArray, direction: npt.ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Distances between the polygon through points and the coupler curve over a turn of the driver.

    Parameters
    ----------
    linkage : Linkage
        One or a batch (n,), whose drivers turn fully.
    points : ndarray, shape (N, 2), length
        Corners of the polygon; the last may repeat the first.
    direction : array_like of int, shape (...)
        Sense of the driver for which the curve runs as the points do.

    Returns
    -------
    hausdorff : ndarray, shape (...), length
        Greatest distance of a point of either from the other, to 1e-9 of the size.
    frechet : ndarray, shape (...), length
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
    >>> [round(float(distance), 3) for distance in curve_distances(linkage, circle, 1)]
    [0.5, 0.5]
    """
    corners = points @ _COMPLEX
    if corners[0] == corners[-1]:
        corners = corners[:-1]
    batch = linkage if linkage.shape else linkage[None]
    senses = np.broadcast_to(direction, batch.shape)
    found = [
        _distances_of(batch[first : first + _TOGETHER], corners, senses[first : first + _TOGETHER])
        for first in range(0, len(senses), _TOGETHER)
    ]
    hausdorff, frechet = np.concatenate(found, axis=-1).reshape(2, *linkage.shape)
    return hausdorff[()], frechet[()]


def _distances_of(batch: Linkage, corners: ComplexArray, senses: IntArray) -> FloatArray:
    """Both distances of linkages (n,), shape (2, n); NaN where a curve has gaps."""
    curves, found = _Curves.of(batch), np.full((2, len(senses)), np.nan)
    if not (whole := np.isfinite(curves.p).all(axis=-1)).all():
        if whole.any():
            found[:, whole] = _distances_of(batch[whole], corners, senses[whole])
        return found
    target = _even(corners, _TARGET)
    to_edge, from_edge = list[FloatArray](), list[FloatArray]()
    for row, sense in enumerate(senses.tolist()):
        (track,) = tracks(batch[row], _CURVE, same_branch=True)
        curve = track.start[0][::_EVERY][::sense]
        to_edge.append(_to_edges(target, curve))
        from_edge.append(_to_edges(curve, target).T)
    hausdorff = np.maximum(_from_curves(curves, corners), _from_target(curves, corners))
    return np.stack([hausdorff, np.maximum(hausdorff, _frechet(np.stack(to_edge), np.stack(from_edge)))])


@dataclass(frozen=True, slots=True, eq=False)
class _Curves:
    """Closed coupler curves of linkages (n,): samples at even shares of the motion, shape (n, M).

    `angles` are the driver angles at shares (K, N) of the motions of rows (K,) of the batch.
    """

    linkage: Linkage
    share: FloatArray
    theta2: FloatArray
    p: ComplexArray
    angles: Callable[[FloatArray, IntArray], FloatArray]

    @classmethod
    def of(cls, linkage: Linkage) -> _Curves:
        rows, share = np.arange(linkage.shape[0]), np.linspace(0, 1, _CURVE + 1)
        angles = angles_of_rows(linkage, np.zeros(len(rows)), np.full(len(rows), TURN))
        theta2 = angles(np.broadcast_to(share, (len(rows), _CURVE + 1)), rows)
        return cls(linkage, share, theta2, solve_position(linkage[:, None], theta2).p @ _COMPLEX, angles)


def _from_curves(curves: _Curves, corners: ComplexArray) -> FloatArray:
    """Greatest distances of points of the curves from the polygon, shape (n,)."""
    gone = np.cumsum(np.abs(np.diff(curves.p, prepend=curves.p[:, :1])), axis=-1)

    def distance(place: FloatArray, rows: IntArray) -> FloatArray:
        each = zip(place, gone[rows], strict=True)
        share = np.stack([np.interp(at, lengths, curves.share) for at, lengths in each])
        points = solve_position(curves.linkage[rows, None], curves.angles(share, rows)).p @ _COMPLEX
        return np.asarray(_to_edges(points, corners).min(axis=-1))

    return _greatest_distances(distance, gone)


def _from_target(curves: _Curves, corners: ComplexArray) -> FloatArray:
    """Greatest distances of points of the polygon from the curves, shape (n,)."""
    gone = np.concatenate([[0.0], np.cumsum(np.abs(np.roll(corners, -1) - corners))])
    round_trip, theta2 = np.append(corners, corners[0]), curves.theta2[:, :-1]
    steps, around = np.diff(curves.theta2), np.concatenate([curves.p[:, -2:-1], curves.p], axis=-1)
    chords = np.abs(np.diff(around))
    beside = _LONGER * np.maximum(chords[:, 1:], chords[:, :-1])

    def distance(place: FloatArray, rows: IntArray) -> FloatArray:
        points = np.interp(place, gone, round_trip)
        x, y = (points[..., None].view(np.float64)[..., [axis]] for axis in (0, 1))
        far = np.sqrt((x - around.real[rows, None]) ** 2 + (y - around.imag[rows, None]) ** 2)
        here = far[..., 1:-1]
        close = here - beside[rows, None] <= here.min(axis=-1, keepdims=True)
        row, column, nearest = np.nonzero(close & (here <= far[..., :-2]) & (here <= far[..., 2:]))
        at = rows[row], nearest
        found = _nearest(curves.linkage[rows[row]], points[row, column], theta2[at], steps[at])
        firsts = np.searchsorted(row * points.shape[-1] + column, np.arange(points.size))
        return np.minimum.reduceat(found, firsts).reshape(place.shape)

    places = np.unique(np.concatenate([np.linspace(0, gone[-1], _POLYGON + 1), gone]))
    return _greatest_distances(distance, np.broadcast_to(places, (len(theta2), len(places))))


def _greatest_distances(
    distance: Callable[[FloatArray, IntArray], FloatArray], places: FloatArray
) -> FloatArray:
    """Greatest distances of points of lines from something, shape (n,).

    Places are lengths along the lines, ascending (n, N); `distance` takes places (K, N) of rows (K,). It
    changes no faster than the point moves: the highest samples are refined while a higher value may lie
    beside them.
    """
    values = distance(places, np.arange(len(places)))
    best, top = values.max(axis=-1), highest(np.where(summits(values), values, -np.inf), _FURTHEST)
    most = np.take_along_axis(values, top, axis=-1).ravel()
    beside = (np.clip(top + k, 0, places.shape[-1] - 1) for k in (-1, 1))
    low, high = (np.take_along_axis(places, each, axis=-1).ravel() for each in beside)
    rows = np.repeat(np.arange(len(places)), _FURTHEST)
    for _ in range(_ROUNDS):
        hopeful = most + _LONGER * (high - low) > best[rows]
        rows, low, high = rows[hopeful], low[hopeful], high[hopeful]
        if not rows.size:
            break
        near = np.linspace(low, high, _POINTS, axis=-1)
        here, row = distance(near, rows), np.arange(len(near))
        peak = here.argmax(axis=-1)
        most = here[row, peak]
        np.maximum.at(best, rows, most)
        low, high = (near[row, np.clip(peak + k, 0, _POINTS - 1)] for k in (-1, 1))
    return np.asarray(best)


def _nearest(linkage: Linkage, points: ComplexArray, theta2: FloatArray, reach: FloatArray) -> FloatArray:
    """Distance of points from the curves (n,) near driver angles (n,), by Newton steps up to `reach` (n,)."""
    best, left = np.full(theta2.shape, np.inf), np.arange(len(theta2))
    for _ in range(_NEWTON):
        p, rate, bend = coupler_curve(linkage[left], theta2[left])
        gap = p - points[left]
        best[left] = np.minimum(best[left], np.abs(gap))
        speed, slope = np.abs(rate) ** 2, (rate.conj() * gap).real
        second = speed + (bend.conj() * gap).real
        with np.errstate(divide="ignore", invalid="ignore"):  # in a cusp
            step = np.nan_to_num(slope / np.where(second > _FLAT * speed, second, speed))
        theta2[left] -= np.clip(step, -reach[left], reach[left])
        left = left[np.sqrt(speed) * np.abs(step) > _SETTLED * np.abs(gap)]
        if not left.size:
            break
    return best


def _even(corners: ComplexArray, count: int) -> ComplexArray:
    """Corners of a closed polygon and points between them, about `count` in all."""
    edges = np.roll(corners, -1) - corners
    length = np.abs(edges)
    pieces = np.maximum(np.ceil(length / length.sum() * count), 1).astype(np.int64)
    first = np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = (np.arange(pieces.sum()) - first) / np.repeat(pieces, pieces)
    return np.asarray(np.repeat(corners, pieces) + share * np.repeat(edges, pieces))


def _to_edges(points: ComplexArray, polygon: ComplexArray) -> FloatArray:
    """Distance of points (...) from each edge of a closed polygon, shape (..., edges)."""
    edge = np.roll(polygon, -1) - polygon
    offset = points[..., None] - polygon
    share = np.clip((offset * edge.conj()).real / np.maximum(np.abs(edge) ** 2, 1e-300), 0.0, 1.0)
    return np.asarray(np.abs(offset - share * edge))


def _frechet(to_edge: FloatArray, from_edge: FloatArray) -> FloatArray:
    """Frechet distances of pairs of closed polygons, over all starting pairs, shape (n,).

    `to_edge` (n, c, m) is from corner i of the first to edge j of the second, `from_edge` from corner j of
    the second to edge i of the first. The leash is longest where one walker passes a corner and the other is
    on an edge (Alt & Godau 1995). Going back inside an edge is not excluded: an error of the order of the
    sagitta.
    """
    # All walks pass every corner of the first: start at the one close to the fewest edges.
    rows, corners = np.arange(len(to_edge)), np.arange(to_edge.shape[1])
    limit = _leash(to_edge, from_edge, rows, to_edge[:, 0].argmin(axis=-1), np.full(len(rows), np.inf))
    first = (to_edge < limit[:, None, None]).sum(axis=-1).argmin(axis=-1)
    turned = rows[:, None], (corners + first[:, None]) % len(corners)
    to_edge, from_edge = to_edge[turned], from_edge[turned]
    rows, begin = np.nonzero(to_edge[:, 0] < limit[:, None])
    return _leash(to_edge, from_edge, rows, begin, limit)


def _leash(
    to_edge: FloatArray, from_edge: FloatArray, rows: IntArray, begin: IntArray, limit: FloatArray
) -> FloatArray:
    """Shortest leashes of walks from corner 0 and edges `begin` of pairs `rows`; at most the limits, (n,).

    By dynamic programming over pairs of edges; walks that have come to the limit end.
    """
    c, m = to_edge.shape[1:]
    row = np.arange(c + 1)
    column = (np.arange(c + 2 * m + 1)[:, None] - row) % m
    entered_first, entered_second = to_edge[:, row % c, column], from_edge[:, row % c, column]
    walked = np.full((len(begin), c + 1), np.inf)
    walked[:, 0] = to_edge[rows, 0, begin % m]
    for k in range(1, c + m + 1):
        if k % _WALKED == 0:
            shorter = walked.min(axis=1) < limit[rows]
            walked, rows, begin = walked[shorter], rows[shorter], begin[shorter]
            if not rows.size:
                break
        onward = np.maximum(walked, entered_second[rows, begin + k])
        across = np.maximum(walked[:, :-1], entered_first[rows, begin + k, 1:])
        np.minimum(onward[:, 1:], across, out=onward[:, 1:])
        onward[:, : max(k - m, 0)] = np.inf
        walked = onward
    found = limit.copy()
    np.minimum.at(found, rows, walked[:, c])
    return found
