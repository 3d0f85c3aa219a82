"""A cylinder as pictures show it: body and rod between its two pivots."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.four_bar.position import Position
from grashof.analysis.judge.driven import figures_of
from grashof.figures.subject import Subject
from grashof.problems.values.arrays import FloatArray

BODY, ROD, BASE = "#5d6d7e", "#aab2b9", "#17202a"
_SHARE = 0.9  # of the closed length is its body


def cylinder_places(subject: Subject, position: Position) -> FloatArray:
    """Base, end of the body, and pivot of the link in N positions, shape (N, 3, 2); N is 0 without one."""
    verdict, problem = subject.verdict, subject.problem
    if verdict is None or problem is None or verdict.cylinder is None:
        return np.zeros((0, 3, 2))
    found = cylinder_state(verdict.cylinder, subject.linkage, position)
    figures = figures_of(subject.linkage, problem.task, verdict)
    closed = float(found.length.min()) if figures is None else figures.closed
    base = np.broadcast_to(np.asarray(verdict.cylinder.base), found.pivot.shape)
    share = np.minimum(_SHARE * closed / np.maximum(found.length, 1e-300), 1.0)[:, None]
    return np.stack([base, base + share * (found.pivot - base), found.pivot], axis=1)


class DrawnCylinder:
    """A cylinder as drawn in one position, to be moved to others.

    Parameters
    ----------
    axes : Axes
    places : ndarray, shape (3, 2), length
        Base, end of the body, and pivot of the link.
    shade : float
        From 0, invisible, to 1.
    named : bool
        Whether the legend names it.
    """

    def __init__(self, axes: Axes, places: FloatArray, shade: float = 1.0, *, named: bool = True) -> None:
        look = {"alpha": shade, "solid_capstyle": "butt", "zorder": 3.2}
        (self._rod,) = axes.plot(*places[1:].T, color=ROD, linewidth=2.6, **look)
        label = "cylinder" if named else None
        (self._body,) = axes.plot(*places[:2].T, color=BODY, linewidth=6.5, label=label, **look)
        pins = {"linestyle": "none", "marker": "o", "color": "white", "markeredgecolor": BASE}
        (self._pins,) = axes.plot(*places[::2].T, markersize=5, zorder=5.5, alpha=shade, **pins)

    @property
    def artists(self) -> list[Artist]:
        """All that moves."""
        lines: list[Line2D] = [self._rod, self._body, self._pins]
        return list(lines)

    def move(self, places: FloatArray) -> None:
        """Put it where its three places now are, shape (3, 2)."""
        self._rod.set_data(*places[1:].T)
        self._body.set_data(*places[:2].T)
        self._pins.set_data(*places[::2].T)
