"""The force between links 3 and 4 that closes the balance of both, for each kind of linkage."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from grashof.analysis.forces.joints import Joint, joint_motion, slide_direction, slide_normal
from grashof.analysis.forces.loads import Wrench, cross
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems import FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage


class Closing(NamedTuple):
    """What links 3 and 4 exert on each other, and what the slide does.

    Parameters
    ----------
    f43 : ndarray, shape (..., 2), N
        On link 3 by link 4, at B.
    slide_moment : ndarray, shape (...), N length
        Of the slide on link 4, about B; NaN without a slide.
    """

    f43: FloatArray
    slide_moment: FloatArray


def closing(state: Kinematics, demands: dict[int, Wrench], moments: FloatArray) -> Closing:
    """Force and slide moment that meet the demands of links 3 and 4.

    Parameters
    ----------
    state : Kinematics
    demands : dict of int to Wrench
        Force, and moment about the link's origin, that joints must exert on links 3 and 4.
    moments : ndarray, shape (4, ...), N length
        Of friction and torsion springs, on the second link of each joint; in a slide the force along it.

    Notes
    -----
    Two equations with the determinant `margin`:

    - four-bar: moments of link 3 about A and of link 4 about O4;
    - slider-crank: moments of link 3 about A, forces on the slider along the slide, which only friction
      resists; moments of the slider about B give that of the guide;
    - inverted: moments of the rod about A, and of the block about O4, of which the force along the rod
      is known; their arms are the travel and the offset.
    """
    return _CLOSINGS[type(state.linkage)](state.linkage, state, demands, moments)


def _by_pins(linkage: FourBar, state: Kinematics, demands: dict[int, Wrench], moments: FloatArray) -> Closing:
    turn3 = demands[3].moment - moments[1] + moments[2]
    turn4 = demands[4].moment - moments[2] - moments[3]
    sine = np.sin(state.theta4 - state.theta3)
    along3, along4 = turn4 / (linkage.r4 * sine), turn3 / (linkage.r3 * sine)
    f43 = along3[..., None] * direction(state.theta3) + along4[..., None] * direction(state.theta4)
    return Closing(f43, np.full(np.shape(along3), np.nan))


def _by_slider(
    linkage: SliderCrank, state: Kinematics, demands: dict[int, Wrench], moments: FloatArray
) -> Closing:
    along, across = slide_direction(state), slide_normal(state)
    rod = direction(state.theta3)
    turn3 = demands[3].moment - moments[1] + moments[2]
    pull = moments[3] - (demands[4].force * along).sum(axis=-1)
    push = (turn3 / linkage.r3 - pull * cross(rod, along)) / cross(rod, across)
    f43 = pull[..., None] * along + push[..., None] * across
    return Closing(f43, demands[4].moment - moments[2] + np.zeros(state.shape))


def _by_block(
    linkage: InvertedSliderCrank, state: Kinematics, demands: dict[int, Wrench], moments: FloatArray
) -> Closing:
    along, across = slide_direction(state), slide_normal(state)
    travel, _ = joint_motion(state, Joint.B)
    pull = -moments[2]
    moment = demands[4].moment - moments[3] - pull * linkage.offset
    push = (demands[3].moment - moments[1] + moment) / travel
    return Closing(pull[..., None] * along + push[..., None] * across, moment + np.zeros(state.shape))


_CLOSINGS: dict[type[Linkage], Callable[..., Closing]] = {
    FourBar: _by_pins,
    SliderCrank: _by_slider,
    InvertedSliderCrank: _by_block,
}


def direction(theta: FloatArray) -> FloatArray:
    """Unit vector of an angle, shape (..., 2)."""
    return np.stack([np.cos(theta), np.sin(theta)], axis=-1)
