"""How deep moving points and links of many linkages reach, on the way, into areas kept out."""

from __future__ import annotations

import numpy as np

from grashof.problems import Requirements
from grashof.problems.checks import ComplexArray, FloatArray
from grashof.synth.free_region import depth, points_kept_out

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
    names = [name for name in points_kept_out(wanted) if name not in ("o2", "o4")]
    links = "links" in wanted.keep_out_for
    deepest = np.zeros(len(points))
    for begin in range(0, len(points) if names else 0, _ROWS):
        rows = slice(begin, begin + _ROWS)
        places = _places(points[rows], assembly[rows], theta2[rows])
        tracks = [places[name] for name in names]
        if links:
            for one, other in (("o2", "a"), ("a", "b"), ("o4", "b"), ("a", "p"), ("b", "p")):
                tracks += [places[one] + share * (places[other] - places[one]) for share in _ALONG]
        track = np.concatenate(tracks, axis=1)
        closed = np.isfinite(track)
        inside = depth(wanted, names[0], np.where(closed, track, 0.0))
        deepest[rows] = np.where(closed, inside, 0.0).max(axis=1)
    return deepest


def _places(points: ComplexArray, assembly: FloatArray, theta2: FloatArray) -> dict[str, ComplexArray]:
    """Pivots and coupler point at sampled driver angles, each shape (n, samples)."""
    o2, o4, a, b, p = (column[:, None] for column in points.T)
    r3, r4 = np.abs(b - a), np.abs(b - o4)
    share = np.linspace(0, 1, _SAMPLES)
    angle = theta2[:, :1] + (theta2[:, -1:] - theta2[:, :1]) * share
    at_a = o2 + np.abs(a - o2) * np.exp(1j * angle)
    across = o4 - at_a
    square = np.abs(across) ** 2
    with np.errstate(all="ignore"):
        # AB by its shares along and left of A-O4.
        along = (square + r3**2 - r4**2) / (2 * square)
        left = assembly[:, None] * np.sqrt(r3**2 / square - along**2)
        coupler = across * (along + 1j * left)
        arm = coupler * ((p - a) / (b - a))
    fixed = np.ones_like(at_a)
    return {"o2": o2 * fixed, "o4": o4 * fixed, "a": at_a, "b": at_a + coupler, "p": at_a + arm}
