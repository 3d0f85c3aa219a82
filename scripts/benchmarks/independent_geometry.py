"""Plane geometry of the independent search, which shares nothing with `grashof.synth`."""

from typing import Any

import numpy as np

from grashof.problems import Region
from grashof.problems.values.arrays import ComplexArray, FloatArray

HAIR = 1e-12  # added to the length of a line, which may be zero
BESIDE = 5e-7  # share of a segment: how far beside it a joint may lie


def sides(region: Region) -> list[tuple[complex, float]]:
    """Inward normals of a convex polygon, or of both sides of a segment, and the least places along them."""
    corners = region.corners @ np.array([1, 1j])
    along = np.roll(corners, -1) - corners
    turns = np.sign((along.conj() * np.roll(along, -1)).imag)  # 1 where the corners go counter-clockwise
    if np.ptp(turns) > 1:
        raise ValueError("concave regions are not known here")
    normals = 1j * (turns.sum() or 1) * along
    least = (corners * normals.conj()).real / np.abs(normals) - BESIDE * np.abs(along) * (
        region.on is not None
    )
    return list(zip(normals / np.abs(normals), least.tolist(), strict=True))


def elbow(line: ComplexArray, near: Any, far: Any, side: Any) -> ComplexArray:  # closure: RRR
    """From the start of a line to the point `near` from it and `far` from its end, left where `side` is 1."""
    length = np.abs(line) + HAIR
    along = (length**2 + near**2 - far**2) / (2 * length)
    across = np.sqrt(np.maximum(near**2 - along**2, 1e-16))  # in line where there is none
    found: ComplexArray = line / length * (along + 1j * side * across)
    return found


def past_toggle(at: Any, k: int) -> FloatArray:
    """Angle of driver and coupler past toggle at target k, rad, (B, 1)."""
    bend = (at.b - at.a) / (at.a - at.o2 + HAIR) + HAIR
    before = np.angle(bend[:, [0 if k else -1]] / bend[:, [k]])
    return np.asarray(-np.sign(before) * np.angle(bend[:, [k]] ** 2) / 2)  # whichever way the line points


def apart(at: Any, name: str) -> FloatArray:
    """Distance of two points at the targets, (B, N)."""
    one, other = (getattr(at, point) for point in name.split("-"))
    return np.asarray(np.abs(one - other))
