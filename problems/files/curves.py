"""Curves of drawings: smooth parts chained end to end, and places at even distances along them.

A part is its places at the Chebyshev points of its parameter, shape (NODES, 2), both ends among them. The
polynomial through them is the part itself for a line, a Bezier curve or a span of a spline without weights;
arcs of up to 90 degrees and rational spans differ from it by rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev, legendre

from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.checks import GREATEST
from grashof.problems.values.errors import ProblemError

POINTS = 40  # along a curve, where a file states no other number
NODES = 16  # of a part
QUARTERS = 4  # parts of a curve that is not a polynomial: of a full circle quarters
ENDS_MEET = 1e-6  # share of a drawing's size within which two ends are one place
_AT = chebyshev.chebpts2(NODES)
_NO_PARTNER = -1
_TOLERANCE = 1e-13  # of a length, as a share of the whole
_HALVINGS, _MOST_SPANS = 40, 4_000
_STEPS, _NEAR = 100, 1e-15  # of the search for a place, and its error in length, as a share of the whole
_LEAST = 1e-12  # length of a curve, as a share of its greatest coordinate
_ROUNDING = 4 * np.finfo(float).eps


def straight_part(start: npt.ArrayLike, end: npt.ArrayLike) -> FloatArray:
    """The part from one place to another; shape (1, NODES, 2)."""
    share = (1 + _AT[:, None]) / 2
    return np.asarray((1 - share) * np.asarray(start) + share * np.asarray(end), dtype=np.float64)[None]


def parts_of(places: Callable[[FloatArray], FloatArray], knots: FloatArray) -> FloatArray:
    """The parts of a curve between the M + 1 knots of its parameter; shape (M, NODES, 2).

    `places` are those at parameters, (K,) to (K, 2).
    """
    low, high = knots[:-1, None], knots[1:, None]
    at = np.where(_AT > 0, high - (high - low) * (1 - _AT) / 2, low + (high - low) * (1 + _AT) / 2)
    return places(at.ravel()).reshape(-1, NODES, 2)


def turned_back(parts: FloatArray) -> FloatArray:
    """The same curve from its end to its start."""
    return parts[::-1, ::-1]


def size_of(curves: Sequence[FloatArray]) -> float:
    """The longer side of the box around curves; `ProblemError` where it is none that can be computed with."""
    every = np.concatenate([curve.reshape(-1, 2) for curve in curves])
    if not (np.abs(every) <= GREATEST).all():
        raise ProblemError("the drawing has coordinates that are not finite or beyond 1e20")
    return float(np.ptp(every, axis=0).max())


def is_closed(curve: FloatArray) -> bool:
    """Whether a curve ends where it begins."""
    return bool(np.hypot(*(curve[0, 0] - curve[-1, -1])) <= 2 * ENDS_MEET * size_of([curve]))


def chained(curves: Sequence[FloatArray]) -> list[FloatArray]:
    """Curves joined where ends meet, each from the first of its curves on, in the sense of that one.

    Curves that are no longer than a meeting place is wide are left out. `ProblemError` where more than two
    ends meet.
    """
    place = 2 * ENDS_MEET * size_of(curves)
    curves = [curve for curve in curves if size_of([curve]) > place] or curves[:1]
    partner = _partners(curves, place)
    free, found = dict.fromkeys(range(len(curves))), []
    while free:
        first = 2 * next(iter(free))
        onward = _entered(first + 1, partner)
        last = onward[-1] if onward else first
        closed = partner[last ^ 1] == first
        before = [] if closed else [end ^ 1 for end in reversed(_entered(first, partner))]
        chain = [*before, first, *onward]
        found.append(
            np.concatenate([turned_back(curves[end // 2]) if end % 2 else curves[end // 2] for end in chain])
        )
        for end in chain:
            del free[end // 2]
    return found


def _partners(curves: Sequence[FloatArray], distance: float) -> IntArray:
    """The end that each end meets; ends of curve k are 2 k and 2 k + 1."""
    from scipy.spatial import KDTree

    ends = np.array([place for curve in curves for place in (curve[0, 0], curve[-1, -1])])
    _, near = KDTree(ends).query(ends, k=3, distance_upper_bound=distance * (1 + _ROUNDING) + 1e-300)
    others = (near < len(ends)) & (near != np.arange(len(ends))[:, None])
    for end in np.flatnonzero(others.sum(axis=1) > 1):
        x, y = ends[end].tolist()
        raise ProblemError(f"more than two ends meet at ({x:.6g}, {y:.6g}); a curve must not branch")
    met = np.where(others, near, _NO_PARTNER).max(axis=1)
    return np.asarray(met, dtype=np.int64)


def _entered(left: int, partner: IntArray) -> list[int]:
    """The ends at which curves are entered after an end was left, until none follows or the first does."""
    found: list[int] = []
    at = int(partner[left])
    while at != _NO_PARTNER and at // 2 != left // 2:
        found.append(at)
        at = int(partner[at ^ 1])
    return found


def even_places_along(curve: FloatArray, count: int) -> FloatArray:
    """Places (count, 2) at equal distances along a curve, from its start on.

    An open curve ends at the last of them; round a closed one the first would follow. `ProblemError` where
    the curve has no length.
    """
    size_of([curve])
    origin = curve[0, 0]
    shape = np.linalg.solve(chebyshev.chebvander(_AT, NODES - 1), curve - origin).transpose(1, 0, 2)
    rate = np.asarray(chebyshev.chebder(shape), dtype=np.float64)
    part, low, high, length = _spans(rate)
    ends = np.cumsum(length)
    if not length.size or ends[-1] <= _LEAST * np.abs(curve).max():
        raise ProblemError("the curve has no length")
    closed = is_closed(curve)
    wanted = ends[-1] * np.arange(count) / (count if closed else count - 1)
    span = np.minimum(np.searchsorted(ends, wanted, side="right"), len(ends) - 1)
    rest = wanted - ends[span] + length[span]
    at = _reached(rate, part[span], low[span], high[span], rest, _NEAR * ends[-1])
    places = np.asarray(origin + chebyshev.chebval(at[:, None], shape[:, part[span]], tensor=False))
    places[0] = origin
    if not closed:
        places[-1] = curve[-1, -1]
    return places


def _speed(rate: FloatArray, part: IntArray, at: FloatArray) -> FloatArray:
    """Distance by parameter, of parts (N,) at parameters (N, K)."""
    both = chebyshev.chebval(at[..., None], rate[:, part, None], tensor=False)
    return np.hypot(both[..., 0], both[..., 1])


def _length(rate: FloatArray, part: IntArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Lengths (N,) of parts between parameters, by Gaussian quadrature."""
    nodes, weights = legendre.leggauss(NODES)
    half = ((high - low) / 2)[:, None]
    return np.asarray((half * weights * _speed(rate, part, low[:, None] + half * (1 + nodes))).sum(axis=1))


def _spans(rate: FloatArray) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Part, parameters and length of the spans of a curve, in order: short where its speed varies sharply."""
    part = np.arange(rate.shape[1])
    low, high = np.full(len(part), -1.0), np.full(len(part), 1.0)
    whole = _length(rate, part, low, high)
    tolerance = _TOLERANCE * whole.sum()
    done = []
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        halves = np.stack([_length(rate, part, low, middle), _length(rate, part, middle, high)])
        rough = np.abs(halves.sum(axis=0) - whole) > tolerance
        done.append((part[~rough], low[~rough], high[~rough], whole[~rough]))
        part, whole = np.tile(part[rough], 2), halves[:, rough].ravel()
        low, high = (
            np.concatenate([low[rough], middle[rough]]),
            np.concatenate([middle[rough], high[rough]]),
        )
        if not len(part) or len(part) > _MOST_SPANS + rate.shape[1]:
            break
    part, low, high, whole = map(np.concatenate, zip(*done, (part, low, high, whole), strict=True))
    order = np.lexsort((low, part))
    order = order[whole[order] > 0]
    return part[order], low[order], high[order], whole[order]


def _reached(
    rate: FloatArray, part: IntArray, start: FloatArray, end: FloatArray, wanted: FloatArray, near: float
) -> FloatArray:
    """The parameters at lengths from `start` on, to `near`: Newton steps, bisection outside the bracket."""
    low, high = start.copy(), end.copy()
    at = (low + high) / 2
    left = np.arange(len(at))
    for _ in range(_STEPS):
        beyond = _length(rate, part[left], start[left], at[left]) - wanted[left]
        open_ = (np.abs(beyond) > near) & (high[left] - low[left] > _ROUNDING)
        left, beyond = left[open_], beyond[open_]
        if not len(left):
            break
        low[left] = np.where(beyond > 0, low[left], at[left])
        high[left] = np.where(beyond > 0, at[left], high[left])
        speed = _speed(rate, part[left], at[left, None])[:, 0]
        step = np.divide(beyond, speed, out=np.full_like(beyond, np.inf), where=speed > 0)
        tried, halved = at[left] - step, (low[left] + high[left]) / 2
        at[left] = np.where((low[left] <= tried) & (tried <= high[left]), tried, halved)
    return at
