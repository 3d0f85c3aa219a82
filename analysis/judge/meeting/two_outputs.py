"""The two outputs of a linkage: swing and time ratio of each, and how far they are from moving together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.mechanism.kinematics import is_slider
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.stroke import LinkStroke, link_stroke
from grashof.analysis.numerics.peaks import greatest
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray, turned_from

_SAMPLES = 721


@dataclass(frozen=True, slots=True)
class TwoOutputs:
    """Figures of two links that swing, over a full turn of the driver.

    `swings` in rad, infinite for a link that turns fully; `time_ratios` NaN for one that does not turn back
    exactly twice. `synchrony_error` is the greatest difference of the shares of their swings that they have
    done, in the same sense or in opposite ones, whichever is less; NaN where one of them turns fully.
    """

    swings: tuple[float, float]
    time_ratios: tuple[float, float]
    synchrony_error: float


def two_outputs(linkage: Linkage, links: tuple[int, int]) -> TwoOutputs | None:
    """Figures of two links; None where the driver does not turn fully, or one of them slides or is absent."""
    count = len(linkage.mechanism.links)
    if not full_rotation(linkage) or any(link > count or is_slider(linkage, link) for link in links):
        return None
    first, second = (link_stroke(linkage, link) for link in links)
    swings = tuple(np.inf if np.isnan(each.stroke) else each.stroke for each in (first, second))
    error = np.nan if np.inf in swings else _apart(linkage, links, (first, second))
    return TwoOutputs((swings[0], swings[1]), (first.time_ratio, second.time_ratio), error)


def _apart(linkage: Linkage, links: tuple[int, int], strokes: tuple[LinkStroke, LinkStroke]) -> float:
    """The synchrony error of links that swing."""

    def shares(theta2: FloatArray) -> list[FloatArray]:
        state, found = solve_position(linkage, theta2), []
        for link, stroke in zip(links, strokes, strict=True):
            low, high = stroke.value.min(), stroke.value.max()
            middle = (low + high) / 2
            found.append((middle + turned_from(state.angles[link], middle) - low) / (high - low))
        return found

    def same(theta2: FloatArray) -> FloatArray:
        one, other = shares(theta2)
        return np.abs(one - other)

    def opposite(theta2: FloatArray) -> FloatArray:
        one, other = shares(theta2)
        return np.abs(one + other - 1)

    every = np.linspace(0, TURN, _SAMPLES)
    return min(float(greatest(curve, every)[0][0]) for curve in (same, opposite))
