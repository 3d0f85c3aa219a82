"""A cylinder as pictures show it: body and rod between its two pivots."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.judge.driven import figures_of
from grashof.analysis.mechanism.position import Position, places
from grashof.figures.parts import COLOURS
from grashof.figures.subject import Subject
from grashof.problems.values.arrays import FloatArray

BODY, ROD, BASE = "#5d6d7e", "#aab2b9", "#17202a"
_PINS, _BRACKET = [0, 2], [3, 2, 4]
_SHARE = 0.9  # of the closed length is its body


def cylinder_places(subject: Subject, position: Position) -> FloatArray:
    """Base, end of the body, pivot and the joints of its link in N positions, shape (N, 5, 2), or none."""
    verdict, problem = subject.verdict, subject.problem
    if verdict is None or problem is None or verdict.cylinder is None:
        return np.zeros((0, 5, 2))
    found = cylinder_state(verdict.cylinder, subject.linkage, position)
    figures = figures_of(subject.linkage, problem.task, verdict)
    closed = float(found.length.min()) if figures is None else figures.closed
    base = np.broadcast_to(np.asarray(verdict.cylinder.base), found.pivot.shape)
    share = np.minimum(_SHARE * closed / np.maximum(found.length, 1e-300), 1.0)[:, None]
    at, points = (
        places(subject.linkage, position),
        subject.linkage.mechanism.links[verdict.cylinder.link - 1].points,
    )
    one, other = at[points[0]], at[points[:2][-1]]  # a slider has one alone
    return np.stack([base, base + share * (found.pivot - base), found.pivot, one, other], axis=1)


class DrawnCylinder:
    """A cylinder as drawn in one position (`corners` (5, 2) of `cylinder_places`), to be moved to others.

    A bracket of the colour of the link it is `on` holds the pivot; `shade` is from 0, invisible, to 1.
    """

    def __init__(
        self, axes: Axes, on: str, corners: FloatArray, shade: float = 1.0, *, named: bool = True
    ) -> None:
        bracket: dict[str, Any] = {"color": COLOURS[on], "linewidth": 1.0, "alpha": shade, "zorder": 3.1}
        (self._bracket,) = axes.plot(*corners[_BRACKET].T, **bracket)
        look: dict[str, Any] = {"alpha": shade, "solid_capstyle": "butt", "zorder": 3.2}
        (self._rod,) = axes.plot(*corners[1:3].T, color=ROD, linewidth=2.6, **look)
        label = "cylinder" if named else None
        (self._body,) = axes.plot(*corners[:2].T, color=BODY, linewidth=6.5, label=label, **look)
        pins: dict[str, Any] = {"linestyle": "none", "marker": "o", "color": "white", "markeredgecolor": BASE}
        (self._pins,) = axes.plot(*corners[_PINS].T, markersize=5, zorder=5.5, alpha=shade, **pins)

    @property
    def artists(self) -> list[Artist]:
        """All that moves."""
        lines: list[Line2D] = [self._bracket, self._rod, self._body, self._pins]
        return list(lines)

    def move(self, corners: FloatArray) -> None:
        """Put it where its places now are, shape (5, 2)."""
        self._bracket.set_data(*corners[_BRACKET].T)
        self._rod.set_data(*corners[1:3].T)
        self._body.set_data(*corners[:2].T)
        self._pins.set_data(*corners[_PINS].T)
