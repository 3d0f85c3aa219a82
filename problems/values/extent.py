"""Greatest distance between two points of many, without all pairs."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from grashof.problems.values.arrays import FloatArray

FEW = 64  # points up to which every pair is compared


def span(points: FloatArray) -> float:
    """Greatest distance between two of N points (N, 2).

    The two are corners of the convex hull on parallel lines that enclose it. Such pairs are at most as many
    as the corners, so that memory grows with N and time with N log N (Shamos 1978; Preparata & Shamos,
    *Computational Geometry*, 1985, section 4.2).
    """
    if len(points) <= FEW or not np.isfinite(points).all():
        return _greatest(points[:, None] - points[None])
    return _known_span(np.ascontiguousarray(points, dtype=np.float64).tobytes())


@lru_cache(maxsize=16)
def _known_span(data: bytes) -> float:
    """The span of many points, which is needed repeatedly."""
    points = np.frombuffer(data).reshape(-1, 2)
    corners = convex_corners(points)
    if len(corners) <= FEW:
        return _greatest(corners[:, None] - corners[None])
    count = len(corners)
    edges = np.roll(corners, -1, axis=0) - corners
    way = np.unwrap(np.arctan2(edges[:, 1], edges[:, 0]))
    # Where the line through the next edge in the opposite direction touches; one more on either side.
    opposite = np.searchsorted(np.concatenate([way, way + 2 * np.pi]), way + np.pi)
    across = (opposite[:, None] + np.arange(-1, 2)) % count
    here = np.arange(count)[:, None]
    ends = np.concatenate([corners[across] - corners[here], corners[across] - corners[(here + 1) % count]])
    return _greatest(ends)


def convex_corners(points: FloatArray) -> FloatArray:
    """Corners of the convex hull of N finite points (N, 2), counter-clockwise.

    Andrew's monotone chain (1979). Two points where all lie on a line, one where all are at one place.
    """
    ordered = np.unique(points, axis=0)
    low, high = ordered.min(axis=0), ordered.max(axis=0)
    unit = max(float(np.max(high - low)), np.finfo(np.float64).tiny)
    near: list[list[float]] = (
        (ordered - low) / unit
    ).tolist()  # products of these neither over- nor underflow
    count = len(near)
    chain = _lower(near, range(count)), _lower(near, range(count - 1, -1, -1))
    corners: FloatArray = ordered[[*chain[0][:-1], *chain[1][:-1]] or [0]]
    return corners


def _lower(points: list[list[float]], order: range) -> list[int]:
    """Indices, in order, of the points of a chain that turns left at each of them."""
    chain: list[int] = []
    for k in order:
        x, y = points[k]
        while len(chain) > 1:
            (x0, y0), (x1, y1) = points[chain[-2]], points[chain[-1]]
            if (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) > 0:
                break
            chain.pop()
        chain.append(k)
    return chain


def _greatest(separation: FloatArray) -> float:
    return float(np.hypot(separation[..., 0], separation[..., 1]).max(initial=0.0))
