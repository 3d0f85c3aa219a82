"""The frame of a bar: from its link's origin towards its other joint."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.bars import bars_of
from grashof.analysis.forces.loads import turned
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray


class BarFrame(NamedTuple):
    """The bar of a link: how its own frame, u towards the other joint, lies in the link's, and its ends."""

    theta: FloatArray
    sign: FloatArray  # -1 where the other joint lies against the link's u-axis
    length: FloatArray
    low: FloatArray
    high: FloatArray

    def own(self, at: npt.ArrayLike) -> FloatArray:
        """A place of the link's frame in that of the bar."""
        place: FloatArray = np.asarray(at, dtype=np.float64) * self.sign[..., None]
        return place

    def turned(self, force: FloatArray) -> FloatArray:
        """A vector of global axes in the frame of the bar."""
        return turned(np.asarray(force), -self.theta) * self.sign[..., None]


def bar_frame(state: Kinematics, link: int) -> BarFrame:
    """The frame of the bar of a link in some states."""
    bar, theta, ahead = bars_of(state.linkage)[link], state.angular(link)[0], np.ones(())
    slide = state.slides[(link - 3) // 2] if (link, link + 1) in state.linkage.mechanism.slides else None
    if slide is not None:
        sign = np.where(slide.travel < 0, -1.0, 1.0)
        ends = bar.low * sign, bar.high * sign
        return BarFrame(theta, sign, np.abs(slide.travel), np.minimum(*ends), np.maximum(*ends))
    return BarFrame(theta, ahead, np.asarray(bar.high), np.asarray(bar.low), np.asarray(bar.high))
