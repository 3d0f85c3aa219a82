"""How deep moving points and links of many linkages reach, on the way, into areas kept out."""

from __future__ import annotations

import numpy as np
import shapely

from grashof.problems import FourBar, Requirements
from grashof.problems.values.areas import solid
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.theory.closure import coupler_of

TOUCHING = 1e-10  # sizes: a point no deeper inside counts as on the boundary
_SAMPLES = 13  # driver angles, the targets' ends among them
_ALONG = np.array([0.2, 0.4, 0.6, 0.8])  # of a link
_ROWS = 4000  # linkages at a time


def depth_on_the_way(
    points: ComplexArray, assembly: FloatArray, theta2: FloatArray, wanted: Requirements
) -> FloatArray:
    """Greatest depth of what must keep out, over sampled driver angles.

    Parameters
    ----------
    points : ndarray of complex, shape (n, 5), sizes
        O2, O4, and A, B, P at the first target.
    assembly : ndarray, shape (n,)
    theta2 : ndarray, shape (n, N), rad
        Driver angles along the motion.
    wanted : Requirements
        In the frame of the points.

    Returns
    -------
    ndarray, shape (n,), sizes
        Zero where no sample lies inside: the judge looks closer.
    """
    names = [name for name in points_kept_out(wanted) if name in FourBar.MOVING]
    links = "links" in wanted.keep_out_for
    deepest = np.zeros(len(points))
    for begin in range(0, len(points) if names else 0, _ROWS):
        rows = slice(begin, begin + _ROWS)
        places = _places(points[rows], assembly[rows], theta2[rows])
        tracks = [places[name] for name in names]
        if links:
            for one, other in (line for link in FourBar.LINKS[1:] for line in link.lines):
                tracks += [places[one] + share * (places[other] - places[one]) for share in _ALONG]
        track = np.concatenate(tracks, axis=1)
        closed = np.isfinite(track)
        inside = depth(wanted, names[0], np.where(closed, track, 0.0))
        deepest[rows] = np.where(closed, inside, 0.0).max(axis=1)
    return deepest


def _places(points: ComplexArray, assembly: FloatArray, theta2: FloatArray) -> dict[str, ComplexArray]:
    """Pivots and coupler point at sampled driver angles, each shape (n, samples)."""
    o2, o4, a, b, p = (column[:, None] for column in points.T)
    angle = theta2[:, :1] + (theta2[:, -1:] - theta2[:, :1]) * np.linspace(0, 1, _SAMPLES)
    at_a = o2 + np.abs(a - o2) * np.exp(1j * angle)
    with np.errstate(all="ignore"):
        coupler = coupler_of(o4 - at_a, np.abs(b - a), np.abs(b - o4), assembly[:, None])
        arm = coupler * ((p - a) / (b - a))
    fixed = np.ones_like(at_a)
    return {"o2": o2 * fixed, "o4": o4 * fixed, "a": at_a, "b": at_a + coupler, "p": at_a + arm}


def points_kept_out(wanted: Requirements) -> tuple[str, ...]:
    """Which of o2, o4, a, b, p must keep out of areas: those named, and the ends of links."""
    if not wanted.keep_out:
        return ()
    return tuple(name for name in FourBar.POINTS if {name, "links"} & set(wanted.keep_out_for))


def depth(wanted: Requirements, name: str, points: ComplexArray) -> FloatArray:
    """How deep points lie inside areas that `name` must keep out of; zero outside and where it need not.

    Parameters
    ----------
    wanted : Requirements
        In the frame of `points`.
    name : {"o2", "o4", "a", "b", "p"}
    points : ndarray of complex, shape (...)

    Returns
    -------
    ndarray, shape (...)

    Examples
    --------
    >>> square = Requirements(keep_out=[[[0, 0], [4, 0], [4, 4], [0, 4]]])
    >>> points = np.array([1 + 2j, 4 + 1j, 9])
    >>> depth(square, "o2", points).tolist(), depth(square, "a", points).tolist()
    ([1.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    """
    found = np.zeros(points.shape)
    if name not in points_kept_out(wanted):
        return found
    area = solid(wanted.keep_out)
    inside = shapely.contains_xy(area, points.real, points.imag)
    places = shapely.points(points.real[inside], points.imag[inside])
    found[inside] = shapely.distance(shapely.boundary(area), places)
    return np.where(found > TOUCHING, found, 0.0)
