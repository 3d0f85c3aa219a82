"""The sides of convex regions for the independent search, which shares nothing with `grashof.synth`."""

import numpy as np

from grashof.problems import Region

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
