"""The dwell of the last link of a six-bar: its band, with tolerances too, and the swing over the turn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.sensitivity import sensitivity, turn_sensitivity
from grashof.analysis.mechanism.stroke import link_stroke
from grashof.analysis.numerics.peaks import greatest
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray, turned_from
from grashof.problems.values.tasks.dwell_task import USUAL_TOLERANCE

_STARTS = 1440  # of the dwell, over a turn
_MOST, _ROUNDS = 4, 6  # of the best starts, refined
_WITHIN = 49  # driver angles within the dwell at which tolerances are counted


@dataclass(frozen=True, slots=True)
class DwellFigures:
    """The dwell of least band, and the swing; output in rad, of a slide in the unit of length.

    The output is the last link, or its slide; `start` and `end` are driver angles, the end ahead
    counter-clockwise.
    """

    start: float
    end: float
    band: float
    swing: float


def least_band(linkage: Linkage, rotation: float) -> DwellFigures | None:
    """The `rotation` of the driver, rad, over which the last link moves least; None without such a turn.

    The output is monotone between its limit positions, so that those within and the two ends decide.
    """
    if not full_rotation(linkage):
        return None
    found, output = link_stroke(linkage), _output(linkage)
    limits, inner = found.theta2, found.value
    if np.isnan(found.stroke):  # it turns fully
        return None
    middle = (inner.max() + inner.min()) / 2
    period = None if linkage.mechanism.loops[-1].slide_angle else TURN

    def near(theta2: FloatArray) -> FloatArray:
        """The output, unwrapped as at the limits, shape of `theta2`."""
        raw = output(theta2)
        return raw if period is None else middle + turned_from(raw, middle)

    def bands(start: FloatArray) -> FloatArray:
        within = (limits - start[..., None]) % TURN <= rotation
        ends = np.stack([near(start), near(start + rotation)], axis=-1)
        high, low = (
            np.concatenate([ends, np.where(within, inner, beyond)], axis=-1) for beyond in (-np.inf, np.inf)
        )
        band: FloatArray = low.min(axis=-1) - high.max(axis=-1)
        return band

    best, start = greatest(bands, np.linspace(0, TURN, _STARTS + 1), _MOST, _ROUNDS)
    return DwellFigures(float(start[0]), float(start[0]) + rotation, float(-best[0]), found.stroke)


def made_band(linkage: Linkage, found: DwellFigures, tolerance: float | None = None) -> float:
    """The band of a dwell with its dimensions off by three standard deviations, each a `tolerance`, length.

    The greatest difference of two positions within the dwell: the nominal one, and the root of the sum of the
    squares of what each dimension adds to it, linearised; 2e-4 of r1 where no tolerance is given.
    """
    tolerance = USUAL_TOLERANCE * float(linkage.r1) if tolerance is None else tolerance
    theta2 = np.linspace(found.start, found.end, _WITHIN)
    value = _output(linkage)(theta2)
    loop = linkage.mechanism.loops[-1]
    if loop.slide_angle:
        angle = getattr(linkage, loop.slide_angle)
        along = np.array([np.cos(angle), np.sin(angle), 0.0])
        slope = np.einsum("r,nrd->nd", along, sensitivity(_at_e(linkage), theta2))
    else:
        value = np.unwrap(value)
        slope = turn_sensitivity(linkage, theta2, loop.links[1])
    apart = value[:, None] - value
    off = np.sqrt(((slope[:, None] - slope) ** 2).sum(axis=-1))
    return float((apart + tolerance * off).max())


def _output(linkage: Linkage) -> Callable[[FloatArray], FloatArray]:
    """The angle of the last link, or the travel of the slide, of driver angles."""
    last = linkage.mechanism.loops[-1]

    def output(theta2: FloatArray) -> FloatArray:
        state = solve_position(linkage, theta2)
        found: FloatArray = state.travel if last.slide_angle else state.angles[last.links[1]]
        return found

    return output


def _at_e(linkage: Linkage) -> Linkage:
    """The same with P in E, on the slider."""
    given = linkage.stated | {"point_link": linkage.mechanism.links[-1].number, "coupler_point": (0.0, 0.0)}
    return type(linkage)(**given)
