"""The room a linkage needs: the box around its pivots and all that its points reach."""

from __future__ import annotations

import numpy as np

from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import greatest, own
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray

_SAMPLES = 361
_ROUNDS = 2  # at this sampling more of them change nothing


def reach_box(linkage: Linkage, start: float, end: float) -> FloatArray:
    """Box around the ground's pivots and all that the moving points reach between two driver angles.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    start, end : float, rad

    Returns
    -------
    ndarray, shape (2, 2), length
        Lower left and upper right corner.

    Notes
    -----
    The motion is sampled evenly for all links (`even_motion`), then ever closer about each extreme.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> reach_box(crank_rocker, 0.0, 2 * np.pi).round(6).tolist()
    [[-1.0, -1.0], [4.0, 3.0]]
    """
    motion = even_motion(linkage, start, end)

    def tracks(share: FloatArray) -> FloatArray:
        """The coordinates of each point that moves, and the same turned round."""
        state = solve_position(linkage, motion.theta2(share))
        rows = np.concatenate(
            [np.moveaxis(getattr(state, point), -1, 0) for point in linkage.mechanism.moving]
        )
        both = own(np.concatenate([rows, -rows]))
        closed = own(np.broadcast_to(np.isfinite(rows.sum(axis=0)), (len(both), *state.theta2.shape)))
        return np.where(closed, both, -np.inf)

    furthest = greatest(tracks, np.linspace(0, 1, _SAMPLES), most=2, rounds=_ROUNDS)[0].reshape(2, -1, 2)
    corners = np.stack([getattr(linkage, pivot) for pivot in linkage.mechanism.ground])
    most, least = np.where(np.isfinite(furthest), furthest, -np.inf)
    return np.stack([np.min([*corners, *-least], axis=0), np.max([*corners, *most], axis=0)])


def diagonal(box: FloatArray) -> float:
    """Diagonal of a box of two corners, shape (2, 2)."""
    return float(np.hypot(*(box[1] - box[0])))
