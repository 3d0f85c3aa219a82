"""The joints of each kind of linkage: pins or a slide, how they move, and where the frames of links begin."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage


class Joint(IntEnum):
    """The four joints, in the order of arrays that have an axis for them.

    One of those at B and O4 is a slide in slider kinds: the ground guides the slider of a slider-crank,
    which has no O4; the block of an inverted one, which turns about O4, guides the rod, so that B is no pin.
    """

    O2 = 0
    A = 1
    B = 2
    O4 = 3


# Which links a joint joins; motions in it are those of the second relative to the first.
JOINED = ((1, 2), (2, 3), (3, 4), (1, 4))


def slide_of(linkage: Linkage) -> Joint | None:
    """The joint that is a slide; None where all are pins."""
    return Joint(JOINED.index(linkage.mechanism.slides[0])) if linkage.mechanism.slides else None


def pins_of(linkage: Linkage) -> tuple[Joint, ...]:
    """The joints that are pins."""
    slide = slide_of(linkage)
    return tuple(joint for joint in Joint if joint is not slide)


def joint_name(linkage: Linkage, joint: Joint) -> str:
    """What a joint is called in tables and messages: O2, A, B, O4, or slide."""
    return "slide" if joint is slide_of(linkage) else joint.name


def joint_motion(state: Kinematics, joint: int) -> tuple[FloatArray, FloatArray]:
    """Angle and angular velocity of the second link of a joint relative to the first; in a slide its travel.

    Returns
    -------
    ndarray, shape (...), rad and rad/s; or length and length/s
        The travel of B from the foot of O2 on the line of the slide, or from A along the rod.
    """
    if joint == slide_of(state.linkage) and state.slide is not None:
        return state.slide.travel, state.slide.velocity
    first, second = JOINED[joint]
    angle, rate = state.angular(second)[:2]
    if first == 1:
        return angle, rate
    before, rate_before = state.angular(first)[:2]
    return angle - before, rate - rate_before


def slide_direction(state: Kinematics) -> FloatArray:
    """Unit vector along the slide, or the rod in its block, shape (..., 2): link 4 less a right angle."""
    return np.stack([np.sin(state.theta4), -np.cos(state.theta4)], axis=-1)


def slide_normal(state: Kinematics) -> FloatArray:
    """Unit vector across the slide, to its left, shape (..., 2)."""
    return np.stack([np.cos(state.theta4), np.sin(state.theta4)], axis=-1)


def output_rate(state: Kinematics) -> FloatArray:
    """Angular velocity of link 4, rad/s; of a slider its velocity along the slide, length/s."""
    slide = slide_of(state.linkage)
    return joint_motion(state, slide)[1] if slide is Joint.O4 else state.omega4


def moving_origins(linkage: Linkage) -> tuple[int, ...]:
    """The links whose frames begin in a point that moves."""
    kind = linkage.mechanism
    return tuple(link.number for link in kind.links[1:] if link.points[0] not in kind.ground)
